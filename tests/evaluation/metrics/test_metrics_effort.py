"""Operations and active time of scenes, and the paper's table of them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.evaluation.metrics.editing_effort import (
    PAPER_REFINED,
    PAPER_SCRATCH,
    active_s,
    effort_of,
    improvement,
    mean_row,
)


def event(time_s, step="do", counts_as="add", **more):
    held = {"kind": "fill", "counts_as": counts_as, "cells": 3, "class_id": 2, "actor": ""}
    return {"step": step, "time_s": time_s, **held, **more}


def test_idle_time_is_counted_up_to_ten_seconds():
    events = [event(0, "open"), event(4), event(104), event(105, "active"), event(107)]
    assert active_s(events) == 4 + 10 + 1 + 2


def test_between_two_sessions_is_no_time():
    assert active_s([event(0, "open"), event(2), event(5, "open"), event(6)]) == 3


@given(st.lists(st.floats(0, 1e6), max_size=30), st.floats(0, 100))
def test_active_time_is_bounded_and_moves_with_the_clock(times, shift):
    times = sorted(times)
    whole = active_s([event(t) for t in times])
    assert 0 <= whole <= min(10.0 * max(len(times) - 1, 0), (times or [0])[-1]) + 1e-6
    assert active_s([event(t + shift) for t in times]) == pytest.approx(whole, abs=1e-4)


def test_a_clock_that_is_set_back_takes_no_time_away():
    assert active_s([event(100), event(103), event(50), event(52)]) == 5


def test_operations_are_counted_by_what_they_count_as():
    events = [event(0, "open"), event(1), event(2, counts_as="delete"), event(3, "undo", "delete")]
    events += [event(4, "redo", "delete"), event(5, counts_as="orient", class_id=None)]
    found = effort_of("den", events, 30.0)
    assert (found.operations, found.undone, found.redone, found.cells) == (3, 1, 1, 9)
    assert {k: n for k, n in found.counted.items() if n} == {"add": 1, "delete": 1, "orient": 1}
    assert found.by_class == {2: 2} and found.by_kind == {"fill": 3}
    assert found.active_s == 5 and found.total_s == 35


def test_effort_means_are_over_scenes_with_known_times():
    one = effort_of("a", [event(0), event(5)], 10.0)
    two = effort_of("b", [event(0, counts_as="orient")])
    row = mean_row([one, two])
    assert row["operations"] == 1.5 and row["add"] == 1 and row["orient"] == 0.5
    assert (row["manual_s"], row["automatic_s"], row["total_s"]) == (2.5, 10.0, 12.5)
    assert mean_row([one])["add"] == 2


def test_no_scene_gives_no_figures():
    assert set(mean_row([]).values()) == {None}
    assert mean_row([]).keys() == mean_row([effort_of("a", [])]).keys()


def test_the_papers_figures_add_up():
    for row in (PAPER_SCRATCH, PAPER_REFINED):
        assert row["total_s"] == pytest.approx((row["automatic_s"] or 0) + row["manual_s"])
        parts = sum(row[kind] or 0 for kind in ("add", "delete", "orient"))
        assert row["operations"] == pytest.approx(parts)
    assert improvement(PAPER_SCRATCH["operations"], PAPER_REFINED["operations"]) == pytest.approx(
        13.9, abs=0.05
    )
    assert improvement(None, 3.0) is None and improvement(4.0, 0.0) is None

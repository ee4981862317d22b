"""Scores equal published definitions: test vectors, slow twins on 1,000 random paths, and laws."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.navigation.scores import (
    WalkedPath,
    cls,
    dtw_m,
    ndtw,
    paired_p,
    path_length_m,
    rate,
    score_episode,
    summarise,
)

LINE = np.stack([np.arange(40) * 0.25, np.zeros(40), np.zeros(40)], axis=1)


def slow_dtw(one, other):
    table = {(-1, -1): 0.0}
    for i in range(len(one)):
        for j in range(len(other)):
            before = [table.get(at, math.inf) for at in ((i - 1, j), (i, j - 1), (i - 1, j - 1))]
            table[i, j] = math.dist(one[i], other[j]) + min(before)
    return table[len(one) - 1, len(other) - 1]


def slow_cls(path, reference):
    kept = [math.exp(-min(math.dist(r, p) for p in path) / 3) for r in reference]
    coverage = sum(kept) / len(kept)
    expected = coverage * sum(math.dist(a, b) for a, b in pairwise(reference))
    walked = sum(math.dist(a, b) for a, b in pairwise(path))
    return coverage * expected / (expected + abs(expected - walked))


@pytest.mark.parametrize(
    ("path", "near", "covered"),
    [(LINE, 1.0, 1.0), (LINE + np.array([0, 1, 0]), 0.7165, 0.5134), (LINE[:1], 0.1969, 0.1508)],
)
def test_the_reference_vectors(path, near, covered):
    assert ndtw(path, LINE) == pytest.approx(near, abs=5e-5)
    assert cls(path, LINE) == pytest.approx(covered, abs=5e-5)


def test_a_thousand_random_paths_score_as_the_slow_versions_say():
    rng = np.random.default_rng(0)
    for _ in range(1000):
        path = np.cumsum(rng.normal(0, 0.4, (rng.integers(1, 12), 3)), axis=0)
        reference = np.cumsum(rng.normal(0, 0.4, (rng.integers(2, 12), 3)), axis=0)
        assert dtw_m(path, reference) == pytest.approx(slow_dtw(path, reference))
        assert cls(path, reference) == pytest.approx(slow_cls(path, reference))
        distance = np.linalg.norm(path - reference[-1], axis=1)
        stopped = bool(rng.integers(2))
        got = score_episode(WalkedPath(path, distance, stopped, len(path)), reference, radius_m=1.0)
        length = sum(math.dist(a, b) for a, b in pairwise(path))
        won = stopped and distance[-1] < 1
        assert got.spl == pytest.approx(won * distance[0] / max(distance[0], length))
        soft = max(0, 1 - distance[-1] / distance[0]) * distance[0] / max(distance[0], length)
        assert got.soft_spl == pytest.approx(soft)
        assert got.success == tuple(stopped and distance[-1] < r for r in (0.5, 1, 2, 3))
        assert got.oracle == tuple(distance.min() < r for r in (0.5, 1, 2, 3))
        assert got.sdtw == pytest.approx(won * got.ndtw)


def test_turns_on_the_spot_do_not_count_as_a_way():
    turned = np.repeat(LINE, 3, axis=0)
    assert ndtw(turned, LINE) == ndtw(LINE, LINE) == 1
    assert path_length_m(turned) == path_length_m(LINE)


def test_success_needs_a_stop_and_lies_strictly_under_the_radius():
    at_edge = WalkedPath(LINE[:2], np.array([9.0, 3.0]), True, 3)
    within = WalkedPath(LINE[:2], np.array([9.0, 2.999]), True, 3)
    silent = WalkedPath(LINE[:2], np.array([9.0, 0.1]), False, 3)
    assert score_episode(at_edge, LINE).success[-1] is False
    assert score_episode(within, LINE).success == (False, False, False, True)
    assert not any(score_episode(silent, LINE).success)
    assert all(score_episode(silent, LINE).oracle)


paths = st.lists(st.tuples(*[st.floats(-5, 5, allow_nan=False)] * 3), min_size=1, max_size=8).map(
    lambda points: np.array(points, float)
)


@given(paths, paths)
def test_dtw_does_not_know_which_path_is_which(one, other):
    assert dtw_m(one, other) == pytest.approx(dtw_m(other, one), abs=1e-9)
    assert dtw_m(one, one) == 0
    assert 0 <= ndtw(one, other) <= 1
    assert 0 <= cls(one, other) <= 1


def test_means_leave_out_ends_that_no_way_leads_from():
    good = score_episode(WalkedPath(LINE, 9.75 - LINE[:, 0], True, 41), LINE)
    lost = score_episode(WalkedPath(LINE[:2], np.array([9.75, np.inf]), True, 2), LINE)
    told = summarise([good, good, lost])
    assert told["ne_m"] == 0 and told["unreachable_ends"] == 1
    assert told["success_3m"]["share"] == pytest.approx(2 / 3)
    assert told["success_3m"]["low"] < 2 / 3 < told["success_3m"]["high"]
    assert told["spl"] == pytest.approx(2 / 3)


def test_rates_have_wilson_intervals():
    assert rate(0, 0).share == 0 and (rate(0, 0).low, rate(0, 0).high) == (0, 1)
    found = rate(206, 309)  # The paper's Extend, Next Action.
    z = 1.959963984540054
    middle = (206 + z * z / 2) / (309 + z * z)
    half = z * math.sqrt(206 * 103 / 309 + z * z / 4) / (309 + z * z)
    assert (found.low, found.high) == pytest.approx((middle - half, middle + half))


def test_agents_are_compared_item_by_item():
    one, other = np.array([1, 1, 0, 1, 1, 1, 1, 1], bool), np.array([0, 0, 1, 0, 0, 0, 1, 1], bool)
    assert paired_p(one, other) == pytest.approx(2 * (1 + 6) / 2**6)
    assert paired_p(one, one) == 1


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (
            lambda: ndtw(np.zeros((0, 3)), LINE),
            (r"shape \[N, 3\] with at " r"least one point, got \(0, 3\)"),
        ),
        (lambda: rate(3, 2), "hits must be 0 to 2, got 3"),
        (lambda: paired_p(np.ones(2), np.ones(3)), "both methods must be scored on the same items"),
        (
            lambda: WalkedPath(LINE, np.zeros(3), True, 1),
            ("distance_m must contain 40 non-negative numbers"),
        ),
        (
            lambda: score_episode(WalkedPath(LINE[:1], np.array([np.inf]), True, 1), LINE),
            "no path leads",
        ),
        (lambda: summarise([]), "at least one episode score"),
    ],
)
def test_what_cannot_be_scored_is_refused(call, text):
    with pytest.raises(ValueError, match=text):
        call()

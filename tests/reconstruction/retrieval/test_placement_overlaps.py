"""Overlaps of a cell give way, real ones and tucked chairs stay; crumbs are tidied."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture import template
from world2minecraft.furniture.layout_checks import collisions
from world2minecraft.reconstruction.retrieval.furniture_placement import merge_crumbs
from world2minecraft.reconstruction.retrieval.placement_settling import clear_overlaps

CLOSE = 1e-6


def _put(number, name, low, high, turns=0):
    class_id = SemanticClass.OBJS if name == "cells" else template(name).class_id
    low, high = np.array(low, float), np.array(high, float)
    size = (high - low)[[1, 0, 2]] if turns % 2 else high - low
    return Placement(number, class_id, name, (low + high) / 2, size, turns, 0.8)


def test_a_box_on_a_table_begins_at_its_top():
    table = _put(1, "dining_table", (0, 0, 0), (0.8, 1.6, 0.8), 0)
    box = _put(2, "box", (0.24, 0.24, 0.72), (0.48, 0.48, 1.04))
    for order in ([table, box], [box, table]):
        cleared = clear_overlaps(order, 0.08)
        assert collisions(cleared) == []
        by_name = {one.template: one for one in cleared}
        np.testing.assert_allclose(by_name["dining_table"].size_m, table.size_m)
        np.testing.assert_allclose(by_name["box"].center_m, (0.36, 0.36, 0.92))
        assert [one.object_id for one in cleared] == [one.object_id for one in order]


def test_longer_of_two_overlapping_cabinets_gives_way():
    short = _put(1, "cabinet", (0, 0, 0), (0.48, 0.8, 0.8))
    long = _put(2, "cabinet", (0, 0.72, 0), (0.48, 2.4, 0.8))
    first, second = clear_overlaps([short, long], 0.08)
    np.testing.assert_allclose(first.size_m, short.size_m)
    np.testing.assert_allclose(second.size_m, (0.48, 1.6, 0.8))
    assert collisions([first, second]) == []


def test_a_turned_piece_gives_way_along_the_right_side():
    one = _put(1, "cabinet", (0, 0, 0), (1.6, 0.48, 0.8), 1)
    other = _put(2, "cabinet", (1.52, 0, 0), (1.92, 0.4, 0.4))
    first, _ = clear_overlaps([one, other], 0.08)
    np.testing.assert_allclose(first.size_m, (0.48, 1.52, 0.8))


def test_what_is_as_small_as_it_may_be_leaves_it_to_the_other():
    small = _put(1, "cabinet", (0, 0.32, 0), (0.32, 0.64, 0.8))
    box = _put(2, "box", (0, 0.56, 0), (0.32, 0.8, 0.32))
    first, second = clear_overlaps([small, box], 0.08)
    assert first.size_m[1] >= 0.32 - CLOSE
    assert collisions([first, second]) == []


def test_tucked_chairs_deep_overlaps_and_own_runs_stay():
    table = _put(1, "dining_table", (0, 0, 0), (0.8, 1.6, 0.72))
    chair = _put(2, "chair", (0.72, 0.4, 0), (1.2, 0.88, 0.88))
    deep = _put(3, "box", (2.0, 2.0, 0), (2.4, 2.4, 0.4))
    deeper = _put(4, "box", (2.1, 2.1, 0.1), (2.5, 2.5, 0.5))
    runs = [_put(5, "cells", (5, 5, 0), (6, 6, 1)), _put(5, "cells", (5.9, 5, 0), (7, 6, 1))]
    given_ = [table, chair, deep, deeper, *runs]
    for before, after in zip(given_, clear_overlaps(given_, 0.08), strict=True):
        np.testing.assert_allclose(after.center_m, before.center_m)


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_boxes_only_shrink_and_collisions_never_grow(seed):
    rng = np.random.default_rng(seed)
    placed = []
    for number in range(1, 8):
        low = rng.integers(0, 20, 3) * 0.08
        placed.append(_put(number, "cells", low, low + rng.integers(1, 8, 3) * 0.08))
    cleared = clear_overlaps(placed, 0.08)
    assert len(collisions(cleared)) <= len(collisions(placed))
    for before, after in zip(placed, cleared, strict=True):
        room = (before.size_m - after.size_m) / 2
        assert (np.abs(after.center_m - before.center_m) <= room + 1e-3).all()


def _block(low, high):
    return np.argwhere(np.ones(np.subtract(high, low))).astype(np.int32) + np.array(low)


RUN = _block((0, 0, 0), (6, 20, 10))
RUN_BOX = (np.array((0, 0, 0)), np.array((6, 20, 10)))


def test_crumbs_in_a_template_and_specks_are_left_out():
    hidden = _block((6, 3, 2), (7, 6, 6))
    speck = _block((12, 3, 2), (13, 4, 5))
    standing = _block((1, 3, 10), (3, 6, 14))
    (kept,) = merge_crumbs([hidden, speck, standing], [RUN], [RUN_BOX])
    np.testing.assert_array_equal(kept, standing)


def test_crumbs_that_touch_become_one_and_no_cell_is_lost():
    crumbs = [_block((1, y, 10), (3, y + 3, 14)) for y in (0, 3, 6)]
    (kept,) = merge_crumbs(crumbs, [RUN], [RUN_BOX])
    assert {tuple(c) for c in kept} == {tuple(c) for one in crumbs for c in one}


def test_crumbs_whose_common_box_holds_a_run_stay_apart():
    over = _block((0, 0, 12), (6, 2, 16))
    beside = _block((6, 2, 3), (9, 4, 12))
    assert len(merge_crumbs([over, beside], [RUN], [RUN_BOX])) == 2

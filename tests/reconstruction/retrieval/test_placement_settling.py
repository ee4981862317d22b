"""Placements settled: none outside its room, no two solid in the same place, none lost."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from label_grids import grid_of

from world2minecraft.core.types import Layout, Placement
from world2minecraft.furniture.layout_checks import collisions, out_of_rooms
from world2minecraft.furniture.solid_parts import box_m, depth_m, solids_m
from world2minecraft.reconstruction.retrieval.placement_settling import (
    settle_placements,
    within_rooms,
)

VOXEL_M = 0.08
ROOM = Layout(np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float), 2.4)
ELL = Layout(np.array([[0, 0], [4, 0], [4, 1.5], [2, 1.5], [2, 3], [0, 3]], float), 2.4)
CUT = Layout(np.array([[0, 0], [4, 0], [4, 2], [3, 3], [0, 3]], float), 2.4)
EMPTY = grid_of(np.zeros((60, 50, 34), np.uint8))
SORTS = {
    "chair": (5, (0.48, 0.48, 0.88)),
    "dining_table": (8, (0.88, 1.6, 0.72)),
    "cabinet": (10, (0.48, 0.96, 0.88)),
    "sofa": (7, (0.88, 1.76, 0.8)),
    "box": (11, (0.4, 0.4, 0.4)),
}


def put(number, template, x, y, z=0.0, turns=0, size=None) -> Placement:
    class_id, usual = SORTS[template]
    size_m = np.array(size or usual)
    center = np.array([x, y, z + size_m[2] / 2])
    return Placement(number, class_id, template, center, size_m, turns, 0.7)


PLACEMENTS = st.lists(
    st.tuples(
        st.sampled_from(sorted(SORTS)),
        st.floats(-0.3, 4.3),
        st.floats(-0.3, 3.3),
        st.sampled_from([0.0, 0.4, 0.72]),
        st.integers(0, 3),
    ),
    min_size=1,
    max_size=5,
)


@settings(max_examples=40, deadline=None)
@given(PLACEMENTS, st.sampled_from([ROOM, ELL, CUT]))
def test_settled_placements_neither_collide_nor_lie_outside(rows, room):
    placed = [
        put(number, name, x, y, z, turns) for number, (name, x, y, z, turns) in enumerate(rows, 1)
    ]
    settled = settle_placements(placed, EMPTY, [room])
    assert collisions(settled, grid=EMPTY) == []
    assert out_of_rooms(settled, [room]) == []
    assert [one.object_id for one in settled] == sorted(one.object_id for one in settled)


@pytest.mark.parametrize("room", [ROOM, ELL, CUT])
def test_what_lies_within_and_apart_stays_as_it_is(room):
    placed = [put(1, "cabinet", 0.3, 0.6), put(2, "chair", 1.2, 1.2), put(3, "box", 1.2, 2.5)]
    settled = settle_placements(placed, EMPTY, [room])
    for before, after in zip(placed, settled, strict=True):
        np.testing.assert_allclose(box_m(after), box_m(before), atol=1e-4)


def test_tucked_chair_stays_one_through_the_top_moves():
    table = put(1, "dining_table", 2.0, 1.5)
    tucked = put(2, "chair", 2.4, 1.5, turns=2)  # Its back stands before the top.
    assert box_m(settle_placements([table, tucked], EMPTY)[1]) == pytest.approx(box_m(tucked))
    through = put(2, "chair", 2.15, 1.5, turns=2)
    moved = settle_placements([table, through], EMPTY)
    assert collisions([table, through]) == [(0, 1)] and collisions(moved) == []
    assert moved[1].template == "chair"
    assert box_m(moved[0]) == pytest.approx(box_m(table)), "people move chairs, not tables"
    assert 0 < moved[1].center_m[0] - through.center_m[0] <= 0.25


def test_a_picture_that_lies_in_the_wall_is_moved_onto_it():
    picture = put(1, "box", 4.1, 1.5, z=1.2, size=(0.08, 0.8, 0.6))
    inside = within_rooms(picture, [ROOM], VOXEL_M)
    assert inside is not None
    np.testing.assert_allclose(box_m(inside)[:, 0], [3.92, 4.0])
    np.testing.assert_allclose(inside.size_m, picture.size_m)


def test_placements_in_walls_are_cut_or_moved():
    cabinet = within_rooms(put(1, "cabinet", 0.16, 1.0), [ROOM], VOXEL_M)
    assert cabinet is not None
    np.testing.assert_allclose(box_m(cabinet)[:, 0], [0.0, 0.4])
    chair = within_rooms(put(1, "chair", 0.05, 1.0), [ROOM], VOXEL_M)
    assert chair is not None
    assert box_m(chair)[0, 0] == 0 and chair.size_m[0] >= 0.36


def test_a_thing_in_the_notch_of_an_l_goes_to_the_nearer_leg():
    sofa = within_rooms(put(1, "sofa", 2.05, 2.1), [ELL], VOXEL_M)
    assert sofa is not None and out_of_rooms([sofa], [ELL]) == []
    assert np.abs(sofa.center_m - [2.05, 2.1, 0.4]).max() <= 0.6


def test_far_outside_is_left_out_upstairs_stays_upstairs():
    assert within_rooms(put(1, "chair", 6.0, 1.0), [ROOM], VOXEL_M) is None
    upper = Layout(ROOM.floor_polygon_m, 2.4, floor_z_m=2.8)
    bed = within_rooms(put(1, "cabinet", 1.0, 1.0, z=2.72), [ROOM, upper], VOXEL_M)
    assert bed is not None and box_m(bed)[0, 2] == pytest.approx(2.8)


def test_the_same_placements_settle_the_same():
    placed = [put(n, "chair", 1.0 + 0.1 * n, 1.0, turns=n % 4) for n in range(1, 6)]
    first, again = (settle_placements(placed, EMPTY, [ROOM]) for _ in range(2))
    assert [box_m(a).tolist() for a in first] == [box_m(b).tolist() for b in again]


def test_cells_that_stand_out_of_their_thin_box_are_parted_too():
    """A box of 2 cm holds the middles of cells of 8 cm, which alone meet what stands beside."""
    instance = np.zeros(EMPTY.shape, np.uint16)
    instance[20, 10:14, 0:6] = 2
    grid = replace(EMPTY, instance=instance)
    x = float(grid.origin_m[0]) + 20.5 * VOXEL_M
    y = float(grid.origin_m[1]) + 12 * VOXEL_M
    low = float(grid.origin_m[2])
    size_m = np.array([0.02, 0.32, 0.48])
    thin = Placement(2, 11, "cells", np.array([x, y, low + 0.24]), size_m, 0, 1)
    beside = put(1, "box", x - 0.2 + 0.02, y, low)  # 3 cm into the thin box, 6 into its cells.
    assert depth_m(solids_m(beside, grid), solids_m(thin, grid)) > 0.05
    settled = settle_placements([beside, thin], grid)
    first, second = (solids_m(one, grid) for one in settled)
    assert depth_m(first, second) <= 0.04
    assert [one.object_id for one in settled] == [1, 2]

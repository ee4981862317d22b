"""Collisions, things out of bounds, and things that hang in the air."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.types import LayoutObject, Placement
from world2minecraft.furniture.layout_checks import (
    collisions,
    floaters,
    inside_polygon,
    out_of_bounds,
    overlap_depth_m,
    overlapping_boxes,
    plan_corners_m,
)

L_ROOM = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], float)


def box(x, y, size=(1.0, 1.0, 1.0), yaw_deg=0.0, z=0.5):
    return LayoutObject(10, np.array([x, y, z]), np.array(size), yaw_deg)


BOXES = st.builds(
    box,
    st.floats(-1, 1),
    st.floats(-1, 1),
    st.tuples(st.floats(0.2, 1.5), st.floats(0.2, 1.5), st.floats(0.2, 1.5)),
    st.floats(0, 360),
)


@given(BOXES, BOXES)
def test_overlap_goes_both_ways(a, b):
    assert overlap_depth_m(a, b) == pytest.approx(overlap_depth_m(b, a), abs=1e-9)


@given(BOXES, BOXES)
def test_boxes_share_a_point_where_they_overlap_deeply(a, b):
    random = np.random.default_rng(0)
    inside = plan_corners_m(a)[0] + random.random((4000, 2)) @ np.stack(
        [plan_corners_m(a)[1] - plan_corners_m(a)[0], plan_corners_m(a)[3] - plan_corners_m(a)[0]]
    )
    corners = plan_corners_m(b)
    along, aside = corners[1] - corners[0], corners[3] - corners[0]
    u = (inside - corners[0]) @ along / (along @ along)
    v = (inside - corners[0]) @ aside / (aside @ aside)
    shared = ((u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)).any()
    depth = overlap_depth_m(a, b)
    if shared:
        assert depth > 0
    if depth > 0.15:
        assert shared


@pytest.mark.parametrize(
    ("x", "yaw_deg", "depth"),
    [(1.0, 0, 0.0), (0.9, 0, 0.1), (0.0, 0, 1.0), (1.1, 45, 0.107), (1.3, 45, 0.0)],
)
def test_overlap_by_hand(x, yaw_deg, depth):
    assert overlap_depth_m(box(0, 0), box(x, 0, yaw_deg=yaw_deg)) == pytest.approx(depth, abs=1e-3)


def test_touching_is_no_collision_and_stacking_neither():
    things = [box(0, 0), box(1.0, 0), box(0, 0, z=1.5), box(0.5, 0)]
    assert collisions(things) == [(0, 3), (1, 3)]


def test_an_overlap_that_is_forgiven_to_the_millimetre_is_none():
    things = [box(0, 0), box(0.75, 0)]
    assert overlapping_boxes(things, 0.25) == []
    assert overlapping_boxes(things, 0.249) == [(0, 1)]


def test_runs_of_one_object_do_not_collide():
    def run(object_id, x):
        return Placement(
            object_id=object_id,
            class_id=10,
            template="counter",
            center_m=np.array([x, 0.0, 0.45]),
            size_m=np.array([0.6, 1.0, 0.9]),
            quarter_turns=1,
            iou=0.9,
        )

    assert collisions([run(1, 0.0), run(1, 0.3), run(2, 0.5)]) == [(0, 2), (1, 2)]


def test_out_of_bounds_in_an_l_shaped_room():
    things = [
        box(1, 1),
        box(3, 3),  # In the notch.
        box(1.9, 1.9, size=(1.6, 1.6, 1)),  # Its corner alone reaches into the notch.
        box(0.48, 1),  # 2 cm into the wall.
        box(0.4, 1),  # 10 cm into the wall.
        box(1, 1, z=2.2),  # Through the ceiling.
        box(3.5, 1.0, yaw_deg=45),
    ]
    assert out_of_bounds(things, L_ROOM, 2.5) == [1, 2, 4, 5, 6]
    assert out_of_bounds(things, L_ROOM[::-1], 2.5) == [1, 2, 4, 5, 6]
    assert 5 not in out_of_bounds(things, L_ROOM)


@pytest.mark.parametrize(
    ("z", "size", "outside"),
    [
        (2.03, 1.0, False),  # 3 cm into the ceiling.
        (2.05, 1.0, True),  # 5 cm.
        (0.47, 1.0, False),  # 3 cm into the floor.
        (0.45, 1.0, True),
        (1.25, 2.5, False),  # From floor to ceiling.
        (1.25, 2.6, True),
    ],
)
@pytest.mark.parametrize("floor_z_m", [0.0, 2.8])
def test_a_box_may_reach_4_cm_into_floor_and_ceiling(z, size, outside, floor_z_m):
    one = box(1, 1, size=(0.5, 0.5, size), z=z + floor_z_m)
    assert out_of_bounds([one], L_ROOM, 2.5, floor_z_m=floor_z_m) == ([0] if outside else [])


def test_a_room_may_have_three_corners():
    triangle = np.array([[0, 0], [4, 0], [0, 4]], float)
    inside = box(0.6, 0.6), box(2.3, 0.6), box(2.5, 2.5)
    assert out_of_bounds(inside, triangle) == [2]
    assert out_of_bounds([box(2.5, 0.6, size=(1.2, 1.0, 1.0))], triangle) == [0]


def test_side_that_cuts_a_corner_is_out_of_bounds():
    across = box(2, 2, size=(2.6, 0.2, 1), yaw_deg=135)
    assert inside_polygon(plan_corners_m(across), L_ROOM, 0.0).all()
    assert out_of_bounds([across], L_ROOM) == [0]


def test_what_lies_in_line_with_a_wall_but_beyond_it_is_outside():
    beyond = [(-1, 0), (5, 0), (0, -1), (0, 5), (4, 3), (3, 4), (-1, 4), (4, -1)]
    for outline in (L_ROOM, L_ROOM[::-1]):
        assert not inside_polygon(np.array(beyond, float), outline, 0.04).any()
        assert inside_polygon(L_ROOM, outline, 0.0).all(), "the corners belong to the room"


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_quarter_turn_is_a_yaw_of_90_degrees(turns):
    size_m, center_m = np.array([0.6, 1.0, 0.9]), np.array([1.0, 2.0, 0.45])
    placed = Placement(1, 10, "counter", center_m, size_m, turns, 0.9)
    yawed = LayoutObject(10, center_m, size_m, 90.0 * turns)
    np.testing.assert_allclose(plan_corners_m(placed), plan_corners_m(yawed), atol=1e-12)
    assert overlap_depth_m(placed, yawed) == pytest.approx(0.6)


def test_an_outline_needs_three_corners():
    with pytest.raises(ValueError, match="N >= 3"):
        out_of_bounds([], np.zeros((2, 2)))


def test_only_what_no_structure_carries_floats():
    labels = np.zeros((7, 7, 7), np.uint8)
    labels[:, :, 0] = 2
    labels[1, 1, 1:3] = 8  # A table on the floor,
    labels[1, 1, 3] = 11  # a cup on the table,
    labels[3, 3, 1:2] = 255  # nothing known here,
    labels[3, 3, 4:6] = 11  # a floater,
    labels[1, 5, 6] = 11  # another one,
    labels[6, :, 5] = 3  # a beam of wall
    labels[5, 2, 5] = 10  # with a shelf on it.
    found = floaters(labels)
    assert (found.parts, found.cells) == (2, 3)
    assert found.mask[3, 3, 4] and found.mask[1, 5, 6] and not found.mask[5, 2, 5]


def test_nothing_floats_in_an_empty_grid():
    assert floaters(np.zeros((2, 2, 2), np.uint8)).parts == 0


def test_an_outline_lies_in_a_plane():
    with pytest.raises(ValueError, match="floor_polygon_m must have shape"):
        out_of_bounds([], np.zeros((4, 3)))


def test_a_corner_that_is_told_twice_changes_nothing():
    twice = np.repeat(L_ROOM, 2, axis=0)
    points = np.array([[1, 1], [3, 3], [2.02, 3.0], [3.9, 1.9], [-0.01, 0.0]])
    for tolerance_m in (0.0, 0.05):
        expected = inside_polygon(points, L_ROOM, tolerance_m)
        np.testing.assert_array_equal(inside_polygon(points, twice, tolerance_m), expected)

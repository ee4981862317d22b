"""Collisions, things out of bounds, and things that hang in the air."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.metrics.layout import (
    collisions,
    floaters,
    out_of_bounds,
    overlap_depth_m,
    plan_corners_m,
)
from world2minecraft.types import LayoutObject, Placement

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

"""Boxes in plan: exact areas beside counted points, and laws."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.furniture.footprints import (
    area_m2,
    outside_share,
    shared_area_m2,
    shared_height_m,
    shared_volume_m3,
)
from world2minecraft.furniture.layout_checks import inside_polygon, plan_corners_m

ROOM = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], float)
ELL = np.array([[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]], float)


def box(x, y, z=0.5, size=(1.0, 1.0, 1.0), yaw=0.0):
    return SimpleNamespace(
        center_m=np.array([x, y, z]), size_m=np.array(size, float), yaw_deg=float(yaw)
    )


lengths = st.floats(0.1, 2.0)
places = st.floats(-1.5, 1.5)
boxes = st.builds(
    lambda x, y, z, a, b, c, yaw: box(x, y, z, (a, b, c), yaw),
    places, places, places, lengths, lengths, lengths, st.floats(0, 360),
)  # fmt: skip


def counted_area(a, b, count):
    """The slow way: points of a fine raster over one box that lie in the other."""
    corners = plan_corners_m(a)
    steps = (np.arange(count) + 0.5) / count
    points = (
        corners[0]
        + steps[:, None, None] * (corners[1] - corners[0])
        + steps[None, :, None] * (corners[3] - corners[0])
    ).reshape(-1, 2)
    return inside_polygon(points, plan_corners_m(b), 0.0).mean() * a.size_m[0] * a.size_m[1]


@given(boxes, boxes)
def test_a_shared_area_is_what_counting_finds(a, b):
    assert shared_area_m2(a, b) == pytest.approx(counted_area(a, b, 60), abs=0.08)


@given(boxes, boxes)
def test_sharing_is_mutual_and_never_more_than_the_smaller(a, b):
    area, volume = shared_area_m2(a, b), shared_volume_m3(a, b)
    assert area == pytest.approx(shared_area_m2(b, a), abs=1e-9)
    assert area <= min(np.prod(a.size_m[:2]), np.prod(b.size_m[:2])) + 1e-9
    assert 0 <= volume <= min(np.prod(a.size_m), np.prod(b.size_m)) + 1e-9


@given(boxes)
def test_a_box_shares_all_of_itself(one):
    assert shared_area_m2(one, one) == pytest.approx(np.prod(one.size_m[:2]), rel=1e-6)
    assert shared_volume_m3(one, one) == pytest.approx(np.prod(one.size_m), rel=1e-6)


def test_known_areas():
    assert shared_area_m2(box(0, 0), box(0.75, 0)) == pytest.approx(0.25)
    assert shared_area_m2(box(0, 0), box(1.0, 0)) == pytest.approx(0.0, abs=1e-12)
    assert shared_area_m2(box(0, 0), box(0, 0, yaw=45)) == pytest.approx(2 * (2**0.5 - 1))
    assert shared_height_m(box(0, 0, 0.5), box(0, 0, 1.7)) == pytest.approx(-0.2)
    assert shared_volume_m3(box(0, 0, 0.5), box(0, 0, 1.7)) == 0.0
    assert area_m2(ELL) == pytest.approx(6.0)
    assert area_m2(ELL[:2]) == 0.0


def test_a_share_outside():
    assert outside_share(box(2, 1.5), ROOM, 0.0) == 0.0
    assert outside_share(box(4, 1.5), ROOM, 0.0) == pytest.approx(0.5, abs=0.02)
    assert outside_share(box(4, 1.5), ROOM, 0.1) == pytest.approx(0.4, abs=0.02)
    assert outside_share(box(9, 9), ROOM, 0.1) == 1.0


@given(boxes)
def test_the_share_outside_is_what_clipping_leaves(one):
    room = box(2.0, 1.5, size=(4.0, 3.0, 1.0))
    shared = shared_area_m2(one, room) / np.prod(one.size_m[:2])
    assert outside_share(one, ROOM, 0.0) == pytest.approx(1 - shared, abs=0.03)


def test_a_triangle_has_an_area_and_a_line_has_none():
    triangle = np.array([[0, 0], [4, 0], [0, 3]], float)
    assert area_m2(triangle) == area_m2(triangle[::-1]) == 6.0
    assert area_m2(triangle[:2]) == area_m2(triangle[:0]) == 0.0


def test_inner_corner_of_an_l_is_outside():
    across = box(1.0, 1.0, size=(2.6, 0.2, 1.0), yaw=135)
    assert inside_polygon(plan_corners_m(across), ELL, 0.0).all()
    assert outside_share(across, ELL, 0.0) > 0.01


@given(boxes, st.floats(0, 0.3))
def test_a_wider_margin_never_puts_more_outside(one, margin):
    assert outside_share(one, ROOM, margin) <= outside_share(one, ROOM, 0.0)

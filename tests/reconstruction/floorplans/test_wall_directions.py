"""Walls that an app measured askew become parallel; a wing at 45 degrees is a regular stair."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.formats.roomplan import PlanSurface
from world2minecraft.reconstruction.floorplans.wall_directions import (
    SNAP_RAD,
    main_direction_rad,
    snap_outline,
    snapped_rad,
)

# A hall of 8 x 6 m with a wing at 45 degrees instead of a corner.
HALL = np.array([[0, 0], [8, 0], [8, 4], [10, 6], [8, 8], [6, 6], [0, 6]], float)


def turned(points, angle_deg):
    angle = np.radians(angle_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return points @ turn.T


def walls_of(outline):
    return [
        PlanSurface("wall", start, end, 0.0, 2.5)
        for start, end in zip(outline, np.roll(outline, -1, axis=0), strict=True)
    ]


def side_angles_deg(outline):
    along = np.roll(outline, -1, axis=0) - outline
    return np.degrees(np.arctan2(along[:, 1], along[:, 0]))


@given(st.floats(-180, 180))
def test_the_main_direction_is_not_moved_by_a_wing_at_45_degrees(angle_deg):
    found = np.degrees(main_direction_rad(walls_of(turned(HALL, angle_deg))))
    assert (found - angle_deg + 45) % 90 - 45 == pytest.approx(0, abs=1e-6)


@given(st.integers(0, 10_000))
def test_sides_that_were_measured_askew_are_snapped(seed):
    rng = np.random.default_rng(seed)
    askew = HALL + rng.uniform(-0.08, 0.08, HALL.shape)
    snapped = snap_outline(askew)
    eighths = side_angles_deg(snapped) / 45
    assert eighths == pytest.approx(np.round(eighths), abs=1e-7)
    assert len(snapped) == len(HALL)
    assert np.abs(snapped - HALL).max() < 0.3


def test_stretches_of_one_wall_are_joined():
    askew = np.array([[0, 0], [2, 0.05], [4, 0], [4, 3], [0, 3]], float)
    assert len(snap_outline(askew)) == 4


def test_a_wall_at_another_angle_is_unchanged():
    assert snapped_rad(np.radians(20)) == np.radians(20)
    assert snapped_rad(np.radians(45) + 0.9 * SNAP_RAD) == pytest.approx(np.radians(45))
    cut = np.array([[0, 0], [4, 0], [4, 2], [1.3, 3], [0, 3]], float)
    assert snap_outline(cut) == pytest.approx(cut)

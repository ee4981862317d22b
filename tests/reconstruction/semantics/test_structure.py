"""Walls of noisy surfaces, as a single frame shows them from afar."""

import numpy as np
import pytest

from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.layout.slanted_walls import find_slanted_walls
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.layout.walls import _before_m

VOXEL_M = 0.08
SHAPE = (50, 50, 40)
PARAMETERS = GeometricParameters().structure


def surface_of_points(points_m, free):
    """Return a surface whose cells contain the points [N, 3]; ``free`` is bool [X, Y, Z]."""
    points = np.zeros((*SHAPE, 3), np.float32)
    at = tuple(np.floor(points_m / VOXEL_M).astype(int).T)
    points[at] = points_m
    occupied = np.zeros(SHAPE, bool)
    occupied[at] = True
    hits = occupied.astype(np.float32)
    colour = np.zeros((*SHAPE, 3), np.float32)
    return Surface(occupied, free & ~occupied, points, hits, colour, VOXEL_M, np.zeros(3))


def plan_m():
    places = (np.arange(SHAPE[0]) + 0.5) * VOXEL_M
    return np.stack(np.meshgrid(places, places, indexing="ij"), -1).reshape(-1, 2)


@pytest.mark.parametrize("noise_m", [0.0, 0.005, 0.013])
def test_a_sharp_wall_takes_nothing_in_front_of_it(noise_m):
    gap_m = np.abs(np.random.default_rng(1).normal(0, noise_m, 500))
    assert _before_m(gap_m, PARAMETERS) == PARAMETERS.before_m


def test_a_thick_band_reaches_no_further_than_its_shadow():
    gap_m = np.random.default_rng(1).normal(0, 0.05, 500)
    thick = _before_m(gap_m, PARAMETERS)
    assert PARAMETERS.before_m < thick <= PARAMETERS.shadow_m
    things = np.full(2000, -0.1)  # In front, such as a curtain: they are no noise.
    assert _before_m(np.r_[gap_m, things], PARAMETERS) == thick


@pytest.mark.parametrize("turn_deg", [20, 45, 160])
def test_a_slanted_wall_is_one_straight_piece(turn_deg):
    outward = np.array([np.cos(np.radians(turn_deg)), np.sin(np.radians(turn_deg))])
    along = np.array([-outward[1], outward[0]])
    side, height = np.meshgrid(np.arange(-1.4, 1.4, 0.02), np.arange(0.1, 2.4, 0.02))
    plan = np.array([2.0, 2.0]) + side.reshape(-1, 1) * along
    points = np.column_stack([plan, height.reshape(-1)])
    gap = (plan_m() - 2.0) @ outward
    free = np.repeat((gap < -0.06).reshape(SHAPE[:2])[:, :, None], SHAPE[2], axis=2)
    surface = surface_of_points(points, free)
    walls = find_slanted_walls(surface, surface.occupied, PARAMETERS)
    assert len(walls) == 1
    assert walls[0].outward @ outward > 0.998
    assert walls[0].cells[surface.occupied].mean() > 0.95

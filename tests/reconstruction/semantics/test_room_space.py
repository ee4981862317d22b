"""The space of rooms: what lies beyond the walls stays empty, what furniture hides is in it."""

from typing import Any

import label_rooms as rooms
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.layout.room_space import convex_hull, room_space
from world2minecraft.reconstruction.layout.storeys import Storey
from world2minecraft.reconstruction.layout.structure import structure_of
from world2minecraft.reconstruction.layout.surface_cells import surface_of


def space_of(room, **options) -> tuple[Any, Any]:
    grid, evidence, _ = room.scanned(**options)
    storey = Storey(0.0, 0, grid.shape[2])
    structure = structure_of(
        storey.surface(surface_of(grid, evidence)), GeometricParameters().structure
    )
    return grid, room_space(structure)


def columns_m(grid) -> tuple[np.ndarray, np.ndarray]:
    """Return the x and y of the centres of columns in metres, float [X, 1] and [1, Y]."""
    x, y = ((np.arange(n) + 0.5) * grid.voxel_m for n in grid.shape[:2])
    return x[:, None] + grid.origin_m[0], y[None] + grid.origin_m[1]


def test_the_space_ends_one_cell_behind_the_walls():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    grid, space = space_of(room)
    x, y = columns_m(grid)
    inside = (x > 0) & (x < 3.2) & (y > 0) & (y < 4)
    around = (x > -0.09) & (x < 3.29) & (y > -0.09) & (y < 4.09)
    columns = space.cells.any(axis=2)
    assert columns[inside].all()
    assert not columns[~around].any()
    assert space.floor.any(axis=2)[inside].all()
    assert space.floor.sum() == space.floor.any(axis=2).sum()


def test_the_wall_behind_a_wardrobe_is_in_the_space():
    room = rooms.SmallRoom().add((0, 1.0, 0, 0.6, 2.4, 2.0), 10)
    grid, space = space_of(room)
    x, y = columns_m(grid)
    hidden = (x > 0) & (x < 0.6) & (y > 1.0) & (y < 2.4)
    assert space.cells.any(axis=2)[hidden].all()
    face = (x > -0.08) & (x < 0) & (y > 1.1) & (y < 2.3)
    low = slice(round(-grid.origin_m[2] / 0.08), round((2.0 - grid.origin_m[2]) / 0.08))
    assert space.wall[:, :, low][face].all()


def test_the_corner_outside_an_ell_is_beyond():
    room = rooms.SmallRoom(size_m=(4.0, 4.0, 2.4))
    room.add((2.4, 2.4, 0, 4.0, 4.0, 2.4), 3, rooms.WHITE)
    grid, space = space_of(room)
    x, y = columns_m(grid)
    outside = (x > 2.6) & (y > 2.6)
    assert not space.cells[outside].any()


def test_without_free_space_there_is_no_room():
    room = rooms.SmallRoom()
    grid, evidence, _ = room.scanned()
    surface = surface_of(grid, evidence)
    surface.free[:] = False
    structure = structure_of(surface, GeometricParameters().structure)
    space = room_space(structure)
    assert not (space.cells.any() or space.floor.any() or space.wall.any())


@pytest.mark.parametrize("columns", [[(1, 1)], [(0, 0), (3, 3)], [(2, 0), (2, 1), (2, 4)]])
def test_a_line_is_its_own_hull(columns):
    mask = np.zeros((5, 5), bool)
    mask[tuple(np.array(columns).T)] = True
    assert (convex_hull(mask) == mask).all()


@given(st.lists(st.tuples(st.integers(0, 8), st.integers(0, 8)), min_size=3, max_size=12))
def test_a_hull_holds_its_cells_and_is_its_own_hull(columns):
    mask = np.zeros((9, 9), bool)
    mask[tuple(np.array(columns).T)] = True
    hull = convex_hull(mask)
    assert hull[mask].all()
    assert (convex_hull(hull) == hull).all()

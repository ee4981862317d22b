"""Bare walls: guesses before and behind them go, what is there stays, what was unseen is whole."""

from dataclasses import replace

import numpy as np
import pytest

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import COMPLETED, OBSERVED, UNSEEN, Layout, OccupancyGrid, Opening
from world2minecraft.reconstruction.layout.photo_walls import BEFORE_M, wall_edges
from world2minecraft.reconstruction.semantics import complete_walls, remove_wall_guesses

VOXEL_M = 0.08
MARGIN = 10  # Cells around the room.
INNER = (40, 30, 30)  # Cells of the room's air: 3.2 x 2.4 x 2.4 m.
PAINT, RED = (200, 195, 190), (180, 20, 20)
CORNERS = np.array([[0, 0], [3.2, 0], [3.2, 2.4], [0, 2.4]], np.float64)
ROOM = Layout(CORNERS, 2.4)
AIR = tuple(slice(MARGIN, MARGIN + side) for side in INNER)


def room_grid() -> OccupancyGrid:
    """A closed box, painted alike, its air seen and nothing beyond it."""
    shape = tuple(side + 2 * MARGIN for side in INNER)
    labels = np.full(shape, 255, np.uint8)
    shell = tuple(slice(s.start - 1, s.stop + 1) for s in AIR)
    labels[shell] = SemanticClass.OBJS
    labels[AIR] = 0
    return painted(labels)


def painted(labels: np.ndarray) -> OccupancyGrid:
    known = labels != 255
    colour = np.zeros((*labels.shape, 3), np.uint8)
    colour[known & (labels > 0)] = PAINT
    return OccupancyGrid(
        labels,
        known.astype(np.float16),
        colour,
        np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
        np.zeros(labels.shape, np.uint16),
        VOXEL_M,
        np.full(3, -MARGIN * VOXEL_M),
    )


def with_cells(grid: OccupancyGrid, where, colour=PAINT) -> OccupancyGrid:
    labels, colours, source = grid.labels.copy(), grid.colour.copy(), grid.source.copy()
    labels[where], colours[where], source[where] = SemanticClass.OBJS, colour, OBSERVED
    return replace(grid, labels=labels, colour=colours, source=source)


def box(x, y, z):
    """Cells of the room, counted from its inner corner."""
    return tuple(slice(a + MARGIN, b + MARGIN) for a, b in (x, y, z))


def test_what_hangs_before_a_wall_in_its_colour_goes():
    hung = box((2, 3), (8, 14), (10, 20))
    found = remove_wall_guesses(with_cells(room_grid(), hung), [ROOM])
    assert (found.labels[hung] == 0).all()
    assert np.array_equal(found.labels, room_grid().labels)


def test_what_has_another_colour_or_stands_farther_off_stays():
    red = with_cells(room_grid(), box((2, 3), (8, 14), (10, 20)), RED)
    far_cells = int(BEFORE_M / VOXEL_M) + 1
    both = with_cells(red, box((far_cells, far_cells + 2), (8, 14), (10, 20)))
    found = remove_wall_guesses(both, [ROOM])
    assert np.array_equal(found.labels, both.labels)


def test_what_lies_behind_a_seen_wall_goes():
    behind = box((-8, -4), (5, 20), (3, 20))
    corner = box((-8, -4), (-8, -4), (3, 20))
    scraps = with_cells(with_cells(room_grid(), behind), corner)
    found = remove_wall_guesses(scraps, [ROOM])
    assert (found.labels[behind] == 255).all()
    assert (found.source[corner] == UNSEEN).all()


def test_what_lies_behind_a_door_or_a_wall_that_nobody_saw_stays():
    behind = box((-8, -4), (5, 15), (3, 20))
    scene = with_cells(room_grid(), behind)
    door = Opening("door", np.array([0, 0.4]), np.array([0, 1.2]), 0.0, 2.0)
    found = remove_wall_guesses(scene, [replace(ROOM, openings=(door,))])
    assert np.array_equal(found.labels[behind], scene.labels[behind])
    gone = scene.labels.copy()
    gone[box((-1, 0), (-1, 31), (-1, 31))] = 255
    unseen = replace(scene, labels=gone, source=(gone != 255).astype(np.uint8))
    found = remove_wall_guesses(unseen, [ROOM])
    assert np.array_equal(found.labels[behind], scene.labels[behind])


def labelled_room() -> OccupancyGrid:
    grid = room_grid()
    labels = grid.labels.copy()
    labels[labels == SemanticClass.OBJS] = SemanticClass.WALL
    labels[:, :, MARGIN - 1][labels[:, :, MARGIN - 1] < 255] = SemanticClass.FLOOR
    labels[:, :, MARGIN + INNER[2]][labels[:, :, MARGIN + INNER[2]] < 255] = SemanticClass.CEILING
    return replace(grid, labels=labels)


def test_unseen_parts_of_a_seen_shell_are_completed_and_marked():
    whole = labelled_room()
    holes = [
        box((-1, 0), (5, 12), (5, 20)),
        box((4, 20), (4, 20), (-1, 0)),
        box((4, 20), (4, 20), (30, 31)),
    ]
    labels = whole.labels.copy()
    for hole in holes:
        labels[hole] = 255
    seen = replace(whole, labels=labels, source=(labels != 255).astype(np.uint8))
    found = complete_walls(seen, [ROOM])
    assert np.array_equal(found.labels, whole.labels)
    for hole in holes:
        assert (found.source[hole] == COMPLETED).all()
    again = complete_walls(found, [ROOM])
    assert np.array_equal(again.labels, found.labels)


def test_carved_wall_is_closed_windows_stay_open():
    whole = labelled_room()
    labels = whole.labels.copy()
    small, window = box((-1, 0), (5, 10), (5, 10)), box((-1, 0), (14, 28), (10, 25))
    labels[small] = labels[window] = 0
    opening = Opening("window", np.array([0, 1.12]), np.array([0, 2.24]), 0.8, 2.0)
    room = replace(ROOM, openings=(opening,))
    found = complete_walls(replace(whole, labels=labels), [room])
    assert (found.labels[small] == SemanticClass.WALL).all()
    assert (found.labels[window] == 0).all()


def test_what_is_flat_on_a_wall_becomes_the_wall():
    whole = labelled_room()
    poster = box((0, 1), (5, 12), (10, 20))
    shelf = box((0, 3), (14, 20), (10, 12))
    scene = with_cells(with_cells(whole, poster, RED), shelf, RED)
    found = complete_walls(scene, [ROOM])
    assert (found.labels[poster] == SemanticClass.WALL).all()
    assert (found.labels[box((1, 3), (14, 20), (10, 12))] == SemanticClass.OBJS).all()


@pytest.mark.parametrize("change", [remove_wall_guesses, complete_walls])
def test_without_rooms_nothing_changes(change):
    grid = with_cells(labelled_room(), box((-8, -4), (5, 20), (3, 20)))
    found = change(grid, [])
    assert np.array_equal(found.labels, grid.labels)
    assert np.array_equal(found.source, grid.source)


def test_walls_look_into_their_room():
    for edge in wall_edges(ROOM):
        assert edge.depth_m(np.array([[1.6, 1.2, 1.0]]))[0] > 1

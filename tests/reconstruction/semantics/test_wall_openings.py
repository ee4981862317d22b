"""What is cut into walls and hangs on them: door leaves, pictures, windows, bends that are none."""

from dataclasses import replace

import label_rooms as rooms
import numpy as np
import pytest

from world2minecraft.reconstruction.semantics import find_structure
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller


def with_wall(room, thick_m, hole):
    """Put a layer before the wall at x = 0 that leaves a hole (y0, y1, z0, z1) free."""
    low, high, bottom, top = hole
    depth, height = room.size_m[1], room.size_m[2]
    for box in (
        (0, 0, 0, thick_m, low, height),
        (0, high, 0, thick_m, depth, height),
        (0, low, 0, thick_m, high, bottom),
        (0, low, top, thick_m, high, height),
    ):
        if box[4] > box[1] and box[5] > box[2]:
            room.add(box, 3, rooms.WHITE)
    return room


@pytest.mark.parametrize("thick_m", [0.02, 0.06])
def test_a_closed_door_is_found_by_the_depth_of_its_leaf(thick_m):
    room = with_wall(rooms.SmallRoom(), thick_m, (1.2, 2.1, 0.0, 2.04))
    grid, evidence, _ = room.scanned()
    (layout,) = find_structure(grid, evidence)
    (opening,) = layout.openings
    assert opening.kind == "door"
    assert np.allclose(sorted([opening.start_m[1], opening.end_m[1]]), [1.2, 2.1], atol=0.1)
    assert opening.sill_m == 0 and abs(opening.head_m - 2.04) < 0.1


def test_a_window_with_a_bar_is_one_window():
    room = with_wall(rooms.SmallRoom(), 0.06, (1.0, 2.6, 0.9, 2.0))
    room.add((0, 1.76, 0.9, 0.06, 1.84, 2.0), 4, rooms.WHITE)
    (layout,) = find_structure(*room.scanned()[:2])
    (opening,) = layout.openings
    assert opening.kind == "window"
    assert np.allclose(sorted([opening.start_m[1], opening.end_m[1]]), [1.0, 2.6], atol=0.1)


def test_a_picture_that_is_four_centimetres_thick_is_no_wall():
    room = rooms.SmallRoom().add((0, 1.0, 1.2, 0.04, 1.8, 1.8), 11, rooms.CLOTH)
    grid, evidence, _ = room.scanned()
    result = GeometricLabeller().label(grid, evidence)
    at = (slice(0, 4), slice(15, 24), slice(18, 24))
    found = result.labels[at]
    assert (found[(found > 0) & (found < 255)] == 11).mean() > 0.9


def test_a_bend_of_the_sensor_is_neither_door_nor_picture():
    grid, evidence, _ = rooms.SmallRoom().scanned()
    offset = np.array(evidence.offset_sum)
    bend_m = 0.03 * np.sin(np.linspace(0, np.pi, grid.shape[1]))[:, None]
    offset[: rooms.MARGIN, ..., 0] += bend_m * np.array(evidence.hits, np.float32)[: rooms.MARGIN]
    evidence = replace(evidence, offset_sum=offset)
    result = GeometricLabeller().label(grid, evidence)
    assert set(np.unique(result.labels[result.occupied])) <= {1, 2, 3}
    (layout,) = find_structure(grid, evidence)
    assert layout.openings == ()

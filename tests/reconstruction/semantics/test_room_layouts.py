"""Rooms as layouts: outlines, storeys, openings; the walls between two rooms."""

from dataclasses import replace

import label_rooms as rooms
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.reconstruction.fusion import extract_grid
from world2minecraft.reconstruction.layout.room_layouts import outline_of
from world2minecraft.reconstruction.semantics import find_structure
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller

WALL = rooms.WHITE


def found(room, **options):
    grid, evidence, _ = room.scanned(**options)
    return find_structure(grid, evidence)


def area_m2(polygon):
    x, y = polygon.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_a_furnished_box_room_is_a_rectangle_to_the_centimetre():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    room.add((0, 1.0, 0, 0.6, 2.4, 2.0), 10)
    (layout,) = found(room)
    assert np.allclose(layout.floor_polygon_m, [[0, 0], [3.2, 0], [3.2, 4], [0, 4]], atol=0.01)
    assert abs(layout.wall_height_m - 2.4) < 0.02
    assert layout.openings == ()


def test_an_ell_has_six_corners():
    room = rooms.SmallRoom(size_m=(4.0, 4.0, 2.4)).add((2.4, 2.4, 0, 4.0, 4.0, 2.4), 3, WALL)
    (layout,) = found(room)
    assert len(layout.floor_polygon_m) == 6
    assert abs(area_m2(layout.floor_polygon_m) - (16 - 2.56)) < 0.1


def two_rooms(head_m=2.0):
    """Two rooms with a wall of 0.16 m between, and a doorway in it."""
    room = rooms.SmallRoom(size_m=(5.6, 3.2, 2.4))
    room.add((2.72, 0, 0, 2.88, 1.2, 2.4), 3, WALL)
    room.add((2.72, 2.0, 0, 2.88, 3.2, 2.4), 3, WALL)
    return room.add((2.72, 1.2, head_m, 2.88, 2.0, 2.4), 3, WALL)


def test_rooms_are_parted_at_the_doorway():
    layouts = found(two_rooms())
    assert len(layouts) == 2
    for layout in layouts:
        assert abs(area_m2(layout.floor_polygon_m) - 2.72 * 3.2) < 0.15
        (opening,) = layout.openings
        assert opening.kind == "doorway"
        ends = sorted([opening.start_m[1], opening.end_m[1]])
        assert np.allclose(ends, [1.2, 2.0], atol=0.1)
        assert opening.sill_m == 0 and abs(opening.head_m - 2.0) < 0.1


def test_a_gap_up_to_the_ceiling_parts_no_rooms():
    assert len(found(two_rooms(head_m=2.4))) == 1


@given(st.integers(1, 6), st.integers(1, 6), st.integers(0, 5), st.integers(0, 5))
def test_an_outline_holds_the_area_of_its_region(width, depth, cut_x, cut_y):
    region = np.zeros((12, 12), bool)
    region[2 : 4 + width, 3 : 5 + depth] = True
    region[2 : 2 + min(cut_x, width), 3 : 3 + min(cut_y, depth)] = False
    lines = [float(n) for n in range(13)]
    polygon = outline_of(region, np.zeros(2), 1.0, (lines, lines))
    assert polygon is not None
    assert area_m2(polygon) == region.sum()


def test_nothing_seen_is_no_room():
    grid, evidence, _ = rooms.SmallRoom().scanned()
    labels = np.where(grid.occupied, np.uint8(0), grid.labels)
    assert find_structure(replace(grid, labels=labels), evidence) == ()


def stacked(lower, upper):
    """Two scanned rooms, one over the other: (grid, evidence)."""
    (_, first, _), (_, second, _) = lower.scanned(), upper.scanned()
    names = ("log_odds", "votes", "colour_sum", "offset_sum", "hits")
    arrays = {
        name: np.concatenate([getattr(first, name), getattr(second, name)], axis=2)
        for name in names
    }
    evidence = replace(first, **arrays)
    return extract_grid(evidence), evidence


def test_storeys_are_found_and_each_has_its_rooms():
    upper = rooms.SmallRoom()
    rooms.table(upper, 1.6, 2.0)
    grid, evidence = stacked(two_rooms_of(upper.size_m), upper)
    layouts = find_structure(grid, evidence)
    rise_m = grid.shape[2] / 2 * rooms.VOXEL_M
    assert np.allclose([layout.floor_z_m for layout in layouts], [0, 0, rise_m], atol=0.01)
    assert all(abs(layout.wall_height_m - 2.4) < 0.02 for layout in layouts)


def two_rooms_of(size_m):
    """A room of a size, parted by a wall up to the ceiling."""
    room = rooms.SmallRoom(size_m=size_m)
    return room.add((0, 1.92, 0, size_m[0], 2.08, size_m[2]), 3, WALL)


def test_an_upper_storey_is_labelled_as_if_it_were_alone():
    upper = rooms.SmallRoom()
    rooms.table(upper, 1.6, 2.0)
    grid, evidence = stacked(rooms.SmallRoom(), upper)
    result = GeometricLabeller().label(grid, evidence)
    alone = GeometricLabeller().label(*upper.scanned()[:2])
    half = grid.shape[2] // 2
    assert (result.labels[:, :, half:] == alone.labels).mean() > 0.99


def test_sloped_ceiling_and_its_low_wall_are_structure():
    room = rooms.SmallRoom(size_m=(3.2, 4.0, 2.4))
    steps = np.arange(0.0, 1.2, 0.04)
    for start in steps:  # A roof that rises from 1.0 m at x = 0 to 2.2 m at x = 1.2.
        room.add((start, 0, 1.0 + start, start + 0.04, 4.0, 2.4), 1, WALL)
    result = GeometricLabeller().label(*room.scanned()[:2])
    assert np.isin(result.labels[result.occupied], (1, 2, 3)).mean() > 0.95
    roof = result.labels[rooms.MARGIN + 3 : rooms.MARGIN + 12, 4:-4, rooms.MARGIN + 14 : -4]
    assert (roof[(roof > 0) & (roof < 255)] == 1).mean() > 0.9
    low_wall = result.labels[: rooms.MARGIN, 4:-4, rooms.MARGIN + 2 : rooms.MARGIN + 10]
    assert (low_wall[low_wall > 0] != 1).all() and (low_wall == 3).any()

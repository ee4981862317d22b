"""Collisions told by what is solid, categories and objects that are kept."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.coordinates import apply, block_to_room, invert
from world2minecraft.core.types import (
    BlockVolume,
    Layout,
    LayoutObject,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.furniture import template, templates_of_class
from world2minecraft.furniture.layout_checks import (
    category_integrity,
    collisions,
    kept_objects,
    out_of_rooms,
    overlapping_boxes,
)
from world2minecraft.furniture.solid_parts import box_m, depth_m, own_cells, solids_m

NAMES = ["chair", "dining_table", "sofa", "counter", "bookcase", "desk", "double_bed"]


def put(number, name, x, y, turns=0, size=None, z=0.0) -> Placement:
    one = template(name)
    size_m = np.array(size or one.typical_m)
    center = np.array([x, y, z + size_m[2] / 2])
    return Placement(number, one.class_id, name, center, size_m, turns, 0.5)


def grid_with(cells: dict[int, list[tuple[int, int, int]]]) -> OccupancyGrid:
    labels = np.zeros((40, 40, 20), np.uint8)
    instance = np.zeros(labels.shape, np.uint16)
    for number, where in cells.items():
        for cell in where:
            labels[cell], instance[cell] = 11, number
    return OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=np.ones(labels.shape, np.uint8),
        instance=instance,
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )


@given(st.sampled_from(NAMES), st.integers(0, 3), st.floats(-2, 2), st.floats(-2, 2))
def test_solid_parts_fill_the_turned_box_to_its_sides(name, turns, x, y):
    placement = put(1, name, x, y, turns)
    parts = solids_m(placement)
    hull = np.stack([parts[:, 0].min(axis=0), parts[:, 1].max(axis=0)])
    np.testing.assert_allclose(hull, box_m(placement), atol=1e-6)


@given(st.sampled_from(NAMES), st.sampled_from(NAMES), st.floats(-1, 1), st.integers(0, 3))
def test_solid_depth_is_symmetric_and_within_box_depth(first, second, y, turns):
    one, other = solids_m(put(1, first, 0, 0)), solids_m(put(2, second, 0.6, y, turns))
    assert depth_m(one, other) == pytest.approx(depth_m(other, one))
    boxes = depth_m(box_m(put(1, first, 0, 0))[None], box_m(put(2, second, 0.6, y, turns))[None])
    assert depth_m(one, other) <= boxes + 1e-9


def test_a_chair_under_its_table_touches_only_the_table_s_box():
    table = put(1, "dining_table", 0, 0, size=(0.9, 1.6, 0.75))
    tucked = put(2, "chair", 0.45, 0, turns=2)
    assert overlapping_boxes([table, tucked]) == [(0, 1)]
    assert collisions([table, tucked]) == []


def test_back_through_a_thin_table_top_collides():
    table = put(1, "dining_table", 0, 0, size=(0.9, 1.6, 0.75))
    through = put(2, "chair", 0.1, 0, turns=2)
    assert collisions([table, through]) == [(0, 1)]


def test_box_of_unknown_parts_is_solid_throughout():
    """A chair under a table whose parts are known touches nothing; under a mere box it does."""
    tucked = put(2, "chair", 0.45, 0, turns=2)
    table = LayoutObject(8, np.array([0, 0, 0.375]), np.array([0.9, 1.6, 0.75]), 0.0)
    assert collisions([table, tucked]) == [(0, 1)]
    assert collisions([tucked, table]) == [(0, 1)]


def test_parts_that_meet_by_what_is_forgiven_do_not_collide():
    boxes = [put(1, "box", 0, 0, size=(1, 1, 1)), put(2, "box", 0.75, 0, size=(1, 1, 1))]
    assert collisions(boxes, 0.25) == []
    assert collisions(boxes, 0.249) == [(0, 1)]


def test_every_template_collides_with_itself_in_the_same_place():
    for class_id in range(5, 12):
        for one in templates_of_class(class_id):
            assert collisions([put(1, one.name, 0, 0), put(2, one.name, 0.01, 0)]) == [(0, 1)]


def test_own_cells_are_solid_where_they_lie_and_nowhere_else():
    grid = grid_with({1: [(10, 10, 0), (20, 10, 0)], 2: [(15, 10, 0)]})
    wide = Placement(
        1, 11, "cells", np.array([1.24, 0.84, 0.04]), np.array([0.08, 0.88, 0.08]), 1, 0
    )
    inner = Placement(2, 11, "cells", np.array([1.24, 0.84, 0.04]), np.array([0.08] * 3), 0, 0)
    assert own_cells(wide, grid).tolist() == [[10, 10, 0], [20, 10, 0]]
    assert collisions([wide, inner], grid=grid) == []
    assert collisions([wide, inner]) == [(0, 1)], "without a grid the whole box is solid"
    over = put(3, "box", 0.84, 0.84, size=(0.4, 0.4, 0.4))
    assert collisions([wide, over], grid=grid) == [(0, 1)]


def test_own_cells_have_their_centres_in_the_box():
    """Slow reading: every cell of the object's number, its centre against the box's sides."""
    random = np.random.default_rng(3)
    cells = np.unique(random.integers(0, 20, (400, 3)), axis=0)
    grid = replace(
        grid_with({1: [tuple(cell) for cell in cells.tolist()], 2: [(0, 0, 19)]}),
        origin_m=np.array([-0.8, 1.6, -0.08]),
    )
    for turns, x in ((0, -0.31), (1, 0.02), (3, 5.0)):
        placed = Placement(
            1, 11, "cells", np.array([x, 2.2, 0.6]), np.array([0.7, 1.03, 0.5]), turns, 0
        )
        low, high = box_m(placed)
        middles = grid.origin_m + (cells + 0.5) * grid.voxel_m
        inside = ((middles >= low) & (middles <= high)).all(axis=1)
        assert own_cells(placed, grid).tolist() == cells[inside].tolist()
        boxes = solids_m(placed, grid)
        np.testing.assert_allclose(boxes.mean(axis=1), middles[inside], atol=1e-9)
        np.testing.assert_allclose(boxes[:, 1] - boxes[:, 0], grid.voxel_m, atol=1e-9)


def test_what_has_no_solid_part_meets_nothing():
    some, none = np.array([[[0, 0, 0], [1, 1, 1]]], float), np.zeros((0, 2, 3))
    assert depth_m(some, none) == depth_m(none, some) == depth_m(none, none) == 0.0
    assert depth_m(some, some) == 1.0


def test_an_object_must_lie_in_one_room_and_on_its_storey():
    square = np.array([[0, 0], [2, 0], [2, 2], [0, 2]], float)
    rooms = [
        Layout(square, 2.4),
        Layout(square + np.array([2.1, 0]), 2.4),
        Layout(square, 2.4, floor_z_m=2.8),
    ]
    things = [
        put(1, "box", 1.0, 1.0, size=(0.4, 0.4, 0.4)),
        put(2, "box", 3.0, 1.0, size=(0.4, 0.4, 0.4)),
        put(3, "box", 2.05, 1.0, size=(0.4, 0.4, 0.4)),
        put(4, "box", 1.0, 1.0, size=(0.4, 0.4, 0.4), z=2.8),
        put(5, "box", 1.0, 1.0, size=(0.4, 0.4, 0.4), z=2.3),
    ]
    assert out_of_rooms(things, rooms) == [2, 4]


def test_category_integrity_is_the_paper_s_ratio():
    assert category_integrity({5, 8, 11}, {5, 8, 10, 11}) == 0.75
    assert category_integrity({2, 3, 5}, {2, 3, 5, 6}) == 0.5, "structure is no category"
    assert category_integrity(set(), set()) == 1.0


def test_object_survives_where_its_blocks_stand():
    cells = np.array([[x, 5, z] for x in range(10, 16) for z in range(6)], np.int32)
    grid = grid_with({1: [tuple(cell) for cell in cells.tolist()]})
    one = ObjectInstance(
        1, 11, np.array([1.04, 0.44, 0.24]), np.array([0.48, 0.08, 0.48]), 0, cells, 1
    )
    shape = (16, 12, 16)
    to_room = block_to_room(np.array([0.0, 3.2]), 4.0)

    def volume(x, number=1, class_id=11):
        semantic, instance = np.zeros(shape, np.uint8), np.zeros(shape, np.uint16)
        semantic[x : x + 2, 1:3, 11], instance[x : x + 2, 1:3, 11] = class_id, number
        states = (semantic > 0).astype(np.uint16)
        palette = ("minecraft:air", "minecraft:stone")
        return BlockVolume(states, palette, semantic, instance, (0, 63, 0), to_room)

    assert kept_objects(volume(3), [one], grid) == [0]
    assert kept_objects(volume(9), [one], grid) == [], "not in its place"
    assert kept_objects(volume(3, number=2), [one], grid) == []
    assert kept_objects(volume(3, class_id=10), [one], grid) == []


def slow_share_shown(volume: BlockVolume, one: ObjectInstance, voxel_m: float) -> float:
    """Of an object's cells, the share that has its block in its place or one step off."""
    reach_m = max(voxel_m, 1 / volume.blocks_per_metre)
    shown = 0
    for cell in one.cells:
        middle_m = (cell + 0.5) * voxel_m
        places = [middle_m]
        for axis in range(3):
            places += [middle_m + sign * reach_m * np.eye(3)[axis] for sign in (-1, 1)]
        blocks = [
            np.floor(apply(invert(volume.block_to_room), at) - volume.corner) for at in places
        ]
        shown += any(
            (volume.instance[at], volume.semantic[at]) == (one.id, one.class_id)
            for at in (tuple(int(index) for index in block) for block in blocks)
            if all(0 <= index < size for index, size in zip(at, volume.states.shape, strict=True))
        )
    return shown / len(one.cells)


@pytest.mark.parametrize("blocks_per_metre", [4.0, 20.0])
@given(st.integers(0, 10_000))
def test_kept_is_what_a_slow_reading_keeps(blocks_per_metre, seed):
    """Thin blocks of two classes and numbers, some at the edge of the volume; cells beyond it."""
    random = np.random.default_rng(seed)
    shape = (8, 5, 7)
    full = random.random(shape) < 0.08
    semantic = np.where(full, random.integers(10, 12, shape), 0).astype(np.uint8)
    instance = np.where(full, random.integers(1, 3, shape), 0).astype(np.uint16)
    to_room = block_to_room(np.array([0.013, 1.517]), blocks_per_metre)
    palette = ("minecraft:air", "minecraft:stone")
    corner = (0, 63, int(random.integers(-1, 3)))
    volume = BlockVolume(full.astype(np.uint16), palette, semantic, instance, corner, to_room)
    low, high = np.array([-0.2, 0.3, -0.3]), np.array([8 / blocks_per_metre, 1.6, 1.0])
    grid = grid_with({})
    for least in (0.25, 0.5):
        for number in (1, 2):
            cells = np.unique(random.integers(low / 0.08, high / 0.08, (6, 3)), axis=0)
            one = ObjectInstance(
                number, 11, np.ones(3), np.ones(3), 0, cells.astype(np.int32).clip(0), 1
            )
            kept = slow_share_shown(volume, one, 0.08) >= least
            assert kept_objects(volume, [one], grid, least) == ([0] if kept else [])


def test_own_cells_of_a_box_that_reaches_out_of_the_grid():
    grid = grid_with({7: [(0, 0, 0), (1, 0, 0), (39, 39, 19)]})
    far = grid.origin_m + np.array([40, 40, 20]) * grid.voxel_m
    for center, cells in ((grid.origin_m, [[0, 0, 0], [1, 0, 0]]), (far, [[39, 39, 19]])):
        size = np.full(3, 6 * grid.voxel_m)
        found = own_cells(Placement(7, 11, "cells", center, size, 0, 0.0), grid)
        assert found.tolist() == cells


def test_parts_that_are_apart_meet_by_nothing():
    one = np.array([[[0, 0, 0], [1, 1, 1]]], float)
    assert depth_m(one, one + 0.75) == 0.25
    assert depth_m(one, one + 5) == 0.0

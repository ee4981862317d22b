"""Vanilla block designs: their states, their fronts and their quarter turns."""

from itertools import pairwise

import numpy as np
import pytest

from world2minecraft.core.types import Placement
from world2minecraft.furniture import TEMPLATES, block_design, template
from world2minecraft.minecraft.block_states import complete, known_blocks, parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.paintings import PAINTING

NAMES = TEMPLATES.names()
SCALES = (1.0, 2.0, 4.0)


def _placed(name, quarter_turns=0, size_m=None, **parameters):
    one = template(name)
    size = np.array(size_m or one.typical_m)
    return Placement(1, one.class_id, name, np.zeros(3), size, quarter_turns, 1.0, parameters)


def _boxes(design):
    """Return all collision boxes of a design, sorted, in blocks from its corner."""
    boxes = [
        box + np.tile(block.offset, 2) for block in design.blocks for box in boxes_of(block.state)
    ]
    return np.array(sorted(map(tuple, np.round(boxes, 4))))


def _volume(design):
    """Return a design's collision boxes as bool cells of a sixteenth of a block."""
    east, up, south = design.size
    volume = np.zeros((east * 16 + 32, up * 16 + 32, south * 16 + 32), bool)
    for box in np.round(_boxes(design) * 16).astype(int) + 16:
        volume[box[0] : box[3], box[1] : box[4], box[2] : box[5]] = True
    return volume


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", NAMES)
def test_a_quarter_turn_turns_every_box_of_the_design(name, scale):
    designs = [block_design(_placed(name, turns), scale) for turns in range(3)]
    for before, after in pairwise(designs):
        assert after.size == (before.size[2], before.size[1], before.size[0])
        # Counter-clockwise from above carries east to north, which is -z: from axis 2 to axis 0.
        np.testing.assert_array_equal(_volume(after), np.rot90(_volume(before), axes=(2, 0)))


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", NAMES)
def test_states_are_known_complete_and_within_the_size(name, scale):
    design = block_design(_placed(name), scale)
    offsets = [block.offset for block in design.blocks]
    assert offsets == sorted(set(offsets))
    assert (np.array(offsets) >= 0).all() and (np.array(offsets) < design.size).all()
    for block in design.blocks:
        state = parse_state(block.state)
        assert state.name in known_blocks() or state.name == PAINTING
        assert str(complete(state)) == block.state


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("name", ["chair", "armchair", "office_chair", "sofa"])
def test_the_high_side_of_a_seat_is_its_back(name, turns):
    boxes = _boxes(block_design(_placed(name, turns), 1.0))
    size = np.array(block_design(_placed(name, turns), 1.0).size)
    high = boxes[boxes[:, 4] > 0.9]
    middle = ((high[:, :3] + high[:, 3:]) / 2).mean(axis=0) - size / 2
    front = {0: (1, 0), 1: (0, -1), 2: (-1, 0), 3: (0, 1)}[turns]
    assert middle[0] * front[0] + middle[2] * front[1] < -0.1


def test_a_chair_that_looks_east_has_stairs_that_face_west():
    (block,) = block_design(_placed("chair"), 1.0).blocks
    assert block.state == (
        "minecraft:oak_stairs[facing=west,half=bottom,shape=straight,waterlogged=false]"
    )


def test_the_head_of_a_bed_lies_at_its_back():
    blocks = {
        block.offset: block.state for block in block_design(_placed("single_bed"), 1.0).blocks
    }
    assert blocks == {
        (0, 0, 0): "minecraft:blue_bed[facing=west,occupied=false,part=head]",
        (1, 0, 0): "minecraft:blue_bed[facing=west,occupied=false,part=foot]",
    }


@pytest.mark.parametrize(
    ("scale", "height_m", "top_blocks"),
    [(2.0, 0.75, 1.5), (2.0, 0.95, 2.1875), (4.0, 0.75, 3.0), (4.0, 0.9, 3.5), (1.0, 0.75, 1.0)],
)
def test_the_top_of_a_table_is_at_its_height(scale, height_m, top_blocks):
    boxes = _boxes(block_design(_placed("dining_table", size_m=(1.0, 1.5, height_m)), scale))
    wide = boxes[boxes[:, 3] - boxes[:, 0] > 0.8]
    assert wide[:, 4].max() == top_blocks


def test_a_plate_of_one_block_lies_on_a_fence():
    blocks = block_design(_placed("coffee_table", size_m=(0.5, 0.5, 0.53)), 2.0).blocks
    names = [parse_state(block.state).name for block in blocks]
    assert names == ["minecraft:spruce_fence", "minecraft:spruce_pressure_plate"]


def test_fences_join_their_neighbours_as_the_game_joins_them():
    blocks = block_design(_placed("chair", size_m=(0.5, 0.5, 0.9)), 4.0).blocks
    legs = [parse_state(block.state) for block in blocks if block.role == "leg"]
    assert len(legs) == 4
    ways = ("east", "north", "south", "west")
    assert [sum(leg.get(way) == "true" for way in ways) for leg in legs] == [2, 2, 2, 2]


def test_a_corner_sofa_runs_on_at_the_side_it_says():
    left = block_design(_placed("corner_sofa", side=1.0), 2.0)
    right = block_design(_placed("corner_sofa", side=-1.0), 2.0)
    front = left.size[0] - 1
    assert max(b.offset[2] for b in left.blocks if b.offset[0] == front) < left.size[2] - 1
    assert min(b.offset[2] for b in right.blocks if b.offset[0] == front) > 0


def test_parts_are_built_from_six_blocks_a_metre():
    assert block_design(_placed("chair"), 5.9) is not None
    assert block_design(_placed("chair"), 6.0) is None
    own = Placement(1, 5, "cells", np.zeros(3), np.ones(3), 0, 0.2)
    assert block_design(own, 1.0) is None

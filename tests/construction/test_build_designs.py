"""Designs in a room: equal ones equal, on what carries them, and without lumps beside them."""

import numpy as np
import pytest
from build_samples import (
    CHAIR,
    FURN,
    OBJS,
    RED,
    TABLE,
    TVS,
    VOXEL_M,
    WALL,
    WOOD,
    Sketch,
    placement,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.construction import BuildParameters, build_volume
from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.design_placement import body_box, design_box
from world2minecraft.furniture import block_design, template
from world2minecraft.minecraft.rules.stability import find_unstable

BARE = BuildParameters(ceiling=False, lights=False, expose=False)


def _built(sketch, placements, scale):
    return build_volume(
        sketch.grid(),
        placements,
        (),
        corner_m=sketch.corner_m,
        blocks_per_metre=scale,
        parameters=BARE,
    )


def _states(volume, number):
    """Return an object's states, sorted by place, from its own first block on."""
    at = np.argwhere(volume.instance == number)
    held = [volume.palette[i] for i in volume.states[tuple(at.T)]]
    return [
        (tuple((cell - at.min(axis=0)).tolist()), state)
        for cell, state in zip(at, held, strict=True)
    ]


def _chair(number, x, y, sketch, colour=WOOD):
    sketch.put((x, x + 6), (y, y + 6), (5, 6), CHAIR, colour, number)
    sketch.put((x, x + 1), (y, y + 6), (0, 11), CHAIR, colour, number)
    middle = (0.08 * (x + 3), 0.08 * (y + 3), 0.44)
    return placement("chair", CHAIR, middle, (0.48, 0.48, 0.88), number=number)


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0])
@settings(max_examples=8, deadline=None)
@given(x=st.integers(2, 12), y=st.integers(2, 10))
def test_equal_chairs_come_out_equal_wherever_they_stand(scale, x, y):
    sketch = Sketch()
    chairs = [_chair(1, x, y, sketch), _chair(2, x + 22, y + 4, sketch)]
    volume = _built(sketch, chairs, scale)
    assert _states(volume, 1) == _states(volume, 2)
    assert _states(volume, 1)


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_chair_of_few_blocks_leaves_no_lump_of_cells(scale):
    sketch = Sketch()
    chair = _chair(1, 10, 10, sketch)
    sketch.put((17, 24), (10, 14), (0, 9), CHAIR, RED, 1)  # Cells that the chair does not explain.
    volume = _built(sketch, [chair], scale)
    blocks = block_design(chair, scale).blocks
    assert (volume.instance == 1).sum() == len(blocks)


def test_at_four_blocks_a_metre_they_are_built():
    sketch = Sketch()
    chair = _chair(1, 10, 10, sketch)
    sketch.put((17, 24), (10, 14), (0, 9), CHAIR, RED, 1)
    volume = _built(sketch, [chair], 4.0)
    assert (volume.instance == 1).sum() > len(block_design(chair, 4.0).blocks)


@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_a_box_on_a_table_lies_over_its_top_and_both_are_whole(scale):
    sketch = Sketch().put((10, 30), (6, 18), (9, 10), TABLE, WOOD, 1)
    sketch.put((16, 22), (9, 15), (10, 15), OBJS, RED, 2)
    table = placement("dining_table", TABLE, (1.6, 0.96, 0.4), (0.96, 1.6, 0.8), 1, 1)
    box = placement("box", OBJS, (1.52, 0.96, 1.0), (0.48, 0.48, 0.4), number=2)
    volume = _built(sketch, [table, box], scale)
    assert (volume.instance == 1).sum() == len(block_design(table, scale).blocks)
    own, under = np.argwhere(volume.instance == 2), np.argwhere(volume.instance == 1)
    assert len(own) == len(block_design(box, scale).blocks)
    assert own[:, 1].min() > under[:, 1].max()
    assert find_unstable(volume) == []


@pytest.mark.parametrize("turns", range(4))
def test_handles_protrude_and_the_body_stays_at_the_wall(turns):
    one = placement("cabinet", FURN, (2.0, 2.0, 0.45), (0.5, 1.0, 0.9), turns)
    lattice = Lattice((-3, 61, -3), (30, 30, 20), np.array([0.0, 4.0]), 4.0)
    design = block_design(one, 4.0)
    low, size = design_box(design, one, lattice)
    start, solid = body_box(design, one, lattice, low, size)
    axis = turns % 2
    own = template("cabinet").typical_m
    assert solid[axis] == 2 and size[axis] >= 2
    assert (solid[1 - axis], solid[2]) == (size[1 - axis], size[2])
    # What stands out lies at the far end where the front looks along the axis, else at the near.
    assert start[axis] == (low[axis] if turns < 2 else low[axis] + size[axis] - solid[axis])
    assert len(own) == 3


@pytest.mark.parametrize(
    ("size_m", "word"),
    [
        ((0.1, 0.1, 0.15), "flower_pot"),
        ((0.4, 0.4, 0.2), "slab"),
        ((0.08, 0.9, 1.2), "pane"),
        ((0.5, 0.5, 0.5), "barrel"),
    ],
)
def test_a_small_thing_stays_small_at_two_blocks_per_metre(size_m, word):
    blocks = block_design(placement("box", OBJS, (0, 0, 0), size_m), 2.0).blocks
    assert all(word in block.state for block in blocks)


@pytest.mark.parametrize(("scale", "let_in"), [(1.0, True), (2.0, True), (4.0, False)])
@pytest.mark.parametrize("turns", range(4))
def test_a_wall_screen_is_let_into_an_outer_wall(scale, let_in, turns):
    size = np.array(Sketch().size[:2]) * VOXEL_M
    center = size / 2
    axis = turns % 2
    center[axis] = 0.05 if turns < 2 else size[axis] - 0.05
    screen = placement("wall_tv", TVS, (*center, 1.3), (0.1, 1.2, 0.7), turns)
    volume, empty = (_built(Sketch(), those, scale) for those in ([screen], []))
    own = volume.semantic == TVS
    assert own.any()
    assert (empty.semantic[own] == WALL).all() == let_in
    names = {volume.palette[number].partition("[")[0] for number in volume.states[own]}
    assert names <= {"minecraft:black_concrete", "minecraft:polished_blackstone_stairs"}

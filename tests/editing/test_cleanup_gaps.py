"""Gaps of less than a block under a thing are closed, in the way that shows least."""

from dataclasses import replace

import numpy as np
import pytest
from edit_volumes import seen
from test_cleanup import FURN, OBJS, RED, TABLE, Room, kinds

from world2minecraft.editing.cleanup.floating import floating_cells
from world2minecraft.editing.cleanup.gaps import full_block_of
from world2minecraft.editing.cleanup.passes import repair_volume
from world2minecraft.editing.volume_draft import Draft, apply_edits

FENCE = "minecraft:oak_fence[east=false,north=false,south=false,waterlogged=false,west=false]"


def trapdoor(half):
    inner = f"facing=north,half={half},open=false,powered=false,waterlogged=false"
    return f"minecraft:oak_trapdoor[{inner}]"


def with_blocks(blocks):
    """The room with further blocks: state, class and instance by cell."""
    volume = Room().volume()
    states, semantic = volume.states.copy(), volume.semantic.copy()
    instance, palette = volume.instance.copy(), list(volume.palette)
    for cells, state, class_id, number in blocks:
        if state not in palette:
            palette.append(state)
        states[cells], semantic[cells] = palette.index(state), class_id
        instance[cells] = number
    return replace(
        volume, states=states, semantic=semantic, instance=instance, palette=tuple(palette)
    )


def plate_table():
    """A table whose top is a board of trapdoors on four legs."""
    legs = [((x, slice(1, 3), z), FENCE, TABLE, 5) for x in (10, 15) for z in (10, 13)]
    return [*legs, ((slice(10, 16), 3, slice(10, 14)), trapdoor("bottom"), TABLE, 5)]


def mend(blocks):
    volume = with_blocks(blocks)
    result, edits = repair_volume(volume, ("floating",))
    assert seen(apply_edits(result, *[e.inverse() for e in reversed(edits)])) == seen(volume)
    assert not floating_cells(Draft(result)).any()
    return np.array(result.palette, object)[result.states], result, kinds(edits)


def test_a_vase_sinks_into_the_board_that_it_stands_on():
    states, result, done = mend([*plate_table(), ((12, slice(4, 6), 12), RED, OBJS, 6)])
    assert done == ["move"]
    assert states[12, 3:6, 12].tolist() == [RED, RED, "minecraft:air"]
    assert (result.instance[10:16, 3, 10:14] == 5).sum() == 23


def test_a_thing_as_large_as_the_board_does_not_swallow_it():
    _, result, _ = mend([*plate_table(), ((slice(10, 16), 4, slice(10, 14)), RED, OBJS, 6)])
    assert (result.instance[10:16, 3, 10:14] == 5).all()


@pytest.mark.parametrize(
    ("state", "lowered"),
    [
        (trapdoor("top"), trapdoor("bottom")),
        ("minecraft:oak_slab[type=top,waterlogged=false]", None),
    ],
)
def test_a_flat_thing_in_the_upper_half_of_its_cell_is_put_down(state, lowered):
    chest = ((slice(12, 15), slice(1, 3), slice(12, 14)), RED, FURN, 5)
    states, _, done = mend([chest, ((13, 3, 12), state, OBJS, 6)])
    assert done == ["settle"]
    assert states[13, 3, 12] == (lowered or state.replace("top", "bottom"))


def test_a_higher_thing_gets_a_whole_foot():
    chest = ((slice(12, 15), slice(1, 3), slice(12, 14)), RED, FURN, 5)
    thing = [((13, 3, 12), trapdoor("top"), OBJS, 6), ((13, 4, 12), RED, OBJS, 6)]
    states, _, done = mend([chest, *thing])
    assert done == ["settle"]
    assert states[13, 3:5, 12].tolist() == ["minecraft:oak_planks", RED]


@pytest.mark.parametrize(
    ("state", "expected"),
    [
        ("minecraft:oak_slab[type=bottom]", "minecraft:oak_slab[type=double]"),
        ("minecraft:iron_trapdoor[half=top,open=false]", "minecraft:iron_block"),
        ("minecraft:bamboo_trapdoor[half=top]", "minecraft:bamboo_planks"),
        ("minecraft:stone", "minecraft:stone"),
        ("mod:pine_trapdoor[half=top]", "mod:pine_trapdoor[half=top]"),
    ],
)
def test_the_whole_of_a_half(state, expected):
    assert full_block_of(state) == expected

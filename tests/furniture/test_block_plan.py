"""The sheet that designs are laid on: sides, heights and what holds what."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.furniture import Look, Material
from world2minecraft.furniture.block_plan import Plan
from world2minecraft.furniture.box_primitives import (
    RISES,
    lay_back,
    lay_legs,
    lay_plate,
    lay_trestle,
)
from world2minecraft.furniture.template import BlockSize
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.visual_shapes import visual_boxes

WOOD = Look("thing", {}, {}, {"top": Material("wood", "oak"), "cloth": Material("cloth", "red")})
# Where the panel of an open trapdoor lies: axis of block axes (x east, z south) and its low side.
PANELS = {"back": (0, 0.0), "front": (0, 1.0), "right": (2, 1.0), "left": (2, 0.0)}


def _plan(depth=2, width=3, height=2, scale=2.0):
    exact = (float(depth), float(width), float(height))
    return Plan(BlockSize(depth, width, height, exact, scale), WOOD)


@pytest.mark.parametrize("side", PANELS)
def test_a_panel_stands_at_the_side_that_is_said(side):
    plan = _plan()
    plan.panel("top", 0, 0, 0, side)
    (box,) = visual_boxes(str(complete(parse_state(plan.blocks[0].state))))
    axis, edge = PANELS[side]
    assert edge in (box[axis], box[axis + 3])
    assert box[axis + 3] - box[axis] < 0.2


@pytest.mark.parametrize("side", PANELS)
def test_stairs_are_high_at_the_side_that_is_said(side):
    plan = _plan()
    plan.stairs("top", 0, 0, 0, side)
    boxes = visual_boxes(str(complete(parse_state(plan.blocks[0].state))))
    axis, edge = PANELS[side]
    high = [box for box in boxes if box[4] == 1.0 and box[1] > 0.0]
    assert high
    assert all(abs((box[axis] + box[axis + 3]) / 2 - edge) < 0.5 for box in high)


def test_later_blocks_replace_earlier_ones():
    plan = _plan()
    plan.put("cloth", range(2), range(3), 0)
    plan.slab("top", 0, 0, 0)
    assert len(plan.blocks) == 6
    assert plan.blocks[0].state == "minecraft:oak_slab[type=bottom]"
    plan.drop(range(2), 0, 0)
    assert not plan.held((0, 0, 0))
    assert len(plan.blocks) == 4


@given(st.floats(0.6, 8.0))
def test_a_plate_lies_as_near_to_its_height_as_its_shapes_allow(height):
    plan = _plan(1, 1)
    layer = lay_plate(plan, "top", 0, 0, height)
    (block,) = plan.blocks
    top = block.cell[2] + visual_boxes(str(complete(parse_state(block.state))))[:, 4].max()
    heights = [k + rise for k in range(10) for name, rise in RISES.items() if name != "carpet"]
    best = min(abs(one - height) for one in heights if one > 0.4)
    assert abs(top - height) <= best + 1e-5
    assert block.cell[2] == layer


def test_a_plate_of_cloth_is_whole_or_a_carpet():
    plan = _plan()
    assert lay_plate(plan, "cloth", 0, 0, 1.1, ("carpet", "full")) == 1
    assert lay_plate(plan, "cloth", 1, 0, 0.9, ("carpet", "full")) == 0
    assert [block.state for block in plan.blocks] == ["minecraft:red_carpet", "minecraft:red_wool"]


def test_legs_are_fences_or_whole_blocks_by_material():
    plan = _plan()
    lay_legs(plan, "top", plan.corners, 2)
    assert {block.state for block in plan.blocks} == {"minecraft:oak_fence"}
    assert len(plan.blocks) == 8
    lay_legs(plan, "cloth", [(0, 1)], 1)
    assert plan.held((0, 1, 0))


def test_a_back_of_cloth_is_whole():
    plan = _plan()
    lay_back(plan, "cloth", 0, 0)
    lay_back(plan, "top", 1, 0)
    cloth, wood = (block.state for block in plan.blocks)
    assert cloth == "minecraft:red_wool"
    assert "trapdoor" in wood


def test_a_trestle_has_a_leg_at_either_end_and_a_top_between():
    plan = _plan(1, 4, 1)
    lay_trestle(plan)
    names = [block.state.partition("[")[0] for block in plan.blocks]
    stairs, slab = "minecraft:oak_stairs", "minecraft:oak_slab"
    assert names == [stairs, slab, slab, stairs]

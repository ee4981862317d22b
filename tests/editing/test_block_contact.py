"""Blocks touch where their shapes meet; the fast parts are those of a readable twin."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.types import AIR
from world2minecraft.editing.cleanup.floating import GAP, STEPS, touches, touching_parts
from world2minecraft.minecraft.visual_shapes import visual_boxes

STONE = "minecraft:stone"
LOWER, UPPER = (f"minecraft:oak_slab[type={kind},waterlogged=false]" for kind in ("bottom", "top"))
POST = "minecraft:oak_fence[east=false,north=false,south=false,waterlogged=false,west=false]"
LANTERN = "minecraft:lantern[hanging=false,waterlogged=false]"
HANGING = "minecraft:lantern[hanging=true,waterlogged=false]"
PALETTE = (AIR, HANGING, LANTERN, LOWER, POST, STONE, UPPER)


@pytest.mark.parametrize(
    ("state", "other", "step", "expected"),
    [
        (STONE, STONE, (1, 0, 0), True),
        (STONE, STONE, (1, 1, 0), True),
        (STONE, STONE, (1, 1, 1), True),
        (LOWER, STONE, (0, 1, 0), False),
        (UPPER, STONE, (0, 1, 0), True),
        (STONE, LANTERN, (0, 1, 0), True),
        (LOWER, LANTERN, (0, 1, 0), False),
        (HANGING, STONE, (0, 1, 0), True),
        (LANTERN, STONE, (0, 1, 0), False),
        (POST, STONE, (1, 0, 0), False),
        (POST, POST, (0, 1, 0), True),
        (STONE, AIR, (0, 1, 0), False),
        (STONE, "minecraft:barrier", (0, 1, 0), False),
        (LOWER, UPPER, (1, 0, 0), True),
        (STONE, "mod:sofa", (0, 1, 0), True),
    ],
)
def test_shapes_touch_or_not(state, other, step, expected):
    assert touches(state, other, step) is expected
    back = tuple(-s for s in step)
    assert touches(other, state, back) is expected


def slowly(states, mask):
    """Parts by flooding, each pair of cells compared box by box."""
    cells = list(map(tuple, np.argwhere(mask).tolist()))

    def near(a, b):
        away = np.array(b) - a
        if np.abs(away).max() > 1:
            return False
        for one in visual_boxes(PALETTE[states[a]]):
            for two in visual_boxes(PALETTE[states[b]]):
                gaps = [
                    max(two[n] + away[n] - one[n + 3], one[n] - two[n + 3] - away[n])
                    for n in range(3)
                ]
                if max(gaps) < GAP - 1e-6:
                    return True
        return False

    parts, number = np.zeros(states.shape, np.int32), 0
    for start in cells:
        if parts[start]:
            continue
        number += 1
        queue = [start]
        while queue:
            cell = queue.pop()
            if not parts[cell]:
                parts[cell] = number
                queue += [other for other in cells if not parts[other] and near(cell, other)]
    return parts


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.05, 0.6))
def test_parts_are_those_of_the_readable_twin(seed, share):
    rng = np.random.default_rng(seed)
    states = rng.integers(1, len(PALETTE), (4, 4, 3)).astype(np.uint16)
    mask = rng.random(states.shape) < share
    assert np.array_equal(touching_parts(states, PALETTE, mask), slowly(states, mask))


def test_half_the_neighbours_stand_for_all():
    assert len(STEPS) == 13
    both = {*STEPS, *(tuple(-s for s in step) for step in STEPS)}
    assert len(both) == 26

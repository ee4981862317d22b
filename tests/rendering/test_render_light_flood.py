"""Sky and block light, against a slow reading of the game's rules."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.rendering.light_worlds import PALETTE, SLOW_SHAPES, random_world

from world2minecraft.minecraft.rules.light import (
    DIMS,
    SHUT,
    SOLID,
    light_tables,
    light_units,
    opacity_word,
    rounded_reach,
)
from world2minecraft.rendering.light import light_field

TOP = 15


def covered(state: str, side: int) -> frozenset:
    """The quarters of a face that hold light back; a solid state holds it back on entering."""
    return SLOW_SHAPES.get(state, {}).get(side, frozenset())


@cache
def is_shut(state: str, other: str, side: int) -> bool:
    """Whether no light passes from one cell to the other by this side."""
    return covered(state, side) | covered(other, side ^ 1) == ALL


ALL = frozenset((p, q) for p in (0, 1) for q in (0, 1))
STEPS = [(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)]
GIVES = ("minecraft:glowstone", "minecraft:lantern")
SOLIDS = ("minecraft:stone", "minecraft:glowstone")
DIM = ("minecraft:water", "minecraft:oak_leaves[persistent=true]")


def slow_light(states: np.ndarray, kind: str) -> np.ndarray:
    """Raise any cell by any neighbour until nothing changes."""
    names = {cell: PALETTE[states[cell]] for cell in np.ndindex(states.shape)}
    light = dict.fromkeys(names, 0)
    changed = True
    while changed:
        changed = False
        for cell, name in names.items():
            best = 15 if kind == "block" and name in GIVES else 0
            if name not in SOLIDS:
                for side, step in enumerate(STEPS):
                    other = (cell[0] + step[0], cell[1] + step[1], cell[2] + step[2])
                    level = light.get(other, TOP if kind == "sky" and other[1] >= 0 else 0)
                    if is_shut(name, names.get(other, "outside"), side):
                        continue
                    straight = kind == "sky" and side == 3 and level == TOP
                    best = max(best, level if straight and name not in DIM else level - 1)
            if best > light[cell]:
                light[cell], changed = best, True
    return np.array(list(light.values())).reshape(states.shape)


@pytest.mark.parametrize("seed", range(6))
def test_light_spreads_by_the_game_s_rules(seed):
    states = random_world(seed)
    field = light_field(states, PALETTE)
    assert np.array_equal(field.sky_light, slow_light(states, "sky"))
    assert np.array_equal(field.block_light, slow_light(states, "block"))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 8))
def test_a_larger_reach_extends_light_from_its_source(seed, reach):
    states = random_world(seed)
    near, far = light_field(states, PALETTE), light_field(states, PALETTE, reach)
    assert (far.sky_light / reach >= near.sky_light).all()
    assert (far.block_light / reach >= near.block_light).all()


def test_a_reach_spreads_a_lamp_so_many_blocks_a_level():
    states = np.zeros((40, 1, 1), np.uint16)
    states[0] = PALETTE.index("minecraft:lantern")
    for reach in (1.0, 1.5, 2.0, 4.0):
        field = light_field(states, PALETTE, reach)
        assert field.reach == pytest.approx(reach, abs=0.034)
        light = field.block_light[:, 0, 0] / field.reach
        assert light[0] == pytest.approx(15)
        assert light[10] == pytest.approx(15 - 10 / field.reach)


def test_open_air_is_lit_in_full_and_a_closed_box_is_dark():
    states = np.zeros((5, 5, 5), np.uint16)
    assert (light_field(states, PALETTE).sky_light == 15).all()
    states[:] = PALETTE.index("minecraft:stone")
    states[1:4, 1:4, 1:4] = 0
    field = light_field(states, PALETTE)
    assert field.sky_light.max() == 0
    assert field.block_light.max() == 0


def test_water_dims_the_sky_by_one_a_block_and_glass_not_at_all():
    states = np.full((3, 6, 3), PALETTE.index("minecraft:stone"), np.uint16)
    states[1, :, 1] = PALETTE.index("minecraft:water")
    assert light_field(states, PALETTE).sky_light[1, :, 1].tolist() == [9, 10, 11, 12, 13, 14]
    states[1, :, 1] = PALETTE.index("minecraft:glass")
    assert light_field(states, PALETTE).sky_light[1, :, 1].tolist() == [15] * 6


def test_a_roof_of_slabs_or_stairs_keeps_a_room_dark():
    for roof in (
        "minecraft:oak_slab[type=bottom]",
        "minecraft:oak_stairs[facing=east,half=bottom]",
    ):
        states = np.full((4, 4, 4), PALETTE.index("minecraft:stone"), np.uint16)
        states[1:3, 1:3, 1:3] = 0
        states[:, 3] = PALETTE.index(roof)
        assert light_field(states, PALETTE).sky_light[1:3, 1:3, 1:3].max() == 0


def test_what_states_are_to_light():
    assert opacity_word("minecraft:air") == 0
    assert opacity_word("minecraft:stone") == SHUT | SOLID
    assert opacity_word("minecraft:tinted_glass") == SHUT | SOLID
    assert opacity_word("minecraft:glass") == 0
    assert opacity_word("minecraft:ice") == DIMS
    assert opacity_word("minecraft:oak_fence[waterlogged=true]") == DIMS
    slab = opacity_word("minecraft:oak_slab[type=bottom]")
    assert [slab >> 4 * side & 15 for side in range(6)] == [3, 3, 15, 0, 5, 5]
    words, gives = light_tables(("minecraft:air", "minecraft:lantern"))
    assert words[0] == SHUT
    assert gives.tolist() == [0, 0, 15]


def test_a_reach_out_of_range_is_refused():
    with pytest.raises(
        ValueError, match=r"^reach must be 1 to 16 blocks per light level, got 0.5$"
    ):
        rounded_reach(0.5)
    assert light_units(15, rounded_reach(16)) == 240


@pytest.mark.parametrize("shape", [(0, 3, 3), (1, 1, 1), (3, 1, 2)])
def test_small_volumes_have_light(shape):
    field = light_field(np.zeros(shape, np.uint16), PALETTE)
    assert field.sky_light.shape == shape
    assert (field.sky_light == 15).all()


def test_hidden_lamps_may_be_left_out():
    palette = ("minecraft:air", "minecraft:light[level=12]", "minecraft:lantern")
    states = np.array([[[1, 0, 0, 0, 2]]], np.uint16)
    shining = light_field(states, palette).block_light[0, 0]
    natural = light_field(states, palette, hidden_lamps=False).block_light[0, 0]
    assert shining.tolist() == [12, 12, 13, 14, 15]
    assert natural.tolist() == [11, 12, 13, 14, 15]

"""Connections and shapes against the published rules, a slow twin, and laws."""

import json
from pathlib import Path

import numpy as np
import pytest
from connection_rules import STEP, slowly_connected
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.turn_and_mirror import mirror_state, turn_state

CASES = json.loads((Path(__file__).parent / "connection_cases.json").read_text())["cases"]
STEPS = {way[0]: np.array(step) for way, step in STEP.items()} | {"o": np.zeros(3, int)}
PALETTE = (
    "minecraft:air", "minecraft:stone", "glass_pane", "iron_bars", "oak_fence", "birch_fence",
    "nether_brick_fence", "oak_fence_gate[facing=north]", "oak_fence_gate[facing=east,open=true]",
    "cobblestone_wall", "brick_wall[up=false,east=tall]", "oak_leaves[persistent=true]", "barrier",
    "oak_stairs[facing=north]", "oak_stairs[facing=east]", "oak_stairs[facing=south]",
    "stone_stairs[facing=west]", "stone_stairs[facing=north,half=top]",
    "oak_stairs[facing=west,half=top,shape=inner_left]", "oak_slab[type=bottom]", "torch",
    "stone_slab[type=top]", "white_carpet", "chain", "lantern[hanging=true]", "oak_sign",
    "oak_trapdoor[facing=north,open=true]", "oak_trapdoor[half=bottom]", "pumpkin", "chest",
    "oak_door[facing=north,half=upper]", "oak_door[facing=east,half=lower,hinge=right]",
    "hopper", "composter", "oak_pressure_plate", "red_wall_banner[facing=north]", "mod:thing",
)  # fmt: skip
NAMES = st.integers(0, len(PALETTE) - 1)


def volume(size, seed, share=0.3):
    random = np.random.default_rng(seed)
    states = random.integers(0, len(PALETTE), size).astype(np.uint16)
    return np.where(random.random(size) < share, 0, states).astype(np.uint16)


def texts(states, palette):
    whole = np.array([str(complete(parse_state(text))) for text in palette], object)
    return whole[states]


@pytest.mark.parametrize(("group", "what", "blocks", "expected"), CASES)
def test_the_published_rules(group, what, blocks, expected):
    palette, states = ["minecraft:air"], np.zeros((5, 5, 5), np.uint16)
    for place, text in blocks.items():
        if text not in palette:
            palette.append(text)
        states[tuple(2 + sum(STEPS[letter] for letter in place))] = palette.index(text)
    found, names = update_connections(states, palette)
    got = dict(complete(parse_state(names[found[2, 2, 2]])).properties)
    assert {key: got[key] for key in expected} == expected


def test_there_are_cases_enough():
    assert len(CASES) >= 80
    assert len({json.dumps(case[2], sort_keys=True) for case in CASES}) == len(CASES)


@pytest.mark.parametrize("seed", range(4))
def test_the_fast_rules_are_the_slow_ones(seed):
    states = volume((6, 5, 6), seed)
    found, names = update_connections(states, PALETTE)
    for cell, state in slowly_connected(states, PALETTE).items():
        if "leaves" not in state.name:
            assert texts(found[cell], names) == str(state), cell


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.tuples(*[st.integers(1, 5)] * 3))
def test_twice_is_once(seed, size):
    once, names = update_connections(volume(size, seed), PALETTE)
    twice, more = update_connections(once, names)
    assert more == names and np.array_equal(once, twice)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.tuples(*[st.integers(1, 5)] * 3))
def test_turning_and_connecting_go_in_any_order(seed, size):
    states = volume(size, seed)
    turned = np.rot90(states, 1, axes=(2, 0))
    late, names = update_connections(states, PALETTE)
    late = np.rot90(texts(late, [turn_state(text, 1) for text in names]), 1, axes=(2, 0))
    early = texts(*update_connections(turned, [turn_state(text, 1) for text in PALETTE]))
    assert np.array_equal(early, late)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.tuples(*[st.integers(1, 5)] * 3))
def test_mirroring_and_connecting_go_in_any_order(seed, size):
    states = volume(size, seed)
    late, names = update_connections(states, PALETTE)
    late = texts(late, [mirror_state(text, "x") for text in names])[::-1]
    early = texts(*update_connections(states[::-1], [mirror_state(text, "x") for text in PALETTE]))
    assert np.array_equal(early, late)


@given(st.integers(0, 10_000))
@settings(deadline=None, max_examples=20)
def test_nothing_but_the_computed_properties_changes(seed):
    states = volume((4, 4, 4), seed)
    before, after = texts(states, PALETTE), texts(*update_connections(states, PALETTE))
    kept = ("half", "type", "waterlogged", "persistent", "layers", "axis", "rotation")
    for one, other in zip(before.ravel(), after.ravel(), strict=True):
        first, second = parse_state(one), parse_state(other)
        assert first.name == second.name
        assert [first.get(key) for key in kept] == [second.get(key) for key in kept]


def test_the_palette_keeps_its_order_and_an_empty_volume_is_one():
    states, names = update_connections(volume((5, 5, 5), 1), PALETTE)
    assert names[: len(PALETTE)] == PALETTE
    assert states.dtype == np.uint16
    empty, names = update_connections(np.zeros((0, 3, 2), np.uint16), ("minecraft:air",))
    assert empty.shape == (0, 3, 2) and names == ("minecraft:air",)


def test_equal_chests_of_a_row_stay_pairs():
    row = ("minecraft:air", "chest[facing=north,type=left]", "chest[facing=north,type=right]")
    states = np.array([1, 2, 1, 2], np.uint16).reshape(4, 1, 1)
    found, names = update_connections(states, row)
    assert [parse_state(names[n]).get("type") for n in found.ravel()] == ["left", "right"] * 2


def test_walls_of_old_games_keep_their_sides():
    """Before 1.16 a wall's side was true or false, with no height to compute."""
    old = "minecraft:cobblestone_wall[east=true,north=false,south=false,up=true,west=false]"
    states, names = update_connections(np.ones((1, 1, 1), np.uint16), ("minecraft:air", old))
    assert names[states[0, 0, 0]] == old


def test_a_text_that_is_no_state_is_refused():
    with pytest.raises(UsageError):
        update_connections(np.zeros((1, 1, 1), np.uint16), ("minecraft:air", "No State"))

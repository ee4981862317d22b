"""What would not stay: the published rules case by case, laws, and builds of other people."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import complete, known_blocks, parse_state, states_of
from world2minecraft.minecraft.formats import read_blocks
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.rules.light import emitted_light
from world2minecraft.minecraft.rules.stability import find_unstable, find_unstable_cells
from world2minecraft.minecraft.turn_and_mirror import turn_volume
from world2minecraft.minecraft.visual_shapes import visual_boxes

CASES = json.loads((Path(__file__).parent / "stability_cases.json").read_text())["cases"]
STEP = {"o": (0, 0, 0), "n": (0, 0, -1), "e": (1, 0, 0), "s": (0, 0, 1), "w": (-1, 0, 0),
        "u": (0, 1, 0), "d": (0, -1, 0)}  # fmt: skip
_STATES = (
    "minecraft:air", "minecraft:stone", "torch", "wall_torch[facing=west]", "oak_fence",
    "glass_pane", "sand", "red_carpet", "lantern[hanging=true]", "oak_door[half=lower]",
    "oak_door[half=upper]", "red_bed[part=foot,facing=north]", "red_bed[part=head,facing=north]",
    "oak_button[face=wall,facing=east]", "ladder[facing=south]", "water", "oak_stairs",
    "vine[north=true]", "oak_leaves", "snow[layers=3]", "light[level=15]", "cobblestone_wall",
    "oak_slab[waterlogged=true]", "cactus", "peony[half=upper]", "bell[attachment=double_wall]",
)  # fmt: skip
PALETTE = tuple(str(complete(parse_state(text))) for text in _STATES)


def built(blocks: dict[str, str]) -> BlockVolume:
    """A volume of five blocks a side with some in and around its middle, as updates leave them."""
    palette, states = ["minecraft:air"], np.zeros((5, 5, 5), np.uint16)
    for place, text in blocks.items():
        if text not in palette:
            palette.append(text)
        states[tuple(2 + sum(np.array(STEP[letter]) for letter in place))] = palette.index(text)
    renewed, names = update_connections(states, palette)
    middle = states[2, 2, 2]
    states = renewed.copy()
    states[2, 2, 2] = middle  # The one in question keeps what it says.
    return BlockVolume(
        states, names, np.zeros((5, 5, 5), np.uint8), np.zeros((5, 5, 5), np.uint16),
        (-2, -2, -2), np.eye(4),
    )  # fmt: skip


@pytest.mark.parametrize(("what", "blocks", "expected"), CASES)
def test_the_published_rules(what, blocks, expected):
    reasons = [one.reason for one in find_unstable(built(blocks)) if one.block_pos == (0, 0, 0)]
    if not expected:
        assert reasons == []
    else:
        assert any(reason.startswith(expected) for reason in reasons), reasons


def test_an_empty_volume_and_a_plain_one_stay():
    assert find_unstable(built({})) == []
    assert find_unstable_cells(np.ones((3, 3, 3), np.uint16), ("minecraft:air", "stone")) == []


def test_what_is_told():
    (found,) = find_unstable(built({"o": "torch"}))
    assert found == ((0, 0, 0), "torch", "pops off: no support below its middle")


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000))
def test_turning_a_volume_turns_what_does_not_stay(seed):
    random = np.random.default_rng(seed)
    states = random.integers(0, len(PALETTE), (4, 4, 4)).astype(np.uint16)
    labels = np.zeros((4, 4, 4), np.uint8)
    volume = BlockVolume(states, PALETTE, labels, labels.astype(np.uint16), (0, 0, 0), np.eye(4))
    before = sorted((z, y, 3 - x, one.reason.split(":")[0].split(" to ")[0])
                    for one in find_unstable(volume) for x, y, z in [one.block_pos])  # fmt: skip
    after = sorted((*one.block_pos, one.reason.split(":")[0].split(" to ")[0])
                   for one in find_unstable(turn_volume(volume, 1)))  # fmt: skip
    assert before == after


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 10_000))
def test_what_is_connected_changes_no_more(seed):
    random = np.random.default_rng(seed)
    states = random.integers(0, len(PALETTE), (4, 4, 4)).astype(np.uint16)
    reasons = [reason for _, _, reason in find_unstable_cells(*update_connections(states, PALETTE))]
    assert not [reason for reason in reasons if reason.startswith("changes to")]


def test_every_state_of_the_game_can_be_asked():
    names = [str(state) for name in known_blocks() for state in states_of(name)[:2]]
    states = np.zeros((len(names), 3, 1), np.uint16)
    states[:, 1, 0] = np.arange(1, len(names) + 1)
    assert find_unstable_cells(states, ("minecraft:air", *names))


def test_builds_saved_by_the_game_keep_their_connections(shared_data):
    """People built these in the game, so every connection in them is the game's own."""
    found = [
        path for end in ("litematic", "nbt", "schem") for path in shared_data.rglob(f"*.{end}")
    ]
    assert found
    for path in sorted(found):
        volume = read_blocks(path)
        changes = [one for one in find_unstable(volume) if one.reason.startswith("changes to")]
        assert not changes, (path.name, changes[:3])


WORDS = st.sampled_from(["x", "north", "up", "top", "99999999999", "true", "1e9", "left", "0", "7"])


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(known_blocks()), st.lists(WORDS, min_size=8, max_size=8))
def test_strange_values_of_properties_are_asked_as_well(name, words):
    """Files of others may say anything: an answer or a typed error, and nothing else."""
    keys = [key for key, _ in states_of(name)[0].properties]
    try:
        state = f"{name}[{','.join(f'{k}={w}' for k, w in zip(keys, words, strict=False))}]"
        palette = ("minecraft:air", state, "minecraft:stone")
        states = np.array([[[1, 2], [1, 0]], [[2, 1], [0, 1]]], np.uint16)
        find_unstable_cells(*update_connections(states, palette))
        visual_boxes(state)
        emitted_light(state)
    except UsageError:
        pass

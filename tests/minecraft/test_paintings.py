"""Paintings: where they hang, which cells they cover, and what is drawn of them."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.minecraft.entity_conversion import convert_entity
from world2minecraft.minecraft.painting_placement import (
    HUNG,
    INVISIBLE,
    hang_paintings,
    painting_state,
)
from world2minecraft.minecraft.paintings import SIDES, VARIANTS
from world2minecraft.minecraft.turn_and_mirror import turn_volume

CORNER = (-7, 60, 12)
OUT = {"south": (0, 0, 1), "west": (-1, 0, 0), "north": (0, 0, -1), "east": (1, 0, 0)}


def _volume(facing, width, height, gap=0, *, walled=True, stated=None):
    """A picture of width x height cells, ``gap`` blocks off a wall, in a box of 9 x 8 x 9 cells."""
    palette = ("minecraft:air", "minecraft:stone", painting_state(stated or facing, "landscape"))
    states = np.zeros((9, 8, 9), np.uint16)
    out = np.array(OUT[facing])
    along = np.abs(out[[2, 1, 0]])
    wall = np.array([4, 0, 4]) - 2 * out
    for u in range(9 if walled else 0):
        for v in range(8):
            states[tuple(np.where(out != 0, wall, np.array([u, v, u])))] = 1
    low = np.array([4, 2, 4]) - (1 - gap) * out - 2 * along
    cells = [low + u * along + (0, v, 0) for u in range(width) for v in range(height)]
    states[tuple(np.array(cells).T)] = 2
    own = states == 2
    return BlockVolume(
        states, palette, (own * 11).astype(np.uint8), (own * 5).astype(np.uint16), CORNER, np.eye(4)
    )


def _covered(volume):
    """The cells that the drawn paintings reach, and the boxes of their canvases in the volume."""
    cells, boxes = set(), []
    for cube in display_cubes(volume.entities):
        ends = np.array([[0, 0, 0, 1], [1, 1, 1, 1]]) @ cube.cube_to_world.T
        box = np.sort(ends[:, :3], axis=0) - CORNER
        boxes.append(box)
        first, last = np.floor(box[0] + 1e-6).astype(int), np.ceil(box[1] - 1e-6).astype(int)
        cells |= set(map(tuple, (np.argwhere(np.ones(last - first)) + first).tolist()))
    return cells, boxes


sides = st.sampled_from(SIDES)
lengths = st.integers(1, 5)


@given(sides, lengths, lengths, st.integers(0, 1), st.booleans())
def test_one_painting_hangs_flat_on_the_wall(facing, width, height, gap, reversed_front):
    stated = SIDES[(SIDES.index(facing) + 2) % 4] if reversed_front else facing
    hung = hang_paintings(_volume(facing, width, height, gap, stated=stated))
    ((entity,), (cells, (box,))) = hung.entities, _covered(hung)
    out = np.array(OUT[facing])
    assert hung.palette == ("minecraft:air", INVISIBLE, "minecraft:stone")
    labelled = set(map(tuple, np.argwhere(hung.instance == 5).tolist()))
    assert cells <= labelled and len(labelled) == width * height
    assert {hung.palette[hung.states[cell]] for cell in labelled} == {INVISIBLE}
    assert all(hung.palette[hung.states[tuple(cell - out)]] == "minecraft:stone" for cell in cells)
    axis = int(np.flatnonzero(out)[0])
    back = box[0 if out[axis] > 0 else 1, axis]
    assert back == pytest.approx(round(back)) and np.ptp(box[:, axis]) == pytest.approx(1 / 16)
    assert (entity.class_id, entity.instance) == (11, 5)


@given(sides, lengths, lengths)
def test_no_larger_painting_would_fit(facing, width, height):
    cells, _ = _covered(hang_paintings(_volume(facing, width, height)))
    sizes = [VARIANTS[name][:2] for name in HUNG]
    assert len(cells) == max(w * h for w, h in sizes if w <= width and h <= height)


@given(sides, st.sampled_from([(1, 1), (2, 1), (1, 2), (2, 2), (4, 4)]))
def test_the_named_block_is_where_the_game_expects_it(facing, size):
    """The game puts the middle of a side of even length half a block beyond the named block."""
    (entity,) = hang_paintings(_volume(facing, *size)).entities
    width, height = VARIANTS[entity.nbt["variant"].removeprefix("minecraft:")][:2]
    named = np.array([entity.nbt[key] for key in ("TileX", "TileY", "TileZ")])
    out = np.array(OUT[facing])
    counted = np.array([out[2], 0, -out[0]])  # Counter-clockwise from the side it faces.
    middle = named + 0.5 - (0.5 - 1 / 32) * out
    middle = middle + (width % 2 == 0) * counted / 2 + (0, (height % 2 == 0) / 2, 0)
    np.testing.assert_allclose(entity.position, middle)


@given(sides, lengths, lengths, st.integers(1, 3))
def test_a_turned_volume_has_its_painting_turned(facing, width, height, turns):
    hung = hang_paintings(_volume(facing, width, height))
    turned = turn_volume(hung, turns)
    cells, _ = _covered(replace(turned, corner=CORNER))
    own = np.zeros(hung.states.shape, bool)
    own[tuple(np.array(sorted(_covered(hung)[0])).T)] = True
    # Counter-clockwise from above carries east to north, which is -z: from axis 2 to axis 0.
    expected = np.argwhere(np.rot90(own, turns, axes=(2, 0))) + turned.corner - CORNER
    assert cells == set(map(tuple, expected.tolist()))


def test_a_picture_without_a_wall_is_of_panels():
    hung = hang_paintings(_volume("east", 2, 2, walled=False))
    assert not hung.entities
    (state,) = {hung.palette[number] for number in hung.states[hung.instance == 5]}
    assert state.startswith("minecraft:spruce_trapdoor[facing=east") and "open=true" in state


def test_a_volume_without_pictures_stays_what_it_is():
    volume = _volume("east", 1, 1)
    plain = replace(volume, palette=(*volume.palette[:2], "minecraft:dirt"))
    assert hang_paintings(plain) is plain


def test_the_block_it_hangs_on_has_the_key_of_the_game():
    (entity,) = hang_paintings(_volume("west", 2, 2)).entities
    newer = convert_entity(entity, 4325)
    named = [entity.nbt[key] for key in ("TileX", "TileY", "TileZ")]
    assert newer.nbt["block_pos"].tolist() == named and "TileX" not in newer.nbt
    assert convert_entity(newer, 3465).nbt == entity.nbt


@pytest.mark.parametrize("nbt", [{}, {"variant": "kebab"}, {"variant": "x", "facing": 1},
                                 {"variant": "kebab", "facing": "east"}])  # fmt: skip
def test_a_painting_that_no_game_knows_is_not_drawn(nbt):
    (entity,) = hang_paintings(_volume("west", 2, 2)).entities
    assert not display_cubes([replace(entity, nbt=nbt)])

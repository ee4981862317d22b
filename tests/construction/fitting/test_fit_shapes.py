"""Masks and shapes: what the game draws, in room axes, turned and mirrored."""

import numpy as np
import pytest

from world2minecraft.construction.fitting.shapes import (
    CALM,
    PROBES,
    SUB,
    Shape,
    contact_faces,
    probe_state,
    shape_set,
    subcell_mask,
)
from world2minecraft.minecraft.block_states import check_state, complete, parse_state
from world2minecraft.minecraft.visual_shapes import visual_boxes

ALL = shape_set(CALM | {"carpet", "post"})
SAMPLES = [shape.sample for shape in ALL.shapes]


def slow_solid(state: str) -> np.ndarray:
    """Every probe asked whether a box holds its middle; block axes carried to room axes by hand."""
    solid = np.zeros((PROBES,) * 3, bool)
    for i, j, k in np.ndindex(4, 4, 4):
        at = np.array([i, j, k]) * (PROBES // 4) + 3
        x, y, z = (at + 0.5) / PROBES
        point = np.array([x, z, 1 - y])
        inside = [(box[:3] < point) & (point < box[3:]) for box in visual_boxes(state)]
        solid[tuple(at)] = any(bool(one.all()) for one in inside)
    return solid[3 :: PROBES // 4, 3 :: PROBES // 4, 3 :: PROBES // 4]


@pytest.mark.parametrize("state", SAMPLES)
def test_masks_are_the_boxes_in_room_axes(state):
    step = PROBES // 4
    assert np.array_equal(probe_state(state)[3::step, 3::step, 3::step], slow_solid(state))
    assert subcell_mask(state).mean() == pytest.approx(probe_state(state).mean())


def test_stairs_that_face_east_are_high_in_the_east():
    mask = subcell_mask("minecraft:oak_stairs[facing=east,half=bottom,shape=straight]")
    assert mask[SUB // 2 :].mean() == 1
    assert mask[: SUB // 2, :, SUB // 2 :].mean() == 0


def test_faces_are_what_a_state_touches():
    faces = contact_faces("minecraft:oak_slab[type=top]")
    assert faces[2, 1].all()
    assert not faces[2, 0].any()
    assert not faces[0, 0, :, : SUB // 2].any()


def test_the_calm_set_has_seventeen_shapes_and_the_empty_one():
    calm = shape_set(CALM)
    assert calm.free == 18
    assert len({mask.tobytes() for mask in calm.masks[: calm.free]}) == 18


@pytest.mark.parametrize("turns", range(4))
def test_turning_a_shape_turns_its_mask(turns):
    masks = ALL.masks.reshape(-1, SUB, SUB, SUB)
    for number in range(len(ALL)):
        turned = np.rot90(masks[number], turns, axes=(0, 1))
        assert np.allclose(masks[ALL.turns[turns][number]], turned)


@pytest.mark.parametrize("axis", [0, 1])
def test_mirroring_a_shape_mirrors_its_mask(axis):
    masks = ALL.masks.reshape(-1, SUB, SUB, SUB)
    for number in range(len(ALL)):
        assert np.allclose(masks[ALL.mirrors[axis][number]], np.flip(masks[number], axis))
    assert np.array_equal(ALL.mirrors[axis][ALL.mirrors[axis]], np.arange(len(ALL)))


@pytest.mark.parametrize("state", SAMPLES)
def test_samples_state_every_property_that_the_game_knows(state):
    parsed = check_state(parse_state(state))
    assert complete(parsed) == parsed


def test_a_shape_goes_to_any_block_of_its_kind():
    shape = Shape("trapdoor", (("facing", "west"), ("half", "bottom"), ("open", "true")))
    state = shape.of("minecraft:spruce_trapdoor")
    assert check_state(parse_state(state)).get("facing") == "west"


def test_an_unknown_kind_is_refused():
    with pytest.raises(KeyError, match="jelly"):
        shape_set(frozenset(("jelly",)))

"""Light after edits: always that of a whole new flood."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.rendering.light_worlds import PALETTE, random_world

from world2minecraft.rendering.light import edit_light, light_field


def assert_fresh(field, states, palette=PALETTE):
    fresh = light_field(states, palette, field.reach)
    assert np.array_equal(field.kinds, fresh.kinds)
    assert np.array_equal(field.sky, fresh.sky)
    assert np.array_equal(field.block, fresh.block)
    assert np.array_equal(field.lattice, fresh.lattice)


def random_box(rng, shape):
    low = np.array([rng.integers(n) for n in shape])
    size = np.minimum(rng.integers(1, 4, 3), np.array(shape) - low)
    return tuple(low.tolist()), tuple(size.tolist())


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 100_000), st.sampled_from([1.0, 1.4, 3.0]))
def test_edits_give_the_light_of_a_whole_new_flood(seed, reach):
    rng = np.random.default_rng(seed)
    states = random_world(seed, 12)
    field = light_field(states, PALETTE, reach)
    for _ in range(4):
        corner, size = random_box(rng, states.shape)
        values = rng.integers(0, len(PALETTE), size).astype(np.uint16)
        values[rng.random(size) < 0.4] = rng.integers(2)
        box = tuple(slice(c, c + n) for c, n in zip(corner, size, strict=True))
        states[box] = values
        edit_light(field, corner, values)
        assert_fresh(field, states)


def test_a_roof_is_taken_off_and_put_back():
    states = np.zeros((12, 9, 12), np.uint16)
    states[:, 0], states[:, 8] = 1, 1
    states[0], states[-1], states[:, :, 0], states[:, :, -1] = 1, 1, 1, 1
    states[4, 2, 0] = PALETTE.index("minecraft:glass")
    field = light_field(states, PALETTE)
    roof = states[:, 8:9].copy()
    for values in (np.zeros_like(roof), roof):
        states[:, 8:9] = values
        edit_light(field, (0, 8, 0), values)
        assert_fresh(field, states)


def test_a_lamp_is_lit_where_it_was_lighter_than_dark_already():
    states = np.zeros((30, 3, 3), np.uint16)
    states[:, 2] = 1
    states[0, 1, 1] = PALETTE.index("minecraft:lantern")
    field = light_field(states, PALETTE)
    lamp = np.full((1, 1, 1), PALETTE.index("minecraft:lantern"), np.uint16)
    states[20, 1, 1] = lamp[0, 0, 0]
    edit_light(field, (20, 1, 1), lamp)
    assert_fresh(field, states)


def test_the_lattice_stays_the_same_array():
    states = random_world(1)
    field = light_field(states, PALETTE)
    lattice = field.lattice
    edit_light(field, (0, 0, 0), np.ones((1, 1, 1), np.uint16))
    assert field.lattice is lattice


def test_an_edit_may_bring_new_states():
    states = np.zeros((3, 3, 3), np.uint16)
    field = light_field(states, PALETTE)
    longer = (*PALETTE, "minecraft:sea_lantern")
    states[1, 1, 1] = len(PALETTE)
    edit_light(field, (1, 1, 1), states[1:2, 1:2, 1:2], longer)
    assert field.block_light[1, 1, 1] == 15
    assert_fresh(field, states, longer)
    with pytest.raises(ValueError, match="^the new palette must have 11 to 65,535 states$"):
        edit_light(field, (0, 0, 0), states[:1, :1, :1], PALETTE)


def test_a_box_outside_the_volume_is_refused():
    field = light_field(np.zeros((3, 3, 3), np.uint16), PALETTE)
    with pytest.raises(
        ValueError, match=r"^the box at \(2, 0, 0\) with size \(2, 1, 1\) is not within the"
    ):
        edit_light(field, (2, 0, 0), np.zeros((2, 1, 1), np.uint16))
    edit_light(field, (0, 0, 0), np.zeros((0, 1, 1), np.uint16))

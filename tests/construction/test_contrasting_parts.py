import numpy as np
import pytest
from build_samples import WALL, WHITE, Sketch

from world2minecraft.construction import build_volume
from world2minecraft.construction.shell import PICTURE, RUG, find_contrasting_parts
from world2minecraft.core.coordinates import apply
from world2minecraft.geometry.colour import linear_to_oklab, srgb_to_linear, srgb_to_oklab
from world2minecraft.minecraft.block_colours import colour_of

PURPLE, BLUE = (92, 86, 116), (60, 90, 140)


def hue_of(state):
    return srgb_to_oklab(np.array(colour_of(state), np.uint8))[1:]


def state_at(volume, *point_m):
    """The state of the block at a point of the room."""
    place = apply(np.linalg.inv(volume.block_to_room), np.array(point_m)) - volume.corner
    return volume.palette[volume.states[tuple(np.floor(place).astype(int))]]


def lit(rgb, shares):
    """Colours float32 [N, 3] of one paint under different light."""
    linear = srgb_to_linear(np.array(rgb, np.uint8))
    return linear_to_oklab(np.outer(shares, linear))


def test_a_rug_stays_and_is_of_its_hue():
    sketch = Sketch((50, 25, 30))
    sketch.colour[sketch.at((13, 38), (5, 20), (-1, 0))] = PURPLE
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m)
    points = np.random.default_rng(1).uniform((1.3, 0.6), (2.7, 1.4), (20, 2))
    rug = {state_at(volume, x, y, -0.1) for x, y in points}
    floor = {state_at(volume, 3.3 + x / 5, y, -0.1) for x, y in points}
    assert len(rug) == len(floor) == 1 and rug != floor
    assert hue_of(next(iter(rug)))[1] < -0.02  # blue to purple


@pytest.mark.parametrize("rgb", [WHITE, (206, 216, 206), (234, 220, 200), (150, 90, 80)])
def test_a_wall_shaded_towards_its_corners_stays_one_block(rgb):
    sketch = Sketch((50, 25, 30))
    wall = sketch.labels == WALL
    places = np.argwhere(wall)
    towards = np.abs(places[:, 0] - 26) / 28 + np.abs(places[:, 1] - 14) / 16
    share = 1 - 0.28 * np.clip(towards, 0, 1.5)
    noise = np.random.default_rng(3).normal(0, 3, (len(places), 3))
    sketch.colour[wall] = np.clip(np.array(rgb) * share[:, None] + noise, 1, 255)
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m)
    level = 66 - volume.corner[1]
    wall = volume.semantic == WALL
    names = {volume.palette[n] for n in np.unique(volume.states[:, level][wall[:, level]])}
    assert len(names) == 1


def test_a_picture_on_a_plain_wall_is_a_patch_and_no_more():
    mask = np.ones((1, 16, 10), bool)
    shares = np.linspace(1, 0.7, 16)[:, None] * np.ones(10)
    colours = lit(WHITE, shares.ravel()).reshape(16, 10, 3)
    picture = np.zeros((16, 10), bool)
    picture[5:8, 4:7] = True
    colours[picture] = srgb_to_oklab(np.array(BLUE, np.uint8))
    parts = find_contrasting_parts(mask, colours.reshape(-1, 3), 0.25, PICTURE)
    assert np.array_equal(parts.reshape(16, 10) > 0, picture)


def test_shade_on_a_floor_is_no_rug():
    mask = np.ones((16, 20, 1), bool)
    shares = np.ones((16, 20))
    shares[4:12, 5:14] = 0.4
    colours = lit((186, 142, 92), shares.ravel())
    assert not find_contrasting_parts(mask, colours, 0.25, RUG).any()
    shaded = colours.reshape(16, 20, 3)
    shaded[4:12, 5:14] = lit(PURPLE, [0.4])
    assert (find_contrasting_parts(mask, shaded.reshape(-1, 3), 0.25, RUG) > 0).sum() == 72


@pytest.mark.parametrize("rug", [(225, 190, 80), (205, 185, 150), (215, 190, 140)])
def test_light_rug_on_wood_is_found_but_sunlight_is_not(rug):
    mask = np.ones((20, 20, 1), bool)
    noise = np.random.default_rng(5).normal(1, 0.03, 400)
    colours = lit((162, 131, 79), noise).reshape(20, 20, 3)
    sunny = colours.copy()
    sunny[5:14, 6:15] = lit((162, 131, 79), [1.7])
    assert not find_contrasting_parts(mask, sunny.reshape(-1, 3), 0.25, RUG).any()
    colours[5:14, 6:15] = srgb_to_oklab(np.array(rug, np.uint8))
    parts = find_contrasting_parts(mask, colours.reshape(-1, 3), 0.25, RUG).reshape(20, 20)
    found = np.zeros((20, 20), bool)
    found[5:14, 6:15] = True
    assert np.array_equal(parts > 0, found)


@pytest.mark.parametrize("shape", [(0, 0, 0), (1, 1, 1), (1, 1, 30), (3, 1, 3), (4, 4, 4)])
def test_what_is_no_flat_surface_has_no_parts(shape):
    mask = np.ones(shape, bool)
    colours = np.random.default_rng(0).random((mask.sum(), 3))
    assert find_contrasting_parts(mask, colours, 0.25, PICTURE).shape == (mask.sum(),)
    assert not find_contrasting_parts(mask, colours, 0.25, PICTURE).any()

"""Views of a whole room: what is left out, what is shown, which way is up."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import volume_of

from world2minecraft.rendering import plan_view, preview
from world2minecraft.rendering.cutaway import (
    ceiling_level,
    without_ceiling,
    without_near_walls,
    without_partitions,
)


def furnished(blocks_per_metre=4.0):
    """A room of white walls, a red floor block in its (+x, +y) corner, a plank chest."""
    states = np.zeros((20, 12, 16), np.int64)
    semantic = np.zeros(states.shape, np.uint8)
    for cells in (np.s_[0], np.s_[-1], np.s_[:, :, 0], np.s_[:, :, -1]):
        states[cells], semantic[cells] = 1, 3
    states[:, 0], semantic[:, 0] = 1, 2
    states[:, -1], semantic[:, -1] = 1, 1
    states[15:19, 0, 1:5] = 6  # Block -z is room +y: the far right corner of the plan.
    states[2:6, 1:4, 1:3], semantic[2:6, 1:4, 1:3] = 2, 10
    return volume_of(states, semantic, blocks_per_metre)


def redness(image):
    image = image.astype(int)
    return (image[..., 0] > image[..., 1] + 50) & (image[..., 0] > image[..., 2] + 50)


def test_the_ceiling_and_what_is_above_it_go():
    volume = furnished()
    assert ceiling_level(volume.semantic) == 11
    opened = without_ceiling(volume)
    assert not (opened.states[:, 11:] > 0).any()
    assert np.array_equal(opened.states[:, :11], volume.states[:, :11])


def test_a_room_without_a_ceiling_stays_as_it_is():
    opened = without_ceiling(furnished())
    assert np.array_equal(without_ceiling(opened).states, opened.states)


@pytest.mark.parametrize("near_x", [-1, 1])
@pytest.mark.parametrize("near_z", [-1, 1])
def test_near_walls_are_cut_to_a_rim_and_nothing_else(near_x, near_z):
    opened = without_ceiling(furnished())
    cut = without_near_walls(opened, near_x, near_z)
    wall_x, wall_z = (-1 if near_x > 0 else 0), (-1 if near_z > 0 else 0)
    assert not cut.states[wall_x, 3:].any()
    assert not cut.states[:, 3:, wall_z].any()
    assert cut.states[wall_x, 1].all()
    far_x = 0 if near_x > 0 else -1
    inner = slice(1, -1)
    assert cut.states[far_x, 1:11, inner].all()
    assert np.array_equal(cut.states[1:-1, :, 1:-1], opened.states[1:-1, :, 1:-1])


@pytest.mark.parametrize("joined", [False, True])
def test_floor_seen_past_a_near_wall_is_no_room(joined):
    opened = without_ceiling(furnished(12.5))
    beside = ((0, 3), (0, 0), (0, 0))
    states, semantic = np.pad(opened.states, beside), np.pad(opened.semantic, beside)
    states[20:23, 0, 6:9], semantic[20:23, 0, 6:9] = 1, 2  # Beyond the wall at the end of x.
    if joined:  # By a door.
        states[19, 1:10, 6:9], semantic[19, 1:10, 6:9] = 0, 0
    wider = volume_of(states, semantic, 12.5)
    cut = without_near_walls(wider, 1, 1)
    assert not cut.states[19:, 5:].any()
    assert cut.states[0, 5:11, 1:-1].all()


def test_a_far_wall_stays_behind_what_hid_the_floor():
    opened = without_ceiling(furnished(12.5))
    states, semantic = opened.states.copy(), opened.semantic.copy()
    states[1:7, 0, 1:15], semantic[1:7, 0, 1:15] = 0, 0  # Under a counter along the start of x,
    states[1:7, 1:8, 1:15], semantic[1:7, 1:8, 1:15] = 2, 10
    states[1:4, 8:10, 1:15], semantic[1:4, 8:10, 1:15] = 2, 10  # and a cupboard above.
    for near_z in (-1, 1):
        far = without_near_walls(without_partitions(volume_of(states, semantic, 12.5)), 1, near_z)
        assert far.states[0, 1:10, 1:15].all() and far.states[1:4, 8:10, 1:15].all()
        near = without_near_walls(volume_of(states, semantic, 12.5), -1, near_z)
        assert not near.states[0, 5:].any() and near.states[1:7, 1:8, 1:15].all()


@pytest.mark.parametrize(("width", "cut"), [(2, False), (5, True)])
def test_floor_seen_behind_an_outer_wall_does_not_cut_it(width, cut):
    states, semantic = np.zeros((2, 20, 11, 16), np.uint8)
    semantic[: 13 + width, 0] = 2
    semantic[12, 1:, :] = 3
    states[semantic > 0] = 1
    opened = without_partitions(volume_of(states, semantic, 4.0))
    assert opened.states[12, 8:, 4:12].any() != cut


def test_the_plan_has_room_x_to_the_right_and_room_y_up():
    image = plan_view(furnished(), 6)
    assert image.shape == (16 * 6, 20 * 6, 3)
    red = np.argwhere(redness(image))
    assert len(red) > 300
    v, u = red.mean(axis=0)
    assert u > 0.7 * image.shape[1]
    assert v < 0.3 * image.shape[0]


def test_a_preview_shows_floor_furniture_and_a_margin():
    image = preview(furnished(), 240, 180)
    assert image.shape == (180, 240, 3)
    assert redness(image).sum() > 100
    border = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]]).astype(int)
    assert (np.ptp(border, axis=1) <= 3).all()
    assert border.min() > 200
    assert (image.astype(int).max(axis=2) - image.astype(int).min(axis=2) > 30).sum() > 300
    assert np.array_equal(image, preview(furnished(), 240, 180))


@pytest.mark.parametrize("turns", range(4))
def test_the_only_wall_is_not_cut_to_show_more_furniture(turns):
    states = np.zeros((20, 12, 20), np.int64)
    semantic, instance = np.zeros(states.shape, np.uint8), np.zeros(states.shape, np.uint16)
    states[:, 0], semantic[:, 0] = 1, 2
    states[-1, 1:11], semantic[-1, 1:11] = 6, 3  # A red wall, and a row of chests
    for number, z in enumerate(range(1, 18, 3), start=2):
        box = np.s_[6:8, 1:3, z : z + 2]
        states[box], semantic[box], instance[box] = 2, 10, number
    states[4:6, 1:9], semantic[4:6, 1:9], instance[4:6, 1:9] = 2, 10, 1  # that only it sees.
    turned = [np.rot90(one, turns, axes=(0, 2)) for one in (states, semantic, instance)]
    volume = replace(volume_of(turned[0], turned[1], 4.0), instance=turned[2])
    assert redness(preview(volume, 240, 180)).sum() > 2000


@pytest.mark.parametrize("size", [(0, 100), (30_000, 30_000)])
def test_a_preview_of_no_sensible_size_is_refused(size):
    with pytest.raises(ValueError, match="is out of range"):
        preview(furnished(), *size)


def test_a_plan_of_no_pixels_is_refused():
    with pytest.raises(ValueError, match="^px_per_block must be at least 1, got 0"):
        plan_view(furnished(), 0)


def test_an_empty_volume_still_gives_a_picture():
    volume = volume_of(np.zeros((4, 4, 4), np.int64))
    assert preview(volume, 40, 30).shape == (30, 40, 3)
    assert plan_view(volume, 3).shape == (12, 12, 3)

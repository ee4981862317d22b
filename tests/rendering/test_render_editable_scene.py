"""Edits in place: after any of them the scene draws what a new scene of the same blocks draws."""

from dataclasses import replace

import numpy as np
import pytest
from block_models_for_tests import FewLooks
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import CAMERA, PALETTE, random_pose, random_volume, volume_of

from world2minecraft.core.errors import UsageError
from world2minecraft.rendering import prepare_scene, render_volume
from world2minecraft.rendering.editable_scene import EditableScene
from world2minecraft.rendering.empty_space_boxes import find_empty_boxes, update_empty_boxes
from world2minecraft.rendering.scene_tables import BOXES, FULL

OUTPUTS = ("colour", "semantic", "instance", "opaque")
LOOKS = FewLooks({2: "glass", 4: "tall", 6: "holes"})


def assert_boxes_fit(space: np.ndarray, bounds: np.ndarray, kinds: np.ndarray) -> None:
    assert np.array_equal(space < 0, kinds != 0)
    assert np.array_equal(space[kinds != 0], kinds[kinds != 0])
    for cell in np.argwhere(kinds == 0):
        box = bounds[space[tuple(cell)]]
        assert (box[:3] <= cell).all()
        assert (cell < box[3:]).all()
    for x0, y0, z0, x1, y1, z1 in bounds[np.unique(space[space >= 0])]:
        assert not kinds[x0:x1, y0:y1, z0:z1].any()


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000))
def test_boxes_stay_air_and_hold_their_cells_through_edits(seed):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(2, 9, 3))
    kinds = np.where(rng.random(shape) < 0.2, FULL, 0).astype(np.int8)
    space, bounds = find_empty_boxes(kinds)
    for _ in range(6):
        cells = np.stack([rng.integers(0, side, 4) for side in shape], axis=1)
        new = rng.choice([FULL, BOXES, 0], 4).astype(np.int8)
        for cell, kind in zip(cells, new, strict=True):
            kinds[tuple(cell)] = kind
        bounds = update_empty_boxes(space, bounds, cells, new)
        assert_boxes_fit(space, bounds, kinds)


def test_a_table_of_boxes_that_grew_too_long_is_made_anew():
    kinds = np.zeros((24, 24, 1), np.int8)
    space, bounds = find_empty_boxes(kinds)
    cells = np.argwhere(np.indices((24, 24)).sum(axis=0) % 2 == 0)
    cells = np.pad(cells, ((0, 0), (0, 1)))
    bounds = update_empty_boxes(space, bounds, cells, np.full(len(cells), FULL, np.int8))
    kinds[tuple(cells.T)] = FULL
    assert len(bounds) == (kinds == 0).sum()
    assert_boxes_fit(space, bounds, kinds)


@pytest.mark.parametrize("seed", range(6))
def test_after_edits_the_scene_draws_what_a_new_one_draws(seed):
    rng = np.random.default_rng(seed)
    volume = random_volume(rng, share=0.15)
    live = EditableScene(volume, LOOKS)
    states = volume.states.copy()
    semantic, instance = volume.semantic.copy(), volume.instance.copy()
    for step in range(5):
        cells = np.unique(np.stack([rng.integers(0, side, 5) for side in states.shape], 1), axis=0)
        rows = rng.integers(0, len(PALETTE), len(cells))
        live.set_blocks(cells, [PALETTE[row] for row in rows], semantic=step, instance=40 + step)
        states[tuple(cells.T)] = rows
        semantic[tuple(cells.T)], instance[tuple(cells.T)] = step, 40 + step
    after = replace(volume, states=states, semantic=semantic, instance=instance)
    anew = prepare_scene(after, LOOKS)
    assert np.array_equal(live.scene.tables.light[:, 1:-1], _inner(anew, live))
    for _ in range(3):
        pose = random_pose(rng, volume)
        one = render_volume(live.scene, CAMERA, pose, outputs=OUTPUTS)
        two = render_volume(anew, CAMERA, pose, outputs=OUTPUTS)
        same = one.block_index == two.block_index
        assert same.mean() > 0.9
        for name in ("colour", "semantic", "instance", "opaque_index"):
            equal = getattr(one, name) == getattr(two, name)
            assert equal.mean() > 0.9, name


def _inner(anew, live) -> np.ndarray:
    """The light of a new scene in the grid of the live one, whose margin may differ."""
    shift = live.scene.tables.window[0] - anew.tables.window[0]
    if shift.any() or anew.tables.light.shape != live.scene.tables.light.shape:
        pytest.skip("the margins differ: what reaches out of the volume is cut in a live scene")
    return anew.tables.light[:, 1:-1]


def test_the_volume_that_was_given_never_changes():
    volume = random_volume(np.random.default_rng(3))
    before = volume.semantic.copy(), volume.instance.copy(), volume.states.copy()
    live = EditableScene(volume, LOOKS)
    live.set_blocks(np.array([[1, 1, 1]]), [PALETTE[1]], semantic=7, instance=9)
    for old, new in zip(before, (volume.semantic, volume.instance, volume.states), strict=True):
        assert np.array_equal(old, new)
    assert live.volume_states[0][1, 1, 1] == 1


def test_a_state_that_no_palette_had_is_drawn():
    states = np.zeros((7, 3, 3), np.int64)
    states[6] = 1
    live = EditableScene(volume_of(states, scale=1.0))
    live.set_blocks(np.array([[4, 1, 1]]), ["minecraft:gold_block"], semantic=11)
    assert live.volume_states[1][-1] == "minecraft:gold_block"
    pose = np.linalg.inv(live.scene.room_to_grid)
    axes = np.array([[0, 0, 1], [0, -1, 0], [1, 0, 0]], float)  # Along +x, upright.
    pose[:3, :3] = np.linalg.inv(live.scene.room_to_grid)[:3, :3] @ axes
    pose[:3, 3] = (np.linalg.inv(live.scene.room_to_grid) @ [0.5, 1.5, 1.5, 1])[:3]
    picture = render_volume(live.scene, CAMERA, pose)
    assert picture.semantic[24, 32] == 11
    assert picture.depth_m[24, 32] == pytest.approx(3.5)
    red, _, blue = (int(value) for value in picture.colour[24, 32])
    assert red > blue + 40


def test_what_reached_out_goes_with_its_block():
    states = np.zeros((5, 6, 5), np.int64)
    states[2, 0, 2] = 4
    live = EditableScene(volume_of(states, scale=1.0), LOOKS)
    assert (live.scene.tables.space < 0).sum() == 4  # Four blocks tall.
    live.set_blocks(np.array([[2, 0, 2]]), ["minecraft:air"])
    assert (live.scene.tables.space < 0).sum() == 0
    live.set_blocks(np.array([[1, 1, 1]]), [PALETTE[4]])
    assert (live.scene.tables.space < 0).sum() == 4


def test_bad_edits_are_refused():
    live = EditableScene(random_volume(np.random.default_rng(4)), LOOKS)
    with pytest.raises(UsageError, match=r"^cell \(9, 0, 0\) is outside the volume of \(9, 7, 8\)"):
        live.set_blocks(np.array([[9, 0, 0]]), [PALETTE[1]])
    with pytest.raises(UsageError, match="^1 cells need 1 states, got 2$"):
        live.set_blocks(np.array([[0, 0, 0]]), [PALETTE[1], PALETTE[1]])

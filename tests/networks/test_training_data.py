"""Caches, splits, mixes, batches: which frames a run sees, and when."""

import pickle

import numpy as np
import pytest
import torch
from tests.networks.toy_sets import toy_config, toy_set, write_toy_store

from world2minecraft.core.errors import UsageError
from world2minecraft.networks.config import GRIDS, DataSource
from world2minecraft.networks.data.batches import (
    TrainingSet,
    ordered_loader,
    plan_draws,
    training_loader,
)
from world2minecraft.networks.data.cache import StreamedFrames, cache_bytes, open_cached_frames
from world2minecraft.networks.data.class_weights import class_counts, class_weights
from world2minecraft.networks.data.frames import FrameRule
from world2minecraft.networks.data.splits import split_rows, take_evenly
from world2minecraft.networks.data.training_data import CacheLocation, open_run_data

RULE = FrameRule(GRIDS["0.16"], 40, 30)
ARRAYS = (
    "image",
    "intrinsics",
    "camera_to_grid",
    "grid_to_room",
    "labels",
    "in_frustum",
    "seen",
    "free",
)


def placed(folder):
    """A set's own folder, which caches beside it do not change."""
    (folder / "set").mkdir(exist_ok=True)
    return folder / "set"


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return write_toy_store(tmp_path_factory.mktemp("sets") / "toy")


def test_cached_frames_are_the_frames(tmp_path):
    source = toy_set(placed(tmp_path), 4)
    cached, made = open_cached_frames(source, RULE, tmp_path / "c"), StreamedFrames(source, RULE)
    assert cached.keys == made.keys and cached.scenes == made.scenes
    for row in range(4):
        one, other = cached[row], made[row]
        for name in ARRAYS:
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
        np.testing.assert_allclose(one.depth_m, other.depth_m, atol=6e-4)
        assert one.has_depth == other.has_depth
    stored = sum(file.stat().st_size - 128 for file in (tmp_path / "c").rglob("*.npy"))
    assert stored == cache_bytes(4, RULE)


def test_a_filled_cache_reads_no_sample_and_depends_on_size(tmp_path):
    source, told = toy_set(placed(tmp_path), 3), []
    open_cached_frames(source, RULE, tmp_path / "c", lambda *step: told.append(step))
    assert told[-1][:3] == ("frames", 3, 3)
    silent = toy_set(placed(tmp_path), 3)
    object.__setattr__(silent, "read", lambda key: pytest.fail("it was read again"))
    assert len(open_cached_frames(silent, RULE, tmp_path / "c")) == 3
    open_cached_frames(source, FrameRule(GRIDS["0.16"], 20, 16), tmp_path / "c")
    assert len([one for one in (tmp_path / "c").iterdir() if one.is_dir()]) == 2


def test_an_interrupted_cache_is_refilled(tmp_path):
    source = toy_set(placed(tmp_path), 3)

    def stop(stage, done, total, note=""):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        open_cached_frames(source, RULE, tmp_path / "c", stop)
    assert open_cached_frames(source, RULE, tmp_path / "c")[2].image.any()


def test_scenes_are_in_one_part_alone_and_the_test_split_is_kept():
    scenes = [f"s{n % 7}" for n in range(40)]
    splits = ["test" if name == "s6" else "train" for name in scenes]
    split = split_rows(scenes, splits, 0.3, "set")
    parts = [{scenes[row] for row in rows} for rows in split]
    assert parts[2] == {"s6"} and len(parts[1]) == 2 and not parts[0] & parts[1]
    assert sorted([*split.train, *split.val, *split.test]) == list(range(40))
    assert split == split_rows(scenes, splits, 0.3, "set")
    assert split.scored == split.test


def test_a_split_that_cannot_be_says_why():
    assert split_rows(["a", "b"], ["train", "test"], 0, "set").val == [1]
    with pytest.raises(UsageError, match="reserve scenes for validation .--val-share"):
        split_rows(["a", "b"], ["", ""], 0, "set")
    with pytest.raises(UsageError, match="only 1 training scene, so none can be used"):
        split_rows(["a", "b"], ["", "test"], 0.1, "set")
    with pytest.raises(UsageError, match="has no training frames, only 1 frames in its test split"):
        split_rows(["b"], ["test"], 0.1, "set")
    assert take_evenly(list(range(10)), 3) == [0, 3, 6]


def test_each_frame_is_drawn_once_before_any_repeats():
    sizes, weights = [5, 12], [3.0, 1.0]
    draws = plan_draws(sizes, weights, 4000, 7)
    for number, size in enumerate(sizes):
        rows = draws.row[draws.source == number]
        for first in range(0, len(rows) - size, size):
            assert sorted(rows[first : first + size].tolist()) == list(range(size))
    share = np.mean(draws.source == 0)
    assert share == pytest.approx(0.75, abs=0.03)
    assert np.array_equal(draws.row, plan_draws(sizes, weights, 4000, 7).row)
    assert not np.array_equal(draws.row, plan_draws(sizes, weights, 4000, 8).row)
    orders = draws.row[draws.source == 1][:24].reshape(2, 12)
    assert not np.array_equal(*orders)


def test_a_run_that_goes_on_draws_what_it_would_have_drawn(tmp_path):
    frames = StreamedFrames(toy_set(placed(tmp_path), 6), RULE)
    config = toy_config(tmp_path)
    draws = plan_draws([6], [1.0], config.steps * config.batch, config.seed)
    parts = [TrainingSet(frames, list(range(6)))]
    whole = list(training_loader(parts, draws, config))
    rest = list(training_loader(parts, draws, config, 4))
    assert len(whole) == config.steps and len(rest) == 2
    for one, other in zip(whole[4:], rest, strict=True):
        assert torch.equal(one.inputs.image, other.inputs.image)
        assert torch.equal(one.target.labels, other.target.labels)


def test_a_batch_holds_what_networks_take(tmp_path):
    frames = StreamedFrames(toy_set(placed(tmp_path), 3), RULE)
    batches = list(ordered_loader(frames, [2, 0, 1], toy_config(tmp_path)))
    inputs, target, more = batches[0]
    assert not more  # Validation is of single frames.
    assert inputs.image.shape == (2, 3, 30, 40) and inputs.image.dtype == torch.float32
    assert inputs.image.min() >= 0 and inputs.image.max() <= 1
    assert inputs.grid_shape == (30, 30, 18) and inputs.voxel_m == 0.16
    assert inputs.depth_m is None  # A monocular network is taught depth, and sees none.
    assert target.depth_m is not None and target.depth_m.shape == (2, 30, 40)
    given = next(iter(ordered_loader(frames, [2], toy_config(tmp_path, depth="given"))))
    assert torch.equal(given.inputs.depth_m[0], target.depth_m[0])
    without = next(iter(ordered_loader(frames, [2], toy_config(tmp_path, depth="none"))))
    assert without.inputs.depth_m is None and without.target.depth_m is None
    assert target.labels.shape == (2, 30, 30, 18) and target.labels.dtype == torch.int64
    assert target.in_frustum.dtype == torch.bool
    assert len(batches[1].inputs.image) == 1
    np.testing.assert_array_equal(target.labels[0].numpy(), frames[2].labels)


def test_frames_are_handed_to_processes_by_their_folder(store, tmp_path):
    frames = open_run_data(toy_config(store, steps=2), CacheLocation(root=tmp_path)).target
    data = pickle.dumps(frames)
    assert len(data) < 1000
    np.testing.assert_array_equal(pickle.loads(data)[0].image, frames[0].image)


def test_worker_processes_make_the_same_batches(store, tmp_path):
    config = toy_config(store, steps=2)
    data = open_run_data(config, CacheLocation(root=tmp_path))
    draws = plan_draws([len(data.parts[0].rows)], [1.0], 4, 0)
    alone = list(training_loader(data.parts, draws, config))
    helped = list(training_loader(data.parts, draws, toy_config(store, steps=2, workers=1)))
    for one, other in zip(alone, helped, strict=True):
        assert torch.equal(one.inputs.image, other.inputs.image)


def test_the_first_set_is_the_target_and_no_test_frame_trains(store, tmp_path):
    other = write_toy_store(tmp_path / "other", count=6, scenes=3)
    config = toy_config(store)
    sources = (DataSource(str(store)), DataSource(str(other), 3.0))
    data = open_run_data(
        type(config)(**{**vars(config), "data": sources}), CacheLocation(root=tmp_path / "c")
    )
    assert len(data.target) == 8 and data.weights == (1.0, 3.0)
    first, second = data.parts
    assert (len(first.rows), len(data.split.val), len(data.split.test)) == (4, 2, 2)
    assert {second.frames.scenes[row] for row in second.rows} == {"room_0", "room_1"}
    assert data.descriptions[1].endswith("store, 4 train")
    assert data.counts[0] > data.counts[3] > 0
    assert open_run_data(config, CacheLocation.parse("off")).counts.shape == (12,)


def test_rare_classes_weigh_more_and_absent_ones_are_bounded():
    counts = class_counts([np.array([0] * 90 + [3] * 9 + [5] + [255] * 50, np.uint8)])
    assert counts[[0, 3, 5]].tolist() == [90, 9, 1]
    weights = class_weights(counts, "frequency")
    assert weights[5] > weights[3] > weights[0] > 0
    assert weights[1:].mean() == pytest.approx(1)
    assert weights.max() < 2
    assert class_weights(counts, "monoscene").tolist() == pytest.approx([0.05] + [1] * 11)
    assert class_weights(counts, "even").tolist() == [1] * 12

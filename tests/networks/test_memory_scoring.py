"""Whole scenes by a network that remembers: their truth, their cameras, their score."""

import json
from typing import Any

import numpy as np
import pytest
import torch
from tests.networks.toy_sets import toy_config, toy_set, write_toy_store

from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.formats.sscnet import downsample_labels
from world2minecraft.networks import memory_scoring as memory
from world2minecraft.networks.config import GRIDS
from world2minecraft.networks.data.cache import StreamedFrames
from world2minecraft.networks.data.frames import FrameRule
from world2minecraft.networks.data.training_data import CacheLocation
from world2minecraft.networks.memory_scoring import add_memory_scores, assemble_truth, memory_scores
from world2minecraft.networks.models import make_network
from world2minecraft.networks.scoring import MEMORY
from world2minecraft.networks.training import score_run, train_run

torch.set_num_threads(1)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return toy_set(tmp_path_factory.mktemp("toy"), 6, 2, 1)


def cells_of(sample, truth, voxel_m):
    """Where each cell of a sample's box lies in the scene, int [60, 60, 36, 3]."""
    places = (np.moveaxis(np.indices(sample.occ.labels.shape), 0, -1) + 0.5) * 0.08
    at_m = apply(sample.occ.region.region_to_room, places) - truth.origin_m
    return np.floor(at_m / voxel_m).astype(int)


def test_each_frame_agrees_with_the_truth_of_its_scene(found):
    keys = [key for key in found.splits if found[key].scene_id == "room_0"]
    truth, reason = assemble_truth(found, keys, toy_config("d", grid="0.08"))
    assert truth is not None and not reason
    seen = np.zeros(truth.labels.shape, bool)
    for key in keys:
        sample = found[key]
        at = tuple(np.moveaxis(cells_of(sample, truth, 0.08), -1, 0))
        known = sample.occ.labels != 255
        np.testing.assert_array_equal(truth.labels[at][known], sample.occ.labels[known])
        seen[tuple(axis[sample.occ.in_frustum] for axis in at)] = True
    np.testing.assert_array_equal(truth.seen, seen)
    coarse, _ = assemble_truth(found, keys, toy_config("d", grid="0.16"))
    assert coarse is not None
    x, y, z = (side // 2 * 2 for side in truth.labels.shape)
    wanted = downsample_labels(truth.labels[:x, :y, :z], 2)
    inner = tuple(slice(0, side) for side in wanted.shape)
    np.testing.assert_array_equal(coarse.labels[inner], wanted)
    np.testing.assert_array_equal(coarse.origin_m, truth.origin_m)


class KnowsAll:
    """Stands for a stream that has learned its scene, and keeps where its frames were taken."""

    truth: Any
    last: Any

    def __init__(self, network, scene_shape, box_shape, voxel_m):
        self.poses, self.shape = [], scene_shape
        KnowsAll.last = self

    def add(self, image, intrinsics, camera_to_scene, depth_m=None):
        assert image.shape == (3, 30, 40) and image.max() <= 1 and depth_m is None
        self.poses.append(camera_to_scene.numpy())

    def logits(self):
        held = np.where(KnowsAll.truth.labels == 255, 0, KnowsAll.truth.labels)
        return torch.from_numpy(np.moveaxis(np.eye(12)[held], -1, 0))


@pytest.mark.parametrize("grid", ["0.08", "0.16"])
def test_a_perfect_memory_scores_full_and_gets_the_poses(grid, found, monkeypatch):
    config = toy_config("d", grid=grid)
    keys = [key for key in found.splits if found[key].scene_id == "room_1"]
    KnowsAll.truth, _ = assemble_truth(found, keys, config)
    monkeypatch.setattr(memory, "SceneStream", KnowsAll)
    frames = StreamedFrames(found, FrameRule(GRIDS[grid], 40, 30))
    rows = [frames.keys.index(key) for key in keys]
    network: Any = make_network(
        "embodied", "tiny", grid_shape=config.cells.shape, voxel_m=config.cells.voxel_m
    )
    ((score,), reason) = memory_scores(network, found, frames, rows, config)
    assert not reason and score.counts.geometry.iou == 1
    for key, pose in zip(keys, KnowsAll.last.poses, strict=True):
        room_to_camera = invert_rigid(found[key].camera_to_room)
        place_m = np.array([2.0, 2.0, 1.0])
        seen = apply(np.linalg.inv(pose), place_m - KnowsAll.truth.origin_m)
        np.testing.assert_allclose(seen, apply(room_to_camera, place_m), atol=1e-4)


def test_a_run_is_scored_on_scenes_by_its_own_memory(tmp_path):
    store = write_toy_store(tmp_path / "toy", count=6, scenes=3)
    cache = CacheLocation(root=tmp_path / "frames")
    config = toy_config(store, network="embodied", steps=1)
    trained = train_run(config, tmp_path / "run", device="cpu", cache=cache)
    scores = score_run(trained, config, "cpu")
    found = scores["protocols"][MEMORY]
    assert found["frames"] == 1 and 0 <= found["micro"]["iou"] <= 1
    assert "fused by the network" in found["counts"]
    assert MEMORY in json.loads((tmp_path / "run" / "scores.json").read_text())["protocols"]
    other = {"protocols": {}, "left_out": {}}
    add_memory_scores(other, torch.nn.Identity(), *[None] * 4)  # type: ignore[arg-type]
    assert not other["protocols"]

"""Several frames of a scene as one sample: in one grid, mirrored together, fused by their sums."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import torch
from tests.networks.toy_sets import toy_config, toy_set, write_toy_store

from world2minecraft.core.coordinates import apply, invert_rigid, look_at, rotation_about_z
from world2minecraft.core.errors import UsageError
from world2minecraft.networks.config import GRIDS, read_config
from world2minecraft.networks.csv_logger import read_metrics
from world2minecraft.networks.data.batches import (
    DrawnDataset,
    Draws,
    FrameCollator,
    TrainingSet,
    augment_frame,
    augment_sequence,
    draw_rng,
)
from world2minecraft.networks.data.cache import StreamedFrames
from world2minecraft.networks.data.frames import FrameRule
from world2minecraft.networks.data.sequences import (
    SequenceSampler,
    move_to_grid,
    sequence_length,
    views_grid,
)
from world2minecraft.networks.data.training_data import CacheLocation
from world2minecraft.networks.models import make_network
from world2minecraft.networks.training import train_run

GRID = GRIDS["0.16"]
torch.set_num_threads(1)


@pytest.fixture(scope="module")
def frames(tmp_path_factory):
    found = toy_set(tmp_path_factory.mktemp("toy"), 9, 3, 0)
    return StreamedFrames(found, FrameRule(GRID, 40, 30))


def moved(frame, shift_m, turn_deg):
    """The frame as another box of the same room, turned and beside the first, would have it."""
    box_to_room = rotation_about_z(turn_deg)
    box_to_room[:3, 3] = shift_m
    camera_to_room = frame.grid_to_room @ frame.camera_to_grid
    return replace(
        frame,
        grid_to_room=box_to_room,
        camera_to_grid=(invert_rigid(box_to_room) @ camera_to_room).astype(np.float32),
    )


def test_a_frame_of_another_box_sees_the_same_places(frames):
    """A place of the room falls on the same pixel, whichever box the camera is told in."""
    anchor, other = frames[0], moved(frames[3], [1.1, -0.7, -0.08], 90)
    carried = move_to_grid(anchor, other)
    places_m = np.random.default_rng(0).uniform([0, 0, 0], [4, 4, 2.5], (20, 3))
    in_anchor = apply(invert_rigid(anchor.grid_to_room), places_m)
    in_other = apply(invert_rigid(other.grid_to_room), places_m)
    wanted = apply(invert_rigid(other.camera_to_grid.astype(float)), in_other)
    found = apply(invert_rigid(carried.camera_to_grid.astype(float)), in_anchor)
    np.testing.assert_allclose(found, wanted, atol=1e-5)
    np.testing.assert_array_equal(carried.image, other.image)
    assert carried.labels is anchor.labels


def test_frames_of_a_sample_are_mirrored_together(frames):
    pair = [frames[0], move_to_grid(frames[0], frames[3])]
    over = augment_sequence(pair, GRID.voxel_m, 1.0, 0.0, np.random.default_rng(0))
    width_m = GRID.shape[0] * GRID.voxel_m
    places_m = np.random.default_rng(1).uniform(0, 2.8, (20, 3))
    mirrored_m = places_m * [-1, 1, 1] + [width_m, 0, 0]
    for before, after in zip(pair, over, strict=True):
        seen = apply(np.linalg.inv(before.camera_to_grid.astype(float)), places_m)
        again = apply(np.linalg.inv(after.camera_to_grid.astype(float)), mirrored_m)
        np.testing.assert_allclose(again, seen * [-1, 1, 1], atol=1e-5)
        np.testing.assert_array_equal(after.image, before.image[:, ::-1])
    one = augment_frame(pair[0], GRID.voxel_m, 0.5, 0.4, np.random.default_rng(4))
    same = augment_sequence(pair, GRID.voxel_m, 0.5, 0.4, np.random.default_rng(4))[0]
    np.testing.assert_array_equal(one.image, same.image)


def test_frames_that_view_the_grid_come_first(frames):
    rows = [row for row, scene in enumerate(frames.scenes) if scene == "room_0"]
    away = look_at(np.array([2.0, -9.0, 1.4]), np.array([2.0, -12.0, 1.4]))

    class Held:
        scenes = frames.scenes

        def __getitem__(self, row):
            frame = frames[row]
            if row != rows[1]:
                return frame
            return replace(frame, camera_to_grid=away.astype(np.float32))

    anchor = frames[rows[0]]
    assert views_grid(anchor, GRID.voxel_m)
    found = SequenceSampler(Held(), rows, GRID.voxel_m)  # type: ignore[arg-type]
    for seed in range(5):
        both = found.sample(rows[0], anchor, 2, np.random.default_rng(seed))
        assert [one.key for one in both] == [frames.keys[rows[2]], frames.keys[rows[1]]]
    alone = SequenceSampler(Held(), rows[:1], GRID.voxel_m)  # type: ignore[arg-type]
    again = alone.sample(rows[0], anchor, 2, np.random.default_rng(0))
    assert [one.key for one in again] == [anchor.key] * 2


def test_samples_are_drawn_alike_and_only_of_what_trains(frames):
    config = toy_config("d", network="embodied", batch=2, seed=3)
    assert config.fused == 3 and replace(config, network="iso").fused == 1
    assert replace(config, frames=1).fused == 1
    rows = [row for row, scene in enumerate(frames.scenes) if scene != "room_2"]
    draws = Draws(np.zeros(8, np.int32), np.arange(8) % len(rows))
    drawn = DrawnDataset([TrainingSet(frames, rows)], draws, config)
    samples = [drawn[n] for n in range(8)]
    counts = [len(one) for one in samples]
    assert counts == [sequence_length(3, n // 2, 3) for n in range(8)] and max(counts) > 1
    assert {sequence_length(0, step, 3) for step in range(20)} == {1, 2, 3}
    for sample in samples:
        assert len({one.scene_id for one in sample}) == 1
        assert sample[0].scene_id != "room_2"
        for other in sample[1:]:
            np.testing.assert_array_equal(other.grid_to_room, sample[0].grid_to_room)
    # A stopped run goes on with the same samples; of one frame they are what they always were.
    later = DrawnDataset([TrainingSet(frames, rows)], draws, config, 4)
    np.testing.assert_array_equal(later[1][-1].image, samples[5][-1].image)
    single = DrawnDataset([TrainingSet(frames, rows)], draws, replace(config, frames=1))
    wanted = augment_frame(frames[rows[5]], GRID.voxel_m, 0.5, 0.4, draw_rng(3, 5))
    assert len(single[5]) == 1
    np.testing.assert_array_equal(single[5][0].image, wanted.image)


def test_a_sample_is_the_sum_of_what_its_frames_say(frames):
    anchor = frames[0]
    sample = [anchor, move_to_grid(anchor, frames[3]), move_to_grid(anchor, frames[6])]
    batch = FrameCollator(GRID, "taught")([sample])
    assert len(batch.more) == 2 and batch.more[0].image.shape == batch.inputs.image.shape
    network: Any = make_network("embodied", "tiny", grid_shape=GRID.shape, voxel_m=GRID.voxel_m)
    network.eval()
    with torch.no_grad():
        said = network(batch.inputs, batch.more).logits
        turned = network(batch.inputs, batch.more[::-1]).logits
        alone = network(batch.inputs).logits
        looks = [network.observe(one)[0] for one in (batch.inputs, *batch.more)]
        wanted = network.read(looks[0] + looks[1] + looks[2])
    torch.testing.assert_close(said, wanted)
    torch.testing.assert_close(said, turned, atol=1e-4, rtol=1e-4)
    assert (said - alone).abs().max() > 1e-3


def test_the_embodied_network_trains_on_sequences_by_itself(tmp_path):
    store = write_toy_store(tmp_path / "toy")
    cache = CacheLocation(root=tmp_path / "frames")
    config = toy_config(store, network="embodied", steps=3, seed=1)
    assert max(sequence_length(1, step, 3) for step in range(3)) > 1
    train_run(config, tmp_path / "run", device="cpu", cache=cache)
    losses = [float(value) for _, name, value in read_metrics(tmp_path / "run" / "metrics.csv")
              if name == "train_loss"]  # fmt: skip
    assert losses and np.isfinite(losses).all()
    assert read_config(tmp_path / "run" / "run.yaml").frames == 0
    odd = replace(config, network="monoscene", frames=3)
    with pytest.raises(UsageError, match="monoscene processes single frames"):
        train_run(odd, tmp_path / "odd", device="cpu", cache=cache)
    assert not (tmp_path / "odd").exists()

"""Frames as tensors: batches that a run draws, and batches in order for validation."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch.utils.data import DataLoader, Dataset

from world2minecraft.networks.batch import OccInput, OccTarget
from world2minecraft.networks.config import Grid, RunConfig
from world2minecraft.networks.data.augment import augmented_together
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import Frame
from world2minecraft.networks.data.mixing import Draws, draw_rng
from world2minecraft.networks.data.sequences import Companions, count_of


class Batch(NamedTuple):
    """What a step takes; ``more`` are further frames of the same scenes, in the same grids."""

    inputs: OccInput
    target: OccTarget
    more: tuple[OccInput, ...] = ()


class TrainingPart(NamedTuple):
    """The training frames of one set."""

    frames: Frames
    rows: list[int]


class DrawnFrames(Dataset):
    """The frames of a run's draws from one on, each changed as its draw says.

    Each is a list: the frame, then those of its scene that are seen with it, if any.
    """

    def __init__(
        self, parts: Sequence[TrainingPart], draws: Draws, config: RunConfig, first: int = 0
    ):
        self._parts, self._draws, self._config, self._first = parts, draws, config, first
        fuses, voxel_m = config.fused > 1, config.cells.voxel_m
        self._companions = [Companions(*part, voxel_m) for part in parts] if fuses else []

    def __len__(self) -> int:
        return len(self._draws.source) - self._first

    def __getitem__(self, index: int) -> list[Frame]:
        draw, config = self._first + index, self._config
        source = self._draws.source[draw]
        part = self._parts[source]
        row = part.rows[self._draws.row[draw]]
        frames = [part.frames[row]]
        if self._companions:
            count = count_of(config.seed, draw // config.batch, config.fused) - 1
            rng = np.random.default_rng([config.seed, 2**22, draw])
            frames += self._companions[source].beside(row, frames[0], count, rng) if count else []
        rng = draw_rng(config.seed, draw)
        return augmented_together(frames, config.cells.voxel_m, config.flip, config.jitter, rng)


class RowFrames(Dataset):
    """Some rows of a set, in their order and as they are."""

    def __init__(self, frames: Frames, rows: Sequence[int]):
        self._frames, self._rows = frames, rows

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: int) -> list[Frame]:
        return [self._frames[self._rows[index]]]


class Stacked:
    """Makes a batch of frames; a class, so that worker processes can be sent it."""

    def __init__(self, grid: Grid, depth: str):
        self._grid, self._depth = grid, depth

    def __call__(self, samples: list[list[Frame]]) -> Batch:
        """Return the frames one upon the other."""
        frames, *beside = (list(column) for column in zip(*samples, strict=True))
        target = OccTarget(
            labels=_stacked(frames, "labels").long(),
            in_frustum=_stacked(frames, "in_frustum"),
            depth_m=_stacked(frames, "depth_m") if self._depth != "none" else None,
        )
        more = tuple(self._inputs(others) for others in beside)
        return Batch(self._inputs(frames), target, more)

    def _inputs(self, frames: list[Frame]) -> OccInput:
        shape, voxel_m = self._grid
        image = torch.from_numpy(np.stack([frame.image for frame in frames]))
        return OccInput(
            image=image.permute(0, 3, 1, 2).float().div_(255).contiguous(),
            intrinsics=_stacked(frames, "intrinsics"),
            camera_to_grid=_stacked(frames, "camera_to_grid"),
            grid_shape=shape,
            voxel_m=voxel_m,
            depth_m=_stacked(frames, "depth_m") if self._depth == "given" else None,
        )


def drawn_batches(
    parts: Sequence[TrainingPart], draws: Draws, config: RunConfig, first_step: int = 0
) -> DataLoader:
    """Return the batches of a run from a step on."""
    frames = DrawnFrames(parts, draws, config, first_step * config.batch)
    return _loader(frames, config, config.workers)


def ordered_batches(frames: Frames, rows: Sequence[int], config: RunConfig) -> DataLoader:
    """Return batches of some rows in their order; the last may be smaller."""
    return _loader(RowFrames(frames, rows), config, 0)


def _loader(frames: Dataset, config: RunConfig, workers: int) -> DataLoader:
    return DataLoader(
        frames,
        batch_size=config.batch,
        shuffle=False,
        num_workers=workers,
        persistent_workers=workers > 0,
        collate_fn=Stacked(config.cells, config.depth),
        # Without a generator of its own a loader draws from torch's at each start.
        generator=torch.Generator().manual_seed(config.seed),
    )


def _stacked(frames: list[Frame], name: str) -> torch.Tensor:
    return torch.from_numpy(np.stack([getattr(frame, name) for frame in frames]))

"""Frames as tensors: batches that a run draws, and batches in order for validation."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import torch
from torch.utils.data import DataLoader, Dataset

from world2minecraft.networks.batch import OccInput, OccTarget
from world2minecraft.networks.config import Grid, RunConfig
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import Frame
from world2minecraft.networks.data.sequences import Companions, count_of

LUMINANCE = np.array([0.299, 0.587, 0.114], np.float32)


class Draws(NamedTuple):
    """The draws of a run, in their order."""

    source: np.ndarray  # int32 [N], which set
    row: np.ndarray  # int64 [N], which of its training frames


def plan_draws(sizes: Sequence[int], weights: Sequence[float], count: int, seed: int) -> Draws:
    """Return ``count`` draws from sets of the given sizes.

    Example:
        >>> draws = plan_draws([3], [1.0], 6, 0)
        >>> sorted(draws.row[:3].tolist()), sorted(draws.row[3:].tolist())
        ([0, 1, 2], [0, 1, 2])
    """
    chances = np.asarray(weights, np.float64) / np.sum(weights)
    source = np.random.default_rng([seed, 0]).choice(len(sizes), size=count, p=chances)
    row = np.empty(count, np.int64)
    for number, size in enumerate(sizes):
        places = np.flatnonzero(source == number)
        epochs = -(-len(places) // size)
        orders = [
            np.random.default_rng([seed, 1 + number, epoch]).permutation(size)
            for epoch in range(epochs)
        ]
        row[places] = np.concatenate(orders)[: len(places)] if orders else 0
    return Draws(source.astype(np.int32), row)


def draw_rng(seed: int, draw: int) -> np.random.Generator:
    """Return the generator that changes the frame of one draw."""
    return np.random.default_rng([seed, 2**20, draw])





def flipped(frame: Frame, voxel_m: float) -> Frame:
    """Return the frame of the room mirrored left to right, across the middle of its grid."""
    intrinsics = frame.intrinsics.copy()
    intrinsics[0, 2] = frame.image.shape[1] - intrinsics[0, 2]
    intrinsics[0, 1] = -intrinsics[0, 1]
    mirror = np.diag([-1.0, 1.0, 1.0, 1.0]).astype(np.float32)
    over = mirror.copy()
    over[0, 3] = frame.labels.shape[0] * voxel_m
    return replace(
        frame,
        image=frame.image[:, ::-1],
        depth_m=frame.depth_m[:, ::-1],
        intrinsics=intrinsics,
        camera_to_grid=over @ frame.camera_to_grid @ mirror,
        **{name: getattr(frame, name)[::-1] for name in ("labels", "in_frustum", "seen", "free")},
    )


def jittered(image: np.ndarray, strength: float, rng: np.random.Generator) -> np.ndarray:
    """Return a picture with other brightness, contrast and saturation, in an order by chance.

    Args:
        image: uint8 [H, W, 3].
        strength: 0.4 changes each by a factor of 0.6 to 1.4.
        rng: draws order and factors.
    """
    if not strength:
        return image
    values = image.astype(np.float32)
    order, factors = rng.permutation(3), rng.uniform(1 - strength, 1 + strength, 3)
    for kind in order:
        values = _changed(values, int(kind), np.float32(factors[kind]))
    return (values + np.float32(0.5)).astype(np.uint8)


def _changed(values: np.ndarray, kind: int, factor: np.float32) -> np.ndarray:
    """Return values mixed with black, with their mean grey, or with each pixel's own grey."""
    if kind == 0:
        mixed = values * factor
    else:
        grey = values @ LUMINANCE
        base = grey.mean() if kind == 1 else grey[..., None]
        mixed = base + (values - base) * factor
    return np.clip(mixed, 0, 255)


def augmented(
    frame: Frame, voxel_m: float, flip: float, jitter: float, rng: np.random.Generator
) -> Frame:
    """Return a frame mirrored with chance ``flip``, its colours changed by ``jitter``."""
    return augmented_together([frame], voxel_m, flip, jitter, rng)[0]


def augmented_together(
    frames: Sequence[Frame], voxel_m: float, flip: float, jitter: float, rng: np.random.Generator
) -> list[Frame]:
    """Return frames of one grid, all mirrored or none, each in colours of its own."""
    turn_over = rng.random() < flip
    changed = [replace(one, image=jittered(one.image, jitter, rng)) for one in frames]
    return [flipped(one, voxel_m) for one in changed] if turn_over else changed


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

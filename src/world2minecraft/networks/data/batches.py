"""Batches of frames: their random order, their augmentation and the data loaders.

For each frame, a data set is chosen with a probability proportional to its weight, regardless of
its size. The next frame in the shuffled order of this data set is then used, so each frame is used
once before any is repeated. Everything is derived from the seed, and each choice is independent of
the previous ones, so an interrupted run can resume at any position.

A mirrored frame shows the mirrored room: the image, depth, principal point, pose and cells are
mirrored together, so each cell is still projected to the pixels that show it. The pose remains a
rotation, because both the camera and the grid are mirrored. ``grid_to_room`` is not changed,
because networks do not use it and a mirrored frame does not belong to a real room.
"""

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
from world2minecraft.networks.data.sequences import SequenceSampler, sequence_length

LUMINANCE = np.array([0.299, 0.587, 0.114], np.float32)


class Draws(NamedTuple):
    """The random choices of frames for a run, in order.

    Attributes:
        source: Index of the data set, int32 [N].
        row: Index of the training frame in the data set, int64 [N].
    """

    source: np.ndarray
    row: np.ndarray


def plan_draws(sizes: Sequence[int], weights: Sequence[float], count: int, seed: int) -> Draws:
    """Choose ``count`` random frames from data sets of the given sizes.

    Args:
        sizes: Number of training frames in each data set.
        weights: Relative weight of each data set.
        count: Number of frames to choose.
        seed: Random seed.

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
    """Return the random generator for the augmentation of the frame with this draw number."""
    return np.random.default_rng([seed, 2**20, draw])


def flip_frame(frame: Frame, voxel_m: float) -> Frame:
    """Mirror a frame left to right, across the middle of its grid."""
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


def jitter_colour(image: np.ndarray, strength: float, rng: np.random.Generator) -> np.ndarray:
    """Change the brightness, contrast and saturation of an image in random order.

    Args:
        image: Colour image, uint8 [H, W, 3].
        strength: Maximum relative change; 0.4 changes each by a factor of 0.6 to 1.4.
        rng: Random generator.
    """
    if not strength:
        return image
    values = image.astype(np.float32)
    order, factors = rng.permutation(3), rng.uniform(1 - strength, 1 + strength, 3)
    for kind in order:
        values = _adjust_colour(values, int(kind), np.float32(factors[kind]))
    return (values + np.float32(0.5)).astype(np.uint8)


def _adjust_colour(values: np.ndarray, kind: int, factor: np.float32) -> np.ndarray:
    """Blend colours with black, with their mean grey, or with the grey of each pixel."""
    if kind == 0:
        mixed = values * factor
    else:
        grey = values @ LUMINANCE
        base = grey.mean() if kind == 1 else grey[..., None]
        mixed = base + (values - base) * factor
    return np.clip(mixed, 0, 255)


def augment_frame(
    frame: Frame, voxel_m: float, flip: float, jitter: float, rng: np.random.Generator
) -> Frame:
    """Mirror a frame with probability ``flip`` and change its colours with strength ``jitter``."""
    return augment_sequence([frame], voxel_m, flip, jitter, rng)[0]


def augment_sequence(
    frames: Sequence[Frame], voxel_m: float, flip: float, jitter: float, rng: np.random.Generator
) -> list[Frame]:
    """Augment frames that share a grid: mirror all or none, and change the colours of each."""
    turn_over = rng.random() < flip
    changed = [replace(one, image=jitter_colour(one.image, jitter, rng)) for one in frames]
    return [flip_frame(one, voxel_m) for one in changed] if turn_over else changed


class Batch(NamedTuple):
    """A training batch.

    Attributes:
        inputs: Inputs of the network.
        target: Ground truth.
        more: Inputs from further frames of the same scenes, with the same grids.
    """

    inputs: OccInput
    target: OccTarget
    more: tuple[OccInput, ...] = ()


class TrainingSet(NamedTuple):
    """The training frames of a data set.

    Attributes:
        frames: All frames of the data set.
        rows: Indices of the training frames.
    """

    frames: Frames
    rows: list[int]


class DrawnDataset(Dataset):
    """A PyTorch data set with the randomly chosen and augmented frames of a run.

    Each item is a list with a frame and, for networks that fuse frames, further frames of its
    scene.
    """

    def __init__(
        self, parts: Sequence[TrainingSet], draws: Draws, config: RunConfig, first: int = 0
    ):
        self._parts, self._draws, self._config, self._first = parts, draws, config, first
        fuses, voxel_m = config.fused > 1, config.cells.voxel_m
        self._samplers = [SequenceSampler(*part, voxel_m) for part in parts] if fuses else []

    def __len__(self) -> int:
        return len(self._draws.source) - self._first

    def __getitem__(self, index: int) -> list[Frame]:
        draw, config = self._first + index, self._config
        source = self._draws.source[draw]
        part = self._parts[source]
        row = part.rows[self._draws.row[draw]]
        frames = [part.frames[row]]
        if self._samplers:
            count = sequence_length(config.seed, draw // config.batch, config.fused) - 1
            rng = np.random.default_rng([config.seed, 2**22, draw])
            frames += self._samplers[source].sample(row, frames[0], count, rng) if count else []
        rng = draw_rng(config.seed, draw)
        return augment_sequence(frames, config.cells.voxel_m, config.flip, config.jitter, rng)


class OrderedDataset(Dataset):
    """A PyTorch data set with selected frames in order, without augmentation."""

    def __init__(self, frames: Frames, rows: Sequence[int]):
        self._frames, self._rows = frames, rows

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, index: int) -> list[Frame]:
        return [self._frames[self._rows[index]]]


class FrameCollator:
    """A picklable collate function that stacks frames into a batch."""

    def __init__(self, grid: Grid, depth: str):
        self._grid, self._depth = grid, depth

    def __call__(self, samples: list[list[Frame]]) -> Batch:
        """Stack frames into a batch."""
        frames, *others_of_scenes = (list(column) for column in zip(*samples, strict=True))
        target = OccTarget(
            labels=_stack(frames, "labels").long(),
            in_frustum=_stack(frames, "in_frustum"),
            depth_m=_stack(frames, "depth_m") if self._depth != "none" else None,
        )
        more = tuple(self._inputs(others) for others in others_of_scenes)
        return Batch(self._inputs(frames), target, more)

    def _inputs(self, frames: list[Frame]) -> OccInput:
        shape, voxel_m = self._grid
        image = torch.from_numpy(np.stack([frame.image for frame in frames]))
        return OccInput(
            image=image.permute(0, 3, 1, 2).float().div_(255).contiguous(),
            intrinsics=_stack(frames, "intrinsics"),
            camera_to_grid=_stack(frames, "camera_to_grid"),
            grid_shape=shape,
            voxel_m=voxel_m,
            depth_m=_stack(frames, "depth_m") if self._depth == "given" else None,
        )


def training_loader(
    parts: Sequence[TrainingSet], draws: Draws, config: RunConfig, first_step: int = 0
) -> DataLoader:
    """Return a data loader for the training batches of a run, starting at a step."""
    frames = DrawnDataset(parts, draws, config, first_step * config.batch)
    return _data_loader(frames, config, config.workers)


def ordered_loader(frames: Frames, rows: Sequence[int], config: RunConfig) -> DataLoader:
    """Return a data loader for selected frames in order. The last batch may be smaller."""
    return _data_loader(OrderedDataset(frames, rows), config, 0)


def _data_loader(frames: Dataset, config: RunConfig, workers: int) -> DataLoader:
    return DataLoader(
        frames,
        batch_size=config.batch,
        shuffle=False,
        num_workers=workers,
        persistent_workers=workers > 0,
        collate_fn=FrameCollator(config.cells, config.depth),
        # Without its own generator, a loader draws from the global one each time it starts.
        generator=torch.Generator().manual_seed(config.seed),
    )


def _stack(frames: list[Frame], name: str) -> torch.Tensor:
    return torch.from_numpy(np.stack([getattr(frame, name) for frame in frames]))

"""Augmentation of samples: rotating, mirroring, cropping, corrupting and dropping channels.

All random numbers come from one generator, so a seed and a step determine the batch.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.networks.completion.samples import Sample, crop_input, with_rows
from world2minecraft.networks.completion.simulated_votes import simulate_votes
from world2minecraft.reconstruction.semantics.completion_channels import Sight

CROP = (48, 48, 40)
# How often each is omitted: a scan may have no colour, and a frame no known walls.
NO_HINT, NO_VOTES, NO_COLOUR, NO_OFFSET, NO_HEIGHT, NO_FREE = 0.25, 0.45, 0.2, 0.12, 0.1, 0.05


def augment_sample(sample: Sample, rng: np.random.Generator, crop: tuple[int, int, int]) -> Sample:
    """Augment a sample randomly and crop it to the given shape.

    Args:
        sample: Sample to augment.
        rng: Random generator.
        crop: Shape of the result in cells. The ground truth outside the sample is 255.
    """
    sample = rotate_sample(sample, int(rng.integers(4)), bool(rng.integers(2)))
    sample = crop_sample(sample, _window(sample, rng, crop), crop)
    sight = _drop_channels(_corrupt_input(sample.sight, rng), rng)
    if sight.votes is not None:
        sight = simulate_votes(sight, rng)
    return replace(sample, sight=sight)


def prepare_evaluation(samples: list[Sample], seed: int) -> list[Sample]:
    """Return samples whose votes have errors, or are missing in every second one.

    Args:
        samples: Samples of a room, with the votes of the true labels.
        seed: Seed of the room.
    """
    result = []
    for number, sample in enumerate(samples):
        rng = np.random.default_rng([seed, 14, number])
        voted = number % 2 == 0
        sight = simulate_votes(sample.sight, rng) if voted else replace(sample.sight, votes=None)
        result.append(replace(sample, sight=sight))
    return result


def rotate_sample(sample: Sample, quarter_turns: int, is_mirrored: bool) -> Sample:
    """Optionally mirror a sample along x, then rotate it counter-clockwise, seen from above."""
    order = np.zeros(sample.sight.log_odds.shape, np.int32)
    order.reshape(-1)[sample.sight.at] = np.arange(1, len(sample.sight.at) + 1)
    arrays = [sample.sight.log_odds, sample.truth, order]
    if is_mirrored:
        arrays = [values[::-1] for values in arrays]
    odds, truth, order = (
        np.ascontiguousarray(np.rot90(values, quarter_turns, (0, 1))) for values in arrays
    )
    at = np.flatnonzero(order).astype(np.int32)
    rows = order.reshape(-1)[at] - 1
    sight = with_rows(sample.sight, rows, log_odds=odds, at=at)
    if sight.offset is not None:
        offset = sight.offset.astype(np.int16)
        if is_mirrored:
            offset[:, 0] *= -1
        for _ in range(quarter_turns % 4):
            offset = np.stack([-offset[:, 1], offset[:, 0], offset[:, 2]], axis=1)
        sight = replace(sight, offset=offset.astype(np.int8))
    return replace(sample, sight=sight, truth=truth)


def crop_sample(sample: Sample, start: np.ndarray, shape: tuple[int, int, int]) -> Sample:
    """Crop a sample. Cells outside the sample are unknown.

    Args:
        sample: Sample to crop.
        start: First cell of the crop, which may be negative.
        shape: Shape of the crop in cells.
    """
    truth = np.full(shape, UNKNOWN, np.uint8)
    old = sample.truth.shape
    first, last = np.maximum(start, 0), np.minimum(start + shape, old)
    if (first < last).all():
        target = tuple(slice(a, b) for a, b in zip(first - start, last - start, strict=True))
        truth[target] = sample.truth[tuple(slice(a, b) for a, b in zip(first, last, strict=True))]
    return replace(sample, sight=crop_input(sample.sight, start, shape), truth=truth)


def _window(sample: Sample, rng: np.random.Generator, crop: tuple[int, int, int]) -> np.ndarray:
    """Return a random start of a crop, inside the sample or around a smaller sample."""
    spare = np.array(sample.truth.shape) - crop
    start = [int(rng.integers(min(s, 0), max(s, 0) + 1)) for s in spare[:2]]
    return np.array([*start, int(rng.integers(-3, 3)) + (spare[2] // 2 if spare[2] > 0 else 0)])


def _corrupt_input(sight: Sight, rng: np.random.Generator) -> Sight:
    """Randomly remove cells, boxes and the top from an input, and add false cells."""
    odds = sight.log_odds.copy()
    flat = odds.reshape(-1)
    if len(sight.at) and rng.random() < 0.5:
        flat[sight.at[rng.random(len(sight.at)) < rng.uniform(0, 0.12)]] = 0
    if rng.random() < 0.3:
        corner = rng.uniform(0, 1, 3) * odds.shape
        high = corner + rng.uniform(4, 20, 3)
        box = tuple(slice(int(a), int(b)) for a, b in zip(corner, high, strict=True))
        odds[box] = 0
    if rng.random() < 0.2:
        odds[:, :, int(rng.integers(12, odds.shape[2])) :] = 0
    if rng.random() < NO_FREE:
        odds[odds < 0] = 0
    occupied = np.flatnonzero(flat[sight.at] > 0)
    sight = with_rows(sight, occupied, log_odds=odds, at=sight.at[occupied])
    if len(sight.at) and rng.random() < 0.3:
        return _add_specks(sight, rng)
    return sight


def _add_specks(sight: Sight, rng: np.random.Generator) -> Sight:
    """Add up to 60 false occupied cells with the appearance of random other cells."""
    odds = sight.log_odds.copy()
    empty = np.flatnonzero(odds.reshape(-1) <= 0)
    specks = np.sort(rng.choice(empty, min(len(empty), int(rng.integers(1, 60))), replace=False))
    odds.reshape(-1)[specks] = rng.integers(1, 30, len(specks))
    at = np.concatenate([sight.at, specks.astype(np.int32)])
    rows = np.concatenate([np.arange(len(sight.at)), rng.integers(0, len(sight.at), len(specks))])
    order = np.argsort(at, kind="stable")
    return with_rows(sight, rows[order], log_odds=odds, at=at[order])


def _drop_channels(sight: Sight, rng: np.random.Generator) -> Sight:
    """Randomly remove channels from an input and change the lighting of its colours."""
    draws = rng.random(5)
    colour = sight.colour
    if colour is not None:
        gain = rng.uniform(0.65, 1.35) * rng.uniform(0.88, 1.12, 3)
        bright = (colour / 255.0) ** rng.uniform(0.75, 1.35) * 255 * gain
        colour = np.clip(bright, 0, 255).astype(np.uint8)
    bottom = sight.bottom_m
    if bottom is not None:
        bottom += float(rng.standard_normal()) * 0.02
    return replace(
        sight,
        hint=None if draws[0] < NO_HINT else sight.hint,
        votes=None if draws[1] < NO_VOTES else sight.votes,
        colour=None if draws[2] < NO_COLOUR else colour,
        offset=None if draws[3] < NO_OFFSET else sight.offset,
        bottom_m=None if draws[4] < NO_HEIGHT else bottom,
    )

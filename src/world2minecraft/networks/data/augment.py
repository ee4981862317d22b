"""Frames changed at random: mirrored, and in other colours.

A mirrored frame is a frame of the mirrored room: picture, depth, principal point, pose and cells
turn over together, so that a cell still falls on the pixels that show it. The pose stays a
rotation: camera and grid are mirrored both. Where the grid lies in the room is left as it was: no
network is told, and a mirrored frame is of no room.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.networks.data.frames import Frame

LUMINANCE = np.array([0.299, 0.587, 0.114], np.float32)


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

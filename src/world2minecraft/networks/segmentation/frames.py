"""Labelled frames for the segmentation network, and their split."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
from PIL import Image

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    estimate_up,
    fine_depth,
    geometry_size,
    network_size,
    sample_nearest,
    surface_normals,
)

IGNORED = 39  # Other props, unlabelled pixels and boundaries, which are not trained or scored.
FLOOR = 1  # Class of the floor, counted from 0 like all labels here.
MAX_DEPTH8_M = 10.0  # Of the value 255.
BLOCK, BLOCKS, VALIDATION_BLOCK, BLOCK_MARGIN = 50, 5, 4, 3
# Halves of two blocks of the training part. Temperatures are fitted on them.
CALIBRATION_NUMBERS = (range(350, 375), range(1100, 1125))
CALIBRATION_MARGIN = 3
NYU_CAMERA = Camera(640, 480, 518.85790117, 519.46961112, 325.58244941, 253.73616633)
Part = Literal["train", "validation", "calibration", "unused"]


@dataclass(frozen=True, eq=False)
class LabelledFrame:
    """An image with the class of each pixel.

    Attributes:
        name: Name of the frame.
        colour: Colours, uint8 [H, W, 3].
        labels: NYU40 ids minus 1, uint8 [H, W]; 39 is ignored.
        camera: Camera of the image.
        depth_m: Depth at the size of the geometry channels in metres, smoothed if it was stored in
            steps, float32 [h, w], 0 where unknown.
        stored_m: The same before it was smoothed.
    """

    name: str
    colour: np.ndarray
    labels: np.ndarray
    camera: Camera
    depth_m: np.ndarray
    stored_m: np.ndarray

    @property
    def depth_camera(self) -> Camera:
        """Camera of the depth, at its size."""
        return self.camera.scaled_to(self.depth_m.shape[1], self.depth_m.shape[0])

    @cached_property
    def up(self) -> np.ndarray:
        """Direction of up in the camera frame, estimated from the depth, float32 [3]."""
        return estimate_up(surface_normals(self.depth_m, pixel_rays(self.depth_camera)))


def nyu_part(number: int) -> Part:
    """Return the part of the split that holds a frame of NYUv2's labelled set.

    Validation is every fifth block of 50 numbers. Rooms repeat between neighbouring numbers, so
    the first and last three numbers of its blocks are in no part. Two halves of training blocks
    are kept for the calibration.

    Example:
        >>> [nyu_part(number) for number in (199, 200, 203, 246, 247)]
        ['train', 'unused', 'validation', 'validation', 'unused']
    """
    if (number // BLOCK) % BLOCKS == VALIDATION_BLOCK:
        inside = BLOCK_MARGIN <= number % BLOCK < BLOCK - BLOCK_MARGIN
        return "validation" if inside else "unused"
    for numbers in CALIBRATION_NUMBERS:
        if number in numbers:
            inside = (
                number - CALIBRATION_MARGIN in numbers and number + CALIBRATION_MARGIN in numbers
            )
            return "calibration" if inside else "unused"
    return "train"


def labelled_frame(
    name: str, colour: np.ndarray, labels: np.ndarray, depth_m: np.ndarray, camera: Camera
) -> LabelledFrame:
    """Return a frame with its depth prepared for the geometry channels.

    Args:
        name: Name of the frame.
        colour: Colours, uint8 [H, W, 3].
        labels: NYU40 ids minus 1, uint8 [H, W]; 39 is ignored.
        depth_m: Depth in metres from the same camera, [H, W], 0 where unknown.
        camera: Camera of the image.
    """
    small = geometry_size(*network_size(camera.width_px, camera.height_px))
    stored_m = sample_nearest(np.asarray(depth_m, np.float32), *small)
    return LabelledFrame(name, colour, labels, camera, fine_depth(depth_m, *small), stored_m)


def read_nyu_folder(
    folder: Path, parts: Sequence[Part], cache: Path | None = None
) -> list[LabelledFrame]:
    """Read frames ``NNNN.color.jpg``, ``NNNN.depth8.png`` and ``NNNN.label40.png`` of NYUv2.

    Args:
        folder: Folder of the frames.
        parts: Parts of the split to read.
        cache: Optional folder that keeps the smoothed depth, which takes minutes to compute.

    Raises:
        InputError: If there are no such frames.
        DamagedFileError: If a frame has another size than its labels or depth.
    """
    frames = []
    for path in sorted(folder.glob("*.label40.png")):
        name = path.name.partition(".")[0]
        if name.isdecimal() and nyu_part(int(name)) in parts:
            frames.append(_read_nyu_frame(folder, name, cache))
    if not frames:
        raise InputError(folder, "contains no frames NNNN.label40.png of these parts of the split")
    return frames


def _read_nyu_frame(folder: Path, name: str, cache: Path | None) -> LabelledFrame:
    colour = np.array(Image.open(folder / f"{name}.color.jpg").convert("RGB"))
    labels = np.array(Image.open(folder / f"{name}.label40.png"))
    steps = np.array(Image.open(folder / f"{name}.depth8.png"))
    for file, image in ((f"{name}.label40.png", labels), (f"{name}.depth8.png", steps)):
        if image.shape != colour.shape[:2]:
            raise DamagedFileError(folder / file, f"has another size than {name}.color.jpg")
    depth_m = steps.astype(np.float32) * np.float32(MAX_DEPTH8_M / 255)
    camera = NYU_CAMERA.scaled_to(colour.shape[1], colour.shape[0])
    held = None if cache is None else cache / f"{name}.npy"
    if held is not None and held.is_file():
        small = geometry_size(*network_size(camera.width_px, camera.height_px))
        fine_m = np.load(held)
        return LabelledFrame(name, colour, labels, camera, fine_m, sample_nearest(depth_m, *small))
    frame = labelled_frame(name, colour, labels, depth_m, camera)
    if held is not None:
        held.parent.mkdir(parents=True, exist_ok=True)
        np.save(held, frame.depth_m)
    return frame


def class_shares(frames: Sequence[LabelledFrame]) -> np.ndarray:
    """Return the share of each of the 40 classes among the labelled pixels, float64 [40]."""
    counts = np.zeros(IGNORED + 1)
    for frame in frames:
        counts += np.bincount(frame.labels[::4, ::4].reshape(-1), minlength=len(counts))
    counts[IGNORED] = 0
    return counts / max(counts.sum(), 1)

"""Label images from a separate folder: ``FOLDER/NAME.png``, one 8-bit class id per pixel."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header, read_raw
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.errors import CaptureError


def attach_labels(frames: Sequence[FrameFiles], folder: Path) -> tuple[FrameFiles, ...]:
    """Return the frames with the label images of a folder, matched by the frame's name.

    Raises:
        CaptureError: the folder is missing or none of its images is named like a frame.
    """
    if not folder.is_dir():
        raise CaptureError(
            folder, "is no folder of label images: give one with NAME.png for each frame"
        )
    labelled = tuple(replace(frame, labels_path=_label_of(frame, folder)) for frame in frames)
    if not any(frame.labels_path for frame in labelled):
        raise CaptureError(
            folder, f"has no label image for any frame, such as {frames[0].name}.png"
        )
    return labelled


def _label_of(frame: FrameFiles, folder: Path) -> ImagePlace | None:
    names = [frame.name] if frame.colour_path is None else [frame.name, frame.colour_path.stem]
    found = (folder / f"{name}.png" for name in names)
    return next((path for path in found if path.is_file()), frame.labels_path)


def check_labels(frames: Sequence[FrameFiles]) -> None:
    """Decode the first label image, so that a wrong kind is refused before any long work.

    Raises:
        CaptureError: it is no 8-bit image of class ids, or has another shape than the colour.
    """
    for frame in frames:
        if frame.labels_path is None or frame.colour_camera is None:
            continue
        header = read_header(frame.labels_path)
        try:
            frame.colour_camera.resized(*header.size)
        except ValueError as error:
            raise CaptureError(frame.labels_path, f"labels lie on colour: {error}") from error
        labels = read_raw(frame.labels_path)
        if labels.dtype != np.uint8 or labels.ndim != 2:
            given = f"{labels.dtype} {labels.shape}"
            raise CaptureError(
                frame.labels_path, f"must hold one 8-bit class id a pixel, not {given}"
            )
        wrong = labels[(labels > 11) & (labels != 255)]
        if len(wrong):
            raise CaptureError(
                frame.labels_path, f"must hold class ids 0 to 11 or 255, not {int(wrong[0])}"
            )
        return

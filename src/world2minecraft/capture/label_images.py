"""Label images in a separate folder: ``FOLDER/NAME.png`` with one 8-bit class id per pixel."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header, read_raw
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.errors import CaptureError


def attach_labels(frames: Sequence[FrameFiles], folder: Path) -> tuple[FrameFiles, ...]:
    """Return the frames with label images from a folder, matched by frame name.

    Raises:
        CaptureError: If the folder is missing or no image matches a frame.
    """
    if not folder.is_dir():
        raise CaptureError(
            folder, "is not a folder of label images; give a folder with NAME.png for each frame"
        )
    labelled = tuple(replace(frame, labels_path=_label_of(frame, folder)) for frame in frames)
    if not any(frame.labels_path for frame in labelled):
        raise CaptureError(
            folder, f"contains no label image for any frame, such as {frames[0].name}.png"
        )
    return labelled


def _label_of(frame: FrameFiles, folder: Path) -> ImagePlace | None:
    names = [frame.name] if frame.colour_path is None else [frame.name, frame.colour_path.stem]
    found = (folder / f"{name}.png" for name in names)
    return next((path for path in found if path.is_file()), frame.labels_path)


def check_labels(frames: Sequence[FrameFiles]) -> None:
    """Decode the first label image, to reject wrong formats before long computations.

    Raises:
        CaptureError: If the image does not contain 8-bit class ids, or its aspect ratio differs
            from the colour image.
    """
    for frame in frames:
        if frame.labels_path is None or frame.colour_camera is None:
            continue
        header = read_header(frame.labels_path)
        try:
            frame.colour_camera.resized(*header.size)
        except ValueError as error:
            raise CaptureError(
                frame.labels_path, f"label image does not match the colour image: {error}"
            ) from error
        labels = read_raw(frame.labels_path)
        if labels.dtype != np.uint8 or labels.ndim != 2:
            given = f"{labels.dtype} {labels.shape}"
            raise CaptureError(
                frame.labels_path, f"must be a single-channel image of 8-bit class ids, got {given}"
            )
        wrong = labels[(labels > 11) & (labels != 255)]
        if len(wrong):
            raise CaptureError(
                frame.labels_path,
                f"must contain class ids from 0 to 11, or 255; got {int(wrong[0])}",
            )
        return

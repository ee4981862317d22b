"""Label images in a separate folder: ``FOLDER/NAME.png`` with one 8-bit class id per pixel.

A file ``labels.json`` in the folder can state that the values are NYU40 ids, as
``{"classes": "nyu40"}``. ``w2m segment`` writes such folders.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header, read_raw
from world2minecraft.capture.readers.datasets.nyu40_labels import MappedLabels
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_json, write_json

FACTS_FILE = "labels.json"
NYU12, NYU40 = "nyu12", "nyu40"
MAX_FACTS_BYTES = 1 << 20


def attach_labels(frames: Sequence[FrameFiles], folder: Path) -> tuple[FrameFiles, ...]:
    """Return the frames with label images from a folder, matched by frame name.

    Raises:
        CaptureError: If the folder is missing, no image matches a frame, or ``labels.json`` states
            unknown classes.
    """
    if not folder.is_dir():
        raise CaptureError(
            folder, "is not a folder of label images; give a folder with NAME.png for each frame"
        )
    nyu40 = _holds_nyu40(folder)
    labelled = tuple(
        replace(frame, labels_path=_label_of(frame, folder, nyu40)) for frame in frames
    )
    if not any(frame.labels_path for frame in labelled):
        raise CaptureError(
            folder, f"contains no label image for any frame, such as {frames[0].name}.png"
        )
    return labelled


def _label_of(frame: FrameFiles, folder: Path, nyu40: bool) -> ImagePlace | None:
    names = [frame.name] if frame.colour_path is None else [frame.name, frame.colour_path.stem]
    found = (folder / f"{name}.png" for name in names)
    path = next((path for path in found if path.is_file()), None)
    if path is None:
        return frame.labels_path
    return MappedLabels(path, None) if nyu40 else path


def write_label_facts(folder: Path, network: str) -> None:
    """Write the ``labels.json`` of a folder of NYU40 label images.

    Args:
        folder: Folder of the label images, created if missing.
        network: Name of the network that predicted them.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_json(folder / FACTS_FILE, {"classes": NYU40, "network": network, "unknown": 0})


def _holds_nyu40(folder: Path) -> bool:
    """Return whether the label images of a folder contain NYU40 ids.

    Raises:
        CaptureError: If ``labels.json`` states unknown classes.
        InputError: If ``labels.json`` is not a JSON file.
    """
    path = folder / FACTS_FILE
    if not path.is_file():
        return False
    stated = read_json(path, MAX_FACTS_BYTES)
    classes = stated.get("classes", NYU12) if isinstance(stated, dict) else None
    if classes not in (NYU12, NYU40):
        raise CaptureError(
            path, f'must state the "classes" {NYU12} or {NYU40}, got {str(classes)[:40]!r}'
        )
    return classes == NYU40


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

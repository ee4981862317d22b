"""Label images in a folder: ``FOLDER/NAME.png`` with one id per pixel.

The ids are those of the twelve classes. A file ``labels.json`` in the folder can state other ids:
NYU40, as ``{"classes": "nyu40"}``, which ``w2m segment`` writes, or ids of one's own with their
names, as ``{"classes": {"1": "wall", "65": "toilet"}}``, which may have 16 bits.
"""

import difflib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header, read_raw
from world2minecraft.capture.readers.datasets.label_ids import (
    FACTS_FILE,
    NYU40,
    Reading,
    label_reading,
)
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import write_json
from world2minecraft.core.vocabulary import label_id_classes, label_id_of, read_vocabulary

NAMES_TOLD = 5


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
    reading = label_reading(folder)
    labelled = tuple(
        replace(frame, labels_path=_label_of(frame, folder, reading)) for frame in frames
    )
    if not any(frame.labels_path for frame in labelled):
        raise CaptureError(
            folder, f"contains no label image for any frame, such as {frames[0].name}.png"
        )
    return labelled


def _label_of(frame: FrameFiles, folder: Path, reading: Reading) -> ImagePlace | None:
    names = [frame.name] if frame.colour_path is None else [frame.name, frame.colour_path.stem]
    found = (folder / f"{name}.png" for name in names)
    path = next((path for path in found if path.is_file()), None)
    return frame.labels_path if path is None else reading(path)


def write_label_facts(folder: Path, network: str) -> None:
    """Write the ``labels.json`` of a folder of NYU40 label images.

    Args:
        folder: Folder of the label images, created if missing.
        network: Name of the network that predicted them.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_json(folder / FACTS_FILE, {"classes": NYU40, "network": network, "unknown": 0})


def unknown_names_note(frames: Sequence[FrameFiles]) -> str:
    """Return a remark on the names of label images that the vocabulary does not have, or ''."""
    stated = {names for frame in frames if (names := getattr(frame.labels_path, "names", ()))}
    unknown = {name for names in stated for _, name in names if label_id_of(name) is None}
    if not unknown:
        return ""
    told = []
    for name in sorted(unknown)[:NAMES_TOLD]:
        near = difflib.get_close_matches(name.lower(), read_vocabulary().names, n=1)
        told.append(f"{name} (did you mean {near[0]}?)" if near else name)
    more = f" and {len(unknown) - NAMES_TOLD} more" if len(unknown) > NAMES_TOLD else ""
    return (
        f"{FACTS_FILE} has names that are not known, whose pixels count as unlabelled: "
        f"{', '.join(told)}{more}"
    )


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
        if getattr(frame.labels_path, "holds_label_ids", False):
            labels = label_id_classes()[labels]
        if labels.dtype != np.uint8 or labels.ndim != 2:
            given = f"{labels.dtype} {labels.shape}"
            raise CaptureError(
                frame.labels_path, f"must be a single-channel image of 8-bit class ids, got {given}"
            )
        wrong = labels[(labels > 11) & (labels != UNKNOWN)]
        if len(wrong):
            raise CaptureError(
                frame.labels_path,
                f"must contain class ids from 0 to 11, or 255; got {int(wrong[0])}",
            )
        return

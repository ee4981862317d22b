"""Conversion of label images of other data sets to label ids.

Their values are NYU40 ids, raw ScanNet ids that a table maps to NYU40, or ids that the data set
names. ``core.vocabulary.label_id_names`` lists label ids.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy as np

from world2minecraft.capture.images import (
    ImageHeader,
    ImagePlace,
    NamedByFile,
    check_whole,
    read_header,
    read_raw,
)
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes, read_json
from world2minecraft.core.vocabulary import OTHER_NYU40, label_id_of

LABEL_TABLE = "scannetv2-labels.combined.tsv"
MAX_TABLE_BYTES = 16 << 20  # The published one has 100 kB.
FACTS_FILE = "labels.json"
NYU12, NYU40 = "nyu12", "nyu40"
MAX_FACTS_BYTES = 1 << 20
MAX_ID = 65535

# Returns a label image, given its path.
Reading = Callable[[AnyPath], ImagePlace]


def raw_id_labels(table: AnyPath) -> np.ndarray:
    """Return the label id for each raw ScanNet label as uint16 [65536], 0 if unknown.

    Args:
        table: ScanNet's tab-separated table with the columns ``id`` and ``nyu40id``.

    Raises:
        CaptureError: If the table lacks those columns.
        InputError: If the table is missing.
    """
    lines = read_bytes(table, MAX_TABLE_BYTES).decode("utf-8", "replace").splitlines()
    rows = [line.split("\t") for line in lines]
    if not rows or not {"id", "nyu40id"} <= set(rows[0]):
        raise CaptureError(
            table,
            "does not contain the columns id and nyu40id; use the table of the ScanNet data set",
        )
    own, nyu40 = rows[0].index("id"), rows[0].index("nyu40id")
    labels = np.zeros(MAX_ID + 1, np.uint16)
    for row in rows[1:]:
        if len(row) > max(own, nyu40) and row[own].isdecimal() and row[nyu40].isdecimal():
            number, nyu40_id = int(row[own]), int(row[nyu40])
            if number <= MAX_ID and nyu40_id <= OTHER_NYU40:
                labels[number] = nyu40_id
    return labels


def named_id_labels(names: Mapping[int, str]) -> np.ndarray:
    """Return the label id for each id that a data set names, uint16 [65536], 0 if unknown.

    Example:
        >>> from world2minecraft.core.vocabulary import label_id_names
        >>> label_id_names()[named_id_labels({7: "Toilet"})[7]]
        'toilet'
    """
    labels = np.zeros(MAX_ID + 1, np.uint16)
    for number, name in names.items():
        labels[number] = label_id_of(name) or 0
    return labels


def find_label_table(places: Sequence[AnyPath]) -> AnyPath | None:
    """Return the first ScanNet label table found in the given folders, or None."""
    return next((place / LABEL_TABLE for place in places if (place / LABEL_TABLE).is_file()), None)


@dataclass(frozen=True)
class MappedLabels(NamedByFile):
    """A label image of a data set, converted to label ids.

    Attributes:
        path: The label image. Without ``names``, 16-bit images contain raw ScanNet ids and 8-bit
            images NYU40 labels.
        table: ScanNet's table of raw ids, or None.
        names: Pairs of an id and its name, if the values are ids of the data set.
    """

    path: AnyPath
    table: AnyPath | None
    names: tuple[tuple[int, str], ...] = ()

    holds_label_ids = True

    def header(self) -> ImageHeader:
        """Return the size of the image and the mode of class labels."""
        return ImageHeader(*read_header(self.path).size, "L")

    def check_whole(self) -> None:
        """Check that the image file is complete."""
        check_whole(self.path)

    def colour(self) -> np.ndarray:
        """Raise CaptureError, because a label image has no colours."""
        raise CaptureError(self.path, "contains labels, not colours")

    def raw(self) -> np.ndarray:
        """Return the label ids as uint16 [H, W].

        Raises:
            CaptureError: If the image contains raw ids without a table, or is not a single-channel
                image.
        """
        stored = read_raw(self.path)
        if stored.ndim != 2 or stored.dtype.kind not in "ui":
            raise CaptureError(self.path, "must be a single-channel image of integers")
        if self.names:
            return _cached_names(self.names)[np.clip(stored, 0, MAX_ID)]
        if stored.dtype == np.uint8:
            return np.where(stored <= OTHER_NYU40, stored, 0).astype(np.uint16)
        if self.table is None:
            raise CaptureError(
                self.path, f"contains raw ScanNet ids; put {LABEL_TABLE} next to the scene"
            )
        return _cached_table(str(self.table), self.table)[np.clip(stored, 0, MAX_ID)]


@lru_cache(maxsize=2)
def _cached_table(named: str, table: AnyPath) -> np.ndarray:
    return raw_id_labels(table)


@lru_cache(maxsize=2)
def _cached_names(names: tuple[tuple[int, str], ...]) -> np.ndarray:
    return named_id_labels(dict(names))


def label_reading(folder: AnyPath) -> Reading:
    """Return how the label images of a folder are read, as its ``labels.json`` states.

    Raises:
        CaptureError: If ``labels.json`` states unknown classes.
        InputError: If ``labels.json`` is not a JSON file.
    """
    path = folder / FACTS_FILE
    if not path.is_file():
        return lambda image: image
    stated = read_json(path, MAX_FACTS_BYTES)
    classes = stated.get("classes", NYU12) if isinstance(stated, dict) else None
    if isinstance(classes, dict):
        return partial(MappedLabels, table=None, names=_stated_names(path, classes))
    if classes not in (NYU12, NYU40):
        raise CaptureError(
            path,
            f'must state the "classes" {NYU12} or {NYU40}, or the name of each id, such as '
            f'{{"65": "toilet"}}, got {str(classes)[:40]!r}',
        )
    return partial(MappedLabels, table=None) if classes == NYU40 else lambda image: image


def _stated_names(path: AnyPath, classes: dict[str, Any]) -> tuple[tuple[int, str], ...]:
    """Return the pairs of id and name in a ``labels.json``, in the order of the ids.

    Raises:
        CaptureError: If a key is not an id, a value is not a name, or no name is known.
    """
    names = {}
    for key, value in classes.items():
        if not (key.isascii() and key.isdecimal() and len(key) <= 5 and int(key) <= MAX_ID):
            raise CaptureError(path, f"must have ids from 0 to {MAX_ID} as keys, got {key[:40]!r}")
        if not isinstance(value, str):
            raise CaptureError(path, f"must state a name for the id {key}, got {str(value)[:40]!r}")
        names[int(key)] = value
    if not any(label_id_of(name) for name in names.values()):
        raise CaptureError(
            path,
            'states no known name; use names such as "wall" and "toilet", which '
            'docs/how-to/label-images.md describes, or state the "classes" nyu12 or nyu40',
        )
    return tuple(sorted(names.items()))

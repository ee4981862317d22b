"""Conversion of label images of data sets to World2Minecraft classes.

Labels are NYU40 ids, or raw ScanNet ids that a table maps to NYU40.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from world2minecraft.capture.images import (
    ImageHeader,
    NamedByFile,
    check_whole,
    read_header,
    read_raw,
)
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.vocabulary import nyu40_classes

LABEL_TABLE = "scannetv2-labels.combined.tsv"
MAX_TABLE_BYTES = 16 << 20  # The published one has 100 kB.


def raw_id_classes(table: AnyPath) -> np.ndarray:
    """Return the class id for each raw ScanNet label as uint8 [65536], 255 if unknown.

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
    known, classes = nyu40_classes(), np.full(65536, UNKNOWN, np.uint8)
    for row in rows[1:]:
        if len(row) > max(own, nyu40) and row[own].isdecimal() and row[nyu40].isdecimal():
            number, nyu40_id = int(row[own]), int(row[nyu40])
            if number < 65536 and nyu40_id < 65536:
                classes[number] = known[nyu40_id]
    return classes


def find_label_table(places: Sequence[AnyPath]) -> AnyPath | None:
    """Return the first ScanNet label table found in the given folders, or None."""
    return next((place / LABEL_TABLE for place in places if (place / LABEL_TABLE).is_file()), None)


@dataclass(frozen=True)
class MappedLabels(NamedByFile):
    """A label image of a data set, converted to World2Minecraft class ids.

    Attributes:
        path: The label image. 16-bit images contain raw ScanNet ids, 8-bit images contain NYU40
            labels.
        table: ScanNet's table of raw ids, or None.
    """

    path: AnyPath
    table: AnyPath | None

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
        """Return the class ids as uint8 [H, W].

        Raises:
            CaptureError: If the image contains raw ids without a table, or is not a single-channel
                image.
        """
        stored = read_raw(self.path)
        if stored.ndim != 2 or stored.dtype.kind not in "ui":
            raise CaptureError(self.path, "must be a single-channel image of integers")
        if stored.dtype == np.uint8:
            return nyu40_classes()[stored]
        if self.table is None:
            raise CaptureError(
                self.path, f"contains raw ScanNet ids; put {LABEL_TABLE} next to the scene"
            )
        return _cached_table_classes(str(self.table), self.table)[np.clip(stored, 0, 65535)]


@lru_cache(maxsize=2)
def _cached_table_classes(named: str, table: AnyPath) -> np.ndarray:
    return raw_id_classes(table)

"""Label images of data sets as our classes: NYU40 ids, or ScanNet's raw ids by its table.

``data/nyu40.json`` maps the 40 to the 12 classes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import (
    ImageHeader,
    NamedByFile,
    check_whole,
    read_header,
    read_raw,
)
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.classes import UNKNOWN, class_id
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes, read_json

CLASS_MAP = Path(__file__).parent / "data" / "nyu40.json"
LABEL_TABLE = "scannetv2-labels.combined.tsv"
MAX_TABLE_BYTES = 16 << 20  # The published one has 100 kB.


@lru_cache(maxsize=1)
def nyu40_classes() -> np.ndarray:
    """Return uint8 [65536]: the class of each NYU40 number, 255 where it is none."""
    classes = np.full(65536, UNKNOWN, np.uint8)
    for number, (_, name) in read_json(CLASS_MAP)["classes"].items():
        classes[int(number)] = class_id(name)
    return classes


def raw_id_classes(table: AnyPath) -> np.ndarray:
    """Return uint8 [65536]: the class of each of ScanNet's own ids, by its published table.

    Args:
        table: tab-separated, with the columns ``id`` and ``nyu40id``.

    Raises:
        CaptureError: it lacks the columns. InputError: it is missing.
    """
    lines = read_bytes(table, MAX_TABLE_BYTES).decode("utf-8", "replace").splitlines()
    rows = [line.split("\t") for line in lines]
    if not rows or not {"id", "nyu40id"} <= set(rows[0]):
        raise CaptureError(table, "has no columns id and nyu40id; take the one of the data set")
    own, nyu40 = rows[0].index("id"), rows[0].index("nyu40id")
    known, classes = nyu40_classes(), np.full(65536, UNKNOWN, np.uint8)
    for row in rows[1:]:
        if len(row) > max(own, nyu40) and row[own].isdecimal() and row[nyu40].isdecimal():
            number, nyu40_id = int(row[own]), int(row[nyu40])
            if number < 65536 and nyu40_id < 65536:
                classes[number] = known[nyu40_id]
    return classes


def find_label_table(places: Sequence[AnyPath]) -> AnyPath | None:
    """Return the first of ScanNet's tables that lies in one of some folders."""
    return next((place / LABEL_TABLE for place in places if (place / LABEL_TABLE).is_file()), None)


@dataclass(frozen=True)
class MappedLabels(NamedByFile):
    """A label image of a data set, read as our classes.

    ``table`` is that of ScanNet's raw ids, which are stored with 16 bits; images of 8 bits hold
    NYU40 numbers, as ScanNet's benchmark frames do.
    """

    path: AnyPath
    table: AnyPath | None

    def header(self) -> ImageHeader:
        """Return size and the mode of our labels."""
        return ImageHeader(*read_header(self.path).size, "L")

    def check_whole(self) -> None:
        """Check that the image file is whole."""
        check_whole(self.path)

    def colour(self) -> np.ndarray:
        """Refuse: labels are no colours."""
        raise CaptureError(self.path, "holds labels, not colours")

    def raw(self) -> np.ndarray:
        """Return uint8 [H, W] class ids.

        Raises:
            CaptureError: it holds raw ids and there is no table, or is no image of numbers.
        """
        stored = read_raw(self.path)
        if stored.ndim != 2 or stored.dtype.kind not in "ui":
            raise CaptureError(self.path, "must hold one number a pixel")
        if stored.dtype == np.uint8:
            return nyu40_classes()[stored]
        if self.table is None:
            raise CaptureError(
                self.path, f"holds ScanNet's raw ids; put {LABEL_TABLE} beside the scene"
            )
        return _cached_table_classes(str(self.table), self.table)[np.clip(stored, 0, 65535)]


@lru_cache(maxsize=2)
def _cached_table_classes(named: str, table: AnyPath) -> np.ndarray:
    return raw_id_classes(table)

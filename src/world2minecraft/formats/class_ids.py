"""Class ids of foreign occupancy grids, converted to the 12 classes.

``nyu12`` and ``occscannet`` are the ids of this program: 0 is empty, 1 to 11 are classes and 255 is
unknown. ``embodied`` are those inside EmbodiedOcc and GPOcc: 0 is ignored (unknown), 1 to 11 are
classes and 12 is empty. Any other ids are listed in a YAML file, either as ``id: name`` or as a
list of names from id 0. Names are those of the 12 classes, or ``unknown``::

    0: empty
    1: wall
    2: floor
    40: unknown
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_DISPLAY_NAMES, CLASS_NAMES, UNKNOWN
from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.core.files import load_plain_yaml, read_bytes

EMBODIED_EMPTY = 12
CLASS_SETS = ("nyu12", "embodied", "occscannet")
MAX_TABLE_BYTES = 1 << 20
MAX_ID = 65535
_INVALID = 254  # In tables: ids that the class set does not have.
_NAMES = {name: number for number, name in enumerate(CLASS_DISPLAY_NAMES)} | {
    name: number for number, name in enumerate(CLASS_NAMES)
}


@dataclass(frozen=True, eq=False)
class ClassSet:
    """The ids of a program and their classes.

    Attributes:
        name: Name of the set, or path of its file.
        table: Class of each id from 0 (0 to 11, 255 for unknown, 254 for invalid ids), uint8 [N].
        count: Number of score channels, one per id from 0.
    """

    name: str
    table: np.ndarray
    count: int

    def convert(self, labels: np.ndarray, path: str | Path) -> np.ndarray:
        """Convert an array of ids to classes, uint8 of the same shape (0 to 11 or 255).

        Args:
            labels: Whole numbers of any type.
            path: File to name in errors.

        Raises:
            DamagedFileError: If the array contains other values than the ids of this set. The
                message names the class set that has them, if there is one.
        """
        kind = labels.dtype.kind
        if kind not in "iuf":
            raise DamagedFileError(
                path, f"must contain class ids or scores, got values of type {labels.dtype}"
            )
        if kind == "f" and not np.isfinite(labels).all():
            raise DamagedFileError(path, "contains NaN or infinity, expected class ids")
        low, high = (labels.min(), labels.max()) if labels.size else (0, 0)
        if not 0 <= low <= high <= MAX_ID:
            wrong = low if low < 0 else high
            raise DamagedFileError(
                path, f"contains the value {wrong:g}, expected class ids from 0 to {MAX_ID}"
            )
        whole = labels.astype(np.uint16)
        if kind == "f" and not np.array_equal(whole, labels):
            raise DamagedFileError(
                path,
                "contains fractions, expected class ids; scores need one more axis, with a channel "
                "for each class",
            )
        full = np.full(MAX_ID + 1, _INVALID, np.uint8)
        full[: len(self.table)] = self.table
        classes = full[whole]
        if (classes == _INVALID).any():
            raise DamagedFileError(path, self._unknown_id(whole, full))
        return classes

    def convert_scores(self, scores: np.ndarray) -> np.ndarray:
        """Convert probabilities of ids to those of classes, float32 [..., 12].

        Ids of one class are added. The share of unknown ids is left out and the rest rescaled to a
        sum of 1, or 0 where nothing is left.

        Args:
            scores: Probabilities of the ids, float [..., N], with one channel for each id.
        """
        matrix = np.zeros((self.count, CLASS_COUNT), np.float32)
        known = np.flatnonzero(self.table[: self.count] < CLASS_COUNT)
        matrix[known, self.table[known]] = 1
        mixed = scores.astype(np.float32) @ matrix
        total = mixed.sum(axis=-1, keepdims=True)
        return mixed / np.where(total > 1e-6, total, np.inf)

    def _unknown_id(self, ids: np.ndarray, table: np.ndarray) -> str:
        wrong = int(ids[table[ids] == _INVALID].max())
        if self.name in ("nyu12", "occscannet") and wrong == EMBODIED_EMPTY:
            return (
                "contains the class id 12, which is empty in EmbodiedOcc; set classes to embodied"
            )
        return (
            f"contains the class id {wrong}, which {self.name} does not have; set classes "
            "(--classes) to nyu12, embodied, occscannet or a YAML file of ids and names"
        )


@cache
def _shipped(name: str) -> ClassSet:
    table = np.full(256, _INVALID, np.uint8)
    table[:CLASS_COUNT] = np.arange(CLASS_COUNT)
    table[UNKNOWN] = UNKNOWN
    if name == "embodied":
        table[0], table[EMBODIED_EMPTY] = UNKNOWN, 0
        return ClassSet(name, table, EMBODIED_EMPTY + 1)
    return ClassSet(name, table, CLASS_COUNT)


def read_class_set(name: str | Path) -> ClassSet:
    """Return a class set by its name, or read it from a YAML file.

    Raises:
        UnknownNameError: If there is neither a set nor a file of this name.
        DamagedFileError: If the file does not assign classes to ids.
    """
    if str(name) in CLASS_SETS:
        return _shipped(str(name))
    path = Path(name)
    if not path.is_file():
        raise UnknownNameError("class set", str(name), (*CLASS_SETS, "a YAML file"))
    try:
        rows = load_plain_yaml(read_bytes(path, MAX_TABLE_BYTES))
        return _class_set(path, _ids(rows))
    except ValueError as error:
        raise DamagedFileError(path, f"does not list class ids: {error}") from error


def _ids(rows: Any) -> Mapping[int, str]:
    """Return the name of each id. Raises ValueError."""
    if isinstance(rows, list):
        rows = dict(enumerate(rows))
    if not isinstance(rows, dict) or not rows:
        raise ValueError("expected lines such as 0: empty")
    for number, name in rows.items():
        if type(number) is not int or not 0 <= number <= MAX_ID:
            raise ValueError(f"{number!r} must be an id from 0 to {MAX_ID}")
        if not isinstance(name, str):
            raise ValueError(f"the class of {number} must be a name, got {name!r}")
    return rows


def _class_set(path: Path, names: Mapping[int, str]) -> ClassSet:
    table = np.full(max(names) + 1, _INVALID, np.uint8)
    for number, name in names.items():
        word = name.strip().lower()
        if word not in (*_NAMES, "unknown"):
            known = ", ".join((*CLASS_DISPLAY_NAMES, "unknown"))
            raise ValueError(f"{name!r} is not a class; known: {known}")
        table[number] = _NAMES.get(word, UNKNOWN)
    if 0 not in table:
        raise ValueError("no id is empty; add a line such as 0: empty")
    return ClassSet(str(path), table, len(table))

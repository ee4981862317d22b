"""What the label names of segmenters mean: an editable table from names to the 12 classes."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, class_id
from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.core.files import load_plain_yaml, read_bytes

TABLE = Path(__file__).parent / "data" / "label_names.yaml"
NOTHING = "nothing"  # In place of a class: outdoor things, which vote for none.
MAX_BYTES = 1 << 20
_ENDINGS = re.compile(r" (merged|stuff|other)$")


@dataclass(frozen=True, eq=False)
class LabelClasses:
    """The labels of one model as classes.

    ``matrix`` float32 [C, 12] carries probabilities of C labels to classes; a label that votes for
    nothing has a row of zeros. ``unknown`` are the names that the table does not hold.
    """

    matrix: np.ndarray
    unknown: tuple[str, ...]


def label_classes(names: Sequence[str], table: Mapping[str, int | None]) -> LabelClasses:
    """Return what a model's labels mean, told by their names alone.

    Example:
        >>> found = label_classes(["windowpane, window", "sky-other-merged", "gizmo"], read_table())
        >>> int(found.matrix[0].argmax()), float(found.matrix[1].sum()), found.unknown
        (4, 0.0, ('gizmo',))
    """
    matrix = np.zeros((len(names), CLASS_COUNT), np.float32)
    unknown = []
    for row, name in enumerate(names):
        known = [key for key in _keys(name) if key in table]
        if not known:
            unknown.append(name.strip())
        elif (found := table[known[0]]) is not None:
            matrix[row, found] = 1
    return LabelClasses(matrix, tuple(unknown))


def read_table(own: str | Path = "") -> dict[str, int | None]:
    """Return the class of each name, None for what votes for nothing.

    Args:
        own: a file of the user's, whose names come before those that are shipped.

    Raises:
        InputError: there is no such file. DamagedFileError: it is no such table.
    """
    return {**_shipped(), **(_read(Path(own)) if own else {})}


def _keys(name: str) -> list[str]:
    """Return what a label may be found by: as a whole, then word by word of its synonyms."""
    return [_plain(name), *map(_plain, re.split(r"[,;]", name))]


def _plain(name: str) -> str:
    plain = " ".join(re.sub(r"[-_/\s]+", " ", name.lower()).split())
    while plain != (shorter := _ENDINGS.sub("", plain)):
        plain = shorter
    return plain


@cache
def _shipped() -> dict[str, int | None]:
    return _read(TABLE)


def _read(path: Path) -> dict[str, int | None]:
    try:
        raw = load_plain_yaml(read_bytes(path, MAX_BYTES))
    except ValueError as error:
        raise DamagedFileError(path, f"is not valid YAML ({error})") from None
    rows = raw if isinstance(raw, dict) else {}
    table: dict[str, int | None] = {}
    for key, names in rows.items():
        if key not in (*CLASS_NAMES[1:], NOTHING):
            error = UnknownNameError("class", str(key), (*CLASS_NAMES[1:], NOTHING))
            raise DamagedFileError(path, str(error))
        if not isinstance(names, list):
            raise DamagedFileError(path, f"the entry {key!r} must be a list of label names")
        table |= {_plain(str(name)): None if key == NOTHING else class_id(key) for name in names}
    if not table:
        raise DamagedFileError(
            path, "must map classes to label names, such as chair: [stool, armchair]"
        )
    return table

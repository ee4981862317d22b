"""The editable table that maps label names of segmentation models to the 12 classes."""

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
    """The mapping of a model's labels to classes.

    Attributes:
        matrix: Matrix that converts probabilities of C labels to classes, float32 [C, 12]; rows of
            labels without class are 0.
        unknown: Label names that the table does not contain.
    """

    matrix: np.ndarray
    unknown: tuple[str, ...]


def label_classes(names: Sequence[str], table: Mapping[str, int | None]) -> LabelClasses:
    """Map the labels of a model to classes by their names.

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
    """Return the class of each label name, or None for names that do not vote.

    Args:
        own: Path of a user's table, whose names take precedence over the built-in table.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid table.
    """
    return {**_shipped(), **(_read(Path(own)) if own else {})}


def _keys(name: str) -> list[str]:
    """Return the lookup keys of a label: the whole name, then the words of its synonyms."""
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

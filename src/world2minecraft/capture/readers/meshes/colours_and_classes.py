"""Colours and semantic classes of a mesh or point cloud, from columns and names in its file.

A file ``NAME.classes.json`` next to ``NAME.ply`` maps label numbers to class names:
``{"5": "chair", "7": "table"}``. Without that file, a column ``label`` is read as NYU40 labels, as
in ScanNet. Other label columns are read as World2Minecraft class ids if no value exceeds 11, and as
NYU40 labels otherwise.
"""

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from world2minecraft.core.archives import AnyPath
from world2minecraft.core.classes import CLASS_DISPLAY_NAMES, CLASS_NAMES, UNKNOWN, class_id
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_json
from world2minecraft.core.vocabulary import nyu40_classes

TABLE = Path(__file__).parent / "data" / "names.json"
MAX_LABEL_ID = 65535
MAX_MAP_BYTES = 1 << 20
COLOUR_COLUMNS = (
    ("red", "green", "blue"),
    ("r", "g", "b"),
    ("diffuse_red", "diffuse_green", "diffuse_blue"),
)
SPLAT_COLUMNS = ("f_dc_0", "f_dc_1", "f_dc_2")
SH_C0 = 0.28209479177387814  # Of the constant spherical harmonic, in which splats store it.


@lru_cache(maxsize=1)
def _tables() -> dict[str, dict[str, str]]:
    return read_json(TABLE)


def class_of_name(name: str) -> int:
    """Return the class id for an object name such as ``Wall0`` or ``office_chair.001``.

    The class id is 255 if the name contains no known word.

    Example:
        >>> [class_of_name(name) for name in ("Wall_3", "armchair.002", "Mesh 7", "ceiling_1.txt")]
        [3, 5, 255, 1]
    """
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    words = [word.lower() for word in re.findall(r"[A-Za-z]+", spaced)]
    known = _tables()["names"]
    for length in (2, 1):
        for start in range(len(words) - length, -1, -1):
            found = known.get("_".join(words[start : start + length]))
            if found:
                return class_id(found)
    return UNKNOWN


def identity_classes() -> np.ndarray:
    """Return a uint8 [256] table that maps class ids to themselves and other values to 255."""
    classes = np.full(256, UNKNOWN, np.uint8)
    classes[: len(CLASS_NAMES)] = np.arange(len(CLASS_NAMES))
    return classes


def classes_of_label_ids(
    path: AnyPath, column: str, values: np.ndarray
) -> tuple[np.ndarray | None, str]:
    """Convert the label numbers of a file to class ids.

    Args:
        path: The mesh or point cloud file; its class map is searched for next to it.
        column: Name of the label column in the file.
        values: Label numbers, shape [N].

    Returns:
        The class ids as uint8 [N], or None if the labels are unknown, and a note about the mapping.

    Raises:
        CaptureError: If the class map next to the file is not valid.
    """
    numbers = np.nan_to_num(
        np.asarray(values, np.float64), nan=MAX_LABEL_ID, posinf=MAX_LABEL_ID, neginf=MAX_LABEL_ID
    )
    numbers = np.where((numbers < 0) | (numbers > MAX_LABEL_ID), MAX_LABEL_ID, numbers).astype(
        np.int64
    )
    map_path = path.parent / f"{path.stem}.classes.json"
    if map_path.is_file():
        return _classes_from_map(map_path)[numbers], f"classes are mapped by {map_path.name}"
    known = numbers[(numbers != MAX_LABEL_ID) & (numbers != UNKNOWN)]
    if not len(known):
        return None, ""
    largest, has_unknown = int(known.max()), bool((numbers == UNKNOWN).any())
    if largest < len(CLASS_NAMES) and (column != "label" or has_unknown):
        return identity_classes()[
            np.minimum(numbers, 255)
        ], f"column {column} is read as World2Minecraft class ids"
    if largest <= 40:
        note = f"column {column} is read as NYU40 labels"
        return nyu40_classes()[numbers], note
    note = f"column {column} contains unknown label numbers up to {largest}"
    return None, f"{note}; map them in {map_path.name}"


def _classes_from_map(map_path: AnyPath) -> np.ndarray:
    table = read_json(map_path, MAX_MAP_BYTES)
    classes = np.full(MAX_LABEL_ID + 1, UNKNOWN, np.uint8)
    if not isinstance(table, dict):
        raise CaptureError(
            map_path,
            'must be a JSON object that maps label numbers to class names, such as {"5": "chair"}',
        )
    for number, name in table.items():
        found = class_of_name(str(name))
        if not re.fullmatch("[0-9]{1,9}", number) or int(number) > MAX_LABEL_ID:
            raise CaptureError(
                map_path,
                f"contains the label {number[:20]!r}; labels must be integers from 0 to "
                f"{MAX_LABEL_ID}",
            )
        if found == UNKNOWN and str(name) != "unknown":
            raise CaptureError(
                map_path,
                f"contains the unknown class name {str(name)[:40]!r}; known names: "
                f"{', '.join(CLASS_DISPLAY_NAMES[1:])}",
            )
        classes[int(number)] = found
    return classes


def colours_of_columns(columns: Mapping[str, np.ndarray]) -> np.ndarray | None:
    """Return the colours in a file's columns as uint8 [N, 3], or None if it has no colour columns.

    The value range (0 to 1, 0 to 255 or 0 to 65535) is inferred from the maximum.
    """
    for names in COLOUR_COLUMNS:
        if all(name in columns for name in names):
            return to_uint8_colours(np.stack([columns[name] for name in names], axis=1))
    if all(name in columns for name in SPLAT_COLUMNS):
        mixed = np.stack([columns[name] for name in SPLAT_COLUMNS], axis=1)
        return np.clip((0.5 + SH_C0 * mixed) * 255 + 0.5, 0, 255).astype(np.uint8)
    return None


def colours_or_black(values: np.ndarray) -> np.ndarray:
    """Convert colours to uint8 [N, 3] as ``to_uint8_colours`` does; colours of 0 stay black."""
    found = to_uint8_colours(values)
    return np.zeros(values.shape, np.uint8) if found is None else found


def to_uint8_colours(values: np.ndarray) -> np.ndarray | None:
    """Convert colours of any common value range to uint8 [N, 3].

    Returns:
        The colours, or None if all values are 0.
    """
    if values.dtype == np.uint8:
        return np.ascontiguousarray(values)
    finite = np.nan_to_num(values.astype(np.float32))
    largest = float(finite.max(initial=0))
    if largest <= 0:
        return None
    share = 255.0 if largest <= 1.0 else 1.0 if largest <= 255 else 255 / 65535
    return np.clip(finite * np.float32(share) + np.float32(0.5), 0, 255).astype(np.uint8)

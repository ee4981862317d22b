"""Colours and classes of a mesh or point cloud, from the columns and names in its file.

``NAME.classes.json`` beside ``NAME.ply`` maps label numbers to names:
``{"5": "chair", "7": "table"}``. Without one, ``label`` is taken to be of NYU40, as ScanNet's is;
other columns to be our own ids where none is over 11, else of NYU40.
"""

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from world2minecraft.capture.readers.datasets.nyu40_labels import nyu40_classes
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN, class_id
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_json

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
    """Return the class of a thing's name, such as ``Wall0``, ``office_chair.001``, or 255.

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
    """Return uint8 [256]: our own ids as they are, 255 beyond."""
    classes = np.full(256, UNKNOWN, np.uint8)
    classes[: len(CLASS_NAMES)] = np.arange(len(CLASS_NAMES))
    return classes


def classes_of_label_ids(
    path: AnyPath, column: str, values: np.ndarray
) -> tuple[np.ndarray | None, str]:
    """Return uint8 classes of a file's label numbers, and a note on how.

    Args:
        path: the file.
        column: what the file calls them.
        values: [N] numbers.

    Raises:
        CaptureError: the map next to the file cannot be used.
    """
    numbers = np.nan_to_num(
        np.asarray(values, np.float64), nan=MAX_LABEL_ID, posinf=MAX_LABEL_ID, neginf=MAX_LABEL_ID
    )
    numbers = np.where((numbers < 0) | (numbers > MAX_LABEL_ID), MAX_LABEL_ID, numbers).astype(
        np.int64
    )
    map_path = path.parent / f"{path.stem}.classes.json"
    if map_path.is_file():
        return _classes_from_map(map_path)[numbers], f"classes are told by {map_path.name}"
    known = numbers[(numbers != MAX_LABEL_ID) & (numbers != UNKNOWN)]
    if not len(known):
        return None, ""
    largest, has_unknown = int(known.max()), bool((numbers == UNKNOWN).any())
    if largest < len(CLASS_NAMES) and (column not in ("label",) or has_unknown):
        return identity_classes()[
            np.minimum(numbers, 255)
        ], f"column {column} is read as our class ids"
    if largest <= 40:
        note = f"column {column} is read as NYU40 numbers"
        return nyu40_classes()[numbers], note
    note = f"column {column} holds numbers up to {largest}, which are not known"
    return None, f"{note}: map them in {map_path.name}"


def _classes_from_map(map_path: AnyPath) -> np.ndarray:
    table = read_json(map_path, MAX_MAP_BYTES)
    classes = np.full(MAX_LABEL_ID + 1, UNKNOWN, np.uint8)
    if not isinstance(table, dict):
        raise CaptureError(map_path, 'must map numbers to names, such as {"5": "chair"}')
    for number, name in table.items():
        found = class_of_name(str(name))
        if not number.isascii() or not number.isdecimal() or int(number) > MAX_LABEL_ID:
            raise CaptureError(
                map_path, f"maps {number[:20]!r}, which is no number up to {MAX_LABEL_ID}"
            )
        if found == UNKNOWN and str(name) != "unknown":
            raise CaptureError(
                map_path, f"names {str(name)[:40]!r}; known are {', '.join(CLASS_NAMES[1:])}"
            )
        classes[int(number)] = found
    return classes


def colours_of_columns(columns: Mapping[str, np.ndarray]) -> np.ndarray | None:
    """Return uint8 [N, 3] of columns that hold colours, or None.

    Whole numbers up to 255, or up to 65535 (LAS, PTS of some scanners), and shares up to 1 are
    distinguished by their maximum.
    """
    for names in COLOUR_COLUMNS:
        if all(name in columns for name in names):
            return to_uint8_colours(np.stack([columns[name] for name in names], axis=1))
    if all(name in columns for name in SPLAT_COLUMNS):
        mixed = np.stack([columns[name] for name in SPLAT_COLUMNS], axis=1)
        return np.clip((0.5 + SH_C0 * mixed) * 255 + 0.5, 0, 255).astype(np.uint8)
    return None


def to_uint8_colours(values: np.ndarray) -> np.ndarray | None:
    """Return uint8 [N, 3] of colours in any of the usual ranges; None where all is black."""
    if values.dtype == np.uint8:
        return np.ascontiguousarray(values)
    finite = np.nan_to_num(values.astype(np.float32))
    largest = float(finite.max(initial=0))
    if largest <= 0:
        return None
    share = 255.0 if largest <= 1.0 else 1.0 if largest <= 255 else 255 / 65535
    return np.clip(finite * np.float32(share) + np.float32(0.5), 0, 255).astype(np.uint8)

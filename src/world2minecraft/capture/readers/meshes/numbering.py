"""Label numbers of a file to our classes: a map beside it, else the numbering that fits.

``NAME.classes.json`` beside ``NAME.ply`` maps numbers to names: ``{"5": "chair", "7": "table"}``.
Without one, ``label`` is taken to be of NYU40, as ScanNet's is; other columns to be our own ids
where none is over 11, of S3DIS's 13 where none is over 12, else of NYU40.
"""

import numpy as np

from world2minecraft.capture.readers.datasets.nyu40_labels import nyu40_classes
from world2minecraft.capture.readers.meshes.naming import class_of_name, own_classes
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_json

MOST = 65535
MAX_MAP_BYTES = 1 << 20


def classes_of_numbers(
    place: AnyPath, column: str, values: np.ndarray
) -> tuple[np.ndarray | None, str]:
    """Return uint8 classes of a file's label numbers, and the sentence that tells how.

    Args:
        place: the file.
        column: what the file calls them.
        values: [N] numbers.

    Raises:
        CaptureError: the map beside the file cannot be used.
    """
    numbers = np.nan_to_num(np.asarray(values, np.float64), nan=MOST, posinf=MOST, neginf=MOST)
    numbers = np.where((numbers < 0) | (numbers > MOST), MOST, numbers).astype(np.int64)
    beside = place.parent / f"{place.stem}.classes.json"
    if beside.is_file():
        return _from_map(beside)[numbers], f"classes are told by {beside.name}"
    known = numbers[(numbers != MOST) & (numbers != UNKNOWN)]
    if not len(known):
        return None, ""
    most, has_unknown = int(known.max()), bool((numbers == UNKNOWN).any())
    if most < len(CLASS_NAMES) and (column not in ("label",) or has_unknown):
        return own_classes()[np.minimum(numbers, 255)], f"column {column} is read as our class ids"
    if most <= 40:
        said = f"column {column} is read as NYU40 numbers"
        return nyu40_classes()[numbers], said
    said = f"column {column} holds numbers up to {most}, which are not known"
    return None, f"{said}: map them in {beside.name}"


def _from_map(beside: AnyPath) -> np.ndarray:
    table = read_json(beside, MAX_MAP_BYTES)
    classes = np.full(MOST + 1, UNKNOWN, np.uint8)
    if not isinstance(table, dict):
        raise CaptureError(beside, 'must map numbers to names, such as {"5": "chair"}')
    for number, name in table.items():
        found = class_of_name(str(name))
        if not number.isascii() or not number.isdecimal() or int(number) > MOST:
            raise CaptureError(beside, f"maps {number[:20]!r}, which is no number up to {MOST}")
        if found == UNKNOWN and str(name) != "unknown":
            raise CaptureError(
                beside, f"names {str(name)[:40]!r}; known are {', '.join(CLASS_NAMES[1:])}"
            )
        classes[int(number)] = found
    return classes

"""Classes by the names and the numbers that others use for them."""

import re
from functools import lru_cache
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN, class_id
from world2minecraft.core.files import read_json

TABLE = Path(__file__).parent / "data" / "names.json"


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


def own_classes() -> np.ndarray:
    """Return uint8 [256]: our own ids as they are, 255 beyond."""
    classes = np.full(256, UNKNOWN, np.uint8)
    classes[: len(CLASS_NAMES)] = np.arange(len(CLASS_NAMES))
    return classes

"""Validation of numbers and names in layout files of other programs."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.readers.meshes.colours_and_classes import class_of_name
from world2minecraft.core.classes import STRUCTURE_CLASSES, UNKNOWN, SemanticClass
from world2minecraft.core.types import Layout, LayoutObject

FARTHEST_M = 1000.0  # From a corner of the room; farther is an error of units.
MAX_SCENES = 100_000
MAX_OBJECTS = 1000  # Of a scene, whose pairs are compared.
MAX_CORNERS = 1000
MAX_NAME_CHARACTERS = 80
USUAL_HEIGHT_M = 2.6  # Of a room without a stated height.
_UNIT = re.compile(r"\s*(px|m|met(?:er|re)s?|degrees?|deg|°)?\s*;?\s*$")


@dataclass(frozen=True)
class Box:
    """An object as given in a layout file.

    Attributes:
        name: The name.
        center_m: The centre in metres.
        size_m: The size in metres: front to back, side to side, height.
        yaw_deg: The direction of the front in degrees.
    """

    name: str
    center_m: tuple[float, float, float]
    size_m: tuple[float, float, float]
    yaw_deg: float


def number(value: Any, what: str) -> float:
    """Convert a value to a finite number, also from a string with a unit such as ``40px``.

    Raises:
        ValueError: If the value is not a finite number.

    Example:
        >>> number("40px", "width"), number(1, "width")
        (40.0, 1.0)
    """
    if isinstance(value, str):
        value = _UNIT.sub("", value.strip(), count=1)
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError(f"{what} must be a number, got {type(value).__name__}")
    try:
        found = float(value)
    except (ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise ValueError(f"{what} must be a finite number")
    return found


def why(error: BaseException) -> str:
    """Return the description of one of ``core.errors.MALFORMED``.

    Example:
        >>> why(KeyError("length")), why(ValueError("has no size")), why(IndexError("out of range"))
        ("'length' is missing", 'has no size', 'invalid structure (out of range)')
    """
    if isinstance(error, KeyError):
        return f"{error} is missing"
    return str(error) if isinstance(error, ValueError) else f"invalid structure ({error})"


def clean_name(value: Any) -> str:
    """Return a printable name, or ``object`` if there is none."""
    text = value if isinstance(value, str) else ""
    shown = "".join(letter for letter in text if letter.isprintable()).strip()
    return shown[:MAX_NAME_CHARACTERS] or "object"


def class_of(name: str) -> int:
    """Return the class of an object by its name, or ``objs`` if the name is unknown.

    Example:
        >>> [class_of(name) for name in ("double_bed", "tv_stand", "Desk_2", "samovar")]
        [6, 10, 8, 11]
    """
    found = class_of_name(name)
    return int(SemanticClass.OBJS) if found == UNKNOWN else found


def object_of(box: Box) -> LayoutObject:
    """Convert a box to a layout object.

    Raises:
        ValueError: If the box is part of the building structure, has no size, or is too far away.
    """
    kind = class_of(box.name)
    if kind in STRUCTURE_CLASSES:
        raise ValueError("part of the building structure")
    if min(box.size_m) <= 0:
        raise ValueError(f"box side of {min(box.size_m):g} m is too short")
    if max(map(abs, (*box.center_m, *box.size_m))) > FARTHEST_M:
        raise ValueError(f"extends farther than {FARTHEST_M:g} m from the origin")
    return LayoutObject(
        kind, np.array(box.center_m), np.array(box.size_m), box.yaw_deg % 360, box.name
    )


def checked_count(items: Any, most: int, what: str) -> list[Any]:
    """Return a list of at most ``most`` items.

    Raises:
        ValueError: If the value is not a list, or has too many items.
    """
    if not isinstance(items, list):
        raise ValueError(f"{what} must be a list, got {type(items).__name__}")
    if len(items) > most:
        raise ValueError(f"{len(items):,} {what} exceed the limit of {most:,}")
    return items


def rectangle(x_m: float, y_m: float, height_m: float, name: str = "") -> Layout:
    """Return a rectangular room with a corner at the origin.

    Raises:
        ValueError: If a side is not positive or is too long.
    """
    if not (0 < x_m <= FARTHEST_M and 0 < y_m <= FARTHEST_M and 0 < height_m <= FARTHEST_M):
        raise ValueError(f"room size {x_m:g} x {y_m:g} x {height_m:g} m is out of range")
    corners = np.array([[0, 0], [x_m, 0], [x_m, y_m], [0, y_m]], np.float64)
    return Layout(corners, height_m, name=name)


def height_over(objects: Iterable[LayoutObject]) -> float:
    """Return a height for a room without one: the default, or the height of its tallest object."""
    tops = [float(item.center_m[2] + item.size_m[2] / 2) for item in objects]
    return round(max([USUAL_HEIGHT_M, *tops]), 4)

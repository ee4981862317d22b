"""What all formats share: numbers and names of others, looked at before they are used."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.readers.meshes.colours_and_classes import class_of_name
from world2minecraft.core.classes import STRUCTURE_CLASSES, UNKNOWN, SemanticClass
from world2minecraft.core.types import Layout, LayoutObject

FARTHEST_M = 1000.0  # From a room's corner; farther is a slip of units.
MAX_SCENES = 100_000
MAX_OBJECTS = 1000  # Of a scene: pairs of them are looked at.
MAX_CORNERS = 1000
MAX_NAME_CHARACTERS = 80
USUAL_HEIGHT_M = 2.6  # Of a room that does not say.
READ_ERRORS = (KeyError, TypeError, ValueError, AttributeError, IndexError)  # Of wrong contents.
_UNIT = re.compile(r"\s*(px|m|met(?:er|re)s?|degrees?|deg|°)?\s*;?\s*$")


@dataclass(frozen=True)
class Box:
    """An object as a format gives it: centre and own sizes in metres, where its front looks."""

    name: str
    center_m: tuple[float, float, float]
    size_m: tuple[float, float, float]  # front to back, side, height
    yaw_deg: float


def number(value: Any, what: str) -> float:
    """Return a finite number, also of a text such as ``40px``.

    Raises:
        ValueError: it is none.

    Example:
        >>> number("40px", "width"), number(1, "width")
        (40.0, 1.0)
    """
    if isinstance(value, str):
        value = _UNIT.sub("", value.strip(), count=1)
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise ValueError(f"{what} is {type(value).__name__}, not a number")
    try:
        found = float(value)
    except (ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise ValueError(f"{what} is no finite number")
    return found


def why(error: BaseException) -> str:
    """Return what is wrong with contents, of one of ``READ_ERRORS``.

    Example:
        >>> why(KeyError("length")), why(ValueError("has no size")), why(IndexError("out of range"))
        ("has no 'length'", 'has no size', 'is not of the form (out of range)')
    """
    if isinstance(error, KeyError):
        return f"has no {error}"
    return str(error) if isinstance(error, ValueError) else f"is not of the form ({error})"


def clean_name(value: Any) -> str:
    """Return a name that can be shown; ``object`` for none."""
    text = value if isinstance(value, str) else ""
    shown = "".join(letter for letter in text if letter.isprintable()).strip()
    return shown[:MAX_NAME_CHARACTERS] or "object"


def class_of(name: str) -> int:
    """Return the class of a thing by its name, ``objs`` for one that nobody knows.

    Example:
        >>> [class_of(name) for name in ("double_bed", "tv_stand", "Desk_2", "samovar")]
        [6, 10, 8, 11]
    """
    found = class_of_name(name)
    return int(SemanticClass.OBJS) if found == UNKNOWN else found


def object_of(box: Box) -> LayoutObject:
    """Return a box as an object.

    Raises:
        ValueError: it is structure, has no size, or lies beyond all rooms.
    """
    kind = class_of(box.name)
    if kind in STRUCTURE_CLASSES:
        raise ValueError("is structure")
    if min(box.size_m) <= 0:
        raise ValueError(f"has a side of {min(box.size_m):g} m")
    if max(map(abs, (*box.center_m, *box.size_m))) > FARTHEST_M:
        raise ValueError(f"reaches over {FARTHEST_M:g} m")
    return LayoutObject(
        kind, np.array(box.center_m), np.array(box.size_m), box.yaw_deg % 360, box.name
    )


def checked_count(items: Any, most: int, what: str) -> list[Any]:
    """Return a list of at most ``most`` items. Raises ValueError."""
    if not isinstance(items, list):
        raise ValueError(f"{what} must be a list, not {type(items).__name__}")
    if len(items) > most:
        raise ValueError(f"has {len(items):,} {what}; at most {most:,} are read")
    return items


def rectangle(x_m: float, y_m: float, height_m: float, name: str = "") -> Layout:
    """Return a room from the frame's origin. Raises ValueError where a side is not above 0."""
    if not (0 < x_m <= FARTHEST_M and 0 < y_m <= FARTHEST_M and 0 < height_m <= FARTHEST_M):
        raise ValueError(f"a room of {x_m:g} x {y_m:g} x {height_m:g} m is none")
    corners = np.array([[0, 0], [x_m, 0], [x_m, y_m], [0, y_m]], np.float64)
    return Layout(corners, height_m, name=name)


def height_over(objects: Iterable[LayoutObject]) -> float:
    """Return a height for a room that says none: the usual one, or as high as things reach."""
    tops = [float(item.center_m[2] + item.size_m[2] / 2) for item in objects]
    return round(max([USUAL_HEIGHT_M, *tops]), 4)

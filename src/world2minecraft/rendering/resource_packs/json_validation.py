"""Validation of values in a resource pack's JSON files, with descriptive ``ValueError`` messages.

Readers of pack files append these errors to ``problems`` and continue.
"""

import math
import re
from typing import Any

_NAMESPACE = re.compile(r"[a-z0-9_.-]+")
_PATH = re.compile(r"[a-z0-9_./-]+")
MAX_NAME_LENGTH = 200  # Letters of a resource's name; the game's longest has about 60.


def as_object(value: Any, what: str) -> dict[str, Any]:
    """Return ``value`` if it is a JSON object, else raise ValueError."""
    if not isinstance(value, dict):
        raise ValueError(f"{what} must be an object, got {describe_value(value)}")
    return value


def as_list(value: Any, what: str, most: int) -> list[Any]:
    """Return ``value`` if it is a list of at most ``most`` items, else raise ValueError."""
    if not isinstance(value, list):
        raise ValueError(f"{what} must be a list, got {describe_value(value)}")
    if len(value) > most:
        raise ValueError(f"{what} has {len(value):,} items, the limit is {most:,}")
    return value


def as_number(value: Any, what: str, low: float = -1e6, high: float = 1e6) -> float:
    """Return ``value`` as a float if it is a number from ``low`` to ``high``."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{what} must be a number, got {describe_value(value)}")
    if not (math.isfinite(value) if isinstance(value, float) else abs(value) < 1e9):
        raise ValueError(f"{what} must be a finite number")
    if not low <= value <= high:
        raise ValueError(f"{what} must be {low:g} to {high:g}, got {value:g}")
    return float(value)


def as_numbers(
    value: Any, what: str, count: int, low: float = -1e6, high: float = 1e6
) -> list[float]:
    """Return ``value`` as a list of ``count`` numbers from ``low`` to ``high``."""
    items = as_list(value, what, most=count)
    if len(items) != count:
        raise ValueError(f"{what} must have {count} numbers, got {len(items)}")
    return [as_number(item, what, low, high) for item in items]


def as_quarter_turn(value: Any, what: str) -> int:
    """Return ``value`` as 0, 90, 180 or 270 if it is a multiple of 90."""
    angle = as_number(value, what)
    if angle % 90:
        raise ValueError(f"{what} must be a multiple of 90, got {angle:g}")
    return int(angle) % 360


def as_text(value: Any, what: str) -> str:
    """Return ``value`` if it is a string."""
    if not isinstance(value, str):
        raise ValueError(f"{what} must be a string, got {describe_value(value)}")
    return value


def parse_resource_name(name: str, what: str) -> tuple[str, str]:
    """Return (namespace, path) of a resource name such as ``minecraft:block/stone``.

    Raises:
        ValueError: If the name is invalid, or if its path leads out of the pack.

    Example:
        >>> parse_resource_name("block/stone", "the model")
        ('minecraft', 'block/stone')
    """
    space, colon, path = name.rpartition(":")
    space = space if colon and space else "minecraft"
    right = len(name) <= MAX_NAME_LENGTH and _NAMESPACE.fullmatch(space) and _PATH.fullmatch(path)
    if not right or any(part in ("", ".", "..") for part in (space, *path.split("/"))):
        raise ValueError(
            f"{what} must be a resource name such as minecraft:block/stone, "
            f"got {describe_value(name)}"
        )
    return space, path


def describe_value(value: Any) -> str:
    """Return a short description of any value for an error message."""
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    words = repr(value[:50] if isinstance(value, str) else value)
    return words if len(words) <= 60 else words[:57] + "..."

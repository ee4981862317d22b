"""Pickles of others, read without running anything: a pickle is a program, and may be hostile.

Python's unpickler calls whatever a pickle names. This one knows some fifty operations on a stack,
and of names only those by which numpy's arrays and numbers are made; they stand for values of
ours, so that no foreign byte reaches numpy but as the content of an array whose size was checked.
"""

import pickletools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, reason_of
from world2minecraft.core.files import read_bytes
from world2minecraft.minecraftocc.formats.stack import Array, Machine, Refusal

MAX_BYTES = 512 << 20  # A scene of 220 x 220 x 90 cells with float64 centres takes 105 MB.
MAX_OPERATIONS = 200_000  # A frame takes about a hundred.
_BROKEN = (ValueError, TypeError, KeyError, IndexError, OverflowError, MemoryError, AttributeError)


def read_pickle(path: str | Path, limit_bytes: int = MAX_BYTES) -> dict[str, Any]:
    """Read a pickled dict of arrays, texts, numbers and lists of them.

    Arrays are ndarrays that may be written to; tuples come back as lists.

    Raises:
        InputError: it is missing. LimitError: it is too large. DamagedFileError: it is no pickle,
            or names anything but arrays and plain values.
    """
    return parse_pickle(read_bytes(path, limit_bytes), path)


def parse_pickle(data: bytes, name: object = "pickle") -> dict[str, Any]:
    """Read the bytes of a pickled dict. Raises what ``read_pickle`` raises."""
    try:
        found = _run(data)
        if not isinstance(found, dict):
            raise Refusal(f"holds a {type(found).__name__}, not a dict")
        return {_key(key): _plain(value) for key, value in found.items()}
    except Refusal as error:
        raise DamagedFileError(name, f"{error}; it is not read") from error
    except _BROKEN as error:
        words = reason_of(error, 120)
        raise DamagedFileError(name, f"is no whole pickle ({words})") from error


def _run(data: bytes) -> Any:
    machine = Machine()
    for count, (operation, argument, _) in enumerate(pickletools.genops(data)):
        if count > MAX_OPERATIONS:
            raise Refusal(f"is a program of over {MAX_OPERATIONS:,} steps")
        step: Callable[[Any], None] | None = getattr(machine, f"do_{operation.name}", None)
        if step is None:
            raise Refusal(f"is a pickle with {operation.name}, which no array needs")
        step(argument)
    return machine.result()


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise Refusal(f"has a key that is a {type(key).__name__}, not a text")
    return key


def _plain(value: Any, depth: int = 0) -> Any:
    """Return a value of ours as one of Python's or numpy's; lists lie at most three deep."""
    if isinstance(value, Array) and value.values is not None:
        return value.values
    if value is None or isinstance(value, (bool, int, float, str, bytes, np.ndarray, np.generic)):
        return value
    if isinstance(value, (list, tuple)) and depth < 3:
        return [_plain(member, depth + 1) for member in value]
    raise Refusal(f"holds a {type(value).__name__}")

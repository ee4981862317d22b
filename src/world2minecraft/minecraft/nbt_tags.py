"""The kinds of value in NBT: tags, the classes of the small numbers, how each is packed."""

import struct
from typing import Any

import numpy as np

(END, BYTE, SHORT, INT, LONG, FLOAT, DOUBLE, BYTES, STRING, LIST, COMPOUND, INTS, LONGS) = range(13)


class Byte(int):
    """A number of one byte."""


class Short(int):
    """A number of two bytes."""


class Long(int):
    """A number of eight bytes."""


class Float(float):
    """A number in single precision."""


def number_layouts(order: str) -> dict[int, tuple[struct.Struct, Any]]:
    """Return by tag how a number is packed, and what it becomes; ``order`` is ``>`` or ``<``."""
    kinds = {BYTE: ("b", Byte), SHORT: ("h", Short), INT: ("i", int), LONG: ("q", Long)}
    kinds |= {FLOAT: ("f", Float), DOUBLE: ("d", float)}
    return {tag: (struct.Struct(order + code), kind) for tag, (code, kind) in kinds.items()}


def array_layouts(order: str) -> dict[int, np.dtype]:
    """Return by tag how the numbers of an array lie; ``order`` is ``>`` or ``<``."""
    return {
        tag: np.dtype(order + code) for tag, code in ((BYTES, "i1"), (INTS, "i4"), (LONGS, "i8"))
    }

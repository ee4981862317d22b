"""Pickles as the loaders of others open them, written by hand.

In: a dict of arrays, texts, numbers and lists of them. Out: bytes of pickle protocol 3, the same
for the same values. Python's own pickler names numpy's modules as the numpy that runs it does;
numpy 2 moved them, and the loaders run on numpy 1. Here they have the old names, which both know.
"""

import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

Value = Any  # np.ndarray, str, int, float, bool, None, or a list or tuple of them.
KINDS = "biuf"  # Of arrays: truth values, whole numbers, floats.
_RECONSTRUCT = b"cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\nK\x00\x85C\x01b\x87R"
_DTYPE = b"cnumpy\ndtype\n"


def pickle_bytes(values: Mapping[str, Value]) -> bytes:
    """Return the pickle of a dict.

    Raises:
        TypeError: a value, or a member of a list, is of no kind that loaders expect.

    Example:
        >>> import pickle
        >>> pickle.loads(pickle_bytes({"name": "a", "shape": [60, 60, 36]}))
        {'name': 'a', 'shape': [60, 60, 36]}
    """
    parts = [b"\x80\x03}("]
    for name, value in values.items():
        parts += [_text(name), _value(value)]
    return b"".join([*parts, b"u."])


def _value(value: Value) -> bytes:
    if value is None:
        return b"N"
    if isinstance(value, (bool, np.bool_)):
        return b"\x88" if value else b"\x89"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (int, np.integer)):
        return _whole(int(value))
    if isinstance(value, (float, np.floating)):
        return b"G" + struct.pack(">d", float(value))
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, (list, tuple)):
        return b"](" + b"".join(_value(member) for member in value) + b"e"
    raise TypeError(f"a pickle for other loaders holds no {type(value).__name__}")


def _text(value: str) -> bytes:
    data = value.encode()
    return b"X" + struct.pack("<I", len(data)) + data


def _whole(value: int) -> bytes:
    if -(1 << 31) <= value < 1 << 31:
        return b"J" + struct.pack("<i", value)
    data = value.to_bytes(value.bit_length() // 8 + 1, "little", signed=True)
    return b"\x8a" + struct.pack("<B", len(data)) + data


def _array(values: np.ndarray) -> bytes:
    """An array is made empty, then given its shape, its dtype and its bytes in C order."""
    if values.dtype.kind not in KINDS:
        raise TypeError(f"a pickle for other loaders holds no array of {values.dtype}")
    little = values.astype(values.dtype.newbyteorder("<"), order="C", copy=False)
    data = little.tobytes()
    order = b"X\x01\x00\x00\x00" + (b"|" if little.dtype.itemsize == 1 else b"<")
    code = _text(f"{little.dtype.kind}{little.dtype.itemsize}")
    dtype = _DTYPE + code + b"\x89\x88\x87R(K\x03" + order + b"NNNJ\xff\xff\xff\xff"
    dtype += b"J\xff\xff\xff\xffK\x00tb"
    shape = b"(" + b"".join(_whole(side) for side in little.shape) + b"t"
    size = b"B" + struct.pack("<I", len(data)) + data
    return _RECONSTRUCT + b"(K\x01" + shape + dtype + b"\x89" + size + b"tb"

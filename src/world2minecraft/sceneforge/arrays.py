"""Arrays for the page: a JSON header, then each array where the header says.

``magic`` (4 bytes), u32 length of the header, the header in UTF-8 padded with spaces, then the
arrays, little-endian and in C order, each at a multiple of 8 bytes after the header. The header's
``arrays`` tells ``{name: {"dtype": "f4", "shape": [...], "offset": bytes after the header}}``.
"""

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

_ALIGN = 8


def packed_arrays(magic: bytes, told: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return the bytes of arrays and of what is told about them."""
    rows, parts, offset = {}, [], 0
    for name, values in arrays.items():
        kind = values.dtype.newbyteorder("<")
        data = np.ascontiguousarray(values, kind).tobytes()
        rows[name] = {"dtype": kind.str[1:], "shape": list(values.shape), "offset": offset}
        parts += [data, bytes(-len(data) % _ALIGN)]
        offset += len(data) + len(parts[-1])
    text = json.dumps({**told, "arrays": rows}, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-(len(text) + len(magic) + 4) % _ALIGN)
    return b"".join([magic, struct.pack("<I", len(text)), text, *parts])

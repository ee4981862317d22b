"""OpenEXR files of 32-bit floats: single-part scanlines, zip or no compression.

Written after the format's public description (openexr.com, "OpenEXR File Layout"): a header of
named attributes, a table of offsets, then blocks of 16 lines. Within a block the bytes of its
floats are parted by even and odd place, stored as differences, and deflated.
"""

import struct
import zlib
from collections.abc import Mapping

import numpy as np

MAGIC, VERSION = 20000630, 2
FLOAT = 2
NO_COMPRESSION, ZIP = 0, 3
ZIP_LINES = 16
_LEVEL = 4  # Of deflate; 9 takes four times as long and saves a twentieth.


def exr_bytes(
    channels: Mapping[str, np.ndarray],
    *,
    compress: bool = True,
    notes: Mapping[str, str] | None = None,
) -> bytes:
    """Return an EXR file of float32 channels.

    Args:
        channels: name to float32 [H, W], all of one size; depth is called ``Z``.
        compress: deflate, or raw lines.
        notes: text attributes for the header.

    Raises:
        ValueError: there is no channel, or their sizes differ.
    """
    names = sorted(channels)  # The format orders them so.
    arrays = [np.ascontiguousarray(channels[name], "<f4") for name in names]
    if not arrays or arrays[0].ndim != 2 or any(one.shape != arrays[0].shape for one in arrays):
        raise ValueError("an EXR needs float32 [H, W] channels of one size")
    height, width = arrays[0].shape
    header = _header(names, width, height, ZIP if compress else NO_COMPRESSION, notes or {})
    lines = ZIP_LINES if compress else 1
    chunks = []
    for top in range(0, height, lines):
        raw = np.stack([one[top : top + lines] for one in arrays], axis=1).tobytes()
        data = _packed(raw) if compress else raw
        chunks.append(struct.pack("<ii", top, len(data)) + data)
    sizes = [len(chunk) for chunk in chunks]
    first = len(header) + 8 * len(chunks)
    offsets = first + np.concatenate([[0], np.cumsum(sizes[:-1])]).astype("<u8")
    return header + offsets.tobytes() + b"".join(chunks)


def _header(
    names: list[str], width: int, height: int, compression: int, notes: Mapping[str, str]
) -> bytes:
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    channels = b"".join(_text(name) + struct.pack("<iB3xii", FLOAT, 0, 1, 1) for name in names)
    fixed = [
        ("channels", "chlist", channels + b"\0"),
        ("compression", "compression", bytes([compression])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        ("screenWindowCenter", "v2f", struct.pack("<ff", 0.0, 0.0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1.0)),
    ]
    texts = [(name, "string", text.encode()) for name, text in sorted(notes.items())]
    attributes = b"".join(
        _text(name) + _text(kind) + struct.pack("<i", len(value)) + value
        for name, kind, value in [*fixed, *texts]
    )
    return struct.pack("<ii", MAGIC, VERSION) + attributes + b"\0"


def _text(name: str) -> bytes:
    return name.encode("ascii") + b"\0"


def _packed(raw: bytes) -> bytes:
    """Return a block deflated, or as it is where that is no shorter."""
    data = np.frombuffer(raw, np.uint8)
    parted = np.concatenate([data[0::2], data[1::2]])
    steps = parted.copy()
    steps[1:] = parted[1:] - parted[:-1] + np.uint8(128)  # uint8 wraps round, as it must.
    packed = zlib.compress(steps.tobytes(), _LEVEL)
    return packed if len(packed) < len(raw) else raw

"""Gzip and zlib, undone within bounds; gzip written without what differs from run to run."""

import struct
import zlib
from pathlib import Path

from world2minecraft.core.errors import DamagedFileError, LimitError

MAX_BYTES = 136 << 20  # Unpacked: 67 million blocks in two bytes each.
_AT_ONCE = 1 << 20


def unpack(data: bytes, path: str | Path, limit: int = MAX_BYTES) -> bytes:
    """Undo gzip or zlib where the bytes begin so; other bytes come back as they are.

    Raises:
        DamagedFileError: the stream is broken. LimitError: it holds more than ``limit`` bytes.
    """
    if data[:2] == b"\x1f\x8b":
        kind, window = "gzip", 31
    elif len(data) >= 2 and data[0] == 0x78 and (data[0] << 8 | data[1]) % 31 == 0:
        kind, window = "zlib", 15
    else:
        return data
    stream, parts, rest = zlib.decompressobj(window), [], b""
    size = at = 0
    try:
        while not stream.eof and size <= limit:
            rest, at = (rest, at) if rest else (data[at : at + _AT_ONCE], at + _AT_ONCE)
            part = stream.decompress(rest, _AT_ONCE)
            rest = stream.unconsumed_tail
            if not part and not rest and at >= len(data):
                break
            size += len(part)
            parts = [*parts, part] if size <= _AT_ONCE else []
        if size > limit:
            raise LimitError(path, f"unpacks to more than {limit:,} bytes; at most that is read")
        if not stream.eof or stream.unused_data or at < len(data):
            where = "has bytes after its end" if stream.eof else "ends too early"
            raise DamagedFileError(path, f"its {kind} stream {where}")
        # Much of it goes into one buffer of its size: one that grows takes twice its memory.
        return b"".join(parts) if parts or not size else zlib.decompress(data, window, size)
    except zlib.error as error:
        raise DamagedFileError(path, f"is no whole {kind} stream ({error})") from error


def pack_gzip(data: bytes, level: int = 6) -> bytes:
    """Return ``data`` as gzip without a time or a name, so that the bytes depend on it alone."""
    packer = zlib.compressobj(level, zlib.DEFLATED, -15)
    body = packer.compress(data) + packer.flush()
    head = b"\x1f\x8b\x08\0\0\0\0\0\0\xff"
    return head + body + struct.pack("<II", zlib.crc32(data), len(data) & 0xFFFFFFFF)

"""The size and the texts of a PNG, read chunk by chunk without its pixels, everything bounded."""

# Not by Pillow: its PngInfo only writes texts. Its reader keeps the last of several texts with one
# keyword, where a pose told twice must be refused, unpacks all pixels to find texts behind them,
# and takes a text that does not unpack for an empty one.

import struct
import zlib
from pathlib import Path
from typing import BinaryIO, NamedTuple

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError

SIGNATURE = b"\x89PNG\r\n\x1a\n"
MOST_CHUNKS = 20_000
MOST_TEXT, MOST_TEXTS = 1 << 16, 64  # Bytes of one text, unpacked; texts of a file.
MOST_SIDE_PX = 20_000


class PngFacts(NamedTuple):
    """What a PNG says before its pixels are looked at."""

    width_px: int
    height_px: int
    texts: tuple[tuple[str, str], ...]  # keyword and text, in the order of the file


def read_png_facts(path: str | Path) -> PngFacts:
    """Read the size and the texts of a PNG.

    Raises:
        InputError: it cannot be opened. DamagedFileError: it is no PNG, or is cut short.
        LimitError: it holds more or longer texts than any screenshot.
    """
    source = Path(path)
    try:
        with source.open("rb") as stream:
            return _facts(stream, source)
    except OSError as error:
        raise InputError(source, f"cannot be read: {error.strerror or error}") from error


def _facts(stream: BinaryIO, source: Path) -> PngFacts:
    if stream.read(8) != SIGNATURE:
        raise DamagedFileError(source, "is no PNG")
    length, kind = _head(stream, source)
    if kind != b"IHDR" or length != 13:
        raise DamagedFileError(source, "is no PNG: it does not begin with its size")
    width, height = struct.unpack(">II", _body(stream, length, kind, source)[:8])
    if not (0 < width <= MOST_SIDE_PX and 0 < height <= MOST_SIDE_PX):
        raise DamagedFileError(source, f"says a size of {width}x{height} pixels")
    texts: list[tuple[str, str]] = []
    for _ in range(MOST_CHUNKS):
        length, kind = _head(stream, source)
        if kind == b"IEND":
            return PngFacts(width, height, tuple(texts))
        if kind not in (b"tEXt", b"zTXt", b"iTXt"):
            stream.seek(length + 4, 1)
            continue
        if length > MOST_TEXT or len(texts) == MOST_TEXTS:
            raise LimitError(source, f"holds more than {MOST_TEXTS} texts of {MOST_TEXT} bytes")
        texts.append(_text(kind, _body(stream, length, kind, source), source))
    raise LimitError(source, f"has more than {MOST_CHUNKS} chunks")


def _head(stream: BinaryIO, source: Path) -> tuple[int, bytes]:
    head = stream.read(8)
    if len(head) < 8:
        raise DamagedFileError(source, "is cut short")
    length, kind = struct.unpack(">I4s", head)
    if length > 1 << 31:
        raise DamagedFileError(source, "is no PNG: a chunk's length is out of range")
    return length, kind


def _body(stream: BinaryIO, length: int, kind: bytes, source: Path) -> bytes:
    data = stream.read(length + 4)
    if len(data) < length + 4:
        raise DamagedFileError(source, "is cut short")
    if zlib.crc32(kind + data[:length]) != struct.unpack(">I", data[length:])[0]:
        raise DamagedFileError(source, f"is damaged: the checksum of its {kind.decode()} is wrong")
    return data[:length]


def _text(kind: bytes, data: bytes, source: Path) -> tuple[str, str]:
    keyword, _, rest = data.partition(b"\0")
    encoding = "latin-1"
    if kind == b"zTXt":
        rest = _unpacked(rest[1:], source)
    elif kind == b"iTXt":
        packed, encoding = rest[:1] == b"\1", "utf-8"
        rest = rest[2:].partition(b"\0")[2].partition(b"\0")[2]  # Behind language and translation.
        rest = _unpacked(rest, source) if packed else rest
    return keyword.decode("latin-1"), rest.decode(encoding, "replace")


def _unpacked(data: bytes, source: Path) -> bytes:
    unpacker = zlib.decompressobj()
    try:
        text = unpacker.decompress(data, MOST_TEXT)
    except zlib.error as error:
        raise DamagedFileError(source, "is damaged: a packed text does not unpack") from error
    if unpacker.unconsumed_tail:
        raise LimitError(source, f"holds a text of more than {MOST_TEXT} bytes")
    return text

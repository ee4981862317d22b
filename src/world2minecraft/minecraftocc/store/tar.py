"""The members of a shard: ustar without owners and times, so that bytes tell of content alone.

A member is a header of 512 bytes, its data, and zeros up to the next whole 512.
"""

import re
import tarfile
from dataclasses import dataclass
from typing import BinaryIO

BLOCK = 512
RECORD = 20 * BLOCK  # A tar is so many bytes, or a multiple.
LONGEST_KEY = 90  # With ".depth.png" it is as long as the name of a ustar member may be.
MEMBER_NAME = re.compile(r"([A-Za-z0-9_-]{1,90})\.([a-z]{2,6}(?:\.[a-z]{2,6})?)")


@dataclass(frozen=True)
class Member:
    """Where the data of a member lie in a shard."""

    key: str  # "house_0001-a-000012"
    kind: str  # "jpg", "depth.png", "occ.npz" or "json"
    offset: int
    size: int

    @property
    def end(self) -> int:
        """Where the next member begins."""
        return self.offset + self.size + padding(self.size)


def padding(size: int) -> int:
    """Return how many zeros follow so many bytes of data."""
    return -size % BLOCK


def member_bytes(name: str, data: bytes) -> bytes:
    """Return a member with its header and its padding.

    Example:
        >>> len(member_bytes("a.json", b"{}"))
        1024
    """
    info = tarfile.TarInfo(name)  # Its time and owner are 0, its mode is 644.
    info.size = len(data)
    return info.tobuf(tarfile.USTAR_FORMAT) + data + bytes(padding(len(data)))


def end_bytes(length: int) -> bytes:
    """Return what ends a tar of so many bytes: two blocks of zeros, filled up to a record."""
    return bytes(2 * BLOCK + -(length + 2 * BLOCK) % RECORD)


def member_at(stream: BinaryIO, offset: int, length: int) -> Member | None:
    """Read the header at an offset of a tar that is ``length`` bytes long.

    Returns None where there is no whole member of ours: at the end, or where bytes are damaged.
    """
    stream.seek(offset)
    block = stream.read(BLOCK)
    if len(block) < BLOCK:
        return None
    try:
        info = tarfile.TarInfo.frombuf(block, "ascii", "strict")
    except (tarfile.HeaderError, ValueError):
        return None
    name = MEMBER_NAME.fullmatch(info.name)
    if name is None or not info.isreg() or info.size < 0:
        return None
    member = Member(name[1], name[2], offset + BLOCK, info.size)
    return member if member.end <= length else None

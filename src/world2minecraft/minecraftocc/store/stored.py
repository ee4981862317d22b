"""The samples of a shard, found by their headers and their JSON; pictures are skipped over."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, BinaryIO

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.minecraftocc.store.sample_files import FACTS, MAX_FACTS_BYTES, read_facts
from world2minecraft.minecraftocc.store.tar import Member, member_at

_MOST_MEMBERS = 8
_CHUNK = 1 << 20


@dataclass(frozen=True, eq=False)
class StoredSample:
    """A sample in a shard: where it lies, and what its JSON tells."""

    key: str
    offset: int
    size: int
    members: tuple[Member, ...]
    facts: dict[str, Any]
    facts_sha256: str


def stored_samples(stream: BinaryIO, length: int, checked: bool = False) -> Iterator[StoredSample]:
    """Give the whole samples from the start of a shard, up to its end or the first that is not.

    Args:
        stream: the shard or its part.
        length: its size in bytes.
        checked: whether the sums of all members are compared, not of their JSON alone.
    """
    offset = 0
    while (sample := _sample_at(stream, offset, length)) is not None:
        if checked and not is_right(stream, sample):
            return
        yield sample
        offset = sample.offset + sample.size


def is_right(stream: BinaryIO, sample: StoredSample) -> bool:
    """Whether the members of a sample have the sums that its JSON tells."""
    told = sample.facts.get("sha256")
    others = [member for member in sample.members if member.kind != FACTS]
    if not isinstance(told, dict) or set(told) != {member.kind for member in others}:
        return False
    return all(told[member.kind] == _sum_of(stream, member) for member in others)


def _sample_at(stream: BinaryIO, offset: int, length: int) -> StoredSample | None:
    members: list[Member] = []
    at = offset
    while len(members) < _MOST_MEMBERS:
        member = member_at(stream, at, length)
        if member is None or (members and member.key != members[0].key):
            return None
        members.append(member)
        at = member.end
        if member.kind == FACTS:
            break
    if members[-1].kind != FACTS or members[-1].size > MAX_FACTS_BYTES:
        return None
    stream.seek(members[-1].offset)
    data = stream.read(members[-1].size)
    try:
        facts = read_facts(data, members[-1].key)
    except DamagedFileError:
        return None
    if facts.get("key") != members[0].key:
        return None
    total = hashlib.sha256(data).hexdigest()
    return StoredSample(members[0].key, offset, at - offset, tuple(members), facts, total)


def _sum_of(stream: BinaryIO, member: Member) -> str:
    stream.seek(member.offset)
    digest, left = hashlib.sha256(), member.size
    while left > 0 and (data := stream.read(min(left, _CHUNK))):
        digest.update(data)
        left -= len(data)
    return digest.hexdigest()

"""The block list of a structure file: records of a place, a number and, rarely, a compound."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.jit import njit
from world2minecraft.minecraft.nbt import COMPOUND, INT, LIST, NbtReader, write_nbt
from world2minecraft.minecraft.unlabelled_volume import MISSHAPEN

_RECORD = np.dtype(
    [("pos_head", "V11"), ("pos", ">i4", 3), ("state_head", "V8"), ("state", ">i4"), ("end", "u1")]
)
_POS_HEAD = bytes([LIST, 0, 3]) + b"pos" + bytes([INT, 0, 0, 0, 3])
_STATE_HEAD = bytes([INT, 0, 5]) + b"state"
_NBT_HEAD = bytes([COMPOUND, 0, 3]) + b"nbt"
_DEPTH = 100
# The bytes of one value of each kind; -1 where the value says its length itself.
_SIZES = np.array([0, 1, 2, 4, 8, 4, 8, -1, -1, -1, -1, -1, -1], np.int64)


@dataclass(frozen=True, eq=False)
class BlockList:
    """The blocks of a structure: int32 [N, 3] places, int32 [N] numbers, compounds by number."""

    places: np.ndarray
    states: np.ndarray
    nbt: Mapping[int, Mapping[str, Any]]

    @classmethod
    def of(cls, found: Sequence[Any], path: Path) -> "BlockList":
        """Return the list that ``BlockListReader`` found, however its records are written.

        Raises:
            DamagedFileError: a record lacks its place or its number.
        """
        if len(found) == 1 and isinstance(found[0], cls):
            return found[0]
        try:
            places = [[int(value) for value in record["pos"]] for record in found]
            states = [int(record["state"]) for record in found]
            nbt = {n: dict(r["nbt"]) for n, r in enumerate(found) if "nbt" in r}
            return cls(
                np.array(places, np.int32).reshape(len(states), 3), np.array(states, np.int32), nbt
            )
        except MISSHAPEN as error:
            raise DamagedFileError(path, "has a block without place and number") from error


def block_list_bytes(
    places: np.ndarray, states: np.ndarray, nbt: Mapping[int, Mapping[str, Any]]
) -> bytes:
    """Return the NBT of a list named ``blocks``.

    Args:
        places: int [N, 3].
        states: int [N], numbers in the structure's palette.
        nbt: what block entities hold, by their number in the list.
    """
    records = np.empty(len(places), _RECORD)
    records["pos_head"], records["state_head"] = np.void(_POS_HEAD), np.void(_STATE_HEAD)
    records["pos"], records["state"], records["end"] = places, states, 0
    raw = records.tobytes()
    parts = [bytes([LIST, 0, 6]) + b"blocks" + bytes([COMPOUND]) + len(places).to_bytes(4, "big")]
    start = 0
    for number in sorted(nbt):
        end = (number + 1) * _RECORD.itemsize - 1
        parts += [raw[start:end], _NBT_HEAD, write_nbt(nbt[number])[3:]]
        start = end
    return b"".join([*parts, raw[start:]])


class BlockListReader(NbtReader):
    """Reads the root's ``blocks`` into one ``BlockList``, without an object for each block."""

    def elements(self, tag: int, count: int, depth: int) -> list[Any]:
        """Read a list's elements."""
        if tag != COMPOUND or depth != 2 or self.key != "blocks":
            return super().elements(tag, count, depth)
        is_short = count * _RECORD.itemsize > len(self.data) - self.at
        held = 0 if is_short else count
        places, states = np.empty((held, 3), np.int32), np.empty(held, np.int32)
        nbt_at = np.empty(held, np.int64)
        data = np.frombuffer(self.data, np.uint8)
        end = int(scan_blocks(data, self.at, places, states, nbt_at, _SIZES))
        if is_short or end < 0:
            super()._take(count)
            return super().elements(tag, count, depth)
        nbt: dict[int, Mapping[str, Any]] = {}
        for number in np.flatnonzero(nbt_at >= 0).tolist():
            self.at = int(nbt_at[number])
            nbt[number] = self.compound(depth + 2)
        self.at = end
        return [BlockList(places, states, nbt)]

    def _take(self, count: int) -> None:
        """Records are numbers in arrays: they do not count as values. Their bytes bound them."""
        if self.key != "blocks":
            super()._take(count)


@njit
def _int_at(data, at):  # pragma: no cover
    """Read a signed number of four bytes."""
    value = np.int64(0)
    for step in range(4):
        value = value << 8 | np.int64(data[at + step])
    return value - (value >> 31 << 32)


@njit
def skip_value(data, at, tag, sizes):  # pragma: no cover
    """Return the byte after a value of NBT of the kind ``tag``, or -1 where it is broken."""
    kinds = np.empty(_DEPTH, np.int64)  # What each open list holds, 0 for an open compound.
    left = np.empty(_DEPTH, np.int64)
    depth = 0
    while True:
        if tag < 1 or tag > 12:
            return -1
        if sizes[tag] > 0:
            at += sizes[tag]
        elif tag == 10:
            if depth == _DEPTH:
                return -1
            kinds[depth], left[depth] = 0, 0
            depth += 1
        elif at + 5 > len(data):  # A shorter one would end the data within a compound.
            return -1
        elif tag == 8:
            at += 2 + (np.int64(data[at]) << 8 | np.int64(data[at + 1]))
        elif tag == 7 or tag == 11 or tag == 12:
            count = _int_at(data, at)
            at += 4 + count * (1 if tag == 7 else 4 if tag == 11 else 8)
            if count < 0:
                return -1
        else:
            if depth == _DEPTH:
                return -1
            kinds[depth], left[depth] = data[at], _int_at(data, at + 1)
            at += 5
            if kinds[depth] == 0:
                if left[depth] > 0:
                    return -1
                kinds[depth], left[depth] = 1, 0
            depth += 1
        tag = -1
        while depth > 0 and tag < 0:
            if at >= len(data):
                return -1
            if kinds[depth - 1]:
                left[depth - 1] -= 1
                if left[depth - 1] < 0:
                    depth -= 1
                else:
                    tag = kinds[depth - 1]
                continue
            found = np.int64(data[at])
            at += 1
            if found == 0:
                depth -= 1
            elif at + 2 > len(data):
                return -1
            else:
                tag = found
                at += 2 + (np.int64(data[at]) << 8 | np.int64(data[at + 1]))
        if depth == 0:
            return at if at <= len(data) else -1


@njit
def scan_blocks(data, at, places, states, nbt_at, sizes):  # pragma: no cover
    """Read the records of a block list.

    Args:
        data: uint8 [N], NBT.
        at: where the first record begins.
        places: int32 [M, 3] out.
        states: int32 [M] out.
        nbt_at: int64 [M] out, where each block's compound begins, or -1.
        sizes: the sizes of the kinds of values.

    Returns:
        The byte after the last record, or -1 where a record is not as the game writes it.
    """
    end = len(data)
    for index in range(len(states)):
        has_place, has_state = False, False
        nbt_at[index] = -1
        while True:
            if at >= end:
                return -1
            tag = np.int64(data[at])
            at += 1
            if tag == 0:
                break
            if at + 2 > end:
                return -1
            size = np.int64(data[at]) << 8 | np.int64(data[at + 1])
            name, at = at + 2, at + 2 + size
            if at + (17 if tag == 9 else 4 if tag == 3 else 1) > end:
                return -1
            first = data[name] if size else np.uint8(0)
            if tag == 9 and size == 3 and first == 112:  # pos
                if has_place or data[at] != 3 or _int_at(data, at + 1) != 3:
                    return -1
                for axis in range(3):
                    places[index, axis] = _int_at(data, at + 5 + 4 * axis)
                at, has_place = at + 17, True
            elif tag == 3 and size == 5 and first == 115:  # state
                if has_state:
                    return -1
                states[index] = _int_at(data, at)
                at, has_state = at + 4, True
            elif tag == 10 and size == 3 and first == 110 and nbt_at[index] < 0:  # nbt
                nbt_at[index] = at
                at = skip_value(data, at, tag, sizes)
            else:
                return -1
            if at < 0:
                return -1
        if not (has_place and has_state):
            return -1
    return at

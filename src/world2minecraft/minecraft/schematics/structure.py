"""Reading and writing of the game's structure files (``.nbt``) for structure blocks and commands.

A structure lists its blocks individually, each with its position and palette index. Positions that
are not listed leave the world unchanged. The volume of a room has many thousands of blocks, so the
list is written from a template of 36 bytes per block and read by a kernel.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, LimitError, UsageError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.jit import njit
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.entities import entity_nbt
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import (
    COMPOUND,
    INT,
    LIST,
    NbtLimits,
    NbtReader,
    pack_gzip,
    unpack,
    write_nbt,
)
from world2minecraft.minecraft.rules.attached_entities import TILE, attached_block, move_attachment
from world2minecraft.minecraft.signs import upgrade_signs
from world2minecraft.minecraft.state_nbt import palette_texts, state_entry
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_FILE_BYTES,
    build_palette,
    check_size,
    invalid_file,
    own_tag,
    stated_corner,
    unlabelled_volume,
)
from world2minecraft.minecraft.versions import GameVersion, game_version

_RECORD = np.dtype(
    [("pos_head", "V11"), ("pos", ">i4", 3), ("state_head", "V8"), ("state", ">i4"), ("end", "u1")]
)
_POS_HEAD = bytes([LIST, 0, 3]) + b"pos" + bytes([INT, 0, 0, 0, 3])
_STATE_HEAD = bytes([INT, 0, 5]) + b"state"
_NBT_HEAD = bytes([COMPOUND, 0, 3]) + b"nbt"
_DEPTH = 100
# The bytes of one value of each kind; -1 where the value says its length itself.
_SIZES = np.array([0, 1, 2, 4, 8, 4, 8, -1, -1, -1, -1, -1, -1], np.int64)
LIMITS = NbtLimits()
DEFAULT_GAME = 3465  # 1.20.1, for a file that does not say its game.
MAX_PALETTES = 1000
_UNLISTED = 0xFFFF  # A palette has fewer states.
_BATCH = 1 << 18
MAX_BLOCKS = 3_000_000  # Listed one by one: 108 MB.


@dataclass(frozen=True, eq=False)
class BlockList:
    """The blocks of a structure: positions, palette indices and NBT data.

    ``places`` is int32 [N, 3], ``states`` is int32 [N], and ``nbt`` contains compounds by block
    index.
    """

    places: np.ndarray
    states: np.ndarray
    nbt: Mapping[int, Mapping[str, Any]]

    @classmethod
    def of(cls, found: Sequence[Any], path: Path) -> "BlockList":
        """Return the block list from the values that ``BlockListReader`` read.

        Raises:
            DamagedFileError: If a record lacks its position or palette index.
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
        except MALFORMED as error:
            raise DamagedFileError(path, "contains a block without position or index") from error


def block_list_bytes(
    places: np.ndarray, states: np.ndarray, nbt: Mapping[int, Mapping[str, Any]]
) -> bytes:
    """Return the NBT bytes of a list named ``blocks``.

    Args:
        places: Positions, int [N, 3].
        states: Palette indices, int [N].
        nbt: Data of block entities by index in the list.
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
    """An NBT reader that reads the ``blocks`` list into one ``BlockList`` of arrays."""

    def elements(self, tag: int, count: int, depth: int) -> list[Any]:
        """Read the elements of a list."""
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
        """Exclude block records from the limit on values, because they are stored in arrays."""
        if self.key != "blocks":
            super()._take(count)


@njit
def _int_at(data, at):  # pragma: no cover
    """Read a signed 32-bit integer."""
    value = np.int64(0)
    for step in range(4):
        value = value << 8 | np.int64(data[at + step])
    return value - (value >> 31 << 32)


@njit
def skip_value(data, at, tag, sizes):  # pragma: no cover
    """Return the offset after an NBT value of the given tag type, or -1 if the value is invalid."""
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
        data: NBT bytes, uint8 [N].
        at: Offset of the first record.
        places: Output positions, int32 [M, 3].
        states: Output palette indices, int32 [M].
        nbt_at: Output offset of each block's compound, or -1 if it has none, int64 [M].
        sizes: Size in bytes of a value of each tag type.

    Returns:
        The offset after the last record, or -1 if a record does not have the game's form.
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


Corner = tuple[int, int, int]


def write_structure(
    volume: BlockVolume,
    path: str | Path,
    *,
    version: GameVersion | None = None,
    clears: bool = True,
) -> None:
    """Write a volume of any size as one structure file.

    A structure block can load at most 48 blocks per side; ``structure_pack`` writes pieces of that
    size.

    Args:
        volume: The blocks. The corner is stored in a tag that the game ignores.
        path: The ``.nbt`` file to write.
        version: The target game version. The default is 1.20.1.
        clears: Whether air is included, so that placing the structure removes existing blocks.

    Raises:
        UsageError: If the volume is empty or has more than three million blocks to list.
        OutputError: If the file cannot be written.
    """
    write_bytes(path, structure_bytes(volume, version or game_version(), clears=clears))


def structure_bytes(volume: BlockVolume, version: GameVersion, *, clears: bool = True) -> bytes:
    """Return a volume as the bytes of a structure file.

    Args:
        volume: The blocks. The corner is stored in a tag that the game ignores.
        version: The target game version.
        clears: Whether air is included, so that placing the structure removes existing blocks.

    Raises:
        UsageError: If the volume is empty or has more than three million blocks to list.
    """
    volume = convert_volume(volume, version.data_version)
    # Bottom up, as builders do: y, then z, then x.
    cells = volume.states.transpose(1, 2, 0)
    air = volume.palette.index(AIR)
    listed = np.argwhere(np.ones_like(cells, bool) if clears else cells != air)
    if not volume.states.size or len(listed) > MAX_BLOCKS:
        raise UsageError(
            f"a structure file must have 1 to {MAX_BLOCKS:,} blocks, got {len(listed):,}; write a "
            ".schem file, a .litematic file or a world instead"
        )
    places = np.ascontiguousarray(listed[:, [2, 0, 1]]).astype(np.int32)
    states = volume.states[places[:, 0], places[:, 1], places[:, 2]]
    held = {
        tuple(np.subtract(entity.block_pos, volume.corner).tolist()): entity
        for entity in volume.block_entities
    }
    blocks = block_list_bytes(places, states, _block_nbt(places, held) if held else {})
    tree = {
        "DataVersion": version.data_version,
        "size": [int(side) for side in volume.states.shape],
        "palette": [state_entry(state, version.data_version) for state in volume.palette],
        "entities": [_entity_out(e, n, volume.corner) for n, e in enumerate(volume.entities)],
        **own_tag(volume.corner),
    }
    return pack_gzip(write_nbt(tree)[:-1] + blocks + b"\0", level=4)


def _block_nbt(
    places: np.ndarray, held: Mapping[tuple[int, ...], BlockEntity]
) -> dict[int, dict[str, Any]]:
    """Return the data of block entities by block index in the list."""
    number_of = {tuple(place): number for number, place in enumerate(places.tolist())}
    return {
        number_of[place]: {**entity.nbt, "id": entity.id}
        for place, entity in held.items()
        if place in number_of
    }


def _entity_out(entity: Entity, number: int, corner: Corner) -> dict[str, Any]:
    nbt = move_attachment(entity_nbt(entity, number), entity.position, (0, 0, 0))
    block = np.subtract(attached_block(nbt, entity.position), corner)
    place = np.subtract(entity.position, corner)
    return {"pos": place.tolist(), "blockPos": block.tolist(), "nbt": nbt}


def read_structure(
    path: str | Path, losses: Losses | None = None, *, variant: int = 0
) -> BlockVolume:
    """Read a structure file.

    Args:
        path: The file to read.
        losses: Counts of the data that a volume cannot store, updated by this call. Positions that
            the structure leaves unchanged become air, and only one of several palettes is read.
        variant: Index of the palette, if the structure has several.

    Raises:
        InputError: If the file is not found.
        DamagedFileError: If the file is not a valid structure.
        LimitError: If the file exceeds the size limit.
        UsageError: If the structure has no such palette.
    """
    source = Path(path)
    return parse_structure(read_bytes(source, MAX_FILE_BYTES), source, losses, variant=variant)


def parse_structure(
    data: bytes, source: Path, losses: Losses | None = None, *, variant: int = 0
) -> BlockVolume:
    """Read a structure from the bytes of a structure file.

    Args:
        data: The bytes of the file.
        source: The file path for error messages.
        losses: Counts of the data that a volume cannot store, updated by this call.
        variant: Index of the palette, if the structure has several.

    Raises:
        DamagedFileError: If the data is not a valid structure.
        LimitError: If the data exceeds the size limit.
        UsageError: If the structure has no such palette.
    """
    raw = unpack(data, source, LIMITS.bytes)
    _, root = BlockListReader(raw, source, LIMITS).root()
    del raw
    try:
        return _volume_of(root, source, Losses() if losses is None else losses, variant)
    except MALFORMED as error:
        raise invalid_file(source, "a valid structure file", error) from error


def _volume_of(root: Mapping[str, Any], source: Path, losses: Losses, variant: int) -> BlockVolume:
    size = check_size((int(side) for side in root["size"]), source)
    blocks = BlockList.of(root["blocks"], source)
    game = int(root.get("DataVersion", DEFAULT_GAME))
    texts = palette_texts(_palette(root, source, losses, variant), game, source)
    palette, number_of = build_palette(texts, source)
    places, numbers = blocks.places, blocks.states
    if len(numbers) and not 0 <= numbers.min() <= numbers.max() < len(texts):
        raise DamagedFileError(
            source, f"contains a block index that is not in its palette of {len(texts)} states"
        )
    if len(places) and (places.min() < 0 or (places.max(axis=0) >= size).any()):
        raise DamagedFileError(source, f"contains a block outside its declared size {size}")
    ours = np.array([number_of[text] for text in texts] or [0], np.uint16)
    states = np.full(size, _UNLISTED, np.uint16)
    for start in range(0, len(numbers), _BATCH):  # As indices, all would take much memory.
        x, y, z = places[start : start + _BATCH].T
        states[x, y, z] = ours[numbers[start : start + _BATCH]]
    losses.add("positions that the structure leaves unchanged", _put_air(states))
    corner = stated_corner(root, source) or (0, 0, 0)
    held = [_block_entity(places[n].tolist(), nbt, corner) for n, nbt in blocks.nbt.items()]
    entities = [_entity(nbt, corner) for nbt in root.get("entities", [])]
    return unlabelled_volume(states, palette, corner, upgrade_signs(held, game), entities)


def _put_air(states: np.ndarray) -> int:
    """Set unlisted positions to air and return their number."""
    count = 0
    for layer in states:
        is_unlisted = layer == _UNLISTED
        count += int(is_unlisted.sum())
        layer[is_unlisted] = 0
    return count


def _palette(
    root: Mapping[str, Any], source: Path, losses: Losses, variant: int
) -> Sequence[Mapping[str, Any]]:
    palettes = root["palettes"] if "palettes" in root else [root["palette"]]
    if not 1 <= len(palettes) <= MAX_PALETTES:
        raise LimitError(source, f"has {len(palettes)} palettes; expected 1 to {MAX_PALETTES:,}")
    if not 0 <= variant < len(palettes):
        last = len(palettes) - 1
        raise UsageError(f"variant of {source} must be 0 to {last}, got {variant}")
    losses.add("other palettes of the structure", len(palettes) - 1)
    return palettes[variant]


def _block_entity(place: list[int], nbt: Mapping[str, Any], corner: Corner) -> BlockEntity:
    x, y, z = (low + step for low, step in zip(corner, place, strict=True))
    rest = {key: nbt[key] for key in nbt if key not in ("id", "x", "y", "z")}
    return BlockEntity((x, y, z), str(nbt.get("id", "")), rest)


def _entity(held: Mapping[str, Any], corner: Corner) -> Entity:
    x, y, z = (low + float(step) for low, step in zip(corner, held["pos"], strict=True))
    nbt = dict(held["nbt"])
    if "block_pos" in nbt:
        nbt["block_pos"] = held.get("blockPos", nbt["block_pos"])
    elif TILE[0] in nbt:
        nbt |= dict(zip(TILE, map(int, held["blockPos"]), strict=True))
    rest = move_attachment(nbt, (x, y, z), corner)
    return Entity((x, y, z), str(nbt["id"]), {k: rest[k] for k in rest if k not in ("id", "Pos")})

"""Structure files of the game, ``.nbt``: what structure blocks and ``/place template`` read.

A structure lists its blocks one by one, each with its place and its number in the palette; places
that are not listed are left as they are in the world. A box of a room has many thousands, so the
list is written from a template of 36 bytes a block and read by a kernel.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, LimitError, UsageError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.block_entities import in_game
from world2minecraft.minecraft.entities import entity_nbt
from world2minecraft.minecraft.losses import Losses
from world2minecraft.minecraft.nbt import NbtLimits, pack_gzip, unpack, write_nbt
from world2minecraft.minecraft.rules.attached_entities import TILE, attached, attached_block
from world2minecraft.minecraft.schematics.block_list import (
    BlockList,
    BlockListReader,
    block_list_bytes,
)
from world2minecraft.minecraft.sign_texts import signs_of_today
from world2minecraft.minecraft.state_nbt import palette_texts, state_entry
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_FILE_BYTES,
    MISSHAPEN,
    check_size,
    own_tag,
    palette_of,
    stated_corner,
    unlabelled,
)
from world2minecraft.minecraft.versions import GameVersion, game_version

LIMITS = NbtLimits()
DEFAULT_GAME = 3465  # 1.20.1, for a file that does not say its game.
MAX_PALETTES = 1000
_UNLISTED = 0xFFFF  # A palette has fewer states.
_AT_ONCE = 1 << 18
MAX_BLOCKS = 3_000_000  # Listed one by one: 108 MB.
Corner = tuple[int, int, int]


# Writing.


def write_structure(
    volume: BlockVolume,
    path: str | Path,
    *,
    version: GameVersion | None = None,
    clears: bool = True,
) -> None:
    """Write a volume as one structure file, of any size.

    A structure block takes 48 blocks a side; ``structure_pack`` writes pieces of that size.

    Args:
        volume: the blocks; its corner is kept in a tag that the game ignores.
        path: the file, ``.nbt``.
        version: the game whose data version it carries; 1.20.1 where it is left out.
        clears: whether air is listed, so that placing it takes away what stands there.

    Raises:
        UsageError: the volume is empty or has over three million blocks to list.
        OutputError: the file cannot be written.
    """
    write_bytes(path, structure_bytes(volume, version or game_version(), clears=clears))


def structure_bytes(volume: BlockVolume, version: GameVersion, *, clears: bool = True) -> bytes:
    """Return the bytes of a structure file. Args and errors as ``write_structure``."""
    volume = in_game(volume, version.data_version)
    # Bottom up, as builders do: y, then z, then x.
    cells = volume.states.transpose(1, 2, 0)
    air = volume.palette.index(AIR)
    listed = np.argwhere(np.ones_like(cells, bool) if clears else cells != air)
    if not volume.states.size or len(listed) > MAX_BLOCKS:
        raise UsageError(
            f"a structure holds 1 to {MAX_BLOCKS:,} blocks, not {len(listed):,}; write a .schem, "
            "a .litematic or a world"
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
    """Return what the block entities hold, by the number of their block in the list."""
    number_of = {tuple(place): number for number, place in enumerate(places.tolist())}
    return {
        number_of[place]: {**entity.nbt, "id": entity.id}
        for place, entity in held.items()
        if place in number_of
    }


def _entity_out(entity: Entity, number: int, corner: Corner) -> dict[str, Any]:
    nbt = attached(entity_nbt(entity, number), entity.position, (0, 0, 0))
    block = np.subtract(attached_block(nbt, entity.position), corner)
    place = np.subtract(entity.position, corner)
    return {"pos": place.tolist(), "blockPos": block.tolist(), "nbt": nbt}


# Reading.


def read_structure(
    path: str | Path, losses: Losses | None = None, *, variant: int = 0
) -> BlockVolume:
    """Read a structure file.

    Args:
        path: the file.
        losses: told what a volume cannot hold: places that the structure leaves as they are come
            back as air, and of a structure with several palettes one is read.
        variant: which palette, where the structure has several.

    Raises:
        InputError: there is no file. DamagedFileError: it is no structure.
        LimitError: it is larger than the program reads. UsageError: it has no such variant.
    """
    source = Path(path)
    return structure_of(read_bytes(source, MAX_FILE_BYTES), source, losses, variant=variant)


def structure_of(
    data: bytes, source: Path, losses: Losses | None = None, *, variant: int = 0
) -> BlockVolume:
    """Return the volume of a structure file's bytes. Args and errors as ``read_structure``."""
    raw = unpack(data, source, LIMITS.bytes)
    _, root = BlockListReader(raw, source, LIMITS).root()
    del raw
    try:
        return _volume_of(root, source, Losses() if losses is None else losses, variant)
    except MISSHAPEN as error:
        missing = f" ({error} is missing)" if isinstance(error, KeyError) else ""
        raise DamagedFileError(source, f"is no structure file{missing}") from error


def _volume_of(root: Mapping[str, Any], source: Path, losses: Losses, variant: int) -> BlockVolume:
    size = check_size((int(side) for side in root["size"]), source)
    blocks = BlockList.of(root["blocks"], source)
    game = int(root.get("DataVersion", DEFAULT_GAME))
    texts = palette_texts(_palette(root, source, losses, variant), game, source)
    palette, number_of = palette_of(texts, source)
    places, numbers = blocks.places, blocks.states
    if len(numbers) and not 0 <= numbers.min() <= numbers.max() < len(texts):
        raise DamagedFileError(source, f"has a block that its palette of {len(texts)} lacks")
    if len(places) and (places.min() < 0 or (places.max(axis=0) >= size).any()):
        raise DamagedFileError(source, f"has a block outside of its size, {size}")
    ours = np.array([number_of[text] for text in texts] or [0], np.uint16)
    states = np.full(size, _UNLISTED, np.uint16)
    for start in range(0, len(numbers), _AT_ONCE):  # As indices, all would take much memory.
        x, y, z = places[start : start + _AT_ONCE].T
        states[x, y, z] = ours[numbers[start : start + _AT_ONCE]]
    losses.add("places that the structure leaves as they are", _put_air(states))
    corner = stated_corner(root, source) or (0, 0, 0)
    held = [_block_entity(places[n].tolist(), nbt, corner) for n, nbt in blocks.nbt.items()]
    entities = [_entity(nbt, corner) for nbt in root.get("entities", [])]
    return unlabelled(states, palette, corner, signs_of_today(held, game), entities)


def _put_air(states: np.ndarray) -> int:
    """Put air where nothing is listed, and return in how many places."""
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
        raise LimitError(source, f"has {len(palettes)} palettes; 1 to {MAX_PALETTES:,} are read")
    if not 0 <= variant < len(palettes):
        raise UsageError(f"{source} has variants 0 to {len(palettes) - 1}, not {variant}")
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
    rest = attached(nbt, (x, y, z), corner)
    return Entity((x, y, z), str(nbt["id"]), {k: rest[k] for k in rest if k not in ("id", "Pos")})

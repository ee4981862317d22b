"""Reading of legacy schematics (``.schematic``) from MCEdit, WorldEdit 6 and Schematica.

Before 1.13, a block had a numeric ID and a data value of four bits. In a schematic of width W and
length L, the block (x, y, z) has index (y * L + z) * W + x. Properties that the ID and data value
do not contain, such as the colour of a bed, come from block entities or neighbouring blocks and are
added to the block state.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume
from world2minecraft.minecraft.bit_packing import read_legacy_keys
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import NbtLimits, read_nbt, unpack
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.schematics.pre_flattening import (
    apply_block_entity,
    join_halves,
    legacy_state,
    upgrade_block_entity,
    upgrade_entity,
)
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_FILE_BYTES,
    build_palette,
    check_size,
    invalid_file,
    unlabelled_volume,
)

LIMITS = NbtLimits()
MAX_JOINED_CELLS = 8 << 20  # Looking at all neighbours takes several times a volume's memory.
Corner = tuple[int, int, int]


def read_schematic(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a legacy schematic with numeric block IDs.

    IDs that no vanilla game used become ``legacy:ID_VALUE``, or the name that the file defines.

    Args:
        path: The file to read.
        losses: Counts of blocks without a current name and of data that a volume cannot store,
            updated by this call.

    Raises:
        InputError: If the file is not found or belongs to another edition of the game.
        DamagedFileError: If the file is not a valid schematic.
        LimitError: If the file exceeds the size limit.
    """
    source = Path(path)
    raw = unpack(read_bytes(source, MAX_FILE_BYTES), source, LIMITS.bytes)
    _, root = read_nbt(raw, source, LIMITS)
    del raw
    try:
        return _volume_of(root, source, Losses() if losses is None else losses)
    except MALFORMED as error:
        raise invalid_file(source, "a valid legacy schematic", error) from error


def _volume_of(root: dict[str, Any], source: Path, losses: Losses) -> BlockVolume:
    kind = root.get("Materials", "Alpha")
    if kind != "Alpha":
        raise InputError(
            source, f"has the materials {str(kind)[:40]!r}; only 'Alpha' (Java) is supported"
        )
    sides = (int(root[key]) & 0xFFFF for key in ("Width", "Height", "Length"))
    size = check_size(sides, source)
    states, palette = _blocks(root, size, source, losses)
    corner = _corner(root)
    held = [upgrade_block_entity(nbt, corner) for nbt in root.get("TileEntities", [])]
    states, palette = _with_entities(states, palette, held, corner)
    if states.size <= MAX_JOINED_CELLS:
        states, palette = _trim_palette(*update_connections(*join_halves(states, palette)), palette)
    else:
        losses.add("connections of blocks, which are not computed for large schematics")
    losses.add("biomes", int("Biomes" in root))
    entities_held = [entity for entity in held if entity.id]
    entities = [upgrade_entity(nbt, corner) for nbt in root.get("Entities", [])]
    return unlabelled_volume(states, palette, corner, entities_held, entities)


def _blocks(
    root: dict[str, Any], size: Corner, source: Path, losses: Losses
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the states given by block IDs and data values, and their palette."""
    count = math.prod(size)
    # Taken out of the tree, so that their memory is free when the blocks are made.
    numbers, values = root.pop("Blocks").view(np.uint8), root.pop("Data").view(np.uint8)
    more = root.pop("AddBlocks", np.zeros(0, np.int8)).view(np.uint8)
    if len(numbers) < count or len(values) < count or 0 < 2 * len(more) < count - 1:
        raise DamagedFileError(source, f"declares {count:,} blocks but contains fewer")
    states = np.empty(size, np.uint16)
    counts = np.zeros(1 << 16, np.int64)
    read_legacy_keys(numbers, values, more, states.transpose(1, 2, 0), counts)
    names = _names(root)
    text_of: dict[int, str] = {}
    for key in np.flatnonzero(counts).tolist():
        text_of[key], is_known = legacy_state(key >> 4, key & 15, names)
        if not is_known:
            losses.add("mod blocks, kept with their legacy ID or name", int(counts[key]))
    palette, number_of = build_palette(text_of.values(), source)
    lookup = np.zeros(1 << 16, np.uint16)
    for key, text in text_of.items():
        lookup[key] = number_of[text]
    for layer in states:
        layer[:] = lookup[layer]
    return states, palette


def _names(root: Mapping[str, Any]) -> dict[int, str]:
    """Return the block names by ID that Schematica and MCEdit 2 store in the file."""
    names = {int(number): str(name) for name, number in root.get("SchematicaMapping", {}).items()}
    return names | {int(number): str(name) for number, name in root.get("BlockIDs", {}).items()}


def _corner(root: Mapping[str, Any]) -> Corner:
    """Return the position that WorldEdit copied from, or the world's origin if it is not stored."""
    x, y, z = (int(root.get(f"WEOrigin{axis}", 0)) for axis in "XYZ")
    return x, y, z


def _with_entities(
    states: np.ndarray, palette: tuple[str, ...], held: list[BlockEntity], corner: Corner
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Add the properties in block entities, such as the colour of a bed, to the states."""
    texts = list(palette)
    number_of = {text: number for number, text in enumerate(palette)}
    for entity in held:
        cell = tuple(a - b for a, b in zip(entity.block_pos, corner, strict=True))
        if not all(0 <= at < side for at, side in zip(cell, states.shape, strict=True)):
            continue
        text = apply_block_entity(texts[states[cell]], entity)
        if text not in number_of:
            number_of[text] = len(texts)
            texts.append(text)
        states[cell] = number_of[text]
    return states, tuple(texts)


def _trim_palette(
    states: np.ndarray, palette: tuple[str, ...], before: tuple[str, ...]
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Remove unused states from a palette and sort the others."""
    if palette == before == (AIR, *sorted(before[1:])):
        return states, palette
    used = np.flatnonzero(np.bincount(states.ravel(), minlength=len(palette)))
    used_texts = (AIR, *sorted({palette[number] for number in used.tolist()} - {AIR}))
    number_of = {text: number for number, text in enumerate(used_texts)}
    lookup = np.array([number_of.get(text, 0) for text in palette], np.uint16)
    return lookup[states], used_texts

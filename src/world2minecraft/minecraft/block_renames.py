"""Conversion of block names between game versions.

Volumes use the block names of 1.20.1. Readers convert names from the version of the file, and
writers convert names to the target version. Blocks that the target version does not have keep their
names and are counted as losses.
"""

from collections.abc import Callable
from functools import cache, lru_cache

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.data_files import read_data
from world2minecraft.minecraft.entity_conversion import count_lost_data
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.versions import GameVersion, name_in_version, new_names

FIRST_1_14 = 1952  # Its first release; the names changed in snapshots before.
FIRST_1_16 = 2566
FIRST_1_17 = 2724
FIRST_DISPLAYS = 3337  # 1.19.4.
DISPLAYS = tuple(f"minecraft:{kind}_display" for kind in ("block", "item", "text"))
_OLD_SIGNS = {
    "minecraft:sign": "minecraft:oak_sign",
    "minecraft:wall_sign": "minecraft:oak_wall_sign",
}
_SLABS = ("minecraft:stone_slab", "minecraft:smooth_stone_slab")  # In 1.13, and since.
_PATHS = ("minecraft:grass_path", "minecraft:dirt_path")  # Until 1.16, and since.
_CAULDRONS = ("minecraft:cauldron", "minecraft:water_cauldron")
_SIDES = ("east", "north", "south", "west")


@lru_cache(maxsize=1 << 16)
def read_state(text: str, data_version: int) -> str:
    """Convert the block state of a file to the names of 1.20.1.

    Args:
        text: The canonical text of the block state.
        data_version: The data version of the game that wrote the file.

    Example:
        >>> read_state("minecraft:short_grass", 3700), read_state("minecraft:sign", 1519)
        ('minecraft:grass', 'minecraft:oak_sign')
    """
    name, bracket, rest = text.partition("[")
    if name in new_names():  # No older block was ever called so.
        return new_names()[name] + bracket + rest
    if data_version >= FIRST_1_17:
        return text
    if name in _OLD_SIGNS:
        return _OLD_SIGNS[name] + bracket + rest
    if name == _PATHS[0]:
        return _PATHS[1]
    if name == _SLABS[0] and data_version < FIRST_1_14:
        return _SLABS[1] + bracket + rest
    if name == _CAULDRONS[0] and bracket:
        level = parse_state(text).get("level")
        return f"{_CAULDRONS[1]}[level={level}]" if level != "0" else _CAULDRONS[0]
    if name.endswith("_wall") and data_version < FIRST_1_16:
        return _with_sides(text, lambda value: {"true": "low", "false": "none"}.get(value, value))
    return text


@lru_cache(maxsize=1 << 16)
def write_state(text: str, data_version: int) -> str:
    """Convert a block state of 1.20.1 to the names of another game version.

    Example:
        >>> write_state("minecraft:grass", 3700), write_state("minecraft:oak_sign", 1519)
        ('minecraft:short_grass', 'minecraft:sign')
    """
    name, bracket, rest = text.partition("[")
    if data_version >= FIRST_1_17:
        return name_in_version(name, data_version) + bracket + rest
    if name in _CAULDRONS:
        level = parse_state(text).get("level", "3" if name == _CAULDRONS[1] else "0")
        return f"{_CAULDRONS[0]}[level={level}]"
    if name == _PATHS[1]:
        return _PATHS[0]
    if data_version < FIRST_1_16 and name.endswith("_wall"):
        return _with_sides(text, lambda value: "false" if value == "none" else "true")
    if data_version < FIRST_1_14:
        known = {new: old for old, new in _OLD_SIGNS.items()} | {_SLABS[1]: _SLABS[0]}
        return known.get(name, name) + bracket + rest
    return text


def count_unknown_blocks(volume: BlockVolume, version: GameVersion, losses: Losses) -> None:
    """Count the blocks and display entities of a volume that a game version does not have.

    Such blocks are written with their names, and the game replaces them with air. Item data that
    the game version stores in a different form is counted too.
    """
    count_lost_data(volume, version.data_version, losses)
    if version.data_version < FIRST_DISPLAYS:
        shown = sum(entity.id in DISPLAYS for entity in volume.entities)
        losses.add(f"display entities, which Minecraft {version.name} does not support", shown)
    unknown = [is_unknown(state, version.data_version) for state in volume.palette]
    if not any(unknown):
        return
    counts = np.bincount(volume.states.ravel(), minlength=len(volume.palette))
    for state, count, is_lost in zip(volume.palette, counts.tolist(), unknown, strict=True):
        if is_lost:
            name = state.partition("[")[0]
            losses.add(f"blocks {name}, which Minecraft {version.name} does not have", count)


def count_mod_blocks(volume: BlockVolume) -> dict[str, int]:
    """Return the number of blocks of each mod, by namespace."""
    counts = np.bincount(volume.states.ravel(), minlength=len(volume.palette))
    found: dict[str, int] = {}
    for state, count in zip(volume.palette, counts.tolist(), strict=True):
        space = state.partition(":")[0]
        if space != "minecraft" and count:
            found[space] = found.get(space, 0) + count
    return dict(sorted(found.items()))


def is_unknown(state: str, data_version: int) -> bool:
    """Return whether a vanilla block is newer than a game version. Mod blocks are never unknown."""
    name = write_state(state, data_version).partition("[")[0]
    if state.startswith("minecraft:stone_slab") and data_version < FIRST_1_14:
        return True  # What has this name there is another slab.
    return _first_version(name) > data_version


def _with_sides(text: str, change: Callable[[str], str]) -> str:
    state = parse_state(text)
    sides = {key: change(value) for key, value in state.properties if key in _SIDES}
    return str(BlockState(state.name, {**dict(state.properties), **sides}))


@cache
def _versions_of() -> dict[str, int]:
    listed = read_data("blocks_since.json")["since"]
    return {f"minecraft:{name}": since for since, names in listed for name in names}


def _first_version(name: str) -> int:
    return _versions_of().get(name, 0)

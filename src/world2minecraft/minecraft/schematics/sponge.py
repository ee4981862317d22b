"""Reading and writing of Sponge schematics of version 1 to 3, the format of WorldEdit."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, UsageError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.bit_packing import read_varints, write_varints
from world2minecraft.minecraft.block_renames import read_state, write_state
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.entities import entity_nbt
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import (
    NbtLimits,
    Short,
    pack_gzip,
    read_nbt,
    unpack,
    write_nbt,
)
from world2minecraft.minecraft.rules.attached_entities import move_attachment
from world2minecraft.minecraft.signs import upgrade_signs
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_FILE_BYTES,
    build_palette,
    check_size,
    invalid_file,
    unlabelled_volume,
)
from world2minecraft.minecraft.versions import GameVersion, game_version

LIMITS = NbtLimits()
Corner = tuple[int, int, int]
DEFAULT_GAME = 1952  # 1.14: version 1 does not say its game, and is that old.


def write_schem(
    volume: BlockVolume,
    path: str | Path,
    *,
    schem_version: Literal[1, 2, 3] = 2,
    version: GameVersion | None = None,
) -> None:
    """Write a volume as a Sponge schematic whose ``Offset`` is the volume's corner.

    As in WorldEdit, positions of entities are in world coordinates in version 2 and relative to
    ``Offset`` in version 3.

    Args:
        volume: The blocks to write.
        path: The ``.schem`` file to write.
        schem_version: The schematic version. WorldEdit reads version 2 since 7.0 and version 3
            since 7.3. Version 1 is for older tools; it stores neither entities nor the game
            version.
        version: The target game version. The default is 1.20.1.

    Raises:
        UsageError: If the volume is empty or a side is longer than 65,535 blocks.
        OutputError: If the file cannot be written.
    """
    version = version or game_version()
    volume = convert_volume(volume, version.data_version)
    if max(volume.states.shape) > 0xFFFF or not volume.states.size:
        shape = tuple(volume.states.shape)
        raise UsageError(f"each side of a .schem must be 1 to 65,535 blocks, got {shape}")
    palette = {
        write_state(state, version.data_version): number
        for number, state in enumerate(volume.palette)
    }
    if len(palette) != len(volume.palette):
        raise UsageError("the palette of the volume contains a block state twice")
    cells = np.ascontiguousarray(volume.states.transpose(1, 2, 0)).ravel()
    packed = np.empty(3 * len(cells), np.uint8)
    data = packed[: write_varints(cells, packed)].view(np.int8)
    width, height, length = (_unsigned(side) for side in volume.states.shape)
    head: dict[str, Any] = {
        "Version": schem_version,
        "DataVersion": version.data_version,
        "Width": width,
        "Height": height,
        "Length": length,
        "Offset": np.array(volume.corner, np.int32),
    }
    write = {1: _tree_v1, 2: _tree_v2, 3: _tree_v3}[schem_version]
    name, root = write(head, palette, data, volume)
    write_bytes(path, pack_gzip(write_nbt(root, name), level=4))


def read_schem(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a Sponge schematic of version 1, 2 or 3.

    Args:
        path: The file to read.
        losses: Counts of the data that a volume cannot store (biomes), updated by this call.

    Returns:
        The volume without labels. Its scale is one block per metre, because schematics do not store
        a scale. Mod blocks keep their names.

    Raises:
        InputError: If the file is not found.
        DamagedFileError: If the file is not a valid schematic.
        LimitError: If the file exceeds the size limit.
    """
    source = Path(path)
    raw = unpack(read_bytes(source, MAX_FILE_BYTES), source, LIMITS.bytes)
    _, root = read_nbt(raw, source, LIMITS)
    tree = root["Schematic"] if isinstance(root.get("Schematic"), dict) else root
    try:
        if losses is not None:
            losses.add("biomes", int("BiomeData" in tree or "Biomes" in tree))
        return _volume_of(tree, source)
    except MALFORMED as error:
        raise invalid_file(source, "a valid Sponge schematic", error) from error


# Writing.


def _tree_v1(
    head: dict[str, Any], palette: dict[str, int], data: np.ndarray, volume: BlockVolume
) -> tuple[str, dict[str, Any]]:
    name, tree = _tree_v2(head, palette, data, volume)
    tiles = [{**held, "ContentVersion": 1} for held in tree["BlockEntities"]]
    left_out = ("DataVersion", "BlockEntities", "Entities")
    return name, {key: tree[key] for key in tree if key not in left_out} | {"TileEntities": tiles}


def _tree_v2(
    head: dict[str, Any], palette: dict[str, int], data: np.ndarray, volume: BlockVolume
) -> tuple[str, dict[str, Any]]:
    entities = [
        {**entity_nbt(entity, number), "Id": entity.id}
        for number, entity in enumerate(volume.entities)
    ]
    for nbt in entities:
        del nbt["id"]
    blocks = [
        {**entity.nbt, "Id": entity.id, "Pos": _relative(entity, volume)}
        for entity in volume.block_entities
    ]
    # WorldEdit pastes version 2 by these and not by Offset: the corner goes to the player's feet.
    paste = {"WEOffsetX": 0, "WEOffsetY": 0, "WEOffsetZ": 0}
    rest = {
        "Metadata": paste,
        "PaletteMax": len(palette),
        "Palette": palette,
        "BlockData": data,
        "BlockEntities": blocks,
        "Entities": entities,
    }
    return "Schematic", {**head, **rest}


def _tree_v3(
    head: dict[str, Any], palette: dict[str, int], data: np.ndarray, volume: BlockVolume
) -> tuple[str, dict[str, Any]]:
    blocks = [
        {"Id": entity.id, "Pos": _relative(entity, volume), "Data": dict(entity.nbt)}
        for entity in volume.block_entities
    ]
    entities = []
    for number, entity in enumerate(volume.entities):
        nbt = entity_nbt(entity, number)
        place = (np.array(nbt.pop("Pos")) - volume.corner).tolist()
        entities.append({"Id": nbt.pop("id"), "Pos": place, "Data": nbt})
    held = {"Palette": palette, "Data": data, "BlockEntities": blocks}
    return "", {"Schematic": {**head, "Blocks": held, "Entities": entities}}


def _relative(entity: BlockEntity, volume: BlockVolume) -> np.ndarray:
    return (np.array(entity.block_pos) - volume.corner).astype(np.int32)


def _unsigned(side: int) -> Short:
    """Return an unsigned short as a signed short tag."""
    return Short(side - 0x10000 if side > 0x7FFF else side)


# Reading.


def _volume_of(tree: dict[str, Any], source: Path) -> BlockVolume:
    version = tree["Version"]
    if version not in (1, 2, 3):
        raise InputError(source, f"has Sponge schematic version {version}; supported: 1 to 3")
    sides = (int(tree[key]) & 0xFFFF for key in ("Width", "Height", "Length"))
    size = check_size(sides, source)
    cell_count = math.prod(size)
    blocks = tree["Blocks"] if version == 3 else tree
    # Taken out of the tree, so that its memory is free when the blocks are made.
    data = blocks.pop("Data" if version == 3 else "BlockData").view(np.uint8)
    if len(data) < cell_count:
        raise DamagedFileError(source, f"declares {cell_count:,} blocks but contains fewer")
    game = int(tree.get("DataVersion", DEFAULT_GAME))
    palette, number_of = _palette(blocks["Palette"], game, source)
    width, height, length = size
    states = np.empty((width, height, length), np.uint16)
    _fill(states.transpose(1, 2, 0), data, number_of, source)
    del data
    corner = _corner(tree)
    shift = _shift(tree, version)
    nbts = blocks.get("BlockEntities", tree.get("TileEntities", []))
    held = [_block_entity(nbt, corner, version) for nbt in nbts]
    return unlabelled_volume(
        states,
        palette,
        corner,
        upgrade_signs(held, game),
        [_entity(nbt, corner, version, shift) for nbt in tree.get("Entities", [])],
    )


def _corner(tree: Mapping[str, Any]) -> Corner:
    """Return Offset, or the WorldEdit keys that some tools use in version 2."""
    metadata = tree.get("Metadata", {})
    x, y, z = tree.get("Offset", [metadata.get(f"WEOffset{axis}", 0) for axis in "XYZ"])
    return int(x), int(y), int(z)


def _shift(tree: Mapping[str, Any], version: int) -> Corner:
    """Return the offset of attached entities, whose tags WorldEdit keeps in world coordinates.

    In version 3 all other positions are relative to the player's position, which is stored in
    WorldEdit's metadata.
    """
    try:
        x, y, z = (int(step) for step in tree["Metadata"]["WorldEdit"]["Origin"])
    except MALFORMED:
        return 0, 0, 0
    return (-x, -y, -z) if version == 3 else (0, 0, 0)


def _palette(
    stated: Mapping[str, int], game: int, source: Path
) -> tuple[tuple[str, ...], dict[int, int]]:
    """Return the palette, with air first, and the new index of each of the file's indices."""
    text_of: dict[int, str] = {}
    for text, number in stated.items():
        try:
            state = read_state(str(parse_state(text)), game)
        except UsageError as error:
            raise DamagedFileError(source, f"contains an invalid palette entry: {error}") from error
        if not 0 <= number <= 0xFFFF or number in text_of:
            raise DamagedFileError(
                source, f"contains an invalid or repeated palette index {number}"
            )
        text_of[int(number)] = state
    palette, number_of = build_palette(text_of.values(), source)
    return palette, {number: number_of[state] for number, state in text_of.items()}


def _fill(cells: np.ndarray, data: np.ndarray, number_of: Mapping[int, int], source: Path) -> None:
    """Fill uint16 [Y, Z, X] with palette indices decoded from the file's varints."""
    lookup = np.full(max(number_of, default=0) + 1, -1, np.int32)
    for number, ours in number_of.items():
        lookup[number] = ours
    used = int(read_varints(data, lookup, cells))
    if used <= -3:
        raise DamagedFileError(
            source, f"contains the block index {-3 - used}, which is not in the palette"
        )
    if used != len(data):
        reasons = {
            -1: "has block data that ends too early",
            -2: "has a block index of more than four bytes",
        }
        extra = "has block data after the last block"
        raise DamagedFileError(source, reasons.get(used, extra))


def _block_entity(nbt: dict[str, Any], corner: Corner, version: int) -> BlockEntity:
    x, y, z = (int(low + step) for low, step in zip(corner, nbt["Pos"], strict=True))
    rest = nbt.get("Data", {}) if version == 3 else nbt
    rest = {key: rest[key] for key in rest if key not in ("Id", "Pos", "ContentVersion")}
    return BlockEntity((x, y, z), str(nbt["Id"]), rest)


def _entity(nbt: dict[str, Any], corner: Corner, version: int, shift: Corner) -> Entity:
    start = corner if version == 3 else (0, 0, 0)
    x, y, z = (float(low + step) for low, step in zip(start, nbt["Pos"], strict=True))
    rest = move_attachment(nbt.get("Data", {}) if version == 3 else nbt, (x, y, z), shift)
    rest = {key: rest[key] for key in rest if key not in ("Id", "Pos")}
    return Entity((x, y, z), str(nbt["Id"]), rest)

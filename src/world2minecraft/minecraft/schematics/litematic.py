"""Reading and writing of Litematica files, which contain one or more regions.

Each region has its own palette. The ``Position`` of a region is one of its corners, and its
``Size`` extends from there, backwards along axes on which it is negative. Positions of blocks and
block entities are relative to the lowest corner, and those of entities are relative to
``Position``. In a region of width W and length L, the block (x, y, z) has index (y * L + z) * W +
x. Palette indices have ``max(2, ceil(log2(palette size)))`` bits and are packed without gaps.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    UsageError,
)
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.bit_packing import (
    bit_width,
    pack_straddled,
    straddled_word_count,
    unpack_straddled,
)
from world2minecraft.minecraft.block_states import AIRS
from world2minecraft.minecraft.entities import entity_nbt
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import (
    Long,
    NbtLimits,
    pack_gzip,
    read_nbt,
    unpack,
    write_nbt,
)
from world2minecraft.minecraft.rules.attached_entities import move_attachment
from world2minecraft.minecraft.signs import upgrade_signs
from world2minecraft.minecraft.state_nbt import palette_texts, state_entry
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_CELLS,
    MAX_FILE_BYTES,
    build_palette,
    check_size,
    enclosing_box,
    invalid_file,
    join_volumes,
    own_tag,
    stated_corner,
    unlabelled_volume,
)
from world2minecraft.minecraft.versions import GameVersion, game_version

LIMITS = NbtLimits()
MAX_REGIONS = 4096
VERSIONS = range(4, 8)  # 1.13 to today; before them blocks had the names of 1.12.
MIN_BITS = 2
DEFAULT_GAME = 3465  # 1.20.1, for a file that does not say its game.


# Writing.


def write_litematic(
    volume: BlockVolume,
    path: str | Path,
    *,
    name: str = "room",
    version: GameVersion | None = None,
) -> None:
    """Write a volume as a Litematica file with one region at the origin of the file.

    Args:
        volume: The blocks. The corner is stored in a tag that Litematica ignores.
        path: The ``.litematic`` file to write.
        name: The name of the region and the name that the mod displays.
        version: The target game version. The default is 1.20.1.

    Raises:
        UsageError: If the volume is empty.
        OutputError: If the file cannot be written.
    """
    write_regions({name: volume}, path, name=name, version=version)


def write_regions(
    regions: Mapping[str, BlockVolume],
    path: str | Path,
    *,
    name: str = "room",
    version: GameVersion | None = None,
) -> None:
    """Write volumes as regions of one Litematica file, each at its own corner.

    Args:
        regions: Volumes by region name, in shared world coordinates. The lowest corner of all
            volumes becomes the origin of the file.
        path: The ``.litematic`` file to write.
        name: The name that the mod displays.
        version: The target game version. The default is 1.20.1.

    Raises:
        UsageError: If there is no region, or a region is empty.
        OutputError: If the file cannot be written.
    """
    version = version or game_version()
    regions = {key: convert_volume(volume, version.data_version) for key, volume in regions.items()}
    if not regions or not all(volume.states.size for volume in regions.values()):
        raise UsageError("a .litematic file must have at least one region, each with blocks")
    corners = np.array([volume.corner for volume in regions.values()])
    ends = corners + [volume.states.shape for volume in regions.values()]
    low = corners.min(axis=0)
    tree = {
        "MinecraftDataVersion": version.data_version,
        "Version": _version_for(version),
        "SubVersion": 1,
        "Metadata": _metadata(regions, name, ends.max(axis=0) - low),
        "Regions": {key: _region(volume, low, version) for key, volume in regions.items()},
        **own_tag(low.tolist()),
    }
    write_bytes(path, pack_gzip(write_nbt(tree), level=4))


def _version_for(version: GameVersion) -> int:
    """Return the Litematica version for a game version."""
    return 7 if version.data_version >= 3837 else 6 if version.data_version >= 3463 else 5


def _metadata(regions: Mapping[str, BlockVolume], name: str, size: np.ndarray) -> dict[str, Any]:
    blocks = 0
    for volume in regions.values():
        filled = np.array([state not in AIRS for state in volume.palette])
        blocks += int(filled[volume.states].sum())
    return {
        "Name": name,
        "Author": "",
        "Description": "",
        "RegionCount": len(regions),
        "TotalBlocks": blocks,
        "TotalVolume": sum(volume.states.size for volume in regions.values()),
        "TimeCreated": Long(0),
        "TimeModified": Long(0),
        "EnclosingSize": _xyz(size),
    }


def _region(volume: BlockVolume, low: np.ndarray, version: GameVersion) -> dict[str, Any]:
    corner = np.array(volume.corner)
    cells = np.ascontiguousarray(volume.states.transpose(1, 2, 0)).ravel()
    bits = bit_width(len(volume.palette), MIN_BITS)
    words = np.zeros(straddled_word_count(len(cells), bits), np.uint64)
    pack_straddled(cells, bits, words)
    blocks = [
        {**held.nbt, "id": held.id, **_xyz(np.array(held.block_pos) - corner)}
        for held in volume.block_entities
    ]
    return {
        "Position": _xyz(corner - low),
        "Size": _xyz(np.array(volume.states.shape)),
        "BlockStatePalette": [state_entry(s, version.data_version) for s in volume.palette],
        "BlockStates": words.view(np.int64),
        "TileEntities": blocks,
        "Entities": [_entity_out(held, n, corner) for n, held in enumerate(volume.entities)],
        "PendingBlockTicks": [],
        "PendingFluidTicks": [],
    }


def _entity_out(entity: Entity, number: int, corner: np.ndarray) -> dict[str, Any]:
    nbt = move_attachment(entity_nbt(entity, number), entity.position, (0, 0, 0))
    x, y, z = (np.array(entity.position) - corner).tolist()
    dx, dy, dz = (-corner).tolist()
    return {**move_attachment(nbt, (x, y, z), (dx, dy, dz)), "Pos": [x, y, z]}


def _xyz(values: np.ndarray) -> dict[str, int]:
    return dict(zip("xyz", values.tolist(), strict=True))


# Reading.


def read_litematic(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a Litematica file and join its regions to one volume.

    Where regions overlap, the blocks of the later region are used, except its air.

    Args:
        path: The file to read.
        losses: Counts of the data that a volume cannot store, updated by this call.

    Raises:
        InputError: If the file is not found or was written for 1.12 or older.
        DamagedFileError: If the file is not a valid Litematica file.
        LimitError: If the file exceeds the size limit.
    """
    regions = read_regions(path, losses)
    if len(regions) == 1:
        return next(iter(regions.values()))
    if losses is not None:
        losses.add("names of regions", len(regions))
    return join_volumes(list(regions.values()), path)


def read_regions(path: str | Path, losses: Losses | None = None) -> dict[str, BlockVolume]:
    """Read the regions of a Litematica file as volumes by name.

    Args:
        path: The file to read.
        losses: Counts of the data that a volume cannot store, updated by this call.

    Raises:
        InputError: If the file is not found or was written for 1.12 or older.
        DamagedFileError: If the file is not a valid Litematica file.
        LimitError: If the file exceeds the size limit.
    """
    source = Path(path)
    raw = unpack(read_bytes(source, MAX_FILE_BYTES), source, LIMITS.bytes)
    _, root = read_nbt(raw, source, LIMITS)
    del raw  # So that the blocks do not come on top of it.
    try:
        _check_version(root, source)
        named = root["Regions"]
        if not 1 <= len(named) <= MAX_REGIONS:
            raise DamagedFileError(
                source, f"has {len(named)} regions; expected 1 to {MAX_REGIONS:,}"
            )
        boxes = {name: _box(region, source) for name, region in named.items()}
        check_size(enclosing_box(list(boxes.values()))[1], source)
        cells = sum(math.prod(size.tolist()) for _, size in boxes.values())
        if cells > MAX_CELLS:  # Regions may lie in one another.
            raise LimitError(
                source, f"has regions with {cells:,} blocks in total, the limit is {MAX_CELLS:,}"
            )
        shift, game = _shift(root, boxes, source), root.get("MinecraftDataVersion", DEFAULT_GAME)
        found = {
            name: _region_volume(region, boxes[name], shift, game, source)
            for name, region in named.items()
        }
    except MALFORMED as error:
        raise invalid_file(source, "a valid Litematica file", error) from error
    if losses is not None:
        _count_losses(root, losses)
    return found


def _check_version(root: Mapping[str, Any], source: Path) -> None:
    version = root["Version"]
    if not isinstance(version, int) or version not in VERSIONS:
        known = f"{VERSIONS.start} to {VERSIONS.stop - 1}"
        raise InputError(source, f"has Litematica version {version}; supported: {known}")


def _box(region: Mapping[str, Any], source: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest corner and the size of a region."""
    position = np.array([int(region["Position"][axis]) for axis in "xyz"])
    size = np.array([int(region["Size"][axis]) for axis in "xyz"])
    check_size(np.abs(size), source)
    return position + np.minimum(size + 1, 0), np.abs(size)


def _shift(root: Mapping[str, Any], boxes: Mapping[str, Any], source: Path) -> np.ndarray:
    """Return the offset from file coordinates to the coordinates of the original world."""
    corner = stated_corner(root, source)
    if corner is None:
        return np.zeros(3, np.int64)
    return np.array(corner) - enclosing_box(list(boxes.values()))[0]


def _region_volume(
    region: dict[str, Any],
    box: tuple[np.ndarray, np.ndarray],
    shift: np.ndarray,
    data_version: Any,
    source: Path,
) -> BlockVolume:
    low, size = box
    texts = palette_texts(region["BlockStatePalette"], data_version, source)
    palette, number_of = build_palette(texts, source)
    lookup = np.array([number_of[text] for text in texts], np.uint16)
    states = np.empty(tuple(size.tolist()), np.uint16)
    words = region.pop("BlockStates")  # Its memory is free when the blocks are made.
    bits = bit_width(max(len(texts), 1), MIN_BITS)
    if words.dtype != np.int64 or len(words) < straddled_word_count(states.size, bits):
        raise DamagedFileError(source, f"declares {states.size:,} blocks but contains fewer")
    wrong = int(unpack_straddled(words.view(np.uint64), bits, lookup, states.transpose(1, 2, 0)))
    if wrong >= 0:
        raise DamagedFileError(
            source, f"contains the block index {wrong}, which is not in the palette"
        )
    del words
    corner = low + shift
    x, y, z = corner.tolist()
    held = [_block_entity(nbt, corner) for nbt in region.get("TileEntities", [])]
    start = np.array([int(region["Position"][axis]) for axis in "xyz"]) + shift
    return unlabelled_volume(
        states,
        palette,
        (x, y, z),
        upgrade_signs(held, int(data_version)),
        [_entity(nbt, start) for nbt in region.get("Entities", [])],
    )


def _block_entity(nbt: Mapping[str, Any], corner: np.ndarray) -> BlockEntity:
    x, y, z = (int(nbt[axis]) + low for axis, low in zip("xyz", corner.tolist(), strict=True))
    rest = {key: nbt[key] for key in nbt if key not in ("id", "x", "y", "z")}
    return BlockEntity((x, y, z), str(nbt.get("id", "")), rest)


def _entity(nbt: Mapping[str, Any], start: np.ndarray) -> Entity:
    dx, dy, dz = start.tolist()
    x, y, z = (float(value) for value in nbt["Pos"])
    place = (x + dx, y + dy, z + dz)
    rest = move_attachment(nbt, place, (dx, dy, dz))
    return Entity(place, str(nbt["id"]), {k: rest[k] for k in rest if k not in ("id", "Pos")})


def _count_losses(root: Mapping[str, Any], losses: Losses) -> None:
    """Count the data of a file that a volume cannot store."""
    for region in root["Regions"].values():
        for key in ("PendingBlockTicks", "PendingFluidTicks"):
            losses.add("scheduled ticks", len(region.get(key, [])))
    losses.add("preview images", int("PreviewImageData" in root.get("Metadata", {})))

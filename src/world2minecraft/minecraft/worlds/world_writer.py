"""Writing of Minecraft Java world folders, which ``world_reader`` can read."""

import os
import shutil
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import InputError, OutputError, UsageError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.minecraft.commands.player_scale import size_pack
from world2minecraft.minecraft.entities import entity_nbt
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.nbt import pack_gzip, write_nbt
from world2minecraft.minecraft.versions import GameVersion, game_version
from world2minecraft.minecraft.worlds.anvil import pack_region
from world2minecraft.minecraft.worlds.chunks import (
    FIRST_ENTITY_FILES,
    FIRST_WITHOUT_LEVEL,
    ChunkWriter,
    OldChunkWriter,
)
from world2minecraft.minecraft.worlds.level_dat import MAKER, MAKER_TAG, UNDO_FOLDER, level_data
from world2minecraft.minecraft.worlds.world_reader import Place, read_level, read_world

__all__ = ["read_level", "read_world", "write_world"]

SIZE_PACK_FILE = "player_size.zip"


def write_world(
    volume: BlockVolume,
    folder: str | Path,
    *,
    name: str,
    spawn: tuple[float, float, float],
    spawn_yaw_deg: float,
    version: GameVersion | None = None,
    hour: float = 12.0,
) -> None:
    """Write a volume as a void world that opens in creative mode at a fixed hour of the day.

    The world is written to a temporary folder and then moved. An existing world is replaced only if
    this program wrote it, no game has saved it and nothing was built into it. Any other folder that
    contains files is left unchanged.

    Args:
        volume: The blocks to write.
        folder: The world folder to write.
        name: The name in the game's list of worlds.
        spawn: Position of the player's feet in world block coordinates.
        spawn_yaw_deg: Direction of the player's view as the game's yaw in degrees: 0 is south, 90
            is west.
        version: The target game version. The default is 1.20.1.
        hour: The fixed hour of the day, 0 to 24.

    Raises:
        OutputError: If the folder contains other files or cannot be written.
        UsageError: If the volume exceeds the height limits of the world.
    """
    target, version = Path(folder), version or game_version()
    volume = convert_volume(volume, version.level_data_version)
    _check_heights(volume, version)
    _check_free(target)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        draft = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}."))
    except OSError as error:
        raise OutputError(target, f"cannot be written: {error.strerror or error}") from error
    try:
        os.chmod(draft, 0o755)
        _write_regions(volume, draft, version)
        _write_entities(volume.entities, draft, version)
        write_bytes(draft / "datapacks" / SIZE_PACK_FILE, size_pack(volume.blocks_per_metre))
        level = level_data(name, spawn, spawn_yaw_deg, version, (SIZE_PACK_FILE,), hour)
        write_bytes(draft / "level.dat", pack_gzip(write_nbt(level)))
        _move(draft, target)
    except OutputError as error:  # It names a file of the draft, which is gone by then.
        raise OutputError(target, error.reason) from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _check_heights(volume: BlockVolume, version: GameVersion) -> None:
    low, high = volume.corner[1], volume.corner[1] + volume.states.shape[1] - 1
    if low < version.min_y or high > version.max_y:
        raise UsageError(
            f"the build has layers {low} to {high}, but Minecraft {version.name} has layers "
            f"{version.min_y} to {version.max_y}; use fewer blocks per metre, or another position "
            "with w2m build --into WORLD --at X Y Z"
        )


def _check_free(target: Path) -> None:
    """Check that a folder is empty or contains an unchanged world of this program.

    The game removes the program's mark when it saves a world. Building into a world keeps it.
    """
    try:
        if not target.exists() or (target.is_dir() and not any(target.iterdir())):
            return
        mark = read_level(target).get(MAKER_TAG)
    except OSError as error:
        raise OutputError(target, f"cannot be read: {error.strerror or error}") from error
    except InputError:
        raise OutputError(target, "contains other files; choose another folder") from None
    if mark != MAKER:
        raise OutputError(
            target,
            "contains a world that was played in or created by another program; "
            "move it away or choose another folder",
        )
    if any((target / UNDO_FOLDER).glob("*")):
        raise OutputError(
            target,
            "contains a world that was changed with w2m build --into; "
            "revert the change with w2m undo, or move the world away",
        )


def _move(draft: Path, target: Path) -> None:
    """Move the finished folder to its destination, or change nothing if that fails."""
    old = draft.with_name(f"{draft.name}.old")
    try:
        if target.exists():
            os.replace(target, old)
        os.replace(draft, target)
    except OSError as error:
        if old.exists() and not target.exists():
            os.replace(old, target)
        raise OutputError(target, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(old, ignore_errors=True)


def _write_regions(volume: BlockVolume, folder: Path, version: GameVersion) -> None:
    write = _chunk_writer(volume, version)
    held: dict[Place, list[dict[str, Any]]] = defaultdict(list)
    for entity in volume.block_entities:
        x, y, z = entity.block_pos
        nbt = {**entity.nbt, "id": entity.id, "x": x, "y": y, "z": z}
        held[x >> 4, z >> 4].append(nbt)
    regions: dict[Place, dict[Place, bytes]] = defaultdict(dict)
    for place in sorted({*_chunk_places(volume), *held}):
        data = write(place, held.get(place, []))
        if data is not None:
            regions[place[0] >> 5, place[1] >> 5][place] = data
    if not regions:
        regions[0, 0] = {}
    _write_region_files(regions, folder / "region")


def _chunk_writer(
    volume: BlockVolume, version: GameVersion
) -> Callable[[Place, list[dict[str, Any]]], bytes | None]:
    """Return a function that writes a chunk, given its position and block entities."""
    if version.level_data_version >= FIRST_WITHOUT_LEVEL:
        return ChunkWriter(volume.states, volume.palette, volume.corner, version).chunk
    old = OldChunkWriter(volume.states, volume.palette, volume.corner, version)
    entities = _entities_by_chunk(volume.entities)
    return lambda place, held: old.chunk(place, held, entities.get(place, ()))


def _chunk_places(volume: BlockVolume) -> Iterator[Place]:
    x, _, z = volume.corner
    size_x, _, size_z = volume.states.shape
    for chunk_x in range(x >> 4, (x + size_x + 15) >> 4):
        for chunk_z in range(z >> 4, (z + size_z + 15) >> 4):
            yield chunk_x, chunk_z


def _write_region_files(regions: Mapping[Place, Mapping[Place, bytes]], folder: Path) -> None:
    for (x, z), chunks in sorted(regions.items()):
        data, outside = pack_region(chunks)
        write_bytes(folder / f"r.{x}.{z}.mca", data)
        for name, packed in outside.items():
            write_bytes(folder / name, packed)


def _write_entities(entities: tuple[Entity, ...], folder: Path, version: GameVersion) -> None:
    if version.level_data_version < FIRST_ENTITY_FILES:
        return  # They lie in the chunks.
    regions: dict[Place, dict[Place, bytes]] = defaultdict(dict)
    for place, found in _entities_by_chunk(entities).items():
        root = {
            "DataVersion": version.level_data_version,
            "Position": np.array(place, np.int32),
            "Entities": found,
        }
        regions[place[0] >> 5, place[1] >> 5][place] = write_nbt(root)
    _write_region_files(regions, folder / "entities")


def _entities_by_chunk(entities: tuple[Entity, ...]) -> dict[Place, list[dict[str, Any]]]:
    held: dict[Place, list[dict[str, Any]]] = defaultdict(list)
    for number, entity in enumerate(entities):
        x, _, z = entity.position
        held[int(x // 16), int(z // 16)].append(entity_nbt(entity, number))
    return dict(held)

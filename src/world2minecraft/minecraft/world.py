"""World folders of Minecraft Java: a volume written as one, and read back."""

import hashlib
import os
import shutil
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.coordinates import block_to_room
from world2minecraft.errors import (
    DamagedFileError,
    InputError,
    LimitError,
    OutputError,
    UsageError,
)
from world2minecraft.files import read_bytes, write_bytes
from world2minecraft.minecraft.anvil import pack_region, read_region
from world2minecraft.minecraft.chunks import ChunkWriter, Section, read_chunk
from world2minecraft.minecraft.level import MAKER, MAKER_TAG, level_data
from world2minecraft.minecraft.nbt import (
    Float,
    NbtLimits,
    pack_gzip,
    read_nbt,
    unpack,
    write_nbt,
)
from world2minecraft.minecraft.packing import unpack_section
from world2minecraft.minecraft.sizes import size_pack
from world2minecraft.minecraft.versions import GameVersion, game_version
from world2minecraft.types import AIR, BlockEntity, BlockVolume, Entity

MAX_CELLS = 256 << 20  # A volume of this size takes 1.3 GB.
MAX_UNPACKED_BYTES = 2 << 30  # All chunks of one world together.
SIZE_PACK_FILE = "player_size.zip"
LEVEL_LIMITS = NbtLimits(values=200_000, bytes=32 << 20)
Place = tuple[int, int]
Box = tuple[int, int, int, int, int, int]


def write_world(
    volume: BlockVolume,
    folder: str | Path,
    *,
    name: str,
    spawn: tuple[float, float, float],
    spawn_yaw_deg: float,
    version: GameVersion | None = None,
) -> None:
    """Write a volume as a world that opens in creative mode, at noon, in a void.

    The folder is written beside its place and moved there at the end. A world of this program
    that no game has saved yet is replaced; any other folder with files in it is left alone.

    Args:
        volume: the blocks; states are written as they stand in its palette.
        folder: the world's folder, as it goes under ``saves``.
        name: what the game's list of worlds shows.
        spawn: where the player's feet stand, in world block coordinates.
        spawn_yaw_deg: where the player looks, in the game's yaw: 0 south, 90 west.
        version: the game to write for; 1.20.1 where it is left out.

    Raises:
        OutputError: the folder is taken or cannot be written.
        UsageError: the volume is higher or lower than the game's world.
    """
    target, version = Path(folder), version or game_version()
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
        level = level_data(name, spawn, spawn_yaw_deg, version, (SIZE_PACK_FILE,))
        write_bytes(draft / "level.dat", pack_gzip(write_nbt(level)))
        _move(draft, target)
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def read_world(folder: str | Path, *, box: Box | None = None) -> BlockVolume:
    """Read the overworld of a world folder, of 1.18 or later.

    Args:
        folder: the folder that holds ``level.dat``.
        box: x0 y0 z0 x1 y1 z1 in blocks, the last ones not included; the smallest box of all
            that is not air where it is left out.

    Returns:
        The volume, without labels and with one block a metre: a world does not say its scale.

    Raises:
        InputError: there is no world. DamagedFileError: a file of it is broken.
        LimitError: it is too large to hold; give a box.
    """
    root = Path(folder)
    read_level(root)
    regions = _region_files(root)
    if not regions:
        raise InputError(root, "holds no region files of an overworld; nothing to read")
    sections, block_entities = _gather(regions, box)
    palette = [AIR, *sorted({s for part in sections for s in part.palette} - {AIR})]
    if len(palette) > 65_535:
        raise LimitError(root, f"holds {len(palette):,} block states; at most 65,535 are read")
    states, corner = _fill(root, sections, palette, box)
    if box is None:
        states, corner = _trimmed(states, corner)
    high = np.array(corner) + states.shape

    def inside(position: Any) -> bool:
        return bool((np.array(corner) <= position).all() and (position < high).all())

    entities = _read_entities(regions)
    return BlockVolume(
        states=states,
        palette=tuple(palette),
        semantic=np.zeros(states.shape, np.uint8),
        instance=np.zeros(states.shape, np.uint16),
        corner=corner,
        block_to_room=block_to_room(np.zeros(2), 1.0),
        block_entities=tuple(e for e in block_entities if inside(e.block_pos)),
        entities=tuple(e for e in entities if box is None or inside(e.position)),
    )


def read_level(folder: Path) -> dict[str, Any]:
    """Return the ``Data`` of a world's ``level.dat``.

    Raises:
        InputError: there is none. DamagedFileError: it is broken. LimitError: it is too large.
    """
    path = folder / "level.dat"
    if not path.is_file():
        raise InputError(folder, "is no world folder: it has no level.dat")
    data = unpack(read_bytes(path, LEVEL_LIMITS.bytes), path, LEVEL_LIMITS.bytes)
    _, root = read_nbt(data, path, LEVEL_LIMITS)
    if not isinstance(root.get("Data"), dict):
        raise DamagedFileError(path, "has no Data")
    return root["Data"]


# Writing.


def _check_heights(volume: BlockVolume, version: GameVersion) -> None:
    low, high = volume.corner[1], volume.corner[1] + volume.states.shape[1] - 1
    if low < version.min_y or high > version.max_y:
        raise UsageError(
            f"the build reaches from layer {low} to {high}, but Minecraft {version.name} has "
            f"{version.min_y} to {version.max_y}; choose fewer blocks per metre"
        )


def _check_free(target: Path) -> None:
    """Refuse a folder with something in it that is not an untouched world of this program."""
    try:
        if not target.exists() or (target.is_dir() and not any(target.iterdir())):
            return
        mark = read_level(target).get(MAKER_TAG)
    except OSError as error:
        raise OutputError(target, f"cannot be read: {error.strerror or error}") from error
    except InputError:
        raise OutputError(target, "holds other files; choose another folder") from None
    if mark != MAKER:
        reason = "holds a world that has been played in or made elsewhere"
        raise OutputError(target, f"{reason}; move it away or choose another folder")


def _move(draft: Path, target: Path) -> None:
    """Put the finished folder in its place, whole or not at all."""
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
    writer = ChunkWriter(volume.states, volume.palette, version)
    held: dict[Place, list[dict[str, Any]]] = defaultdict(list)
    for entity in volume.block_entities:
        x, y, z = entity.block_pos
        nbt = {**entity.nbt, "id": entity.id, "x": x, "y": y, "z": z}
        held[x >> 4, z >> 4].append(nbt)
    regions: dict[Place, dict[Place, bytes]] = defaultdict(dict)
    for place in sorted({*_chunk_places(volume), *held}):
        data = writer.chunk(place, volume.corner, held.get(place, []))
        if data is not None:
            regions[place[0] >> 5, place[1] >> 5][place] = data
    if not regions:
        regions[0, 0] = {}
    _write_region_files(regions, folder / "region")


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
    held: dict[Place, list[dict[str, Any]]] = defaultdict(list)
    for number, entity in enumerate(entities):
        x, _, z = entity.position
        held[int(x // 16), int(z // 16)].append(entity_nbt(entity, number))
    regions: dict[Place, dict[Place, bytes]] = defaultdict(dict)
    for place, found in held.items():
        root = {
            "DataVersion": version.level_data_version,
            "Position": np.array(place, np.int32),
            "Entities": found,
        }
        regions[place[0] >> 5, place[1] >> 5][place] = write_nbt(root)
    _write_region_files(regions, folder / "entities")


def entity_nbt(entity: Entity, number: int) -> dict[str, Any]:
    """Return an entity's tags; its UUID comes from its number, so that no two are the same."""
    digest = hashlib.sha256(f"{number} {entity.id} {entity.position}".encode()).digest()
    common = {
        "Motion": [0.0, 0.0, 0.0],
        "Rotation": [Float(0), Float(0)],
        "UUID": np.frombuffer(digest[:16], ">i4").astype(np.int32),
    }
    return {**common, **entity.nbt, "id": entity.id, "Pos": [float(v) for v in entity.position]}


# Reading.


def _region_files(root: Path) -> list[Path]:
    """The overworld's regions: beside level.dat, or from 26.1 on in a tree of dimensions."""
    for folder in (root / "region", root / "dimensions" / "minecraft" / "overworld" / "region"):
        found = sorted(folder.glob("r.*.mca"))
        if found:
            return found
    return []


def _gather(regions: list[Path], box: Box | None) -> tuple[list[Section], list[BlockEntity]]:
    sections: list[Section] = []
    entities: list[BlockEntity] = []
    unpacked = 0
    for path in regions:
        for place, data in read_region(path):
            if box is not None and not _meets(place, box):
                continue
            unpacked += len(data)
            if unpacked > MAX_UNPACKED_BYTES:
                reason = f"the world unpacks to more than {MAX_UNPACKED_BYTES:,} bytes"
                raise LimitError(path, f"{reason}; give a box of it")
            root, found = read_chunk(data, place, path)
            sections.extend(found)
            entities.extend(_block_entities(root, path))
    return sections, entities


def _meets(place: Place, box: Box) -> bool:
    x, z = place[0] * 16, place[1] * 16
    return box[0] < x + 16 and x < box[3] and box[2] < z + 16 and z < box[5]


def _block_entities(root: dict[str, Any], path: Path) -> Iterator[BlockEntity]:
    for nbt in root.get("block_entities", []):
        try:
            rest = {key: nbt[key] for key in nbt if key not in ("id", "x", "y", "z")}
            position = (int(nbt["x"]), int(nbt["y"]), int(nbt["z"]))
            yield BlockEntity(position, str(nbt["id"]), rest)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise DamagedFileError(path, "has a block entity without id and place") from error


def _fill(
    root: Path, sections: list[Section], palette: list[str], box: Box | None
) -> tuple[np.ndarray, tuple[int, int, int]]:
    if box is None:
        places = np.array([section.place for section in sections] or [(0, 4, 0)])
        low, high = places.min(axis=0) * 16, (places.max(axis=0) + 1) * 16
    else:
        low, high = np.array(box[:3]), np.array(box[3:])
    size = high - low
    if (size <= 0).any() or size.astype(float).prod() > MAX_CELLS:
        shown = " x ".join(str(side) for side in size.tolist())
        raise LimitError(root, f"{shown} blocks; at most {MAX_CELLS:,} are read: give a box")
    states = np.zeros(tuple(size.tolist()), np.uint16)
    number_of = {state: number for number, state in enumerate(palette)}
    for section in sections:
        numbers = np.array([number_of[state] for state in section.palette], np.uint16)
        origin = np.array(section.place, np.int64) * 16 - low
        if not unpack_section(section.words, numbers, states, origin):
            raise DamagedFileError(root, f"section {section.place} points outside its palette")
    x, y, z = low.tolist()
    return states, (x, y, z)


def _trimmed(
    states: np.ndarray, corner: tuple[int, int, int]
) -> tuple[np.ndarray, tuple[int, int, int]]:
    """Cut away the layers of air around the blocks."""
    cuts = []
    for axis in range(3):
        filled = np.flatnonzero(states.any(axis=tuple({0, 1, 2} - {axis})))
        cuts.append(slice(filled[0], filled[-1] + 1) if len(filled) else slice(0, 1))
    x, y, z = (int(low + cut.start) for low, cut in zip(corner, cuts, strict=True))
    return np.ascontiguousarray(states[tuple(cuts)]), (x, y, z)


def _read_entities(regions: list[Path]) -> list[Entity]:
    folder = regions[0].parent.parent / "entities"
    found: list[Entity] = []
    for path in sorted(folder.glob("r.*.mca")):
        for _, data in read_region(path):
            _, root = read_nbt(data, path)
            try:
                for nbt in root["Entities"]:
                    x, y, z = (float(value) for value in nbt["Pos"])
                    rest = {key: nbt[key] for key in nbt if key not in ("id", "Pos")}
                    found.append(Entity((x, y, z), str(nbt["id"]), rest))
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                raise DamagedFileError(path, "has an entity without id and place") from error
    return found

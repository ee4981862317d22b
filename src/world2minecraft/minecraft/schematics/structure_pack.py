"""Data packs that build a volume from structure pieces of at most 48 blocks per side.

``/function NAME:place`` loads the chunks, waits for them and places every piece. Structures keep
block entities and entities that would need long commands.
"""

import re
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.files import UNREADABLE, write_bytes
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.minecraft.commands.datapack import build_job_files, to_namespace
from world2minecraft.minecraft.commands.player_scale import pack_mcmeta, pack_zip, size_functions
from world2minecraft.minecraft.commands.writer import entity_tag
from world2minecraft.minecraft.entities import entity_tags
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.schematics.structure import parse_structure, structure_bytes
from world2minecraft.minecraft.unlabelled_volume import MAX_CELLS, join_volumes
from world2minecraft.minecraft.versions import GameVersion, game_version

PIECE = 48  # What a structure block loads and saves, since 1.16.
PACK_SUFFIX = "_pieces.zip"
FIRST_PLACE_VERSION = 3105  # 1.19, the first game with /place template.
MAX_PIECES = 4096
MAX_BYTES = 64 << 20  # Of all pieces, packed; they are gzip themselves.
FOLDERS = ("structure", "structures")  # From 1.21 on, and before.
_PART = re.compile(r"data/[^/]+/functions?/place/part_\d+\.mcfunction")
_PLACE = re.compile(
    r"place template ([a-z0-9_.-]+):([a-z0-9_./-]+) (-?\d{1,8}) (-?\d{1,8}) (-?\d{1,8})"
)


def is_too_large(volume: BlockVolume, version: GameVersion) -> bool:
    """Return whether a volume is too large for a structure block and the game can place pieces."""
    return max(volume.states.shape) > PIECE and version.data_version >= FIRST_PLACE_VERSION


def write_structure_pack(
    volume: BlockVolume,
    path: str | Path,
    *,
    name: str = "room",
    version: GameVersion | None = None,
) -> None:
    """Write a volume as a data pack of structures in a zip archive.

    Args:
        volume: The blocks, which are placed at the volume's own world position.
        path: The ``.zip`` file to write. Put it into the ``datapacks`` folder of a world.
        name: The namespace of the pieces and of the function. Invalid characters become ``_``.
        version: The target game version, 1.19 or later. The default is 1.20.1.

    Raises:
        UsageError: If the game version does not support ``/place template``.
        OutputError: If the file cannot be written.
    """
    version = version or game_version()
    if version.data_version < FIRST_PLACE_VERSION:
        raise UsageError(
            f"Minecraft {version.name} cannot place structures by command; choose version 1.19 "
            "or later (--mc-version), or write a .schem file"
        )
    space = to_namespace(name)
    files: dict[str, str | bytes] = {
        "pack.mcmeta": pack_mcmeta(f"Places {space}", version),
        **size_functions(volume.blocks_per_metre),
    }
    tag = entity_tag(volume)  # Placed again, the entities of the first time go.
    commands = [f"kill @e[tag={tag}]"] if volume.entities else []
    for number, piece in split_into_pieces(_with_tag(volume, tag)).items():
        title = "_".join([space, *map(str, number)])
        data = structure_bytes(piece, version)
        files |= {f"data/{space}/{folder}/{title}.nbt": data for folder in FOLDERS}
        place = " ".join(map(str, piece.corner))
        commands.append(f"place template {space}:{title} {place}")
    files |= build_job_files(volume, space, "place", commands, "placed")
    write_bytes(path, pack_zip(files))


def is_structure_pack(path: Path) -> bool:
    """Return whether a zip archive contains a function that places structure pieces."""
    try:
        with zipfile.ZipFile(path) as archive:
            return any(_PART.fullmatch(name) for name in archive.namelist())
    except UNREADABLE:
        return False


def read_structure_pack(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a data pack of structure pieces that this program wrote, each at its own position.

    Raises:
        InputError: If the file is not found or places no structure.
        DamagedFileError: If a piece is missing or damaged.
        LimitError: If there are too many pieces, or they are too large.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(source, "not found")
    try:
        with zipfile.ZipFile(source) as archive:
            names = set(archive.namelist())
            files = _list_placements(archive, source)
            sizes = [archive.getinfo(name).file_size for name, _ in files if name in names]
            if len(files) > MAX_PIECES or sum(sizes) > MAX_BYTES:
                raise LimitError(
                    source, f"exceeds the limit of {MAX_PIECES:,} pieces or {MAX_BYTES:,} bytes"
                )
            if len(sizes) < len(files):
                raise DamagedFileError(source, "places a structure piece that it does not contain")
            parts, cells = [], 0
            for name, place in files:
                parts.append(_read_piece(archive.read(name), source, place, losses))
                cells += parts[-1].states.size
                if cells > MAX_CELLS:  # A piece of nothing but air says its size in a few bytes.
                    raise LimitError(
                        source, f"has pieces that exceed the limit of {MAX_CELLS:,} blocks in total"
                    )
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is not a valid zip archive ({error})") from error
    return join_volumes(parts, source)


def _list_placements(
    archive: zipfile.ZipFile, source: Path
) -> list[tuple[str, tuple[int, int, int]]]:
    """Return the file and the position of each piece."""
    parts = sorted(name for name in archive.namelist() if _PART.fullmatch(name))
    found = {}
    for name in parts:
        if archive.getinfo(name).file_size > MAX_BYTES:
            raise LimitError(
                source, f"contains a function that exceeds the limit of {MAX_BYTES:,} bytes"
            )
        folder = FOLDERS[1] if "/functions/" in name else FOLDERS[0]
        for match in _PLACE.finditer(archive.read(name).decode("utf-8", "replace")):
            space, title, x, y, z = match.groups()
            found[space, title] = (f"data/{space}/{folder}/{title}.nbt", (int(x), int(y), int(z)))
    if not found:
        raise InputError(source, "contains no command that places a structure")
    return list(found.values())


def _read_piece(
    data: bytes, source: Path, place: tuple[int, int, int], losses: Losses | None
) -> BlockVolume:
    piece = parse_structure(data, source, losses)
    if piece.corner != place:
        raise DamagedFileError(
            source, f"places a piece at {place}, but the piece states the position {piece.corner}"
        )
    return piece


def split_into_pieces(volume: BlockVolume) -> dict[tuple[int, int, int], BlockVolume]:
    """Split a volume into pieces of at most 48 blocks per side, by piece index along x, y, z."""
    counts = [-(-side // PIECE) for side in volume.states.shape]
    return {(x, y, z): _piece(volume, (x, y, z)) for x, y, z in np.ndindex(*counts)}


def _piece(volume: BlockVolume, number: tuple[int, int, int]) -> BlockVolume:
    start = np.array(number) * PIECE
    box = tuple(slice(low, low + PIECE) for low in start.tolist())
    x, y, z = (start + volume.corner).tolist()

    last = np.array(volume.states.shape) - 1

    def is_inside(place: tuple[float, ...]) -> bool:
        """Return whether a position is nearest to this piece."""
        cell = np.clip(np.floor(np.subtract(place, volume.corner)), 0, last)
        return bool((cell // PIECE == number).all())

    states = volume.states[box]
    used, numbers = np.unique(states, return_inverse=True)
    own = np.union1d(used, 0)  # A palette begins with air.
    numbers = np.searchsorted(own, used)[numbers].reshape(states.shape)
    return replace(
        volume,
        states=np.ascontiguousarray(numbers.astype(np.uint16)),
        palette=tuple(volume.palette[n] for n in own.tolist()),
        semantic=np.ascontiguousarray(volume.semantic[box]),
        instance=np.ascontiguousarray(volume.instance[box]),
        corner=(x, y, z),
        block_entities=tuple(e for e in volume.block_entities if is_inside(e.block_pos)),
        entities=tuple(e for e in volume.entities if is_inside(e.position)),
    )


def _with_tag(volume: BlockVolume, tag: str) -> BlockVolume:
    def with_tag(entity: Entity) -> Entity:
        return replace(entity, nbt={**entity.nbt, "Tags": [*entity_tags(entity.nbt), tag]})

    return replace(volume, entities=tuple(map(with_tag, volume.entities)))

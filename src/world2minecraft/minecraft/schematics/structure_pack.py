"""A data pack that builds a volume from structures: pieces of 48 blocks a side and a function.

``/function NAME:place`` loads the chunks, waits for them, and places every piece where it belongs.
Structures carry what commands cannot say shortly: block entities and entities as they are.
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
    """Whether a volume needs a pack of pieces, and the game can place them."""
    return max(volume.states.shape) > PIECE and version.data_version >= FIRST_PLACE_VERSION


def write_structure_pack(
    volume: BlockVolume,
    path: str | Path,
    *,
    name: str = "room",
    version: GameVersion | None = None,
) -> None:
    """Write a volume as the zip of a data pack of structures.

    Args:
        volume: the blocks; they are placed at the volume's own world position.
        path: the file, ``.zip``, to be put into ``datapacks`` of a world.
        name: the namespace of the pieces and of the function; what no namespace can hold of it
            becomes ``_``.
        version: the game to write for, 1.19 or later; 1.20.1 where it is left out.

    Raises:
        UsageError: the game has no ``/place template``. OutputError: it cannot be written.
    """
    version = version or game_version()
    if version.data_version < FIRST_PLACE_VERSION:
        raise UsageError(
            f"Minecraft {version.name} places no structures by command; choose 1.19 or later, or "
            "write a .schem"
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
    """Whether a zip has the function that places the pieces of a structure."""
    try:
        with zipfile.ZipFile(path) as archive:
            return any(_PART.fullmatch(name) for name in archive.namelist())
    except UNREADABLE:
        return False


def read_structure_pack(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read the pieces of a pack that this program wrote, each where the function places it.

    Raises:
        InputError: there is no file, or it places nothing. DamagedFileError: a piece is missing
        or broken. LimitError: there are too many, or they are too large.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(source, "is not there")
    try:
        with zipfile.ZipFile(source) as archive:
            names = set(archive.namelist())
            files = _list_placements(archive, source)
            sizes = [archive.getinfo(name).file_size for name, _ in files if name in names]
            if len(files) > MAX_PIECES or sum(sizes) > MAX_BYTES:
                raise LimitError(
                    source, f"has more than {MAX_PIECES:,} pieces or {MAX_BYTES:,} bytes"
                )
            if len(sizes) < len(files):
                raise DamagedFileError(source, "places a piece that it does not hold")
            parts, cells = [], 0
            for name, place in files:
                parts.append(_read_piece(archive.read(name), source, place, losses))
                cells += parts[-1].states.size
                if cells > MAX_CELLS:  # A piece of nothing but air says its size in a few bytes.
                    raise LimitError(source, f"its pieces have over {MAX_CELLS:,} blocks together")
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is no readable zip ({error})") from error
    return join_volumes(parts, source)


def _list_placements(
    archive: zipfile.ZipFile, source: Path
) -> list[tuple[str, tuple[int, int, int]]]:
    """Return the file of each piece, and where the function places it."""
    parts = sorted(name for name in archive.namelist() if _PART.fullmatch(name))
    found = {}
    for name in parts:
        if archive.getinfo(name).file_size > MAX_BYTES:
            raise LimitError(source, f"has a function of more than {MAX_BYTES:,} bytes")
        folder = FOLDERS[1] if "/functions/" in name else FOLDERS[0]
        for match in _PLACE.finditer(archive.read(name).decode("utf-8", "replace")):
            space, title, x, y, z = match.groups()
            found[space, title] = (f"data/{space}/{folder}/{title}.nbt", (int(x), int(y), int(z)))
    if not found:
        raise InputError(source, "places no structure")
    return list(found.values())


def _read_piece(
    data: bytes, source: Path, place: tuple[int, int, int], losses: Losses | None
) -> BlockVolume:
    piece = parse_structure(data, source, losses)
    if piece.corner != place:
        raise DamagedFileError(source, f"places at {place} what says to stand at {piece.corner}")
    return piece


def split_into_pieces(volume: BlockVolume) -> dict[tuple[int, int, int], BlockVolume]:
    """Return the volume in boxes of at most 48 blocks a side, by their number along x, y, z."""
    counts = [-(-side // PIECE) for side in volume.states.shape]
    return {(x, y, z): _piece(volume, (x, y, z)) for x, y, z in np.ndindex(*counts)}


def _piece(volume: BlockVolume, number: tuple[int, int, int]) -> BlockVolume:
    start = np.array(number) * PIECE
    box = tuple(slice(low, low + PIECE) for low in start.tolist())
    x, y, z = (start + volume.corner).tolist()

    last = np.array(volume.states.shape) - 1

    def is_inside(place: tuple[float, ...]) -> bool:
        """Entities that stand beside the box belong to the piece that is nearest."""
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

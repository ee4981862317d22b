"""A data pack that builds a volume from structures: pieces of 48 blocks a side and a function.

``/function NAME:place`` loads the chunks, waits for them, and places every piece where it belongs.
Structures carry what commands cannot say shortly: block entities and entities as they are.
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.errors import UsageError
from world2minecraft.files import write_bytes
from world2minecraft.minecraft.commands import entity_tag
from world2minecraft.minecraft.datapack import job_files
from world2minecraft.minecraft.sizes import pack_mcmeta, pack_zip, size_functions
from world2minecraft.minecraft.structure import structure_bytes
from world2minecraft.minecraft.versions import GameVersion, game_version
from world2minecraft.types import BlockVolume, Entity

PIECE = 48  # What a structure block loads and saves, since 1.16.
PACK_SUFFIX = "_pieces.zip"
FIRST_PLACE_VERSION = 3105  # 1.19, the first game with /place template.
FOLDERS = ("structure", "structures")  # From 1.21 on, and before.
_NAME = re.compile(r"[a-z0-9_.-]+")


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
    space = _namespace(name)
    files: dict[str, str | bytes] = {
        "pack.mcmeta": pack_mcmeta(f"Places {space}", version),
        **size_functions(volume.blocks_per_metre),
    }
    tag = entity_tag(volume)  # Placed again, the entities of the first time go.
    commands = [f"kill @e[tag={tag}]"] if volume.entities else []
    for number, piece in pieces(_tagged(volume, tag)).items():
        title = "_".join([space, *map(str, number)])
        data = structure_bytes(piece, version)
        files |= {f"data/{space}/{folder}/{title}.nbt": data for folder in FOLDERS}
        place = " ".join(map(str, piece.corner))
        commands.append(f"place template {space}:{title} {place}")
    files |= job_files(volume, space, "place", commands, "placed")
    write_bytes(path, pack_zip(files))


def pieces(volume: BlockVolume) -> dict[tuple[int, int, int], BlockVolume]:
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
    kept = np.union1d(used, 0)  # A palette begins with air.
    numbers = np.searchsorted(kept, used)[numbers].reshape(states.shape)
    return replace(
        volume,
        states=np.ascontiguousarray(numbers.astype(np.uint16)),
        palette=tuple(volume.palette[n] for n in kept.tolist()),
        semantic=np.ascontiguousarray(volume.semantic[box]),
        instance=np.ascontiguousarray(volume.instance[box]),
        corner=(x, y, z),
        block_entities=tuple(e for e in volume.block_entities if is_inside(e.block_pos)),
        entities=tuple(e for e in volume.entities if is_inside(e.position)),
    )


def _tagged(volume: BlockVolume, tag: str) -> BlockVolume:
    def with_tag(entity: Entity) -> Entity:
        return replace(entity, nbt={**entity.nbt, "Tags": [*entity.nbt.get("Tags", []), tag]})

    return replace(volume, entities=tuple(map(with_tag, volume.entities)))


def _namespace(name: str) -> str:
    lowered = re.sub(r"[^a-z0-9_.-]", "_", name.lower())
    return lowered if _NAME.fullmatch(lowered) and lowered != "minecraft" else "room"

"""Registry of block formats, which are detected by file suffix or folder content.

A format is one class and one entry in ``FORMATS``. Readers and writers count in ``losses`` the data
that they cannot convert; ``write_blocks`` counts the labels, which no game format stores.
"""

from pathlib import Path
from typing import Literal, Protocol

import numpy as np

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.file_format import FileFormat, Losses, WriteOptions

PLAYER_LAYERS = 2  # A player is 1.8 blocks high.
LABELS = "labels of blocks (class and object)"  # What no format of the game holds.
FORMATS = Registry(
    "block_format",
    {
        "world": "world2minecraft.minecraft.formats:WorldFormat",
        "schem": "world2minecraft.minecraft.formats:SchemFormat",
        "datapack": "world2minecraft.minecraft.formats:DatapackFormat",
        "litematic": "world2minecraft.minecraft.schematic_formats:LitematicFormat",
        "structure": "world2minecraft.minecraft.schematic_formats:StructureFormat",
        "legacy": "world2minecraft.minecraft.schematic_formats:LegacySchematicFormat",
        "mcfunction": "world2minecraft.minecraft.commands.mcfunction:CommandListFormat",
        "mcstructure": "world2minecraft.minecraft.bedrock.mcstructure:McstructureFormat",
    },
)


def default_spawn(volume: BlockVolume) -> tuple[float, float, float]:
    """Return a standing position near the middle of the volume, in world block coordinates.

    The position is on top of a block with two free layers above it. Positions under a roof are
    preferred, then those nearest to the middle, then the lowest. If there is no such position, the
    result is the middle above the volume.
    """
    size_x, size_y, size_z = volume.states.shape
    tops = np.array([_top_height(state) for state in volume.palette])
    heights = np.pad(tops[volume.states], ((0, 0), (0, PLAYER_LAYERS), (0, 0)))
    is_free = heights == 0
    stands = (heights[:, :size_y] > 0) & is_free[:, 1 : size_y + 1] & is_free[:, 2:]
    middle = np.array([size_x / 2 - 0.5, size_z / 2 - 0.5])
    x, y, z = volume.corner
    if not stands.any():
        return (x + size_x / 2, float(y + size_y), z + size_z / 2)
    cells = np.argwhere(stands)
    distance = np.square(cells[:, [0, 2]] - middle).sum(axis=1)
    roof = np.where(
        volume.states.any(axis=1), size_y - 1 - _first_solid_layer(volume.states[:, ::-1]), -1
    )
    is_outside = cells[:, 1] >= roof[cells[:, 0], cells[:, 2]]
    best = cells[np.lexsort((cells[:, 1], distance, is_outside))[0]]
    floor = float(y + best[1] + heights[tuple(best)])
    return (float(x + best[0] + 0.5), floor, float(z + best[2] + 0.5))


def _first_solid_layer(states: np.ndarray) -> np.ndarray:
    """Return the first layer of each column that is not air."""
    return (states > 0).argmax(axis=1)


def _top_height(state: str) -> float:
    boxes = boxes_of(state)
    return float(boxes[:, 4].max()) if len(boxes) else 0.0


class BlockFormat(Protocol):
    """Interface of a block format. ``suffix`` is empty for a world folder.

    ``keeps_labels`` is whether files store the class and the object of each block.
    """

    suffix: str
    can_read: bool
    can_write: bool
    keeps_labels: bool

    def is_at(self, path: Path) -> bool:
        """Return whether the file or folder at ``path`` has this format, by its name or content."""
        ...

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read a volume of blocks.

        Raises:
            InputError: If the file or folder cannot be read.
        """
        ...

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write a volume of blocks.

        Raises:
            OutputError: If the file or folder cannot be written.
            UsageError: If the format cannot store the volume.
        """
        ...


def read_blocks(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read blocks from a file or folder of any known format.

    Args:
        path: The file or folder to read.
        losses: Counts of the data that a volume cannot store, updated by this call.

    Raises:
        InputError: If the path is not found, has an unknown format or cannot be read.
    """
    source = Path(path)
    if not source.exists():
        raise InputError(source, "not found")
    for format_ in block_formats():
        if format_.can_read and format_.is_at(source):
            return format_.read(source, Losses() if losses is None else losses)
    raise InputError(source, f"is not in a supported format; expected: {list_suffixes('read')}")


def write_blocks(
    volume: BlockVolume,
    path: str | Path,
    options: WriteOptions | None = None,
    losses: Losses | None = None,
) -> None:
    """Write blocks in the format that the path's suffix selects.

    A path without a suffix is written as a world folder.

    Args:
        volume: The blocks to write.
        path: The file or folder to write.
        options: The target game version and other options.
        losses: Counts of the data that the format cannot store, updated by this call.

    Raises:
        UsageError: If no format has this suffix.
        OutputError: If the path cannot be written.
    """
    target = Path(path)
    format_ = format_for_path(target)
    counted = Losses() if losses is None else losses
    format_.write(volume, target, options or WriteOptions(), counted)
    if not format_.keeps_labels:
        counted.add(LABELS, int((volume.semantic > 0).sum()))


def format_for_path(path: str | Path) -> BlockFormat:
    """Return the format that a path's suffix selects for writing.

    Raises:
        UsageError: If no writable format has this suffix.
    """
    suffix = Path(path).suffix.lower()
    for format_ in block_formats():
        if format_.can_write and suffix == format_.suffix:
            return format_
    raise UsageError(
        f"{path}: unknown file suffix for blocks; use one of: {list_suffixes('write')}"
    )


def block_formats() -> list[BlockFormat]:
    """Return an instance of every block format, with the built-in formats first."""
    return [FORMATS.load(name)() for name in FORMATS.names()]


def list_suffixes(verb: Literal["read", "write"]) -> str:
    """Return the suffixes that can be read or written as text for an error message."""
    able = [f for f in block_formats() if (f.can_read if verb == "read" else f.can_write)]
    return ", ".join(f.suffix or "a world folder" for f in able)


class WorldFormat:
    """The world format, a folder with a ``level.dat`` file."""

    suffix = ""
    can_read = True
    can_write = True
    keeps_labels = False

    def is_at(self, path: Path) -> bool:
        """Return whether the folder contains a ``level.dat`` file."""
        return (path / "level.dat").is_file()

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read the overworld of a world folder."""
        from world2minecraft.minecraft.worlds.world_writer import read_world  # noqa: PLC0415  # It needs numba.

        return read_world(path)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write a world folder. The default spawn position is on top of a block near the middle."""
        from world2minecraft.minecraft.block_renames import count_unknown_blocks  # noqa: PLC0415
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415
        from world2minecraft.minecraft.worlds.world_writer import write_world  # noqa: PLC0415  # numba.

        count_unknown_blocks(volume, game_version(options.mc_version), losses)
        write_world(
            volume,
            path,
            name=options.name,
            spawn=options.spawn or default_spawn(volume),
            spawn_yaw_deg=options.spawn_yaw_deg,
            version=game_version(options.mc_version),
        )


class SchemFormat(FileFormat):
    """The Sponge schematic format, ``.schem``."""

    suffix = ".schem"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read a schematic of version 1, 2 or 3."""
        from world2minecraft.minecraft.schematics.sponge import read_schem  # noqa: PLC0415  # It needs numba.

        return read_schem(path, losses)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write a schematic of version 2, or of the version in ``options``."""
        from world2minecraft.minecraft.block_renames import count_unknown_blocks  # noqa: PLC0415
        from world2minecraft.minecraft.schematics.sponge import write_schem  # noqa: PLC0415  # numba.
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        if options.schem_version not in (1, 2, 3):
            raise UsageError(f"schem_version must be 1, 2 or 3, got {options.schem_version}")
        if options.schem_version == 1:
            losses.add("entities, which schematic version 1 cannot store", len(volume.entities))
        count_unknown_blocks(volume, game_version(options.mc_version), losses)
        write_schem(
            volume,
            path,
            schem_version=options.schem_version,
            version=game_version(options.mc_version),
        )


class DatapackFormat:
    """The data pack format, a ``.zip`` of build commands. Only this program's packs are read."""

    suffix = ".zip"
    can_read = True
    can_write = True
    keeps_labels = False

    def is_at(self, path: Path) -> bool:
        """Return whether the path has the suffix ``.zip``."""
        return path.suffix.lower() == self.suffix

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read the blocks that a data pack's ``build`` function or structures place."""
        from world2minecraft.minecraft.commands.parser import read_datapack  # noqa: PLC0415
        from world2minecraft.minecraft.schematics.structure_pack import (  # noqa: PLC0415
            is_structure_pack,
            read_structure_pack,
        )

        if is_structure_pack(path):
            return read_structure_pack(path, losses)
        return read_datapack(path, losses)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write a data pack with a namespace derived from the name in ``options``."""
        from world2minecraft.minecraft.block_renames import count_unknown_blocks  # noqa: PLC0415
        from world2minecraft.minecraft.commands.datapack import (  # noqa: PLC0415  # numba.
            to_namespace,
            write_datapack,
        )
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        version = game_version(options.mc_version)
        count_unknown_blocks(volume, version, losses)
        write_datapack(volume, path, version=version, name=to_namespace(options.name))

"""The formats that hold blocks, found by a file's suffix or a folder's content.

A format is one class and one line of ``FORMATS``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from world2minecraft.errors import InputError, UsageError
from world2minecraft.registry import Registry
from world2minecraft.types import BlockVolume

FORMATS = Registry(
    "block_format",
    {
        "world": "world2minecraft.minecraft.formats:WorldFormat",
        "schem": "world2minecraft.minecraft.formats:SchemFormat",
        "datapack": "world2minecraft.minecraft.formats:DatapackFormat",
    },
)


class BlockFormat(Protocol):
    """A format that holds blocks. ``suffix`` is empty for a format that is a folder."""

    suffix: str
    can_read: bool

    def is_at(self, path: Path) -> bool:
        """Whether the file or folder at ``path`` is of this format, by its name or content."""
        ...

    def read(self, path: Path) -> BlockVolume:
        """Read the blocks. Raises ``InputError`` or one of its kinds."""
        ...

    def write(self, volume: BlockVolume, path: Path, options: "WriteOptions") -> None:
        """Write the blocks. Raises ``OutputError`` or ``UsageError``."""
        ...


@dataclass(frozen=True)
class WriteOptions:
    """What a writer may be told; a format takes what it needs."""

    mc_version: str = "1.20.1"
    name: str = "room"
    spawn: tuple[float, float, float] | None = None
    spawn_yaw_deg: float = 0.0
    schem_version: int = 2
    other: Mapping[str, Any] = field(default_factory=dict)


def read_blocks(path: str | Path) -> BlockVolume:
    """Read blocks from any known format.

    Raises:
        InputError: nothing is there or no format knows it, or one of its kinds from the reader.
    """
    source = Path(path)
    if not source.exists():
        raise InputError(source, "is not there")
    for format_ in _formats():
        if format_.can_read and format_.is_at(source):
            return format_.read(source)
    raise InputError(source, f"is no block file that is read; known: {_known(reading=True)}")


def write_blocks(
    volume: BlockVolume, path: str | Path, options: WriteOptions | None = None
) -> None:
    """Write blocks in the format that the path's suffix names; without one, as a world folder.

    Raises:
        UsageError: no format has this suffix. OutputError: the path cannot be written.
    """
    target = Path(path)
    for format_ in _formats():
        if target.suffix.lower() == format_.suffix:
            format_.write(volume, target, options or WriteOptions())
            return
    raise UsageError(f"{target}: no block format ends so; known: {_known(reading=False)}")


class WorldFormat:
    """A world folder."""

    suffix = ""
    can_read = True

    def is_at(self, path: Path) -> bool:
        """Whether a ``level.dat`` is there."""
        return (path / "level.dat").is_file()

    def read(self, path: Path) -> BlockVolume:
        """Read the overworld."""
        from world2minecraft.minecraft.world import read_world  # noqa: PLC0415  # It needs numba.

        return read_world(path)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions) -> None:
        """Write a world whose player starts at ``spawn``, or on top of the middle."""
        from world2minecraft.minecraft.spawn import top_of_middle  # noqa: PLC0415
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415
        from world2minecraft.minecraft.world import write_world  # noqa: PLC0415  # numba.

        write_world(
            volume,
            path,
            name=options.name,
            spawn=options.spawn or top_of_middle(volume),
            spawn_yaw_deg=options.spawn_yaw_deg,
            version=game_version(options.mc_version),
        )


class SchemFormat:
    """A Sponge schematic."""

    suffix = ".schem"
    can_read = True

    def is_at(self, path: Path) -> bool:
        """Whether the name ends so."""
        return path.is_file() and path.suffix.lower() == self.suffix

    def read(self, path: Path) -> BlockVolume:
        """Read version 1, 2 or 3."""
        from world2minecraft.minecraft.schem import read_schem  # noqa: PLC0415  # It needs numba.

        return read_schem(path)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions) -> None:
        """Write version 2, or 3 where the options say so."""
        from world2minecraft.minecraft.schem import write_schem  # noqa: PLC0415  # numba.
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        if options.schem_version not in (2, 3):
            raise UsageError(f"schem_version must be 2 or 3, not {options.schem_version}")
        write_schem(
            volume,
            path,
            schem_version=3 if options.schem_version == 3 else 2,
            version=game_version(options.mc_version),
        )


class DatapackFormat:
    """A data pack of build commands; it is written and not read."""

    suffix = ".zip"
    can_read = False

    def is_at(self, path: Path) -> bool:
        """Whether the name ends so."""
        return path.suffix.lower() == self.suffix

    def read(self, path: Path) -> BlockVolume:
        """Refuse: commands are no volume."""
        raise InputError(path, "is a data pack, which is written and not read")

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions) -> None:
        """Write the pack under the namespace of the options' name."""
        from world2minecraft.minecraft.datapack import write_datapack  # noqa: PLC0415  # numba.
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        version = game_version(options.mc_version)
        write_datapack(volume, path, version=version, name=options.name)


def _formats() -> list[BlockFormat]:
    return [FORMATS.load(name)() for name in FORMATS.names()]


def _known(*, reading: bool) -> str:
    suffixes = [f.suffix or "a world folder" for f in _formats() if f.can_read or not reading]
    return ", ".join(suffixes)

"""Formats for sharing builds: Litematica files, structure files and legacy schematics."""

from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.file_format import FileFormat, Losses

if TYPE_CHECKING:
    from world2minecraft.minecraft.file_format import WriteOptions


class LitematicFormat(FileFormat):
    """The Litematica format, ``.litematic``."""

    suffix = ".litematic"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read a file of version 4 to 7 and join its regions."""
        from world2minecraft.minecraft.schematics.litematic import read_litematic  # noqa: PLC0415  # numba.

        return read_litematic(path, losses)

    def write(
        self, volume: BlockVolume, path: Path, options: "WriteOptions", losses: Losses
    ) -> None:
        """Write a file with one region that has the name in ``options``."""
        from world2minecraft.minecraft.block_renames import count_unknown_blocks  # noqa: PLC0415
        from world2minecraft.minecraft.schematics.litematic import write_litematic  # noqa: PLC0415
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        version = game_version(options.mc_version)
        count_unknown_blocks(volume, version, losses)
        write_litematic(volume, path, name=options.name, version=version)


class StructureFormat(FileFormat):
    """The game's structure format, ``.nbt``."""

    suffix = ".nbt"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read a structure file. If it has several palettes, the first is used."""
        from world2minecraft.minecraft.schematics.structure import read_structure  # noqa: PLC0415  # numba.

        return read_structure(path, losses)

    def write(
        self, volume: BlockVolume, path: Path, options: "WriteOptions", losses: Losses
    ) -> None:
        """Write a structure file, and also a data pack of pieces if the volume is large."""
        from world2minecraft.minecraft.block_renames import count_unknown_blocks  # noqa: PLC0415
        from world2minecraft.minecraft.schematics.structure import write_structure  # noqa: PLC0415
        from world2minecraft.minecraft.schematics.structure_pack import (  # noqa: PLC0415
            PACK_SUFFIX,
            is_too_large,
            write_structure_pack,
        )
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        version = game_version(options.mc_version)
        count_unknown_blocks(volume, version, losses)
        write_structure(volume, path, version=version)
        if is_too_large(volume, version):
            pack = path.with_name(path.stem + PACK_SUFFIX)
            write_structure_pack(volume, pack, name=options.name, version=version)


class LegacySchematicFormat(FileFormat):
    """The schematic format of MCEdit and WorldEdit before 1.13, which can only be read."""

    suffix = ".schematic"
    can_write = False

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read a legacy schematic and convert its block IDs to current block states."""
        from world2minecraft.minecraft.schematics.mcedit import read_schematic  # noqa: PLC0415  # numba.

        return read_schematic(path, losses)

    def write(
        self, volume: BlockVolume, path: Path, options: "WriteOptions", losses: Losses
    ) -> None:
        """Raise UsageError, because legacy block IDs cannot represent most current blocks."""
        raise UsageError(f"{path}: .schematic files cannot be written; write a .schem file instead")

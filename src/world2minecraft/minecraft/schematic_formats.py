"""Formats in which players share builds: Litematica, structures, old schematics."""

from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.file_format import FileFormat, Losses

if TYPE_CHECKING:
    from world2minecraft.minecraft.file_format import WriteOptions


class LitematicFormat(FileFormat):
    """A Litematica file."""

    suffix = ".litematic"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read version 4 to 7, its regions joined."""
        from world2minecraft.minecraft.schematics.litematic import read_litematic  # noqa: PLC0415  # numba.

        return read_litematic(path, losses)

    def write(
        self, volume: BlockVolume, path: Path, options: "WriteOptions", losses: Losses
    ) -> None:
        """Write one region under the options' name."""
        from world2minecraft.minecraft.block_renames import count_unknown_blocks  # noqa: PLC0415
        from world2minecraft.minecraft.schematics.litematic import write_litematic  # noqa: PLC0415
        from world2minecraft.minecraft.versions import game_version  # noqa: PLC0415

        version = game_version(options.mc_version)
        count_unknown_blocks(volume, version, losses)
        write_litematic(volume, path, name=options.name, version=version)


class StructureFormat(FileFormat):
    """A structure file of the game."""

    suffix = ".nbt"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read the structure, of several palettes the first."""
        from world2minecraft.minecraft.schematics.structure import read_structure  # noqa: PLC0415  # numba.

        return read_structure(path, losses)

    def write(
        self, volume: BlockVolume, path: Path, options: "WriteOptions", losses: Losses
    ) -> None:
        """Write one structure; one too large for a structure block gets a pack of pieces too."""
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
    """A schematic of MCEdit, WorldEdit or Schematica from before 1.13; it is read only."""

    suffix = ".schematic"
    can_write = False

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read it, its numbers as today's states."""
        from world2minecraft.minecraft.schematics.mcedit import read_schematic  # noqa: PLC0415  # numba.

        return read_schematic(path, losses)

    def write(
        self, volume: BlockVolume, path: Path, options: "WriteOptions", losses: Losses
    ) -> None:
        """Refuse: numbers of 1.12 name a fraction of today's blocks."""
        raise UsageError(f"{path}: .schematic is read and not written; write a .schem instead")

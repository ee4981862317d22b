"""Writing of plain command lists (``.mcfunction``), for any tool that runs commands."""

from pathlib import Path

from world2minecraft.core.files import write_text
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_renames import count_unknown_blocks
from world2minecraft.minecraft.commands.parser import read_command_list
from world2minecraft.minecraft.commands.writer import build_commands, chunk_rows
from world2minecraft.minecraft.entities import check_displays
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.file_format import FileFormat, Losses, WriteOptions
from world2minecraft.minecraft.versions import GameVersion, game_version

CHAIN_LIMIT = 65_536  # The most commands that the game runs of one function.


def write_command_list(
    volume: BlockVolume, path: str | Path, *, version: GameVersion | None = None
) -> None:
    """Write the commands that build a volume at its world position, one per line.

    Full blocks come first, so that attached blocks find their supports. The chunks must be loaded
    before the commands run; comments at the top of the file contain the commands that load them.

    Raises:
        UsageError: If the game version does not support display entities that the volume contains,
            or if an entity ID is invalid.
        OutputError: If the file cannot be written.
    """
    version = version or game_version()
    check_displays(volume, version)
    volume = convert_volume(volume, version.data_version)
    commands = build_commands(volume, version)
    head = [f"# {len(commands):,} commands for Minecraft {version.name}, made by World2Minecraft."]
    if len(commands) > CHAIN_LIMIT:
        limit = f"# The game runs at most {CHAIN_LIMIT:,} commands per function;"
        head.append(f"{limit} use a data pack instead, which is split into parts.")
    head.append("# Load the chunks first:")
    head += [f"# forceload add {row}" for row in chunk_rows(volume)]
    write_text(path, "\n".join([*head, *commands]) + "\n")


class CommandListFormat(FileFormat):
    """The command list format, ``.mcfunction``."""

    suffix = ".mcfunction"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read the blocks that the commands of a list set."""
        return read_command_list(path, losses)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write a command list for the game version in ``options``."""
        version = game_version(options.mc_version)
        count_unknown_blocks(volume, version, losses)
        write_command_list(volume, path, version=version)

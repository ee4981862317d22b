"""Data packs with commands that build a volume, remove it, and change the player's size.

``/function NAME:build`` loads the chunks, waits for them and then runs one part per tick. Each part
is below the game's command limit. ``/function NAME:clear`` empties the same box.
"""

import json
import re
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.commands.player_scale import (
    function_files,
    pack_mcmeta,
    pack_zip,
    size_functions,
)
from world2minecraft.minecraft.commands.writer import (
    build_commands,
    chunk_rows,
    clear_commands,
    probe_columns,
)
from world2minecraft.minecraft.entities import check_displays
from world2minecraft.minecraft.entity_conversion import convert_volume
from world2minecraft.minecraft.versions import GameVersion, game_version, game_versions

MAX_COMMANDS = 60_000  # Below maxCommandChainLength, 65,536, which counts a whole chain.
WAIT_TICKS = 10
_NAMESPACE = re.compile(r"[a-z0-9_.-]+")


def write_datapack(
    volume: BlockVolume,
    path: str | Path,
    *,
    version: GameVersion | None = None,
    name: str = "room",
) -> None:
    """Write a volume as a data pack in a zip archive.

    The commands place full blocks first and then all other blocks from bottom to top, so that
    attached blocks find their supports. Blocks are placed at the volume's own world position.

    Args:
        volume: The volume to build.
        path: The ``.zip`` file to write. Put it into the ``datapacks`` folder of a world.
        version: The target game version. The default is 1.20.1.
        name: The namespace of the functions.

    Raises:
        UsageError: If ``name`` is not a valid namespace, or the game version does not support the
            contents of the volume.
        OutputError: If the file cannot be written.
    """
    write_bytes(path, pack_zip(datapack_files(volume, version or game_version(), name)))


def to_namespace(name: str) -> str:
    """Convert a name to a valid data pack namespace by replacing invalid characters with ``_``.

    Example:
        >>> to_namespace("My Room"), to_namespace("minecraft"), to_namespace("")
        ('my_room', 'room', 'room')
    """
    lowered = re.sub(r"[^a-z0-9_.-]", "_", name.lower())
    return lowered if lowered not in ("", "minecraft") else "room"


def has_packs(version: GameVersion) -> bool:
    """Return whether data packs can be written for a game version."""
    return version in game_versions()


def datapack_files(volume: BlockVolume, version: GameVersion, name: str) -> dict[str, str]:
    """Return the contents of a data pack's files by path.

    Raises:
        UsageError: If ``name`` is not a valid namespace, or the game version does not support the
            contents of the volume.
    """
    if not _NAMESPACE.fullmatch(name) or name == "minecraft":
        raise UsageError(
            f"data pack name {name!r} must contain only lower-case letters, digits, _ . or -, "
            f"and not be minecraft; try {to_namespace(name)}"
        )
    check_displays(volume, version)
    if not has_packs(version):
        first = game_versions()[0].name
        raise UsageError(
            f"data packs require Minecraft {first} or later, got {version.name}; "
            "choose another version (--mc-version)"
        )
    volume = convert_volume(volume, version.data_version)
    files = {"pack.mcmeta": pack_mcmeta(f"Builds {name}", version)}
    files |= size_functions(volume.blocks_per_metre)
    commands = build_commands(volume, version)
    files |= build_job_files(volume, name, "build", commands, "built")
    files |= build_job_files(volume, name, "clear", clear_commands(volume), "cleared")
    return files


def build_job_files(
    volume: BlockVolume, name: str, verb: str, commands: list[str], done: str
) -> dict[str, str]:
    """Return the functions of one job, which loads chunks, waits, runs parts and unloads chunks."""
    rows = chunk_rows(volume)
    parts = [commands[at : at + MAX_COMMANDS] for at in range(0, len(commands), MAX_COMMANDS)]
    wait, text = f"{name}:{verb}/wait", json.dumps({"text": f"{name} is {done}."})
    loaded = " ".join(f"if loaded {x} {volume.corner[1]} {z}" for x, z in probe_columns(volume))
    start = f"{name}:{verb}/part_0" if parts else f"{name}:{verb}/end"
    # The wait repeats itself until every corner of the box is loaded, then takes itself back.
    files = {
        verb: [f"forceload add {row}" for row in rows] + [f"function {wait}"],
        f"{verb}/wait": [
            f"schedule function {wait} {WAIT_TICKS}t replace",
            f"execute {loaded} run function {name}:{verb}/begin",
        ],
        f"{verb}/begin": [f"schedule clear {wait}", f"schedule function {start} 1t replace"],
        f"{verb}/end": [f"forceload remove {row}" for row in rows] + [f"tellraw @a {text}"],
    }
    for number, part in enumerate(parts):
        following = f"part_{number + 1}" if number + 1 < len(parts) else "end"
        after = f"schedule function {name}:{verb}/{following} 1t replace"
        files[f"{verb}/part_{number}"] = [*part, after]
    result: dict[str, str] = {}
    for path, lines in files.items():
        result |= function_files(name, path, "\n".join(lines) + "\n")
    return result

"""Write a data pack that builds a volume by commands, removes it, and sizes the player.

``/function NAME:build`` loads the chunks, waits for them, then runs its parts one a tick, each
short enough for the game's command limit; ``/function NAME:clear`` empties the same box.
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
    block_commands,
    chunk_rows,
    clear_commands,
    data_commands,
    entity_commands,
    entity_tag,
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
    """Write a volume as the zip of a data pack.

    Full blocks come first and others after them, from below to above, so that what hangs or
    stands on a block finds it. The blocks stand at the volume's own world position.

    Args:
        volume: the blocks; states are written as they stand in its palette.
        path: the file, ``.zip``, to be put into ``datapacks`` of a world.
        version: the game to write for; 1.20.1 where it is left out.
        name: the namespace of the functions.

    Raises:
        UsageError: the name is no namespace, or the game is older than what the volume holds.
        OutputError: the file cannot be written.
    """
    write_bytes(path, pack_zip(datapack_files(volume, version or game_version(), name)))


def to_namespace(name: str) -> str:
    """Return a name as a pack's namespace may be: what none can hold of it becomes ``_``.

    Example:
        >>> to_namespace("My Room"), to_namespace("minecraft"), to_namespace("")
        ('my_room', 'room', 'room')
    """
    lowered = re.sub(r"[^a-z0-9_.-]", "_", name.lower())
    return lowered if lowered not in ("", "minecraft") else "room"


def has_packs(version: GameVersion) -> bool:
    """Whether data packs are written for a version of the game."""
    return version in game_versions()


def datapack_files(volume: BlockVolume, version: GameVersion, name: str) -> dict[str, str]:
    """Return the pack's files by path. Raises what ``write_datapack`` raises."""
    if not _NAMESPACE.fullmatch(name) or name == "minecraft":
        wanted = "must be lower case letters, digits, _ . or -, and not minecraft"
        raise UsageError(f"data pack name {name!r} {wanted}; try {to_namespace(name)}")
    check_displays(volume, version)
    if not has_packs(version):
        first = game_versions()[0].name
        raise UsageError(f"data packs are written for {first} and later, not {version.name}")
    volume = convert_volume(volume, version.data_version)
    files = {"pack.mcmeta": pack_mcmeta(f"Builds {name}", version)}
    files |= size_functions(volume.blocks_per_metre)
    commands = [
        *block_commands(volume, version),
        *data_commands(volume),
        # Those of an earlier run go first, so that none ever stands there twice.
        *([f"kill @e[tag={entity_tag(volume)}]"] if volume.entities else []),
        *entity_commands(volume),
    ]
    files |= build_job_files(volume, name, "build", commands, "built")
    files |= build_job_files(volume, name, "clear", clear_commands(volume), "cleared")
    return files


def build_job_files(
    volume: BlockVolume, name: str, verb: str, commands: list[str], done: str
) -> dict[str, str]:
    """Return the functions of one job: load the chunks, wait, run the parts, let go."""
    rows = chunk_rows(volume)
    parts = [commands[at : at + MAX_COMMANDS] for at in range(0, len(commands), MAX_COMMANDS)]
    wait, text = f"{name}:{verb}/wait", json.dumps({"text": f"{name} is {done}."})
    loaded = " ".join(f"if loaded {x} {volume.corner[1]} {z}" for x, z in _probes(volume))
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


def _probes(volume: BlockVolume) -> list[tuple[int, int]]:
    """Corners of the box and points every 64 blocks between them."""
    x, _, z = volume.corner
    x1, z1 = x + volume.states.shape[0] - 1, z + volume.states.shape[2] - 1
    xs, zs = sorted({*range(x, x1, 64), x1}), sorted({*range(z, z1, 64), z1})
    return [(px, pz) for px in xs for pz in zs]

"""A data pack that builds a volume in any world by commands, takes it away, and sizes the player.

``/function NAME:build`` loads the chunks, waits for them, then runs its parts one a tick, each
short enough for the game's command limit; ``/function NAME:clear`` empties the same box.
"""

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.errors import UsageError
from world2minecraft.files import write_bytes
from world2minecraft.minecraft.boxes import MAX_FILL, merge_boxes
from world2minecraft.minecraft.nbt import Byte, Float, Long, Short
from world2minecraft.minecraft.shapes import is_full_cube
from world2minecraft.minecraft.sizes import function_files, pack_mcmeta, pack_zip, size_functions
from world2minecraft.minecraft.states import parse_state
from world2minecraft.minecraft.versions import GameVersion, game_version, name_in_version
from world2minecraft.types import BlockVolume

MAX_COMMANDS = 60_000  # Below maxCommandChainLength, 65,536, which counts a whole chain.
MAX_LOADED_CHUNKS = 256  # What one forceload command takes.
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
        UsageError: the name is no namespace. OutputError: the file cannot be written.
    """
    write_bytes(path, pack_zip(datapack_files(volume, version or game_version(), name)))


def datapack_files(volume: BlockVolume, version: GameVersion, name: str) -> dict[str, str]:
    """Return the pack's files by path. Raises what ``write_datapack`` raises."""
    if not _NAMESPACE.fullmatch(name) or name == "minecraft":
        raise UsageError(f"data pack name {name!r} must be lower case letters, digits, _ . or -")
    files = {"pack.mcmeta": pack_mcmeta(f"Builds {name}", version)}
    files |= size_functions(volume.blocks_per_metre)
    commands = [*_build_commands(volume, version), *_nbt_commands(volume)]
    files |= _job(volume, name, "build", commands, "built")
    files |= _job(volume, name, "clear", list(_clear_commands(volume)), "cleared")
    return files


def _build_commands(volume: BlockVolume, version: GameVersion) -> list[str]:
    boxes = merge_boxes(volume.states)
    is_solid = np.array([is_full_cube(state) for state in volume.palette])
    order = np.lexsort((boxes[:, 2], ~is_solid[boxes[:, 0]]))
    names = [_state_in_version(state, version) for state in volume.palette]
    shift = np.tile(volume.corner, 2)
    commands = []
    for state, *cells in boxes[order].tolist():
        x0, y0, z0, x1, y1, z1 = (a + b for a, b in zip(cells, shift.tolist(), strict=True))
        if (x0, y0, z0) == (x1, y1, z1):
            commands.append(f"setblock {x0} {y0} {z0} {names[state]}")
        else:
            commands.append(f"fill {x0} {y0} {z0} {x1} {y1} {z1} {names[state]}")
    return commands


def _nbt_commands(volume: BlockVolume) -> Iterator[str]:
    for held in volume.block_entities:
        if held.nbt:
            x, y, z = held.block_pos
            yield f"data merge block {x} {y} {z} {snbt(held.nbt)}"
    for entity in volume.entities:
        x, y, z = entity.position
        tags = [*entity.nbt.get("Tags", []), _tag(volume)]
        yield f"summon {entity.id} {x:.6f} {y:.6f} {z:.6f} {snbt({**entity.nbt, 'Tags': tags})}"


def _clear_commands(volume: BlockVolume) -> Iterator[str]:
    """Empty the volume's box, layer group by layer group."""
    if volume.entities:
        yield f"kill @e[tag={_tag(volume)}]"
    size_x, size_y, size_z = volume.states.shape
    step_x, step_z = min(size_x, 128), min(size_z, 128)
    step_y = max(1, MAX_FILL // (step_x * step_z))
    x, y, z = volume.corner
    for y0 in range(0, size_y, step_y):
        for z0 in range(0, size_z, step_z):
            for x0 in range(0, size_x, step_x):
                high_x = min(x0 + step_x, size_x) - 1 + x
                high_y = min(y0 + step_y, size_y) - 1 + y
                high_z = min(z0 + step_z, size_z) - 1 + z
                low = f"{x + x0} {y + y0} {z + z0}"
                yield f"fill {low} {high_x} {high_y} {high_z} minecraft:air"


def _tag(volume: BlockVolume) -> str:
    return "w2m_{}_{}_{}".format(*volume.corner)


def _job(
    volume: BlockVolume, name: str, verb: str, commands: list[str], done: str
) -> dict[str, str]:
    """Return the functions of one job: load the chunks, wait, run the parts, let go."""
    rows = _chunk_rows(volume)
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


def _chunk_rows(volume: BlockVolume) -> list[str]:
    """Return the box in blocks as corners, cut so that each holds at most 256 chunks."""
    x, _, z = volume.corner
    size_x, _, size_z = volume.states.shape
    side = 16 * 16  # 16 x 16 chunks.
    rows = []
    for x0 in range(x // 16 * 16, x + size_x, side):
        for z0 in range(z // 16 * 16, z + size_z, side):
            x1, z1 = min(x0 + side, x + size_x) - 1, min(z0 + side, z + size_z) - 1
            rows.append(f"{max(x0, x)} {max(z0, z)} {x1} {z1}")
    return rows


def _probes(volume: BlockVolume) -> list[tuple[int, int]]:
    """Corners of the box and points every 64 blocks between them."""
    x, _, z = volume.corner
    x1, z1 = x + volume.states.shape[0] - 1, z + volume.states.shape[2] - 1
    xs, zs = sorted({*range(x, x1, 64), x1}), sorted({*range(z, z1, 64), z1})
    return [(px, pz) for px in xs for pz in zs]


def _state_in_version(state: str, version: GameVersion) -> str:
    parsed = parse_state(state)
    name = name_in_version(parsed.name, version.data_version)
    return name + str(parsed)[len(parsed.name) :]


def snbt(value: Any) -> str:
    r"""Return NBT as the text that commands take.

    Example:
        >>> snbt({"Id": Byte(1), "list": [1.5, 2.0], "text": "it's"})
        '{"Id":1b,"list":[1.5d,2.0d],"text":"it\'s"}'
    """
    if isinstance(value, np.ndarray):
        letter = {1: "B", 4: "I", 8: "L"}[value.dtype.itemsize]
        suffix = {"B": "b", "I": "", "L": "L"}[letter]
        return f"[{letter};{','.join(f'{number}{suffix}' for number in value.tolist())}]"
    if isinstance(value, Mapping):
        return "{" + ",".join(f"{_quoted(key)}:{snbt(value[key])}" for key in value) + "}"
    if isinstance(value, list | tuple):
        return "[" + ",".join(map(snbt, value)) + "]"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, bool):
        return "1b" if value else "0b"
    if isinstance(value, float):
        return f"{float(value)!r}{'f' if isinstance(value, Float) else 'd'}"
    suffixes: dict[type, str] = {Byte: "b", Short: "s", Long: "L"}
    return f"{int(value)}{suffixes.get(type(value), '')}"


def _quoted(text: str) -> str:
    """Commands stand on one line, so a line break is dropped."""
    plain = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + plain.replace("\n", " ").replace("\r", " ") + '"'

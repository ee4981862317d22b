"""Game commands that build a volume, one per line, for data packs, command lists and RCON.

Every name in a command is validated by ``parse_state`` or by a pattern in this module, so that a
file cannot inject commands.
"""

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_renames import write_state
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.commands.fill_boxes import MAX_FILL, cover_with_boxes
from world2minecraft.minecraft.entities import entity_tags
from world2minecraft.minecraft.nbt import Byte, Float, Long, Short
from world2minecraft.minecraft.versions import GameVersion

MAX_LOADED_CHUNKS = 256  # What one forceload command takes.
PROBE_STEP = 64  # Blocks.
_CONTROLS = re.compile(r"[\x00-\x1f\x7f]")
_ENTITY_ID = re.compile(r"[a-z0-9_.-]+:[a-z0-9_./-]+")


def block_commands(volume: BlockVolume, version: GameVersion) -> list[str]:
    """Return ``setblock`` and ``fill`` commands for all blocks except air.

    Full blocks come first and all other blocks follow from bottom to top, so that attached blocks
    find their supports. Each ``fill`` command is within the game's volume limit.

    Raises:
        UsageError: If a palette entry is not a valid block state.
    """
    boxes = cover_with_boxes(volume.states)
    is_solid = np.array([is_full_cube(state) for state in volume.palette])
    order = np.lexsort((boxes[:, 2], ~is_solid[boxes[:, 0]]))
    names = [state_in_version(state, version) for state in volume.palette]
    shift = np.tile(volume.corner, 2)
    commands = []
    for state, *cells in boxes[order].tolist():
        x0, y0, z0, x1, y1, z1 = (a + b for a, b in zip(cells, shift.tolist(), strict=True))
        if (x0, y0, z0) == (x1, y1, z1):
            commands.append(f"setblock {x0} {y0} {z0} {names[state]}")
        else:
            commands.append(f"fill {x0} {y0} {z0} {x1} {y1} {z1} {names[state]}")
    return commands


def build_commands(volume: BlockVolume, version: GameVersion) -> list[str]:
    """Return the commands that set all blocks and their data, then summon all entities.

    Entities of an earlier run are removed first, so that none is there twice.

    Raises:
        UsageError: If a palette entry or an entity ID is invalid.
    """
    return [
        *block_commands(volume, version),
        *data_commands(volume),
        *([f"kill @e[tag={entity_tag(volume)}]"] if volume.entities else []),
        *entity_commands(volume),
    ]


def air_commands(volume: BlockVolume, mask: np.ndarray) -> list[str]:
    """Return ``fill`` commands that empty the masked cells of a volume, given as bool [X, Y, Z]."""
    boxes = cover_with_boxes(mask.astype(np.uint16))[:, 1:] + np.tile(volume.corner, 2)
    return [f"fill {' '.join(map(str, box))} minecraft:air" for box in boxes.tolist()]


def data_commands(volume: BlockVolume) -> list[str]:
    """Return a ``data merge`` command for each block entity that contains data."""
    return [
        f"data merge block {x} {y} {z} {snbt(held.nbt)}"
        for held in volume.block_entities
        if held.nbt
        for x, y, z in (held.block_pos,)
    ]


def entity_commands(volume: BlockVolume) -> list[str]:
    """Return a ``summon`` command for each entity, with a tag by which all of them can be removed.

    Raises:
        UsageError: If an entity ID is invalid.
    """
    commands = []
    for entity in volume.entities:
        if not _ENTITY_ID.fullmatch(entity.id):
            raise UsageError(
                f"entity ID {entity.id!r} is invalid; "
                "expected an ID such as minecraft:block_display"
            )
        x, y, z = entity.position
        tags = [*entity_tags(entity.nbt), entity_tag(volume)]
        place = f"{x:.6f} {y:.6f} {z:.6f}"
        commands.append(f"summon {entity.id} {place} {snbt({**entity.nbt, 'Tags': tags})}")
    return commands


def clear_commands(volume: BlockVolume) -> list[str]:
    """Return ``fill`` commands that empty the volume's box, each within the game's limit."""
    commands = [f"kill @e[tag={entity_tag(volume)}]"] if volume.entities else []
    size_x, size_y, size_z = volume.states.shape
    step_x, step_z = min(size_x, 128), min(size_z, 128)
    step_y = max(1, MAX_FILL // max(step_x * step_z, 1))
    x, y, z = volume.corner
    for y0 in range(0, size_y, step_y):
        for z0 in range(0, size_z, step_z):
            for x0 in range(0, size_x, step_x):
                high_x = min(x0 + step_x, size_x) - 1 + x
                high_y = min(y0 + step_y, size_y) - 1 + y
                high_z = min(z0 + step_z, size_z) - 1 + z
                low = f"{x + x0} {y + y0} {z + z0}"
                commands.append(f"fill {low} {high_x} {high_y} {high_z} minecraft:air")
    return commands


def chunk_rows(volume: BlockVolume) -> list[str]:
    """Split the volume's box into ``forceload`` areas, each given as "x0 z0 x1 z1" in blocks."""
    x, _, z = volume.corner
    size_x, _, size_z = volume.states.shape
    side = 16 * int(MAX_LOADED_CHUNKS**0.5)
    rows = []
    for x0 in range(x // 16 * 16, x + size_x, side):
        for z0 in range(z // 16 * 16, z + size_z, side):
            x1, z1 = min(x0 + side, x + size_x) - 1, min(z0 + side, z + size_z) - 1
            rows.append(f"{max(x0, x)} {max(z0, z)} {x1} {z1}")
    return rows


def probe_columns(volume: BlockVolume) -> list[tuple[int, int]]:
    """Return x and z of the corners of the box and of points every 64 blocks between them.

    Where all of them are loaded, so are all chunks of the box.
    """
    x, _, z = volume.corner
    x1, z1 = x + volume.states.shape[0] - 1, z + volume.states.shape[2] - 1
    xs, zs = (sorted({*range(a, b, PROBE_STEP), b}) for a, b in ((x, x1), (z, z1)))
    return [(px, pz) for px in xs for pz in zs]


def entity_tag(volume: BlockVolume) -> str:
    """Return the entity tag of a volume, which contains the volume's corner position."""
    return "w2m_{}_{}_{}".format(*volume.corner)


def state_in_version(state: str, version: GameVersion) -> str:
    """Return the text of a block state with the names of a game version.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    return write_state(str(parse_state(state)), version.data_version)


def snbt(value: Any) -> str:
    r"""Return an NBT value as SNBT text for use in commands.

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
        value = value if math.isfinite(value) else type(value)(0)  # Commands know no other.
        return f"{float(value)!r}{'f' if isinstance(value, Float) else 'd'}"
    suffixes: dict[type, str] = {Byte: "b", Short: "s", Long: "L"}
    return f"{int(value)}{suffixes.get(type(value), '')}"


def _quoted(text: str) -> str:
    """Return a text in quotes, with control characters replaced by spaces."""
    plain = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + _CONTROLS.sub(" ", plain) + '"'

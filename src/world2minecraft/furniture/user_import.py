"""Import of blocks as a piece of furniture in the format of ``user_library``.

The volume is cropped to its blocks and rotated so that its front faces east. The visible shapes of
the blocks give the metric boxes that are used for matching.
"""

from collections import Counter
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.classes import (
    CLASS_DISPLAY_NAMES,
    CLASS_NAMES,
    OBJECT_CLASSES,
    class_id,
)
from world2minecraft.core.coordinates import block_axes_to_grid
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.furniture.design_files import MOUNTS
from world2minecraft.furniture.user_library import (
    MAX_BLOCKS,
    MAX_KINDS,
    MAX_PARTS,
    MAX_SIDE,
    PARTS_PER_BLOCK,
    check_name,
    role_of,
)
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.turn_and_mirror import SIDES, turn_volume

SEATS = ("chair", "sofa", "bed")
OPPOSITE = {"north": "south", "south": "north", "east": "west", "west": "east"}
SIZE_SHARE = 0.25  # Objects up to a quarter smaller or larger may be this piece. A guess.
MIN_SIDE_M, MAX_SIDE_M = 0.02, 20.0
INVISIBLE = ("air", "cave_air", "void_air", "structure_void", "barrier", "light")


class ImportRequest(NamedTuple):
    """The user's description of a piece of furniture. None derives a value from the blocks."""

    name: str
    kind: str  # chair, bed, sofa, table, tvs, furn or objs
    blocks_per_metre: float
    front: str | None = None  # north, east, south or west
    size_m: tuple[float, float, float] | None = None  # depth, width, height
    title: str = ""
    mount: str = "floor"
    recolour: bool = False
    match: bool = True


class ImportedFurniture(NamedTuple):
    """The contents of a user furniture file, with notes for the user."""

    content: dict[str, Any]
    front: str
    notes: tuple[str, ...]


def import_blocks(volume: BlockVolume, wish: ImportRequest) -> ImportedFurniture:
    """Return the user furniture file for a piece built from the blocks of a volume.

    Args:
        volume: The blocks. Block entities and entities are ignored.
        wish: Name, class, scale and other properties of the piece.

    Raises:
        UsageError: If the request or the blocks are invalid: no blocks, too many blocks, an unknown
            class, or no recognizable front.
    """
    _check(wish)
    kind = CLASS_NAMES[class_id(wish.kind)]
    trimmed = _trim(volume)
    front = wish.front or front_of(trimmed, kind)
    if front is None:
        raise UsageError(
            "cannot determine the front side from the blocks; set it (--front "
            "north|east|south|west)"
        )
    turned = _join_connections(turn_volume(trimmed, -SIDES.index(front)))
    cells = block_axes_to_grid(turned.states)
    parts = _parts(turned)
    shown = np.array([corners for _, *corners in parts])
    extent = (shown[:, 3:].max(axis=0) - shown[:, :3].min(axis=0)) / PARTS_PER_BLOCK
    size = np.array(wish.size_m or extent / wish.blocks_per_metre)
    _check_size(size)
    content = {
        "name": wish.name,
        "title": wish.title or wish.name.replace("_", " ").capitalize(),
        "class": kind,
        "mount": wish.mount,
        "turns": _turns(turned),
        "match": wish.match,
        "size_m": dict(zip(("depth", "width", "height"), map(_size_span, size), strict=True)),
        "blocks_per_metre": wish.blocks_per_metre,
        "colour": "object" if wish.recolour else "own",
        "blocks": _pack(cells, turned.palette),
        "parts": [[role, *map(int, corners)] for role, *corners in parts],
    }
    return ImportedFurniture(content, front, tuple(_notes(turned)))


def _check(wish: ImportRequest) -> None:
    check_name(wish.name)
    offered = [CLASS_DISPLAY_NAMES[number] for number in OBJECT_CLASSES]
    if wish.kind not in (*offered, *(CLASS_NAMES[number] for number in OBJECT_CLASSES)):
        raise UnknownNameError("furniture class", wish.kind, offered)
    if wish.front is not None and wish.front not in SIDES:
        raise UnknownNameError("side", wish.front, SIDES)
    if wish.mount not in MOUNTS:
        raise UnknownNameError("mount", wish.mount, MOUNTS)
    if not 0.1 <= wish.blocks_per_metre <= 64:
        raise UsageError(
            f"the scale must be 0.1 to 64 blocks per metre, got {wish.blocks_per_metre:g}"
        )


def _check_size(size: np.ndarray) -> None:
    if not (np.isfinite(size).all() and (size >= MIN_SIDE_M).all() and (size <= MAX_SIDE_M).all()):
        given = " x ".join(f"{side:.2f}" for side in size)
        raise UsageError(
            f"each side of the piece must be {MIN_SIDE_M:g} to {MAX_SIDE_M:g} m, got {given}; "
            "set the scale (--blocks-per-metre)"
        )


def _trim(volume: BlockVolume) -> BlockVolume:
    """Return the part of a volume that contains visible blocks, without entities."""
    seen = np.array([role_of(state) not in INVISIBLE for state in volume.palette])
    filled = seen[volume.states]
    if not filled.any():
        raise UsageError("the selection contains no blocks; select the blocks of the piece")
    held = np.argwhere(filled)
    low, high = held.min(axis=0), held.max(axis=0) + 1
    size = high - low
    if (size > MAX_SIDE).any() or int(np.prod(size)) > MAX_BLOCKS:
        given = " x ".join(str(side) for side in size.tolist())
        raise UsageError(
            f"a piece may have at most {MAX_SIDE} blocks per side and {MAX_BLOCKS:,} in total, "
            f"got {given}; select only the piece"
        )
    window = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    states = np.where(filled[window], volume.states[window], 0)
    used, numbers = np.unique(states, return_inverse=True)
    used_states = [state for state in used.tolist() if state]
    if len(used_states) > MAX_KINDS:
        raise UsageError(
            f"a piece may have at most {MAX_KINDS} different block states, got "
            f"{len(used_states)}; select only the piece"
        )
    numbers = numbers.reshape(states.shape) + (0 if used[0] == 0 else 1)
    return BlockVolume(
        numbers.astype(np.uint16),
        ("minecraft:air", *(volume.palette[state] for state in used_states)),
        np.zeros(states.shape, np.uint8),
        np.zeros(states.shape, np.uint16),
        (0, 0, 0),
        np.eye(4),
    )


def _join_connections(volume: BlockVolume) -> BlockVolume:
    """Return a volume with the connections and stair shapes that the game would compute."""
    from world2minecraft.minecraft.rules.connections import update_connections  # noqa: PLC0415  # It needs numba.

    states, palette = update_connections(volume.states, volume.palette)
    used = sorted({0, *np.unique(states).tolist()})
    numbers = np.zeros(len(palette), np.uint16)
    numbers[used] = np.arange(len(used))
    return replace(
        volume, states=numbers[states], palette=tuple(palette[number] for number in used)
    )


def front_of(volume: BlockVolume, kind: str) -> str | None:
    """Return the side that most directional blocks face, or None without such blocks.

    Stairs and beds rise towards their facing, so the front is on the opposite side. Barrels, chests
    and furnaces face the front. Doors and wall-mounted blocks are ignored.
    """
    votes: Counter[str] = Counter()
    counts = np.bincount(volume.states.ravel(), minlength=len(volume.palette))
    for state, count in zip(volume.palette, counts.tolist(), strict=True):
        parsed = parse_state(state)
        facing = parsed.get("facing")
        if facing not in OPPOSITE or not count:
            continue
        if parsed.name.endswith(("_stairs", "_bed")):
            if kind in SEATS and parsed.get("half") != "top":
                votes[OPPOSITE[facing]] += count
        elif not parsed.name.endswith(("_trapdoor", "_door", "_gate", "_banner", "_sign")):
            votes[facing] += count
    most = max(votes.values(), default=0)
    best = [side for side in SIDES if votes[side] == most]
    return best[0] if most and len(best) == 1 else None


def _parts(volume: BlockVolume) -> list[tuple]:
    """Return boxes (role, x0 .. z1) in the piece's own axes, in eighths of a block."""
    from world2minecraft.geometry.box_decomposition import partition_boxes  # noqa: PLC0415  # It needs numba.

    roles = sorted({role_of(state) for state in volume.palette[1:]})
    labels = block_axes_to_grid(_fine_grid(volume, roles))
    for coarse in (1, 2, 4, 8):
        seen = labels if coarse == 1 else _pool(labels, coarse)
        boxes = partition_boxes(seen)
        if len(boxes) <= MAX_PARTS:
            break
    else:
        raise UsageError(f"the shape needs more than {MAX_PARTS} boxes; add a simpler piece")
    return [(roles[label - 1], *(np.array(corners) * coarse)) for label, *corners in boxes.tolist()]


def _fine_grid(volume: BlockVolume, roles: list[str]) -> np.ndarray:
    """Return the visible role, from 1, of each eighth of a block, int16 in block axes."""
    from world2minecraft.minecraft.visual_shapes import visual_boxes  # noqa: PLC0415

    count = PARTS_PER_BLOCK
    fine = np.zeros(np.array(volume.states.shape) * count, np.int16)
    shapes = []
    for state in volume.palette:
        mask = np.zeros((count,) * 3, bool)
        for box in visual_boxes(state):
            low = np.clip(np.floor(box[:3] * count + 0.25), 0, count - 1).astype(int)
            high = np.clip(np.floor(box[3:] * count + 0.75), low + 1, count).astype(int)
            mask[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = True
        shapes.append(mask)
    for x, y, z in np.argwhere(volume.states):
        number = volume.states[x, y, z]
        place = tuple(slice(count * at, count * (at + 1)) for at in (x, y, z))
        fine[place] = np.where(shapes[number], 1 + roles.index(role_of(volume.palette[number])), 0)
    if not fine.any():
        raise UsageError("all blocks of the piece are invisible, so there is nothing to add")
    return fine


def _pool(labels: np.ndarray, coarse: int) -> np.ndarray:
    """Return labels at a coarser resolution, each the maximum of its cells."""
    x, y, z = (side // coarse for side in labels.shape)
    return labels.reshape(x, coarse, y, coarse, z, coarse).max(axis=(1, 3, 5))


def _turns(volume: BlockVolume) -> int:
    """Return the number of different quarter turns of a piece: 1, 2 or 4."""

    def same(turns: int) -> bool:
        """Return whether the piece is unchanged after a number of quarter turns."""
        turned = turn_volume(volume, turns)
        if turned.states.shape != volume.states.shape:
            return False
        return np.array_equal(
            np.array(turned.palette, object)[turned.states],
            np.array(volume.palette, object)[volume.states],
        )

    return 1 if same(1) else 2 if same(2) else 4


def _size_span(side: float) -> list[float]:
    """Return the range of a size: minimum, typical, maximum."""
    return [round(float(side) * share, 4) for share in (1 - SIZE_SHARE, 1.0, 1 + SIZE_SHARE)]


def _pack(cells: np.ndarray, palette: tuple[str, ...]) -> dict[str, Any]:
    flat = cells.ravel().astype(int)
    starts = np.flatnonzero(np.diff(flat, prepend=-1))
    lengths = np.diff(starts, append=len(flat))
    runs = [[int(flat[start]), int(length)] for start, length in zip(starts, lengths, strict=True)]
    return {"size": list(cells.shape), "palette": list(palette[1:]), "runs": runs}


def _notes(volume: BlockVolume) -> list[str]:
    """Return notes on the blocks: those that are unstable, and those of mods."""
    from world2minecraft.minecraft.block_states import known_blocks  # noqa: PLC0415
    from world2minecraft.minecraft.rules.stability import find_unstable_cells  # noqa: PLC0415

    floored = np.pad(volume.states, ((1, 1), (1, 1), (1, 1)))
    floored[:, 0] = len(volume.palette)
    palette = (*volume.palette, "minecraft:stone")
    loose = [reason for _, _, reason in find_unstable_cells(floored.astype(np.uint16), palette)]
    notes = []
    if loose:
        notes.append(f"{len(loose)} blocks need support and would break on their own: {loose[0]}")
    strange = sorted({role_of(s) for s in volume.palette} - {role_of(s) for s in known_blocks()})
    if strange:
        notes.append(
            f"unknown in vanilla Minecraft, treated as full blocks: {', '.join(strange[:5])}"
        )
    return notes

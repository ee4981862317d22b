"""Volumes from files of players: blocks without labels and scale.

Readers know their blocks as a list of state texts, of which the volume's palette is made: air
first, the others sorted, each once.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity

MAX_CELLS = 64 << 20  # 400 blocks a side; a volume of this size takes 340 MB.
MAX_STATES = 0xFFFF
MAX_FILE_BYTES = 96 << 20  # As it lies on disk: packed and unpacked are held together.
# Where a file says to stand in its world; the formats have no place for it, and ignore the tag.
OWN_TAG = "World2Minecraft"
# What a tree raises that has the right keys and other things under them.
MISSHAPEN = (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError)
Corner = tuple[int, int, int]


def build_palette(texts: Iterable[str], path: str | Path) -> tuple[tuple[str, ...], dict[str, int]]:
    """Return a palette of the states in ``texts``, and the number of each in it.

    Raises:
        LimitError: there are more than 65,535 states.
    """
    palette = (AIR, *sorted(set(texts) - {AIR}))
    if len(palette) > MAX_STATES:
        raise LimitError(path, f"has {len(palette):,} block states; at most 65,535 are read")
    return palette, {state: number for number, state in enumerate(palette)}


def check_size(size: Iterable[int], path: str | Path) -> tuple[int, int, int]:
    """Return x, y, z of ``size`` where a volume of it can be held.

    Raises:
        LimitError: it is empty or too large.
    """
    x, y, z = (int(side) for side in size)
    if min(x, y, z) < 1 or x * y * z > MAX_CELLS:
        raise LimitError(path, f"says {x} x {y} x {z} blocks; 1 to {MAX_CELLS:,} are read")
    return x, y, z


def unlabelled_volume(
    states: np.ndarray,
    palette: tuple[str, ...],
    corner: Corner,
    block_entities: Iterable[BlockEntity] = (),
    entities: Iterable[Entity] = (),
) -> BlockVolume:
    """Return a volume without labels and with one block a metre.

    Args:
        states: uint16 [X, Y, Z] in block axes, numbers of ``palette``.
        palette: full block states, air first.
        corner: the world position of the first cell.
        block_entities: those of its blocks, in world coordinates.
        entities: what stands in it, in world coordinates.
    """
    return BlockVolume(
        states=np.ascontiguousarray(states),
        palette=palette,
        semantic=np.zeros(states.shape, np.uint8),
        instance=np.zeros(states.shape, np.uint16),
        corner=corner,
        block_to_room=block_to_room(np.zeros(2), 1.0),
        block_entities=tuple(block_entities),
        entities=tuple(entities),
    )


def enclosing_box(boxes: Sequence[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest corner and the size of the box around boxes of a corner and a size."""
    low = np.min([corner for corner, _ in boxes], axis=0)
    return low, np.max([corner + size for corner, size in boxes], axis=0) - low


def join_volumes(parts: Sequence[BlockVolume], path: str | Path) -> BlockVolume:
    """Return volumes of one world as one; of two in a place the later stands, but for its air.

    Raises:
        LimitError: their box is too large, or they have too many states together.
    """
    boxes = [(np.array(part.corner), np.array(part.states.shape)) for part in parts]
    low, size = enclosing_box(boxes)
    palette, number_of = build_palette((s for part in parts for s in part.palette), path)
    states = np.zeros(check_size(size, path), np.uint16)
    for part, (corner, shape) in zip(parts, boxes, strict=True):
        place = tuple(slice(a, a + n) for a, n in zip(corner - low, shape, strict=True))
        numbers = np.array([number_of[state] for state in part.palette], np.uint16)
        np.copyto(states[place], numbers[part.states], where=part.states != 0)
    x, y, z = low.tolist()
    blocks = [held for part in parts for held in part.block_entities]
    return unlabelled_volume(
        states, palette, (x, y, z), blocks, [e for p in parts for e in p.entities]
    )


def stated_corner(tree: Mapping[str, Any], path: str | Path) -> Corner | None:
    """Return the corner that ``own_tag`` put into ``tree``, or None where there is none.

    Raises:
        DamagedFileError: the tag holds something else.
    """
    if OWN_TAG not in tree:
        return None
    try:
        x, y, z = (int(value) for value in tree[OWN_TAG]["Corner"])
    except MISSHAPEN as error:
        raise DamagedFileError(path, f"has a tag {OWN_TAG} without a Corner of three") from error
    return x, y, z


def own_tag(corner: Iterable[int]) -> dict[str, Any]:
    """Return the tag that keeps a world position in formats that have no place for it."""
    return {OWN_TAG: {"Corner": np.array(list(corner), np.int32)}}

"""Construction of volumes from game files, which contain neither labels nor a scale.

Readers provide a list of block states, from which the volume's palette is built: air first, then
the other states sorted and without duplicates.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import MALFORMED, DamagedFileError, LimitError
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity

MAX_CELLS = 64 << 20  # 400 blocks a side; a volume of this size takes 340 MB.
MAX_STATES = 0xFFFF
MAX_FILE_BYTES = 96 << 20  # As it lies on disk: packed and unpacked are held together.
# The tag with the position of a file in its world, which the formats have no field for and ignore.
OWN_TAG = "World2Minecraft"
Corner = tuple[int, int, int]


def build_palette(texts: Iterable[str], path: str | Path) -> tuple[tuple[str, ...], dict[str, int]]:
    """Build a palette of block states, and return it with the index of each state.

    Raises:
        LimitError: If there are more than 65,535 states.
    """
    palette = (AIR, *sorted(set(texts) - {AIR}))
    if len(palette) > MAX_STATES:
        raise LimitError(path, f"has {len(palette):,} block states, the limit is {MAX_STATES:,}")
    return palette, {state: number for number, state in enumerate(palette)}


def invalid_file(path: str | Path, what: str, error: Exception) -> DamagedFileError:
    """Return the error for a file that is not a valid ``what``, with a missing key if that is why.

    Args:
        path: The file.
        what: Name of the format with its article, such as ``a valid structure file``.
        error: One of ``MALFORMED``, raised while the contents of the file were read.
    """
    missing = f" ({error} is missing)" if isinstance(error, KeyError) else ""
    return DamagedFileError(path, f"is not {what}{missing}")


def check_size(size: Iterable[int], path: str | Path) -> tuple[int, int, int]:
    """Return a size as x, y, z after checking that a volume of this size fits into the limits.

    Raises:
        LimitError: If the size is zero or too large.
    """
    x, y, z = (int(side) for side in size)
    if min(x, y, z) < 1 or x * y * z > MAX_CELLS:
        raise LimitError(
            path, f"declares a size of {x} x {y} x {z} blocks; expected 1 to {MAX_CELLS:,} blocks"
        )
    return x, y, z


def unlabelled_volume(
    states: np.ndarray,
    palette: tuple[str, ...],
    corner: Corner,
    block_entities: Iterable[BlockEntity] = (),
    entities: Iterable[Entity] = (),
) -> BlockVolume:
    """Create a volume without labels, at one block per metre.

    Args:
        states: Palette indices, uint16 [X, Y, Z] in block axes.
        palette: Complete block states, with air first.
        corner: The world position of the first cell.
        block_entities: The block entities, in world coordinates.
        entities: The entities, in world coordinates.
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
    """Return the lowest corner and the size of the bounding box of boxes (corner, size)."""
    low = np.min([corner for corner, _ in boxes], axis=0)
    return low, np.max([corner + size for corner, size in boxes], axis=0) - low


def join_volumes(parts: Sequence[BlockVolume], path: str | Path) -> BlockVolume:
    """Join volumes that share world coordinates to one volume.

    Where volumes overlap, the blocks of the later volume are used, except its air.

    Raises:
        LimitError: If the bounding box is too large, or there are too many block states.
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
    """Return the corner that ``own_tag`` stored in an NBT tree, or None if there is none.

    Raises:
        DamagedFileError: If the tag is invalid.
    """
    if OWN_TAG not in tree:
        return None
    try:
        x, y, z = (int(value) for value in tree[OWN_TAG]["Corner"])
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"contains a tag {OWN_TAG} without a Corner of three numbers"
        ) from error
    return x, y, z


def own_tag(corner: Iterable[int]) -> dict[str, Any]:
    """Return the NBT tag that stores a world position in formats without a field for it."""
    return {OWN_TAG: {"Corner": np.array(list(corner), np.int32)}}

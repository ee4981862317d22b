"""Colliders of display furniture: barrier blocks, and light blocks at weakly filled positions.

Display entities have no collision. A ``barrier`` fills a whole block, so it is used only where the
object covers a sufficient share of a block. Elsewhere an unlit, passable ``light`` block marks the
position. Both are invisible and carry the object's class and instance.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import BARRIER, LIGHT, Canvas
from world2minecraft.construction.display.boxes import DisplayBox, Frame, boxes_in_room
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.minecraft.visual_shapes import is_luminous

FINE = 8  # Samples along the side of a block.
COVERED = 0.25  # Share of a block's face, seen along its best axis; as objects from cells have it.
FILLED = 0.06  # Share of a block's volume, under which its neighbour above or below stands for it.
FLAT = 0.2  # Blocks: what lies on the floor and is lower, one walks over.
MAX_SAMPLES = 1 << 24
MARK = "minecraft:light[level=0,waterlogged=false]"


class Cover(NamedTuple):
    """The share of each block, in a box of the lattice, that display boxes cover."""

    low: np.ndarray  # int64 [3], the first block
    face: np.ndarray  # float64 [X, Y, Z], share of a face, seen along the best axis
    volume: np.ndarray  # float64 [X, Y, Z]
    height: np.ndarray  # float64 [X, Y, Z], how high in the block it reaches


def cover_of(pieces: Sequence[DisplayBox], frame: Frame, canvas: Canvas) -> Cover:
    """Compute the share of each block that the boxes of an object cover."""
    lattice = canvas.lattice
    middles_m, half_m = boxes_in_room(pieces, frame)
    middles = lattice.coordinates_of(middles_m)
    half = half_m * lattice.blocks_per_metre
    turn = rotation_about_z(frame.yaw_deg)[:3, :3]
    reach = half @ np.abs(turn).T
    low = np.floor((middles - reach).min(axis=0) + 1e-6).astype(np.int64)
    high = np.ceil((middles + reach).max(axis=0) - 1e-6).astype(np.int64)
    low, high = np.maximum(low, 0), np.minimum(high, lattice.shape)
    size = np.maximum(high - low, 0)
    if not size.all():
        empty = np.zeros(size)
        return Cover(low, empty, empty, empty)
    fine = max(1, min(FINE, int((MAX_SAMPLES / size.prod()) ** (1 / 3))))
    filled = np.zeros(size * fine, bool)
    for middle, sides, span in zip(middles, half, reach, strict=True):
        first = np.floor((middle - span - low) * fine).astype(int)
        last = np.ceil((middle + span - low) * fine).astype(int)
        first, last = np.clip(first, 0, filled.shape), np.clip(last, 0, filled.shape)
        window = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
        points = [(np.arange(a, b) + 0.5) / fine for a, b in zip(first, last, strict=True)]
        filled[window] |= _inside(points, middle - low, sides, turn, 0.5 / fine)
    blocks = filled.reshape(size[0], fine, size[1], fine, size[2], fine)
    face = np.max(
        [blocks.any(axis=1 + 2 * axis).mean(axis=_others(axis)) for axis in range(3)], axis=0
    )
    top = fine - blocks[..., ::-1].any(axis=(1, 3)).argmax(axis=-1)
    return Cover(low, face, blocks.mean(axis=(1, 3, 5)), np.where(face > 0, top / fine, 0.0))


def put_colliders(
    canvas: Canvas, pieces: Sequence[DisplayBox], frame: Frame, class_id: int, instance: int
) -> int:
    """Set the colliders of an object in free blocks and return the number of barriers."""
    cover = cover_of(pieces, frame, canvas)
    touched = cover.face > 0
    if not touched.any():
        return 0
    solid = _solid(cover, canvas)
    if not solid.any() and frame.size_m.max() * canvas.lattice.blocks_per_metre >= 1:
        solid = (cover.volume == cover.volume.max()) & ~_is_flat(cover, canvas)
    window = tuple(slice(a, a + n) for a, n in zip(cover.low, touched.shape, strict=True))
    free = canvas.states[window] == 0
    glows = _glowing(pieces, frame, canvas, cover)
    for mask, state in (
        (solid & ~glows, BARRIER),
        (touched & ~solid & ~glows, MARK),
        (glows, LIGHT),
    ):
        at = tuple(
            axis + start for axis, start in zip(np.nonzero(mask & free), cover.low, strict=True)
        )
        if len(at[0]):
            canvas.put(at, canvas.id_of(state), class_id, instance)
    return int((solid & free & ~glows).sum())


def _solid(cover: Cover, canvas: Canvas) -> np.ndarray:
    """Return the mask of blocks that stop a player, bool [X, Y, Z]."""
    solid = cover.face >= COVERED
    volume = np.where(solid, cover.volume, 0)
    padded = np.pad(volume, ((0, 0), (0, 0), (1, 1)))
    beside = np.maximum(padded[:, :, 2:], padded[:, :, :-2])
    # A plate on the border of two layers is in the one that has more of it.
    solid &= (cover.volume >= FILLED) | (cover.volume >= beside)
    return solid & ~_is_flat(cover, canvas)


def _is_flat(cover: Cover, canvas: Canvas) -> np.ndarray:
    """Return the mask of blocks with a part flat on a floor, bool [X, Y, Z]."""
    layers = cover.low[2] + np.arange(cover.height.shape[2])
    return np.isin(layers, canvas.lattice.grounds) & (cover.height <= FLAT)


def _glowing(
    pieces: Sequence[DisplayBox], frame: Frame, canvas: Canvas, cover: Cover
) -> np.ndarray:
    """Return the mask of blocks with a glowing part, bool [X, Y, Z]."""
    result = np.zeros(cover.face.shape, bool)
    lit = [piece for piece in pieces if is_luminous(piece.state)]
    if lit:
        shining = cover_of(lit, frame, canvas)
        at = (
            np.argwhere(shining.volume >= max(0.5 * shining.volume.max(), 1e-9))
            + shining.low
            - cover.low
        )
        inside = ((at >= 0) & (at < result.shape)).all(axis=1)
        result[tuple(at[inside].T)] = True
    return result


def _inside(
    points: list[np.ndarray], middle: np.ndarray, half: np.ndarray, turn: np.ndarray, slack: float
) -> np.ndarray:
    """Return which points of a raster are in a rotated box; thin boxes contain one layer."""
    x, y = points[0][:, None] - middle[0], points[1][None, :] - middle[1]
    reach = np.maximum(half, slack) + 1e-9
    along = np.abs(turn[0, 0] * x + turn[1, 0] * y) <= reach[0]
    across = np.abs(turn[0, 1] * x + turn[1, 1] * y) <= reach[1]
    up = np.abs(points[2] - middle[2]) <= reach[2]
    return (along & across)[:, :, None] & up


def _others(axis: int) -> tuple[int, ...]:
    """The sample axes that remain in [X, f, Y, f, Z, f] without one of them."""
    places = [1, 3, 5]
    del places[axis]
    return tuple(place - (place > 1 + 2 * axis) for place in places)

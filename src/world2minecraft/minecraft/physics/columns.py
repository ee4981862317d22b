"""Where a body can stand in each column of a grid: the gaps between what is over and under it.

Heights are counted in sixteenths of a block, as the game's shapes are.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.body import TOUCH

FINE = 16  # Heights a block.
MOST_FLOORS = 16  # Stands over each other in one column; towers have more.
SKY = np.iinfo(np.int32).max  # The ceiling of what is open above.
WET = 254  # The class of liquids: neither a way nor a ground.
_FULL = (1 << FINE) - 1


class Solid(NamedTuple):
    """The collision boxes of a volume, as the kernels read them."""

    kinds: np.ndarray  # uint16 [X, Y, Z]; 0 has no box
    start: np.ndarray  # int32 [K + 1], the first box of each kind
    boxes: np.ndarray  # float64 [B, 6], block units within their cell
    classes: np.ndarray  # uint8 [X, Y, Z], WET for liquids
    is_full: np.ndarray  # bool [K]


class Stands(NamedTuple):
    """The gaps of a grid of C columns in which a body fits; heights in sixteenths of a block."""

    counts: np.ndarray  # int32 [C]
    floor: np.ndarray  # int32 [C, MOST_FLOORS]
    ceiling: np.ndarray  # int32 [C, MOST_FLOORS]
    ground: np.ndarray  # uint8 [C, MOST_FLOORS], the class of what is under the feet


def stands_of(
    solid: Solid, columns: tuple[np.ndarray, np.ndarray], half: float, height: float
) -> Stands:
    """Return where a body stands in each column of a volume.

    Args:
        solid: what stops a body.
        columns: where they are along x and along z, float64, in cells from the volume's corner.
        half: half the body's width, in blocks.
        height: how high it is, in blocks.
    """
    xs, zs = columns
    count = len(xs) * len(zs)
    stands = Stands(
        np.zeros(count, np.int32),
        np.zeros((count, MOST_FLOORS), np.int32),
        np.zeros((count, MOST_FLOORS), np.int32),
        np.zeros((count, MOST_FLOORS), np.uint8),
    )
    need = int(np.ceil(height * FINE - 1e-6))
    if count:
        _fill(solid, xs, zs, half, need, stands)
    return stands


@njit
def _fill(solid, xs, zs, half, need, stands):
    masks = np.zeros(solid.kinds.shape[1] + 2, np.int32)
    for column in range(len(stands.counts)):
        x, z = xs[column // len(zs)], zs[column % len(zs)]
        box = (x - half + TOUCH, z - half + TOUCH, x + half - TOUCH, z + half - TOUCH)
        _mask(solid, box, masks)
        _gaps(solid, box, masks, need, column, stands)


@njit
def _mask(solid, box, masks):
    """Set in each layer's mask the sixteenths of its height that a box meets something in."""
    masks[:] = 0
    nx, ny, nz = solid.kinds.shape
    for i in range(max(0, int(np.floor(box[0]))), min(nx - 1, int(np.floor(box[2]))) + 1):
        for k in range(max(0, int(np.floor(box[1]))), min(nz - 1, int(np.floor(box[3]))) + 1):
            for j in range(ny):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                if solid.is_full[kind]:
                    masks[j] |= _FULL
                    continue
                mask = _cell_mask(solid, kind, box, i, k)
                masks[j] |= mask & _FULL
                masks[j + 1] |= mask >> FINE


@njit
def _cell_mask(solid, kind, box, i, k):
    """Return the sixteenths, from its cell's bottom, of the boxes of a kind that a box meets."""
    mask = 0
    for n in range(solid.start[kind], solid.start[kind + 1]):
        b = solid.boxes[n]
        if i + b[0] < box[2] and i + b[3] > box[0] and k + b[2] < box[3] and k + b[5] > box[1]:
            low = max(0, int(np.floor(b[1] * FINE + 1e-6)))
            top = int(np.ceil(b[4] * FINE - 1e-6))
            mask |= ((1 << max(top - low, 0)) - 1) << low
    return mask


@njit
def _gaps(solid, box, masks, need, column, stands):
    """Write the gaps of a column that are high enough and have a floor."""
    found, floor, is_free = 0, -1, True
    for j in range(len(masks)):
        mask = masks[j]
        if (mask == 0 and is_free) or (mask == _FULL and not is_free):
            continue
        for bit in range(FINE):
            if bool(mask >> bit & 1) != is_free:
                continue
            at = j * FINE + bit
            if not is_free:
                floor = at
            elif floor >= 0 and at - floor >= need:
                found = _add(solid, box, floor, at, column, found, stands)
            is_free = not is_free
    if is_free and floor >= 0:
        found = _add(solid, box, floor, SKY, column, found, stands)
    stands.counts[column] = found


@njit
def _add(solid, box, floor, ceiling, column, found, stands):
    ground = _ground(solid, box, floor)
    if ground == WET or found == MOST_FLOORS:
        return found
    stands.floor[column, found] = floor
    stands.ceiling[column, found] = ceiling
    stands.ground[column, found] = ground
    return found + 1


@njit
def _ground(solid, box, floor):
    """Return the largest class of what a body stands on at a height; unknown counts as none."""
    nx, ny, nz = solid.kinds.shape
    top, found = (floor - 1) // FINE, 0
    for i in range(max(0, int(np.floor(box[0]))), min(nx - 1, int(np.floor(box[2]))) + 1):
        for k in range(max(0, int(np.floor(box[1]))), min(nz - 1, int(np.floor(box[3]))) + 1):
            for j in range(max(0, top - 1), min(ny - 1, top) + 1):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                mask = _cell_mask(solid, kind, box, i, k)
                if mask >> (floor - 1 - j * FINE) & 1 and solid.classes[i, j, k] != 255:
                    found = max(found, int(solid.classes[i, j, k]))
    return found

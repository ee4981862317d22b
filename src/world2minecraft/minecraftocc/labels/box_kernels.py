"""Rasterization of solid boxes into cells, with the owner that fills the most of each cell.

Coordinates are in blocks, relative to the minimum corner of the lattice. Cell (a, b, c) starts at
``(a, b, c) * step`` and is ``step`` wide. A box is counted in a cell only if it overlaps the cell
shrunk by ``slack`` on all sides. A later owner replaces an earlier one only if it fills the cell
more by a small margin, so that rounding errors do not decide the owner.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, njit
from world2minecraft.rendering.scene_tables import ABSOLUTE, FLAGS, FULL, OWNER

NO_OWNER = -1
# Margin in blocks within which the cells of a block are searched, since thin shapes protrude.
SEARCH_MARGIN = 0.1
_MARGIN = 1e-4  # Of a cell's volume.
_SAMPLES = 4  # Points per side by which the volume of a rotated box in a cell is counted.


class CellLattice(NamedTuple):
    """A lattice of cells along the block axes.

    Attributes:
        start: Minimum corner in the block grid of the scene, float64 [3].
        step: Side length of a cell in blocks.
        slack: Depth in blocks to which a shape may reach into a cell without being counted.
    """

    start: np.ndarray
    step: float
    slack: float


class Slab(NamedTuple):
    """Layers of the lattice along its first axis, which the kernels fill in place.

    Attributes:
        first: Index of the first layer.
        amount: Volume in blocks that the owner fills in each cell, float32 [A, B, C].
        owner: Owner of each cell, int32 [A, B, C]: the index of a block in the volume, or -2 - n
            for display entity n.
    """

    first: int
    amount: np.ndarray
    owner: np.ndarray


@njit
def fill_slab(tables, boxes, standing, lattice, slab, scratch):
    """Rasterize all boxes of a scene into the layers of a slab.

    Args:
        tables: ``SceneTables`` of the scene.
        boxes: ``SolidBoxes`` of the scene's elements.
        standing: Elements with coordinates in the grid of the scene, int64 [N].
        lattice: ``CellLattice`` to fill.
        slab: ``Slab`` to fill. Its amounts must be 0 and its owners ``NO_OWNER``.
        scratch: Working memory for the cells of one block, float64 [S, S, S], all 0.
    """
    space, traits, window = tables.space, tables.traits, tables.window
    start, step = lattice.start, lattice.step
    near, past = np.zeros(3, np.int64), np.zeros(3, np.int64)
    for axis in range(3):
        skip = slab.first if axis == 0 else 0
        low, high = start[axis] + skip * step, start[axis] + (skip + slab.amount.shape[axis]) * step
        near[axis] = max(int(np.floor(low)) - 1, 0)
        past[axis] = min(int(np.ceil(high)) + 1, space.shape[axis])
    cube = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    at, base = np.zeros(3), np.zeros(3, np.int64)
    for i in range(near[0], past[0]):
        for j in range(near[1], past[1]):
            for k in range(near[2], past[2]):
                if space[i, j, k] >= 0:
                    continue
                at[0], at[1], at[2] = i - start[0], j - start[1], k - start[2]
                for axis in range(3):
                    base[axis] = int(np.floor((at[axis] - SEARCH_MARGIN) / step))
                if space[i, j, k] == FULL:
                    _add_aligned_box(cube[:3], cube[3:], at, base, lattice, scratch)
                else:
                    look = tables.looks[i, j, k]
                    for n in tables.refs[tables.look_start[look] : tables.look_start[look + 1]]:
                        if boxes.there[n] and not traits[n, FLAGS] & ABSOLUTE:
                            _add_box(boxes, n, at, base, lattice, scratch)
                a, b, c = i - window[0, 0], j - window[0, 1], k - window[0, 2]
                cell = (a * window[1, 1] + b) * window[1, 2] + c
                _claim_block_cells(base, cell, step, slab, scratch)
    for n in standing:
        _fill_standing(boxes, n, -2 - traits[n, OWNER], lattice, slab)


@inlined
def _overlaps(low, high, cell, lattice):
    """Return whether an interval overlaps a cell that is shrunk on both sides."""
    step, slack = lattice.step, lattice.slack
    return high > cell * step + slack and low < (cell + 1) * step - slack


@inlined
def _overlap_length(low, high, cell, step):
    """Return the length of an interval inside a cell."""
    return max(min(high, (cell + 1) * step) - max(low, cell * step), 0.0)


@njit
def _add_aligned_box(low, high, at, base, lattice, scratch):
    """Add the volume of an axis-aligned box, relative to ``at``, to the cells of a block."""
    step = lattice.step
    x0, x1 = at[0] + low[0], at[0] + high[0]
    y0, y1 = at[1] + low[1], at[1] + high[1]
    z0, z1 = at[2] + low[2], at[2] + high[2]
    size = scratch.shape[0]
    for a in range(size):
        if not _overlaps(x0, x1, base[0] + a, lattice):
            continue
        wide = _overlap_length(x0, x1, base[0] + a, step)
        for b in range(size):
            if not _overlaps(y0, y1, base[1] + b, lattice):
                continue
            area = wide * _overlap_length(y0, y1, base[1] + b, step)
            for c in range(size):
                if _overlaps(z0, z1, base[2] + c, lattice):
                    scratch[a, b, c] += area * _overlap_length(z0, z1, base[2] + c, step)


@njit
def _add_box(boxes, n, at, base, lattice, scratch):
    """Add the volume of an element's box to the cells of a block."""
    if boxes.straight[n]:
        _add_aligned_box(boxes.low[n], boxes.high[n], at, base, lattice, scratch)
        return
    size, step = scratch.shape[0], lattice.step
    for a in range(size):
        for b in range(size):
            for c in range(size):
                x, y, z = (base[0] + a) * step, (base[1] + b) * step, (base[2] + c) * step
                x, y, z = x - at[0], y - at[1], z - at[2]
                scratch[a, b, c] += rotated_box_volume(
                    boxes.centre[n], boxes.half[n], x, y, z, lattice
                )


@njit
def _claim_block_cells(base, who, step, slab, scratch):
    """Assign cells to a block where it fills more than earlier owners, and clear ``scratch``."""
    size = scratch.shape[0]
    for a in range(size):
        for b in range(size):
            for c in range(size):
                filled = scratch[a, b, c]
                if filled == 0:
                    continue
                scratch[a, b, c] = 0.0
                i, j, k = base[0] + a - slab.first, base[1] + b, base[2] + c
                if (
                    0 <= i < slab.amount.shape[0]
                    and 0 <= j < slab.amount.shape[1]
                    and 0 <= k < slab.amount.shape[2]
                ):
                    _claim_cell(i, j, k, who, filled, step, slab)


@inlined
def _claim_cell(i, j, k, who, filled, step, slab):
    amount, owner = slab.amount, slab.owner
    if owner[i, j, k] == who:
        amount[i, j, k] += filled
    elif owner[i, j, k] == NO_OWNER or filled > amount[i, j, k] + _MARGIN * step**3:
        amount[i, j, k], owner[i, j, k] = filled, who


@njit
def _fill_standing(boxes, n, who, lattice, slab):
    """Assign cells to a display entity where it fills more than earlier owners."""
    start, step = lattice.start, lattice.step
    near, past = np.zeros(3, np.int64), np.zeros(3, np.int64)
    for axis in range(3):
        skip = slab.first if axis == 0 else 0
        low, high = boxes.low[n, axis] - start[axis], boxes.high[n, axis] - start[axis]
        near[axis] = max(int(np.floor(low / step)), skip)
        past[axis] = min(int(np.floor(high / step)) + 1, skip + slab.amount.shape[axis])
    centre = boxes.centre[n] - start
    low, high = boxes.low[n] - start, boxes.high[n] - start
    for i in range(near[0], past[0]):
        for j in range(near[1], past[1]):
            for k in range(near[2], past[2]):
                if not boxes.straight[n]:
                    filled = rotated_box_volume(
                        centre, boxes.half[n], i * step, j * step, k * step, lattice
                    )
                elif (
                    _overlaps(low[0], high[0], i, lattice)
                    and _overlaps(low[1], high[1], j, lattice)
                    and _overlaps(low[2], high[2], k, lattice)
                ):
                    filled = _overlap_length(low[0], high[0], i, step) * _overlap_length(
                        low[1], high[1], j, step
                    )
                    filled *= _overlap_length(low[2], high[2], k, step)
                else:
                    filled = 0.0
                if filled > 0:
                    _claim_cell(i - slab.first, j, k, who, filled, step, slab)


@njit
def rotated_box_volume(centre, half, x, y, z, lattice):
    """Return the volume of a rotated box inside the cell at (x, y, z), or 0 if they do not overlap.

    Whether the box and the cell overlap is decided by the separating axis theorem with 15 axes. The
    volume is estimated from sample points.
    """
    step = lattice.step
    dx, dy, dz = centre[0] - x - step / 2, centre[1] - y - step / 2, centre[2] - z - step / 2
    reach = step / 2 - lattice.slack
    for axis in range(15):
        ax, ay, az = _separating_axis(half, axis)
        own = abs(ax) + abs(ay) + abs(az)
        box = 0.0
        for edge in range(3):
            box += abs(ax * half[edge, 0] + ay * half[edge, 1] + az * half[edge, 2])
        if abs(ax * dx + ay * dy + az * dz) > reach * own + box:
            return 0.0
    inside = 0
    for place in range(_SAMPLES**3):
        px = ((place // _SAMPLES**2 + 0.5) / _SAMPLES - 0.5) * step - dx
        py = ((place // _SAMPLES % _SAMPLES + 0.5) / _SAMPLES - 0.5) * step - dy
        pz = ((place % _SAMPLES + 0.5) / _SAMPLES - 0.5) * step - dz
        within = True
        for edge in range(3):
            nx, ny, nz = _face_normal(half, edge)
            hx, hy, hz = half[edge, 0], half[edge, 1], half[edge, 2]
            within &= abs(px * nx + py * ny + pz * nz) <= abs(hx * nx + hy * ny + hz * nz)
        inside += within
    return max(inside, 0.01) * step**3 / _SAMPLES**3


@inlined
def _face_normal(half, edge):
    """Return the normal of the two faces that an edge vector of a box leads to, not normalized."""
    p, q = half[(edge + 1) % 3], half[(edge + 2) % 3]
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


@inlined
def _separating_axis(half, number):
    """Return one of the 15 possible separating axes of a cell and a box."""
    if number < 3:
        x, y = 1.0 if number == 0 else 0.0, 1.0 if number == 1 else 0.0
        return x, y, 1.0 - x - y
    if number < 6:
        return _face_normal(half, number - 3)
    edge, axis = (number - 6) // 3, (number - 6) % 3
    hx, hy, hz = half[edge, 0], half[edge, 1], half[edge, 2]
    if axis == 0:
        return 0.0, -hz, hy
    if axis == 1:
        return hz, 0.0, -hx
    return -hy, hx, 0.0

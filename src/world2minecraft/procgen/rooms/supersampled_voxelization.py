"""Voxelization of round and rotated parts by sampling each voxel at 27 points.

Boxes rotated by quarter turns are aligned with voxels and do not need sampling.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.procgen.rooms.furniture_model import STEP_M, Bar, Model, Part, translate_part
from world2minecraft.procgen.rooms.placement import Item

PROBES = (-1 / 3, 0.0, 1 / 3)  # Offsets along each axis, in voxels.
ENOUGH = 9  # Minimum number of 27 probes; keeps thin boards closed.


def make_model(name: str, class_id: int, parts: Sequence[Part | Bar]) -> Model:
    """Create a model from parts at any position, with the size of its voxels."""
    low = np.array([part.box_m for part in parts])[:, :3].min(axis=0)
    base = Item(Model(name, class_id, (STEP_M, STEP_M, STEP_M), ()), 0.0, 0.0, 0.0, 0.0)
    begun = [translate_part(part, tuple((-low).tolist())) for part in parts]
    cells = []
    for part in begun:
        first, filled = solid_cells(base, part)
        cells.append(np.argwhere(filled) + first)
    held = np.concatenate(cells)
    first, last = held.min(axis=0), held.max(axis=0) + 1
    middle = (first + last) / 2 * STEP_M
    middle[2] = first[2] * STEP_M
    size = tuple(float(side) for side in (last - first) * STEP_M)
    shift = tuple((-middle).tolist())
    return Model(
        name, class_id, (size[0], size[1], size[2]), tuple(translate_part(p, shift) for p in begun)
    )


def is_plain(item: Item, part: Part | Bar) -> bool:
    """Return whether a part is a box that is aligned with voxels in the orientation of its item."""
    return isinstance(part, Part) and part.form == "box" and item.yaw_deg % 90 == 0


def solid_cells(item: Item, part: Part | Bar) -> tuple[np.ndarray, np.ndarray]:
    """Return the voxels of a part, relative to the origin of the room frame.

    Returns:
        The first voxel of a box around the part, int64 [3], and which voxels of the box are filled,
        bool [I, J, K]. At least one voxel is filled.
    """
    low_m, high_m = _bounds_m(item, part)
    first = np.floor(low_m / STEP_M).astype(np.int64)
    last = np.ceil(high_m / STEP_M).astype(np.int64)
    shape = tuple(max(1, int(n)) for n in last - first)
    count = np.zeros(shape, np.int64)
    turned = rotation_about_z(-item.yaw_deg)[:3, :3]
    base = np.array([item.x_m, item.y_m, item.z_m])
    middles = (np.moveaxis(np.indices(shape), 0, -1) + first + 0.5) * STEP_M - base
    for offset in np.stack(np.meshgrid(PROBES, PROBES, PROBES, indexing="ij"), -1).reshape(-1, 3):
        count += _inside(part, (middles + offset * STEP_M) @ turned.T)
    # A part thinner than a voxel keeps the voxels that hold the most of it.
    return first, count >= min(ENOUGH, max(1, int(count.max())))


def _bounds_m(item: Item, part: Part | Bar) -> tuple[np.ndarray, np.ndarray]:
    x0, y0, z0, x1, y1, z1 = part.box_m
    corners = np.array([[x, y, 0.0] for x in (x0, x1) for y in (y0, y1)])
    placed = apply(rotation_about_z(item.yaw_deg), corners)
    placed = placed + np.array([item.x_m, item.y_m, item.z_m])
    low, high = placed.min(axis=0), placed.max(axis=0)
    low[2], high[2] = item.z_m + z0, item.z_m + z1
    return low + 1e-9, high - 1e-9


def _inside(part: Part | Bar, points: np.ndarray) -> np.ndarray:
    """Return which points, float64 [..., 3] in the item's local frame, are inside a part."""
    if isinstance(part, Bar):
        return _inside_bar(part, points)
    low, high = np.array(part.box_m[:3]), np.array(part.box_m[3:])
    unit = (points - (low + high) / 2) / ((high - low) / 2)
    if part.form == "ball":
        return (unit**2).sum(axis=-1) <= 1
    flat = np.abs(unit) <= 1
    if part.form == "box":
        return flat[..., 0] & flat[..., 1] & flat[..., 2]
    others = [axis for axis in range(3) if axis != part.axis]
    return flat[..., part.axis] & ((unit[..., others] ** 2).sum(axis=-1) <= 1)


def _inside_bar(bar: Bar, points: np.ndarray) -> np.ndarray:
    start, way = np.array(bar.start_m), np.array(bar.end_m) - np.array(bar.start_m)
    share = np.clip((points - start) @ way / max(float(way @ way), 1e-12), 0, 1)
    off = points - start - share[..., None] * way
    return np.sqrt((off**2).sum(axis=-1)) <= bar.radius_m

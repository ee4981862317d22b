"""Slow, readable references of the labels: what cells hold, which pixels see them, what is free.

They know block states, models, poses and depth, and nothing of the kernels: no tables, no lattice
in block axes, no tiles. Lengths are metres of the room.
"""

from collections.abc import Iterator
from itertools import product

import numpy as np
from scipy.optimize import linprog

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.minecraftocc.types import LabelRegion, SceneVoxels
from world2minecraft.rendering.block_elements import Element, ModelSource

SLACK_M, THICK_M, AROUND_M, REACH_M, CROSSED_M = 0.001, 0.004, 5e-6, 0.006, 0.001


def solid_parts(volume: BlockVolume, looks: ModelSource) -> Iterator[tuple[tuple, np.ndarray]]:
    """Give who each part belongs to, and its middle and three half edges, float64 [4, 3]."""
    models = [looks.model(state) for state in volume.palette]
    for cell in np.argwhere(volume.states):
        model = models[volume.states[tuple(cell)]]
        at = np.eye(4)
        at[:3, 3] = cell + volume.corner
        for element in model.elements if model else ():
            if any(element.faces):
                yield ("block", *cell.tolist()), _edges(element, volume.block_to_room @ at)
    for number, cube in enumerate(display_cubes(volume.entities)):
        model = looks.model(cube.state)
        for element in model.elements if model else ():
            if any(element.faces):
                yield ("thing", number), _edges(element, volume.block_to_room @ cube.cube_to_world)


def _edges(element: Element, block_to_room: np.ndarray) -> np.ndarray:
    to_room = block_to_room if element.turn is None else block_to_room @ element.turn
    low, high = np.float32(element.low).astype(float), np.float32(element.high).astype(float)
    rows = [apply(to_room, (low + high) / 2)]
    for axis in range(3):
        direction = to_room[:3, axis] / np.linalg.norm(to_room[:3, axis])
        length = (high - low)[axis] * np.linalg.norm(to_room[:3, axis])
        rows.append(direction * max(length, THICK_M) / 2)
    return np.array(rows)


def filled(parts, origin_m: np.ndarray, voxel_m: float) -> dict[tuple, dict[tuple, float]]:
    """Return how much of each cell each owner fills, as a share; only cells that are reached."""
    found: dict[tuple, dict[tuple, float]] = {}
    for owner, part in parts:
        around = np.abs(part[1:]).sum(axis=0)
        first = np.floor((part[0] - around - origin_m) / voxel_m).astype(int)
        last = np.floor((part[0] + around - origin_m) / voxel_m).astype(int)
        for cell in product(*(range(a, b + 1) for a, b in zip(first, last, strict=True))):
            low = origin_m + np.array(cell) * voxel_m
            if reaches_into(part, low + SLACK_M, low + voxel_m - SLACK_M):
                shares = found.setdefault(cell, {})
                shares[owner] = shares.get(owner, 0.0) + _share(part, low, voxel_m)
    return found


def is_straight(part: np.ndarray) -> bool:
    """Whether each edge runs along one axis."""
    return bool((np.sort(np.abs(part[1:]), axis=1)[:, :2] < 1e-7).all())


def reaches_into(part: np.ndarray, low: np.ndarray, high: np.ndarray) -> bool:
    """Whether some point of a part lies in the open box from ``low`` to ``high``."""
    around = np.abs(part[1:]).sum(axis=0)
    if not ((part[0] + around > low) & (part[0] - around < high)).all():
        return False
    if is_straight(part):
        return True
    # Some point  middle + edges @ s,  s in [-1, 1] cubed, within the bounds.
    edges = part[1:].T
    bounds = np.concatenate([high - part[0], part[0] - low])
    answer = linprog(np.zeros(3), np.vstack([edges, -edges]), bounds, bounds=[(-1, 1)] * 3)
    return answer.status == 0


def _share(part: np.ndarray, low: np.ndarray, voxel_m: float) -> float:
    around = np.abs(part[1:]).sum(axis=0)
    if is_straight(part):
        common = np.minimum(part[0] + around, low + voxel_m) - np.maximum(part[0] - around, low)
        return float(np.prod(common) / voxel_m**3)
    places = low + (np.stack(np.indices((4, 4, 4)), -1).reshape(-1, 3) + 0.5) / 4 * voxel_m
    within = np.abs((places - part[0]) @ np.linalg.inv(part[1:])) <= 1
    return max(float(within.all(axis=1).mean()), 0.01 / 64)


def rays(camera: Camera, camera_to_room: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the place of a camera, [3], and each pixel's step for a metre of depth, [H, W, 3]."""
    u, v = np.meshgrid(np.arange(camera.width_px) + 0.5, np.arange(camera.height_px) + 0.5)
    x, y = (u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px
    return camera_to_room[:3, 3], np.stack([x, y, np.ones_like(x)], -1) @ camera_to_room[:3, :3].T


def scene_cells_seen(
    voxels: SceneVoxels, camera: Camera, camera_to_room: np.ndarray, depth_m: np.ndarray
) -> np.ndarray:
    """Return the cell of the scene that each pixel sees, int64 [H, W, 3]; -1 for none."""
    place, ways = rays(camera, camera_to_room)
    depth = depth_m[..., None].astype(float)
    before, behind = (
        (place + (depth + around) * ways - voxels.origin_m) / voxels.voxel_m
        for around in (-AROUND_M, AROUND_M)
    )
    first, last = np.floor(before).astype(np.int64), np.floor(behind).astype(np.int64)
    moves = first != last
    share = np.where(
        moves, (np.maximum(first, last) - before) / np.where(moves, behind - before, 1), np.inf
    )
    order = np.argsort(share, axis=-1, kind="stable")
    found, cell = np.full(first.shape, -1, np.int64), first.copy()
    for number in range(3):  # The way crosses three borders at most.
        axis = order[..., number, None]
        step = np.take_along_axis(last, axis, -1)
        np.put_along_axis(cell, axis, step, -1)
        entered = np.take_along_axis(moves, axis, -1)[..., 0]
        _keep(found, entered & (_at(voxels.fine, cell) > 0), cell)
    _keep(found, _at(voxels.fine, first) > 0, first)
    best = np.full(depth_m.shape, np.inf)
    lost, nearest = (found < 0).all(axis=-1), found.copy()
    for step in product((-1, 0, 1), repeat=3):
        cell = last + step
        aside = np.maximum(np.maximum(cell - behind, behind - (cell + 1)), 0)
        away = np.sqrt((aside**2).sum(axis=-1))
        near = lost & (away < best) & (away < REACH_M / voxels.voxel_m)
        near &= _at(voxels.fine, cell) > 0
        best[near], nearest[near] = away[near], cell[near]
    nearest[depth_m <= 0] = -1
    return nearest


def _keep(found: np.ndarray, which: np.ndarray, cells: np.ndarray) -> None:
    """Put cells where none is found yet."""
    which = which & (found < 0).all(axis=-1)
    found[which] = cells[which]


def _at(values: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return the values at cells, 0 outside."""
    inside = ((cells >= 0) & (cells < values.shape)).all(axis=-1)
    return np.where(
        inside, values[tuple(np.moveaxis(np.where(inside[..., None], cells, 0), -1, 0))], 0
    )


def hits(voxels: SceneVoxels, region: LabelRegion, seen: np.ndarray) -> np.ndarray:
    """Return how many pixels see each cell of a region of the scene's own cells, [X, Y, Z]."""
    cells = seen[(seen >= 0).all(axis=-1)]
    middle_m = voxels.origin_m + (cells + 0.5) * voxels.voxel_m
    own = apply(invert(region.region_to_room), middle_m) / region.voxel_m
    own = np.floor(own).astype(np.int64)
    own = own[((own >= 0) & (own < region.shape)).all(axis=-1)]
    counts = np.zeros(region.shape, np.int64)
    np.add.at(counts, tuple(own.T), 1)
    return counts


def labels_of(voxels: SceneVoxels, region: LabelRegion) -> np.ndarray:
    """Return the labels at the middles of a region's cells; 255 outside the scene."""
    cells = np.floor((region.centers_m() - voxels.origin_m) / voxels.voxel_m).astype(np.int64)
    inside = ((cells >= 0) & (cells < voxels.labels.shape)).all(axis=-1)
    return np.where(inside, _at(voxels.labels, cells), 255)


def in_frustum(region: LabelRegion, camera: Camera, camera_to_room: np.ndarray) -> np.ndarray:
    """Return whether the middle of each cell is before the camera and in the image."""
    x, y, z = np.moveaxis(apply(invert(camera_to_room), region.centers_m()), -1, 0)
    ahead = np.where(z > 0, z, 1)
    u = camera.fx_px * x / ahead + camera.cx_px
    v = camera.fy_px * y / ahead + camera.cy_px
    return (z > 0) & (u >= 0) & (u < camera.width_px) & (v >= 0) & (v < camera.height_px)


def crossed(
    region: LabelRegion,
    cells: np.ndarray,
    camera: Camera,
    camera_to_room: np.ndarray,
    depth_m: np.ndarray,
) -> np.ndarray:
    """Return whether the ray of some pixel goes through each cell of [N, 3] before its surface."""
    place, ways = rays(camera, camera_to_room)
    to_region = invert(region.region_to_room)
    place, ways = apply(to_region, place), ways.reshape(-1, 3) @ to_region[:3, :3].T
    ways = np.where(np.abs(ways) < 1e-12, 1e-12, ways)
    end = np.where(depth_m > 0, depth_m, np.inf).reshape(-1).astype(float)
    free = np.zeros(len(cells), bool)
    for number, cell in enumerate(cells):
        low, high = cell * region.voxel_m, (cell + 1) * region.voxel_m
        near, far = (low - place) / ways, (high - place) / ways
        begin = np.maximum(np.minimum(near, far).max(axis=1), 0)
        free[number] = (
            np.minimum(np.maximum(near, far).min(axis=1), end) - begin > CROSSED_M
        ).any()
    return free

"""Selection of camera poses that together see all surfaces, with the most informative first.

Candidate positions are in free space at eye height and at some lower and higher levels. From each
position, rays of 24 cameras without roll are cast through the voxel grid to the cell faces that
they hit. Cameras are then selected greedily by the number of newly seen faces; a face seen for the
second time counts half, and for the third time a quarter.
"""

import numpy as np

from world2minecraft.capture.readers.meshes.interior import Interior, SurfaceGrid
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera

CAMERA = Camera(480, 360, 240.0, 240.0, 240.0, 180.0)  # 90 degrees wide.
HEIGHTS_M = (1.55, 0.6, 1.1, 2.0)  # Eyes of an adult and a child, a desk, and an arm's reach.
POSITION_SPACING_M = 0.6
MAX_POSITIONS = 400
YAWS = 8
PITCHES_DEG = (-12.0, -42.0, 28.0)  # With 74 degrees of height: from straight down to the ceiling.
RAYS_WIDE, RAYS_HIGH = 24, 18
REACH_M = 4.5  # Beyond, a pixel covers over 2 cm; fusion takes up to 6 m.
MIN_VIEWS, MAX_VIEWS = 40, 120
MIN_GAIN = 0.08  # Views with a smaller share of the gain of the first are not added.
VIEW_GAINS = (1.0, 0.5, 0.25)  # Gain of the first, second and third view of a place.


def choose_views(grid: SurfaceGrid, interior: Interior) -> np.ndarray:
    """Select camera poses that see the surface of an interior, with z up.

    Returns:
        The camera_to_world matrices as float64 [F, 4, 4], the most informative first.
    """
    places = _candidate_positions(grid, interior)
    turns = _camera_rotations()
    poses = np.tile(np.eye(4), (len(places) * len(turns), 1, 1))
    poses[:, :3, :3] = np.tile(turns, (len(places), 1, 1))
    poses[:, :3, 3] = np.repeat(places, len(turns), axis=0)
    sides = _visible_sides(grid, poses)
    return poses[_select_greedily(sides, grid.occupied.size * 6)]


def _candidate_positions(grid: SurfaceGrid, interior: Interior) -> np.ndarray:
    """Return candidate camera positions, evenly spread over the free space, as float64 [N, 3]."""
    cells = np.argwhere(interior.clear)
    drop = interior.drop[tuple(cells.T)]
    levels = np.unique([max(1, round(high / grid.cell_m)) for high in HEIGHTS_M])
    chosen = np.isin(drop, levels)
    cells = cells[chosen] if chosen.any() else cells
    step = max(1, round(POSITION_SPACING_M / grid.cell_m))
    while True:
        # One of each square of the plan, level and floor: the cell nearest to the square's middle.
        square = cells // [step, step, 1]
        off = np.abs(cells[:, :2] - square[:, :2] * step - step // 2).sum(axis=1)
        order = np.lexsort((cells[:, 1], cells[:, 0], off))
        _, first = np.unique(square[order], axis=0, return_index=True)
        found = cells[np.sort(order[first])]
        if len(found) <= MAX_POSITIONS:
            return grid.centers_m(found)
        step += 1


def _camera_rotations() -> np.ndarray:
    """Return the axes of cameras without roll in all directions, float64 [24, 3, 3]."""
    turns = []
    for pitch_deg in PITCHES_DEG:
        for turn in range(YAWS):
            yaw, pitch = 2 * np.pi * turn / YAWS, np.radians(pitch_deg)
            ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
            turns.append(look_at(np.zeros(3), np.array(ahead))[:3, :3])
    return np.array(turns)


def _visible_sides(grid: SurfaceGrid, poses: np.ndarray) -> np.ndarray:
    """Return the cell face that each ray hits as int32 [views, rays], or -1 for none."""
    across = (np.arange(RAYS_WIDE) + 0.5) / RAYS_WIDE * CAMERA.width_px
    down = (np.arange(RAYS_HIGH) + 0.5) / RAYS_HIGH * CAMERA.height_px
    x, y = np.meshgrid((across - CAMERA.cx_px) / CAMERA.fx_px, (down - CAMERA.cy_px) / CAMERA.fy_px)
    rays = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    found = np.empty((len(poses), len(rays)), np.int32)
    starts = (poses[:, :3, 3] - grid.origin_m) / grid.cell_m
    turns = np.ascontiguousarray(poses[:, :3, :3])
    _cast_rays(grid.occupied, starts, turns, rays, REACH_M / grid.cell_m, found)
    found.sort(axis=1)
    found[:, 1:][found[:, 1:] == found[:, :-1]] = -1  # Each side counts once a view.
    return found


@njit
def _cast_rays(occupied, starts, turns, rays, reach, found):
    """Follow each ray cell by cell to the first occupied cell; all lengths are in cells."""
    cell, step = np.empty(3, np.int64), np.empty(3, np.int64)
    due, every = np.empty(3), np.empty(3)
    for n in range(len(starts)):
        for r in range(len(rays)):
            for a in range(3):
                way = 0.0
                for b in range(3):
                    way += turns[n, a, b] * rays[r, b]
                cell[a] = int(np.floor(starts[n, a]))
                step[a] = 1 if way > 0 else -1
                every[a] = 1.0 / max(abs(way), 1e-12)
                ahead = cell[a] + 1 - starts[n, a] if way > 0 else starts[n, a] - cell[a]
                due[a] = ahead * every[a]
            found[n, r] = -1
            while True:
                a = 0
                if due[1] < due[0]:
                    a = 1
                if due[2] < due[a]:
                    a = 2
                if due[a] > reach:
                    break
                cell[a] += step[a]
                if cell[a] < 0 or cell[a] >= occupied.shape[a]:
                    break
                due[a] += every[a]
                if occupied[cell[0], cell[1], cell[2]]:
                    index = (cell[0] * occupied.shape[1] + cell[1]) * occupied.shape[2] + cell[2]
                    found[n, r] = index * 6 + 2 * a + (1 if step[a] > 0 else 0)
                    break


def _select_greedily(sides: np.ndarray, count: int) -> np.ndarray:
    """Return the indices of the selected views, in order of selection."""
    seen = np.zeros(count, np.uint8)
    worth = np.array([*VIEW_GAINS, 0.0])
    chosen: list[int] = []
    first = 0.0
    while len(chosen) < min(MAX_VIEWS, len(sides)):
        best, gain = _best_view(sides, seen, worth)
        first = first or gain
        if gain <= 0 or (len(chosen) >= MIN_VIEWS and gain < MIN_GAIN * first):
            break
        chosen.append(int(best))
        met = sides[best][sides[best] >= 0]
        seen[met] = np.minimum(seen[met] + 1, len(VIEW_GAINS))
    return np.array(chosen, np.int64)


@njit
def _best_view(sides, seen, worth):
    best, best_gain = 0, -1.0
    for n in range(len(sides)):
        gain = 0.0
        for side in sides[n]:
            if side >= 0:
                gain += worth[seen[side]]
        if gain > best_gain:
            best, best_gain = n, gain
    return best, best_gain

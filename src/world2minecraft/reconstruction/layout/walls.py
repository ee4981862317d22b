"""Walls: large upright planes with no observed space behind them, or up to the ceiling.

Walls and the fronts of cupboards are both upright planes, distinguished by the observations behind
them: above a counter and below a hung cupboard, rays pass the front and reach the wall, while no
ray passes a wall. Each of the four directions is processed in arrays rotated so that axis 0 points
outwards.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.plane_residuals import (
    PlaneResiduals,
    measure_plane_residuals,
    noise_of,
)
from world2minecraft.reconstruction.layout.surface_cells import Surface, turn_surface

DIRECTIONS = ((0, 1), (0, -1), (1, 1), (1, -1))  # The axis a wall is square to, the way out.
HIGH_M = 100.0  # Above any room.
OPEN_SHARE = 0.5  # No wall is passed over by rays along half of its length.
MAX_PLANES = 24  # For each direction: a bound on the search, well above any room's walls.
MAX_ASKEW = 0.07  # 4 degrees: a wall off the frame, or a frame off its walls.
FIT_ROUNDS = 4
PASSED_FROM = 2
MAX_BEND_M = 0.02  # Into the room; the back of a shelf and a picture are 4 cm thick.
MIN_GAIN = 1.1  # A plane that is askew must explain this many times the cells of a straight one.


@dataclass(frozen=True)
class Askew:
    """How a wall's position changes, in metres per metre, along it and upwards from a point."""

    along: float = 0.0
    upward: float = 0.0
    at_cell: float = 0.0  # Along the wall.
    at_m: float = 0.0  # Height.

    def of(self, along_m: np.ndarray | float, height_m: np.ndarray | float) -> np.ndarray:
        """Return the change of position at places along the wall and at heights, in metres."""
        return np.asarray(self.along * along_m + self.upward * (height_m - self.at_m))


@dataclass(frozen=True, eq=False)
class WallRun:
    """A straight piece of wall. ``outward_m`` increases along its direction out of the room."""

    axis: int
    sign: int
    outward_m: float
    span: tuple[int, int]  # First and last cell along the wall.
    top_m: float
    area_m2: float
    askew: Askew = Askew()


def find_walls(
    surface: Surface,
    level: np.ndarray,
    slopes: np.ndarray,
    ceiling_m: float | None,
    parameters: StructureParameters,
) -> list[tuple[WallRun, PlaneResiduals]]:
    """Return the pieces of wall, each with its relief.

    Args:
        surface: Surface of the room.
        level: Mask of the cells of floor and ceiling, including slopes, bool [X, Y, Z].
        slopes: Mask of the cells of sloped ceilings, bool [X, Y, Z].
        ceiling_m: Height of the ceiling, or None if it was not seen.
        parameters: Thresholds.
    """
    found: list[tuple[WallRun, PlaneResiduals]] = []
    for axis, sign in DIRECTIONS:
        view = _Turned(surface, level, slopes, axis, sign)
        runs = list(_runs(view, ceiling_m, parameters))
        runs = [run for run in runs if not _is_shadow(run, runs, parameters)]
        runs = [run for run in runs if not _is_open_above(run, view, ceiling_m)]
        runs = [run for run in runs if not _is_furniture(run, runs, ceiling_m, view, parameters)]
        for run in runs:
            box, on = _marked(view, run, parameters)
            found.append((run, measure_plane_residuals(surface, on, axis, sign, box)))
    return found


class _Turned:
    """The arrays of a room, rotated to axes outward, along the wall and up."""

    def __init__(
        self, surface: Surface, level: np.ndarray, slopes: np.ndarray, axis: int, sign: int
    ):
        self.axis, self.sign, self.voxel_m = axis, sign, surface.voxel_m
        self.above_floor = max(surface.floor_layer + 1, 0)
        self.occupied = self.turn(surface.occupied & ~level)
        self.free = self.turn(surface.free)
        self.slopes = self.turn(slopes)
        self.layers_below = surface.layers_below
        self.outward_m = sign * self.turn(surface.points_m[..., axis])
        self.height_m = self.turn(surface.points_m[..., 2])
        ends = surface.origin_m[axis] + np.array([0, surface.occupied.shape[axis]]) * self.voxel_m
        self.edge_m = float(min(sign * ends))  # Where layer 0 begins.

    def turn(self, values: np.ndarray) -> np.ndarray:
        return turn_surface(values, self.axis, self.sign)


def _runs(
    view: _Turned, ceiling_m: float | None, parameters: StructureParameters
) -> Iterator[WallRun]:
    """Yield the planes that may be walls, split at long gaps."""
    fronts = view.occupied & _facing(view.free)
    fronts[:, :, : view.above_floor] = False
    hidden = fronts & ~_passed_behind(view, parameters)
    least = parameters.roof_bottom_m if view.slopes.any() else parameters.wall_top_m
    for run in _peeled(view, hidden, parameters, least):
        if run.top_m >= parameters.wall_top_m or _under_slope(run, view):
            yield run
    if ceiling_m is not None:
        full = ceiling_m - parameters.full_gap_m
        for run in _peeled(view, fronts & ~hidden, parameters, full):
            width = (run.span[1] - run.span[0] + 1) * view.voxel_m
            if run.area_m2 >= parameters.full_share * width * ceiling_m:
                yield run


def _under_slope(run: WallRun, view: _Turned) -> bool:
    """Return whether a sloped ceiling begins at a run, which makes it a wall of any height."""
    layer = int(np.floor((run.outward_m - view.edge_m) / view.voxel_m))
    near = view.slopes[max(layer - 3, 0) : layer + 2, run.span[0] : run.span[1] + 1]
    return bool(near.any(axis=(0, 2)).mean() >= 0.5)


def _facing(free: np.ndarray) -> np.ndarray:
    """Return the positions at which a surface would face the room.

    One of the two cells in front is free. The second counts only if no cell behind is free, since
    the surface is otherwise the far face of a thin wall.
    """
    next_, second = np.zeros((2, *free.shape), bool)
    next_[1:] = free[:-1]
    second[2:] = free[:-2]
    return next_ | (second & ~_free_before(free[::-1])[::-1])


def _free_before(free: np.ndarray) -> np.ndarray:
    """Return the cells with a free cell among the two on the room's side."""
    before = np.zeros_like(free)
    before[1:] = free[:-1]
    before[2:] |= free[:-2]
    return before


def _passed_behind(view: _Turned, parameters: StructureParameters) -> np.ndarray:
    """Return the columns behind which rays passed at some height, bool [A, B, 1]."""
    free = view.free[:, :, view.above_floor :].sum(axis=2) >= parameters.passed_cells
    behind = np.zeros_like(free)
    # A wall that leans, or is bent by the sensor, has free space of its own just behind it.
    for step in range(PASSED_FROM, 1 + round(parameters.hidden_m / view.voxel_m)):
        behind[:-step] |= free[step:]
    return behind[:, :, None]


def _peeled(
    view: _Turned, fronts: np.ndarray, parameters: StructureParameters, top_m: float
) -> Iterator[WallRun]:
    """Yield runs, the plane with the most cells first, until none is large enough."""
    along = np.nonzero(fronts)[1]
    outward, height = view.outward_m[fronts], view.height_m[fronts]
    needed = parameters.wall_area_m2 / view.voxel_m**2
    for _ in range(MAX_PLANES):
        if len(outward) < needed:
            return
        peak, count = highest_peak(outward, parameters.plane_gate_m)
        if count < needed:
            return
        near, askew = _inliers(along, height, outward, peak, view.voxel_m, parameters.plane_gate_m)
        for first, last in _spans(along[near], round(parameters.wall_gap_m / view.voxel_m)):
            inside = near & (along >= first) & (along <= last)
            top = float(np.quantile(height[inside], 0.98))
            if inside.sum() >= needed and top >= top_m:
                area = float(inside.sum()) * view.voxel_m**2
                flat = outward[inside] - askew.of(
                    (along[inside] - askew.at_cell) * view.voxel_m, height[inside]
                )
                middle = float(np.median(flat))
                yield WallRun(view.axis, view.sign, middle, (first, last), top, area, askew)
        outward, height, along = outward[~near], height[~near], along[~near]


def _inliers(
    along: np.ndarray,
    height: np.ndarray,
    outward: np.ndarray,
    peak_m: float,
    voxel_m: float,
    gate_m: float,
) -> tuple[np.ndarray, Askew]:
    """Return the cells of the plane at a peak, bool [N], and how askew the plane is.

    A plane is only askew if that explains clearly more cells than a straight one.
    """
    straight = np.abs(outward - peak_m) <= gate_m
    near, askew = straight, Askew()
    for _ in range(FIT_ROUNDS):
        at_cell, at_m = float(along[near].mean()), float(height[near].mean())
        rows = np.stack(
            [np.ones(len(along)), (along - at_cell) * voxel_m, height - at_m], axis=1
        ).astype(np.float64)
        fit = np.linalg.lstsq(rows[near], outward[near], rcond=None)[0].round(9)
        if np.abs(fit[1:]).max() > MAX_ASKEW:
            break
        near = np.abs(outward - rows @ fit) <= gate_m
        askew = Askew(float(fit[1]), float(fit[2]), at_cell, at_m)
    if near.sum() < MIN_GAIN * straight.sum():
        return straight, Askew()
    return near, askew


def _spans(along: np.ndarray, gap_cells: int) -> list[tuple[int, int]]:
    """Split positions along a wall at gaps of more than ``gap_cells``."""
    present = np.unique(along)
    breaks = np.flatnonzero(np.diff(present) > gap_cells + 1)
    firsts = present[np.concatenate([[0], breaks + 1])]
    lasts = present[np.concatenate([breaks, [len(present) - 1]])]
    return [(int(a), int(b)) for a, b in zip(firsts, lasts, strict=True)]


def _is_shadow(run: WallRun, runs: list[WallRun], parameters: StructureParameters) -> bool:
    """Return whether a run only follows a larger one within little more than a cell.

    Noise, windows, door leaves and curtains cause such runs. A pillar is at a gap of the wall.
    """
    for wall in runs:
        near = abs(wall.outward_m - run.outward_m) <= parameters.shadow_m
        shared = min(wall.span[1], run.span[1]) - max(wall.span[0], run.span[0]) + 1
        inside = shared >= 0.7 * (run.span[1] - run.span[0] + 1)
        if near and inside and wall.area_m2 > 1.5 * run.area_m2:
            return True
    return False


def _is_open_above(run: WallRun, view: _Turned, ceiling_m: float | None) -> bool:
    """Return whether rays passed above a run, as of an open door, a wardrobe or a balustrade."""
    layer = int(np.floor((run.outward_m - view.edge_m) / view.voxel_m))
    low = view.layers_below(run.top_m + 2 * view.voxel_m)
    high = view.layers_below(HIGH_M if ceiling_m is None else ceiling_m - view.voxel_m)
    over = view.free[layer + 1 : layer + 3, run.span[0] : run.span[1] + 1, low:high]
    if not over.size:  # The wall is the last that was seen.
        return False
    passed = over.all(axis=0).sum(axis=1) >= 2
    return bool(passed.mean() >= OPEN_SHARE)


def _is_furniture(
    run: WallRun,
    runs: list[WallRun],
    ceiling_m: float | None,
    view: _Turned,
    parameters: StructureParameters,
) -> bool:
    """Return whether a run is the front of tall furniture in front of a wider wall."""
    width = (run.span[1] - run.span[0] + 1) * view.voxel_m
    low, high = parameters.recess_m if ceiling_m is None else (0.05, parameters.recess_m[1])
    for wall in runs:
        before = low <= wall.outward_m - run.outward_m <= high
        reach = round(high / view.voxel_m)
        beside = wall.span[0] - reach <= run.span[0] and run.span[1] <= wall.span[1] + reach
        narrow = ceiling_m is not None or width <= parameters.recess_width_m
        full = wall.top_m if ceiling_m is None else ceiling_m
        short = run.top_m < full - parameters.ceiling_gap_m
        if before and beside and narrow and short and wall.area_m2 > run.area_m2:
            return True
    return False


def _marked(
    view: _Turned, run: WallRun, parameters: StructureParameters
) -> tuple[tuple[slice, slice, slice], np.ndarray]:
    """Return a box of the rotated room and the mask of a run's cells in it, bool [N, A, B].

    The mask contains the cells on the plane and those that noise put in front of or behind it. A
    cell in front of the plane is noise if the cell behind it was also seen; pictures, curtains and
    screens hide the cells behind them.
    """
    box = _box(view, run, parameters)
    occupied, free = view.occupied[box], view.free[box]
    gap = view.outward_m[box] - run.outward_m - _askew_in(view, run, box)
    gap = gap - _bend(view, occupied, gap, parameters)[None]
    beyond = _free_beyond(free) & (gap > parameters.before_m)  # The other face of a thin wall.
    before_m = _before_m(gap[occupied & ~beyond], parameters)
    on = occupied & ~beyond & (gap >= -before_m) & (gap <= parameters.behind_m)
    before = occupied & ~on & (gap >= -view.voxel_m) & (gap < 0)
    before[1:] &= ~occupied[:-1]  # Noise stands alone; a shelf goes on into the room.
    on[:-1] |= before[:-1] & on[1:]
    return box, on


def _before_m(gap_m: np.ndarray, parameters: StructureParameters) -> float:
    """Return how far in front of a wall its cells may be, given the gaps of those near it [N].

    A wall seen from afar is a thick band of cells, beyond what the gate of a plane allows for. Its
    noise is measured behind it, since pictures, doors and curtains are in front.
    """
    near = gap_m[(gap_m > 0) & (gap_m <= parameters.shadow_m)]
    noise_m = parameters.before_m + max(noise_of(near) - parameters.plane_gate_m, 0.0)
    return min(noise_m, parameters.shadow_m)


def _askew_in(view: _Turned, run: WallRun, box: tuple[slice, slice, slice]) -> np.ndarray:
    """Return how far a run is askew at the cells of a box, float [N, A, B] or a scalar."""
    along = np.arange(box[1].start, box[1].stop)[None, :, None] - run.askew.at_cell
    return run.askew.of(along * view.voxel_m, view.height_m[box])


def _box(
    view: _Turned, run: WallRun, parameters: StructureParameters
) -> tuple[slice, slice, slice]:
    """Return the part of the rotated room that contains a run's cells."""
    x, y, z = view.occupied.shape
    layer = (run.outward_m - view.edge_m) / view.voxel_m
    ends_m = (np.array(run.span) - run.askew.at_cell) * view.voxel_m
    off_m = run.askew.of(ends_m[:, None], np.array([[0.0, run.top_m]]))
    first = int(np.floor(layer + off_m.min() / view.voxel_m)) - 3
    last = int(np.ceil(layer + (off_m.max() + parameters.behind_m) / view.voxel_m)) + 2
    return (
        slice(max(first, 0), min(last + 1, x)),
        slice(max(run.span[0] - 1, 0), min(run.span[1] + 2, y)),
        slice(view.above_floor, z),
    )


def _free_beyond(free: np.ndarray) -> np.ndarray:
    """Return the cells with a free cell among the two on the far side."""
    return _free_before(free[::-1])[::-1]


def _bend(
    view: _Turned, occupied: np.ndarray, gap: np.ndarray, parameters: StructureParameters
) -> np.ndarray:
    """Return the distance of a wall from its plane around each position, float [A, B], metres.

    Lens and sensor bend a long wall by some centimetres. The mean over about half a metre follows
    the bend and tends to 0 where little of the wall was seen. Backs of shelves and pictures, which
    are in front of the wall, do not count.
    """
    near = occupied & (gap >= -MAX_BEND_M) & (gap <= parameters.plane_gate_m)
    sigma = parameters.bend_m / view.voxel_m
    total = ndimage.gaussian_filter(np.where(near, gap, 0.0).sum(axis=0), sigma, mode="constant")
    count = ndimage.gaussian_filter(near.sum(axis=0).astype(float), sigma, mode="constant")
    return total / (count + 0.1)

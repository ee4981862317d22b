"""Directions of a plan's walls: the main one, and walls drawn at exact multiples of 45 degrees.

Apps measure each wall on its own, so that walls that are parallel in the house differ by some
degrees in the plan. Drawn as cells, such a wall has a step every few cells.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.formats.roomplan import PlanRoom, PlanSurface

EIGHTH = np.pi / 4
# Walls of the two directions of a RoomPlan of a library deviate by up to 7 degrees from their mean.
SNAP_RAD = np.radians(7.5)
RUN_M = 0.25  # Parallel sides of an outline that are closer are one wall.
MOVED_M = 0.5  # Maximum shift of a corner; 7 degrees shift the ends of a 4 m wall by 0.25 m.
PARALLEL = 0.2  # Sine under which two lines have no corner.


def main_direction_rad(walls: Sequence[PlanSurface]) -> float:
    """Return the direction, from 0 to pi / 2, that most of the length of the walls follows.

    Directions that differ by quarter turns count as one. Walls near that direction are averaged;
    the others, such as those of a wing at 45 degrees, have no influence.
    """
    along = np.array([wall.end_m - wall.start_m for wall in walls])
    length = np.linalg.norm(along, axis=1)
    angle = np.arctan2(along[:, 1], along[:, 0])
    near = np.cos(4 * (angle[:, None] - angle[None, :])) > np.cos(4 * SNAP_RAD)
    first = angle[int((near * length[:, None]).sum(axis=0).argmax())]
    for _ in range(3):
        kept = np.cos(4 * (angle - first)) > np.cos(4 * SNAP_RAD)
        first = float(np.angle(np.sum(length[kept] * np.exp(4j * angle[kept]))) / 4)
    return first % (np.pi / 2)


def snap_room(room: PlanRoom) -> PlanRoom:
    """Turn the walls, openings and floors of a room to the nearest multiple of 45 degrees.

    Surfaces farther than ``SNAP_RAD`` from all multiples are unchanged.
    """
    floors = []
    for floor in room.floors:
        if len(floor) < 3:
            floors.append(floor)
            continue
        outline = snap_outline(floor[:, :2])
        heights = np.full(len(outline), float(floor[:, 2].mean()))
        floors.append(np.column_stack([outline, heights]))
    return replace(
        room,
        walls=tuple(_snap_surface(wall) for wall in room.walls),
        openings=tuple(_snap_surface(opening) for opening in room.openings),
        floors=tuple(floors),
    )


def snapped_rad(angle: float) -> float:
    """Return the multiple of 45 degrees near an angle, or the angle itself if none is near."""
    nearest = round(angle / EIGHTH) * EIGHTH
    return nearest if abs(angle - nearest) <= SNAP_RAD else angle


def snap_outline(outline_m: np.ndarray) -> np.ndarray:
    """Turn the sides of an outline to the nearest multiples of 45 degrees.

    Each side keeps its middle. Successive sides that become parallel and are less than ``RUN_M``
    apart are merged into one side at the mean of their positions.

    Args:
        outline_m: Corners in order, float64 [N, 2].

    Returns:
        The corners, float64 [M, 2] with M at most N.
    """
    runs = _runs(outline_m)
    if len(runs) < 3:
        return outline_m
    corners = []
    for before, after in zip([runs[-1], *runs[:-1]], runs, strict=True):
        corners.append(_meeting(before, after))
    return np.array(corners)


def _snap_surface(surface: PlanSurface) -> PlanSurface:
    along = surface.end_m - surface.start_m
    angle = snapped_rad(float(np.arctan2(along[1], along[0])))
    half = np.array([np.cos(angle), np.sin(angle)]) * surface.length_m / 2
    middle = (surface.start_m + surface.end_m) / 2
    return replace(surface, start_m=middle - half, end_m=middle + half)


class _Run:
    """Successive sides of an outline on one line."""

    def __init__(self, start_m: np.ndarray, end_m: np.ndarray):
        """Create a run from one side."""
        along = end_m - start_m
        self.length_m = float(np.linalg.norm(along))
        self.angle = snapped_rad(float(np.arctan2(along[1], along[0])))
        self.is_snapped = abs(self.angle / EIGHTH - round(self.angle / EIGHTH)) < 1e-9
        self.start_m, self.end_m, self.middle_m = start_m, end_m, (start_m + end_m) / 2

    @property
    def along(self) -> np.ndarray:
        """The unit direction, float64 [2]."""
        return np.array([np.cos(self.angle), np.sin(self.angle)])

    def continues(self, other: "_Run") -> bool:
        """Return whether the next run lies on the same line."""
        a, b = self.along, other.along
        apart = abs(float(_cross(a, other.middle_m - self.middle_m)))
        parallel = abs(float(_cross(a, b))) < 1e-9 and float(a @ b) > 0
        return self.is_snapped and other.is_snapped and parallel and apart < RUN_M

    def join(self, other: "_Run") -> None:
        """Extend the run by the next one."""
        share = other.length_m / max(self.length_m + other.length_m, 1e-9)
        self.middle_m = self.middle_m * (1 - share) + other.middle_m * share
        self.length_m, self.end_m = self.length_m + other.length_m, other.end_m


def _runs(outline_m: np.ndarray) -> list[_Run]:
    runs: list[_Run] = []
    for start, end in zip(outline_m, np.roll(outline_m, -1, axis=0), strict=True):
        side = _Run(np.asarray(start, np.float64), np.asarray(end, np.float64))
        if side.length_m < 1e-6:
            continue
        if runs and runs[-1].continues(side):
            runs[-1].join(side)
        else:
            runs.append(side)
    if len(runs) > 3 and runs[-1].continues(runs[0]):
        last = runs.pop()
        last.join(runs[0])
        runs[0] = last
    return runs


def _meeting(before: _Run, after: _Run) -> np.ndarray:
    """Return the corner of two successive runs, near to their common end."""
    corner, a, b = after.start_m, before.along, after.along
    cross = _cross(a, b)
    if abs(cross) >= PARALLEL:
        met = before.middle_m + a * _cross(after.middle_m - before.middle_m, b) / cross
        if np.linalg.norm(met - corner) <= MOVED_M:
            return met
    return corner


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])

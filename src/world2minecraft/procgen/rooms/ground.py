"""The ground of a room: which part of its box is air, where its walls are, how high its ceiling is.

A room is its inner box less what is built into it: full-height blocks (the missing corner of an L,
a chimney breast, a column), corners cut off at 45 degrees, and roofs that slope down to a wall.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import ndimage

TOUCH_M = 1e-6  # Boxes may share a face.

Box = tuple[float, float, float, float, float, float]
Rect = tuple[float, float, float, float]  # x0 y0 x1 y1


@dataclass(frozen=True)
class Wall:
    """A straight wall, seen from the room.

    ``turn`` is the quarter turns of a front that looks away from it; ``at_m`` its x (turns 0, 2)
    or y (1, 3); it runs from ``first_m`` to ``last_m`` along the other axis.
    """

    turn: int
    at_m: float
    first_m: float
    last_m: float

    @property
    def length_m(self) -> float:
        """How long it is."""
        return self.last_m - self.first_m

    def point(self, along_m: float, away_m: float = 0.0) -> tuple[float, float]:
        """Return the place ``along_m`` on the running axis and ``away_m`` before the wall."""
        off = self.at_m + away_m if self.turn < 2 else self.at_m - away_m
        return (off, along_m) if self.turn % 2 == 0 else (along_m, off)

    def rect(self, first_m: float, last_m: float, near_m: float, far_m: float) -> Rect:
        """Return the rectangle between two places along it and two distances before it."""
        ax, ay = self.point(first_m, near_m)
        bx, by = self.point(last_m, far_m)
        return min(ax, bx), min(ay, by), max(ax, bx), max(ay, by)


@dataclass(frozen=True)
class Cut:
    """A corner cut off at 45 degrees: at x = max and y = max as told, ``leg_m`` along each wall."""

    high_x: bool
    high_y: bool
    leg_m: float


@dataclass(frozen=True)
class Roof:
    """A ceiling that rises from ``knee_m`` at a side (a wall's turn) to full height at reach."""

    side: int
    knee_m: float
    reach_m: float


@dataclass(frozen=True)
class Ground:
    """One room's shape in its own frame, its inner box from (0, 0) to ``size_m``."""

    size_m: tuple[float, float, float]
    blocks: tuple[Rect, ...] = ()
    cuts: tuple[Cut, ...] = ()
    roofs: tuple[Roof, ...] = ()

    @cached_property
    def polygon_m(self) -> np.ndarray:
        """The outline without columns, float64 [N, 2], counter-clockwise from above."""
        corners = _outline(self.size_m, self.blocks)
        width, depth, _ = self.size_m
        for cut in self.cuts:
            spot = (width if cut.high_x else 0.0, depth if cut.high_y else 0.0)
            corners = _chamfered(corners, spot, cut.leg_m)
        return np.array(corners, np.float64)

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """The walls along x and y; number n < 4 is the longest of turn n at the box's side."""
        width, depth, _ = self.size_m
        sides = (0.0, 0.0, width, depth)
        found = []
        for start, end in zip(self.polygon_m, np.roll(self.polygon_m, -1, axis=0), strict=True):
            dx, dy = (end - start).tolist()
            if dx and dy:
                continue
            turn = (1 if dx > 0 else 3) if dx else (2 if dy > 0 else 0)
            axis = 1 - turn % 2
            first, last = sorted((float(start[axis]), float(end[axis])))
            found.append(Wall(turn, float(start[1 - axis]), first, last))
        main = [
            max((w for w in found if (w.turn, w.at_m) == (t, sides[t])), key=lambda w: w.length_m)
            for t in range(4)
        ]
        return (*main, *(wall for wall in found if wall not in main))

    def holds(self, box: Box) -> bool:
        """Tell whether a box lies in the room's air."""
        inside = all(
            box[n] >= -TOUCH_M and box[n + 3] <= self.size_m[n] + TOUCH_M for n in range(3)
        )
        return inside and not self._meets_built(box)

    def _meets_built(self, box: Box) -> bool:
        x0, y0, _, x1, y1, z1 = box
        width, depth, _ = self.size_m
        for a, b, c, d in self.blocks:
            if x0 < c - TOUCH_M and a < x1 - TOUCH_M and y0 < d - TOUCH_M and b < y1 - TOUCH_M:
                return True
        for cut in self.cuts:
            off = (width - x1 if cut.high_x else x0) + (depth - y1 if cut.high_y else y0)
            if off < cut.leg_m - TOUCH_M:
                return True
        return any(self._roof_m(roof, x0, y0, x1, y1) < z1 - TOUCH_M for roof in self.roofs)

    def _roof_m(self, roof: Roof, x0: float, y0: float, x1: float, y1: float) -> float:
        width, depth, height = self.size_m
        off = (x0, y0, width - x1, depth - y1)[roof.side]
        return roof.knee_m + (height - roof.knee_m) * min(1.0, max(0.0, off) / roof.reach_m)

    def built(self, x_m: np.ndarray, y_m: np.ndarray) -> np.ndarray:
        """Return bool of the shape of ``x_m`` and ``y_m``: places that are wall from floor up."""
        width, depth, _ = self.size_m
        taken = np.zeros(np.broadcast(x_m, y_m).shape, bool)
        for a, b, c, d in self.blocks:
            taken |= (x_m > a) & (x_m < c) & (y_m > b) & (y_m < d)
        for cut in self.cuts:
            off_x = width - x_m if cut.high_x else x_m
            taken |= off_x + (depth - y_m if cut.high_y else y_m) < cut.leg_m
        return taken

    def ceiling_m(self, x_m: np.ndarray, y_m: np.ndarray) -> np.ndarray:
        """Return the height of the ceiling over places, float64."""
        width, depth, height = self.size_m
        level = np.full(np.broadcast(x_m, y_m).shape, height)
        for roof in self.roofs:
            off = (x_m, y_m, width - x_m, depth - y_m)[roof.side]
            rise = (height - roof.knee_m) * np.clip(off / roof.reach_m, 0, 1)
            level = np.minimum(level, roof.knee_m + rise)
        return level


def grown(mask: np.ndarray, steps: int) -> np.ndarray:
    """Return a bool mask [X, Y] with all squares up to ``steps`` away, corners counted."""
    wider = np.zeros(mask.shape, bool)
    ndimage.binary_dilation(mask, np.ones((2 * steps + 1,) * 2, bool), output=wider)
    return wider


def _outline(size_m: tuple[float, float, float], blocks: tuple[Rect, ...]) -> list[tuple]:
    """Return the corners around the box less the blocks that touch its sides."""
    width, depth, _ = size_m
    outer = [b for b in blocks if b[0] <= 0 or b[1] <= 0 or b[2] >= width or b[3] >= depth]
    xs = sorted({0.0, width, *(min(max(v, 0.0), width) for b in outer for v in (b[0], b[2]))})
    ys = sorted({0.0, depth, *(min(max(v, 0.0), depth) for b in outer for v in (b[1], b[3]))})
    free = np.ones((len(xs) + 1, len(ys) + 1), bool)  # With a rim of built cells all around.
    free[0] = free[-1] = free[:, 0] = free[:, -1] = False
    for a, b, c, d in outer:
        for i in range(1, len(xs)):
            for j in range(1, len(ys)):
                inside = a <= xs[i - 1] and xs[i] <= c and b <= ys[j - 1] and ys[j] <= d
                free[i, j] &= not inside
    return _walk_around(free, xs, ys)


STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))
# The cell to the left of a step from a corner (i, j): cells are counted one further for the rim.
LEFT = ((1, 1), (0, 1), (0, 0), (1, 0))


def _walk_around(free: np.ndarray, xs: list[float], ys: list[float]) -> list[tuple]:
    """Walk along the edge of the free cells with them at the left; return the corners turned at."""
    i, j = (int(v) for v in np.argwhere(free)[0] - 1)  # Lowest x, then y: a corner going +x.
    begin, heading, corners = (i, j), 0, [(xs[i], ys[j])]
    while True:
        i, j = i + STEPS[heading][0], j + STEPS[heading][1]
        if (i, j) == begin:
            return corners
        for turn in (-1, 0, 1):  # Right where it is free there, else on, else left.
            way = (heading + turn) % 4
            a, b = LEFT[way]
            if free[i + a, j + b]:
                if turn:
                    corners.append((xs[i], ys[j]))
                heading = way
                break


def _chamfered(corners: list[tuple], spot: tuple[float, float], leg_m: float) -> list[tuple]:
    """Replace one corner by two, ``leg_m`` before and after it."""
    n = corners.index(spot)
    ends = []
    for other in (corners[n - 1], corners[(n + 1) % len(corners)]):
        way = np.sign(np.array(other) - spot)
        ends.append(tuple(float(v) for v in np.array(spot) + way * leg_m))
    return [*corners[:n], *ends, *corners[n + 1 :]]

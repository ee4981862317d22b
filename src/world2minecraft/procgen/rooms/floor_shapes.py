"""Shapes of rooms: the free floor area, the walls and the ceiling height.

A room is a box without its built-in parts: full-height blocks (the missing corner of an L, a
chimney breast, a column), corners cut off at 45 degrees, and roofs that slope down to a wall. The
available shapes are a box, an L, a box with a cut corner or chimney breast, a sloped ceiling, and
columns.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import ndimage

from world2minecraft.procgen.rooms.furniture_model import round_to_step

TOUCH_M = 1e-6  # Boxes may share a face.

Box = tuple[float, float, float, float, float, float]
Rect = tuple[float, float, float, float]  # x0 y0 x1 y1
STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))
# The cell to the left of a step from a corner (i, j): cells are counted one further for the rim.
LEFT = ((1, 1), (0, 1), (0, 0), (1, 0))
Size = tuple[float, float, float]
WALL_FOR_OPENING_M = 1.9  # A window of 1.6 m and its curtains, or a door, its frame and a switch.
WALL_FOR_DOOR_M = 1.3


@dataclass(frozen=True)
class Wall:
    """A straight wall, as seen from the room.

    ``turn`` is the yaw of furniture with its back to the wall, in quarter turns. ``at_m`` is the
    wall's x (for turns 0 and 2) or y (for turns 1 and 3). The wall extends from ``first_m`` to
    ``last_m`` along the other axis.
    """

    turn: int
    at_m: float
    first_m: float
    last_m: float

    @property
    def length_m(self) -> float:
        """The length of the wall in metres."""
        return self.last_m - self.first_m

    def point(self, along_m: float, away_m: float = 0.0) -> tuple[float, float]:
        """Return the position ``along_m`` along the wall and ``away_m`` in front of it."""
        off = self.at_m + away_m if self.turn < 2 else self.at_m - away_m
        return (off, along_m) if self.turn % 2 == 0 else (along_m, off)

    def rect(self, first_m: float, last_m: float, near_m: float, far_m: float) -> Rect:
        """Return the rectangle between two positions along the wall and two distances from it."""
        ax, ay = self.point(first_m, near_m)
        bx, by = self.point(last_m, far_m)
        return min(ax, bx), min(ay, by), max(ax, bx), max(ay, by)


@dataclass(frozen=True)
class Cut:
    """A corner cut off at 45 degrees with legs of ``leg_m``.

    ``high_x`` and ``high_y`` select the corner.
    """

    high_x: bool
    high_y: bool
    leg_m: float


@dataclass(frozen=True)
class Roof:
    """A sloped ceiling that rises from ``knee_m`` at a wall to full height at ``reach_m``.

    ``side`` is the direction of the wall at the low side, in quarter turns.
    """

    side: int
    knee_m: float
    reach_m: float


@dataclass(frozen=True)
class Ground:
    """The shape of a room in its local frame, with the inner box from (0, 0) to ``size_m``.

    ``blocks`` are full-height rectangles x0, y0, x1, y1 that are not part of the room.
    """

    size_m: tuple[float, float, float]
    blocks: tuple[Rect, ...] = ()
    cuts: tuple[Cut, ...] = ()
    roofs: tuple[Roof, ...] = ()

    @cached_property
    def polygon_m(self) -> np.ndarray:
        """The outline without columns, float64 [N, 2], counter-clockwise seen from above."""
        corners = _outline(self.size_m, self.blocks)
        width, depth, _ = self.size_m
        for cut in self.cuts:
            spot = (width if cut.high_x else 0.0, depth if cut.high_y else 0.0)
            corners = _chamfer(corners, spot, cut.leg_m)
        return np.array(corners, np.float64)

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """The walls along x and y.

        Walls 0 to 3 are the longest walls at the sides of the inner box, in the order of their
        turns.
        """
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
        """Return whether a box is inside the free space of the room."""
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
        """Return whether positions are inside built-in blocks or cut corners, as a bool array."""
        width, depth, _ = self.size_m
        taken = np.zeros(np.broadcast(x_m, y_m).shape, bool)
        for a, b, c, d in self.blocks:
            taken |= (x_m > a) & (x_m < c) & (y_m > b) & (y_m < d)
        for cut in self.cuts:
            off_x = width - x_m if cut.high_x else x_m
            taken |= off_x + (depth - y_m if cut.high_y else y_m) < cut.leg_m
        return taken

    def ceiling_m(self, x_m: np.ndarray, y_m: np.ndarray) -> np.ndarray:
        """Return the height of the ceiling at positions in metres, as a float64 array."""
        width, depth, height = self.size_m
        level = np.full(np.broadcast(x_m, y_m).shape, height)
        for roof in self.roofs:
            off = (x_m, y_m, width - x_m, depth - y_m)[roof.side]
            rise = (height - roof.knee_m) * np.clip(off / roof.reach_m, 0, 1)
            level = np.minimum(level, roof.knee_m + rise)
        return level


def dilate_mask(mask: np.ndarray, steps: int) -> np.ndarray:
    """Dilate a bool mask [X, Y] by ``steps`` cells in all directions, including diagonals."""
    wider = np.zeros(mask.shape, bool)
    ndimage.binary_dilation(mask, np.ones((2 * steps + 1,) * 2, bool), output=wider)
    return wider


def _outline(size_m: tuple[float, float, float], blocks: tuple[Rect, ...]) -> list[tuple]:
    """Return the corners of the box without the blocks that touch its sides."""
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


def _walk_around(free: np.ndarray, xs: list[float], ys: list[float]) -> list[tuple]:
    """Follow the edge of the free cells counter-clockwise and return its corners."""
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


def _chamfer(corners: list[tuple], spot: tuple[float, float], leg_m: float) -> list[tuple]:
    """Replace a corner by two corners at a distance of ``leg_m`` from it."""
    n = corners.index(spot)
    ends = []
    for other in (corners[n - 1], corners[(n + 1) % len(corners)]):
        way = np.sign(np.array(other) - spot)
        ends.append(tuple(float(v) for v in np.array(spot) + way * leg_m))
    return [*corners[:n], *ends, *corners[n + 1 :]]


def box_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return a rectangular room shape."""
    return Ground(size_m)


def ell_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return an L-shaped room shape whose sides are 22 % longer than those of the box."""
    width, depth = (round_to_step(1.22 * side) for side in size_m[:2])
    gone_x = round_to_step(width * rng.uniform(0.28, 0.4))
    gone_y = round_to_step(depth * rng.uniform(0.28, 0.4))
    x, y = (bool(rng.integers(2)) for _ in range(2))
    block = (
        *(round_to_step(width - gone_x) if x else 0.0, round_to_step(depth - gone_y) if y else 0.0),
        *(width if x else gone_x, depth if y else gone_y),
    )
    return Ground((width, depth, size_m[2]), (block,))


def cut_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return a room shape with a cut corner, a chimney breast or an alcove, chosen at random."""
    width, depth, height = size_m
    drawn = int(rng.integers(3))
    if drawn == 0:
        leg = round_to_step(rng.uniform(0.8, 1.3))
        cut = Cut(bool(rng.integers(2)), bool(rng.integers(2)), leg)
        return Ground(size_m, cuts=(cut,))
    if drawn == 1:
        wide, deep = round_to_step(rng.uniform(1.0, 1.5)), round_to_step(rng.uniform(0.3, 0.46))
        wide = min(wide, round_to_step(0.5 * width))
        first = _between(width - wide, 0.9, rng)
        return Ground(size_m, ((first, depth - deep, first + wide, depth),))
    deep, wide = round_to_step(rng.uniform(0.5, 0.9)), round_to_step(rng.uniform(1.6, 2.2))
    wide = min(wide, round_to_step(0.6 * width))
    first = _between(width - wide, 0.6, rng)
    sides: tuple[Rect, ...] = (
        (0.0, depth, first, depth + deep), (first + wide, depth, width, depth + deep),
    )  # fmt: skip
    return Ground((width, round_to_step(depth + deep), height), sides)


def _between(free_m: float, margin_m: float, rng: np.random.Generator) -> float:
    """Return a random start position that leaves a margin at both ends of a wall."""
    margin_m = min(margin_m, 0.5 * free_m)
    return round_to_step(rng.uniform(margin_m, free_m - margin_m))


def sloped_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return an attic shape with one or two roofs of 35 to 50 degrees above knee walls."""
    width, depth, height = size_m
    axis = 0 if width >= depth else 1
    knee = round_to_step(rng.uniform(0.9, 1.4))
    reach = round_to_step((height - knee) / np.tan(np.radians(rng.uniform(35, 50))))
    both = rng.random() < 0.5
    reach = min(reach, round_to_step(0.42 * min(width, depth)))  # In the middle one stands upright.
    roofs = [Roof(3 - axis, knee, reach)]
    if both:
        roofs.append(Roof(1 - axis, knee, reach))
    return Ground(size_m, roofs=tuple(roofs))


def columns_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return a room shape with one or two square columns outside its middle."""
    width, depth, _ = size_m
    side = round_to_step(rng.uniform(0.28, 0.4))
    blocks = []
    for share_x in (0.3, 0.72)[: 1 + int(rng.integers(2))]:
        x, y = round_to_step(width * share_x), round_to_step(depth * rng.uniform(0.24, 0.34))
        blocks.append((x, y, x + side, y + side))
    return Ground(size_m, tuple(blocks))


SHAPES: dict[str, Callable[[Size, np.random.Generator], Ground]] = {
    "box": box_ground,
    "ell": ell_ground,
    "cut": cut_ground,
    "sloped": sloped_ground,
    "columns": columns_ground,
}


def shaped_ground(shape: str, size_m: Size, rng: np.random.Generator) -> Ground:
    """Return a room shape of a given kind and approximate size.

    Args:
        shape: One of ``SHAPES``.
        size_m: Inner width, depth and height of the box on which the shape is based.
        rng: Random generator for the details of the shape.
    """
    return SHAPES[shape](size_m, rng)


def draw_shape(seed: int) -> str:
    """Return the name of the random room shape of a seed, used if no shape is given."""
    return sorted(SHAPES)[int(np.random.default_rng([seed, 1 << 20]).integers(len(SHAPES)))]


def open_walls(ground: Ground, kind: str) -> tuple[int, ...]:
    """Return the indices of the walls that can have doors and windows.

    In a kitchen, two walls are used by counters. Low walls under a roof cannot have windows.
    """
    low = {roof.side for roof in ground.roofs}
    upright = [n for n, wall in enumerate(ground.walls) if wall.turn not in low]
    wide = [n for n in upright if ground.walls[n].length_m >= WALL_FOR_OPENING_M]
    if len(wide) < 2:  # A narrow hall under a roof has its door and its window in its short walls.
        wide = [n for n in upright if ground.walls[n].length_m >= WALL_FOR_DOOR_M]
    if kind == "kitchen":
        wide = [n for n in wide if n not in (0, 1)]
    return tuple(wide)

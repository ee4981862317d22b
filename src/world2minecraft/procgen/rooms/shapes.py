"""The shapes of rooms: a box, an L, a cut corner or chimney breast, a sloped ceiling, columns."""

from collections.abc import Callable

import numpy as np

from world2minecraft.procgen.rooms.furniture_model import whole
from world2minecraft.procgen.rooms.ground import Cut, Ground, Rect, Roof

Size = tuple[float, float, float]
WALL_FOR_OPENING_M = 1.9  # A window of 1.6 m and its curtains, or a door, its frame and a switch.

WALL_FOR_DOOR_M = 1.3


def box_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return the plain box."""
    return Ground(size_m)


def ell_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return an L: sides a fifth longer than a box's, a corner of a third of each missing."""
    width, depth = (whole(1.22 * side) for side in size_m[:2])
    gone_x = whole(width * rng.uniform(0.28, 0.4))
    gone_y = whole(depth * rng.uniform(0.28, 0.4))
    x, y = (bool(rng.integers(2)) for _ in range(2))
    block = (
        *(whole(width - gone_x) if x else 0.0, whole(depth - gone_y) if y else 0.0),
        *(width if x else gone_x, depth if y else gone_y),
    )
    return Ground((width, depth, size_m[2]), (block,))


def cut_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return a room with a cut corner, a chimney breast, or an alcove."""
    width, depth, height = size_m
    drawn = int(rng.integers(3))
    if drawn == 0:
        leg = whole(rng.uniform(0.8, 1.3))
        cut = Cut(bool(rng.integers(2)), bool(rng.integers(2)), leg)
        return Ground(size_m, cuts=(cut,))
    if drawn == 1:
        wide, deep = whole(rng.uniform(1.0, 1.5)), whole(rng.uniform(0.3, 0.46))
        wide = min(wide, whole(0.5 * width))
        first = _between(width - wide, 0.9, rng)
        return Ground(size_m, ((first, depth - deep, first + wide, depth),))
    deep, wide = whole(rng.uniform(0.5, 0.9)), whole(rng.uniform(1.6, 2.2))
    wide = min(wide, whole(0.6 * width))
    first = _between(width - wide, 0.6, rng)
    sides: tuple[Rect, ...] = (
        (0.0, depth, first, depth + deep), (first + wide, depth, width, depth + deep),
    )  # fmt: skip
    return Ground((width, whole(depth + deep), height), sides)


def _between(free_m: float, margin_m: float, rng: np.random.Generator) -> float:
    """Return where something begins that leaves ``free_m`` of a wall, a margin at both ends."""
    margin_m = min(margin_m, 0.5 * free_m)
    return whole(rng.uniform(margin_m, free_m - margin_m))


def sloped_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return an attic: one or two sides under a roof of 35 to 50 degrees above a knee wall."""
    width, depth, height = size_m
    axis = 0 if width >= depth else 1
    knee = whole(rng.uniform(0.9, 1.4))
    reach = whole((height - knee) / np.tan(np.radians(rng.uniform(35, 50))))
    both = rng.random() < 0.5
    reach = min(reach, whole(0.42 * min(width, depth)))  # In the middle one stands upright.
    roofs = [Roof(3 - axis, knee, reach)]
    if both:
        roofs.append(Roof(1 - axis, knee, reach))
    return Ground(size_m, roofs=tuple(roofs))


def columns_ground(size_m: Size, rng: np.random.Generator) -> Ground:
    """Return a room with one or two square columns, off its middle."""
    width, depth, _ = size_m
    side = whole(rng.uniform(0.28, 0.4))
    blocks = []
    for share_x in (0.3, 0.72)[: 1 + int(rng.integers(2))]:
        x, y = whole(width * share_x), whole(depth * rng.uniform(0.24, 0.34))
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
    """Return a ground of a shape, about of a size.

    Args:
        shape: one of ``SHAPES``.
        size_m: the inner sides and the height of a box room.
        rng: draws where it departs from the box.
    """
    return SHAPES[shape](size_m, rng)


def shape_of_seed(seed: int) -> str:
    """Return the shape that a seed draws where none is asked for."""
    return sorted(SHAPES)[int(np.random.default_rng([seed, 1 << 20]).integers(len(SHAPES)))]


def open_walls(ground: Ground, kind: str) -> tuple[int, ...]:
    """Return the numbers of the walls that may have doors and windows.

    A kitchen's counters take two; under a roof a window finds no place.
    """
    low = {roof.side for roof in ground.roofs}
    upright = [n for n, wall in enumerate(ground.walls) if wall.turn not in low]
    wide = [n for n in upright if ground.walls[n].length_m >= WALL_FOR_OPENING_M]
    if len(wide) < 2:  # A narrow hall under a roof has its door and its window in its short walls.
        wide = [n for n in upright if ground.walls[n].length_m >= WALL_FOR_DOOR_M]
    if kind == "kitchen":
        wide = [n for n in wide if n not in (0, 1)]
    return tuple(wide)

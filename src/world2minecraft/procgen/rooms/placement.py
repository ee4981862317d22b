"""Collision-free placement of furniture, independently or relative to other items.

A ``Plan`` contains the shape of the room, its items, and reserved space such as the swing of a
door, the area in front of a window and the space beside a bed. The first four walls are numbered by
the yaw of furniture with its back to the wall, in quarter turns: 0 is at x = 0, 1 at y = 0, 2 at x
= max and 3 at y = max.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.furniture.layout_checks import overlap_depth_m
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms.floor_shapes import TOUCH_M, Box, Ground, Rect, dilate_mask
from world2minecraft.procgen.rooms.furniture_model import STEP_M, Colour, Model, round_to_step

TRIES = 40
SQUARE_M = 0.1


class Rug(NamedTuple):
    """A flat rug, as a rectangle that is turned about its middle."""

    x0: float
    y0: float
    x1: float
    y1: float
    colour: Colour
    turn_deg: float = 0.0


@dataclass(frozen=True)
class Item:
    """A placed model, with the middle of its footprint, the height of its bottom and its yaw."""

    model: Model
    x_m: float
    y_m: float
    z_m: float
    yaw_deg: float

    @cached_property
    def box_m(self) -> Box:
        """The axis-aligned bounding box as x0, y0, z0, x1, y1, z1."""
        d, w, h = self.model.size_m
        c, s = np.abs(rotation_about_z(self.yaw_deg)[:2, 0])
        half_x, half_y = (d * c + w * s) / 2, (d * s + w * c) / 2
        return (
            self.x_m - half_x, self.y_m - half_y, self.z_m,
            self.x_m + half_x, self.y_m + half_y, self.z_m + h,
        )  # fmt: skip

    @property
    def center_m(self) -> np.ndarray:
        """The centre of the bounding box, float64 [3]."""
        return np.array([self.x_m, self.y_m, self.z_m + self.model.size_m[2] / 2])

    @property
    def size_m(self) -> tuple[float, float, float]:
        """The size of the model."""
        return self.model.size_m

    def point(self, front_m: float, left_m: float) -> tuple[float, float]:
        """Return the room position of a point in the item's local frame."""
        turned = apply(rotation_about_z(self.yaw_deg), np.array([front_m, left_m, 0.0]))
        return self.x_m + float(turned[0]), self.y_m + float(turned[1])


def boxes_intersect(a: Box, b: Box) -> bool:
    """Return whether two boxes overlap. Boxes that only touch do not overlap."""
    return all(a[n] < b[n + 3] - TOUCH_M and b[n] < a[n + 3] - TOUCH_M for n in range(3))


def items_intersect(a: Item, b: Item) -> bool:
    """Return whether two items overlap, considering their rotation. Touching is no overlap."""
    if not boxes_intersect(a.box_m, b.box_m):
        return False
    if a.yaw_deg % 90 == 0 and b.yaw_deg % 90 == 0:
        return True
    return overlap_depth_m(a, b) > TOUCH_M


class Plan:
    """A room that is being furnished."""

    def __init__(self, ground: Ground, rng: np.random.Generator):
        self.ground, self.size_m, self.rng = ground, ground.size_m, rng
        self.items: list[Item] = []
        self.reserved: list[Box] = []
        self.pits: list[Rect] = []  # Holes in the floor: nobody walks there.

    def wall_length(self, wall: int) -> float:
        """Return the length of a wall in metres."""
        return self.ground.walls[wall].length_m

    def at_wall(
        self, model: Model, wall: int, along_m: float, z_m: float = 0.0, gap_m: float = 0.0
    ) -> Item:
        """Return an item with its back to a wall and its middle at ``along_m``.

        ``along_m`` is an x coordinate on walls 1 and 3, and a y coordinate on walls 0 and 2.
        """
        side = self.ground.walls[wall]
        x, y = side.point(along_m, model.size_m[0] / 2 + gap_m)
        return snap_to_voxels(Item(model, x, y, z_m, 90.0 * side.turn))

    def behind(self, item: Item, model: Model, z_m: float, shift_m: float = 0.0) -> Item:
        """Return a model on the wall behind an item, its middle ``shift_m`` along the wall."""
        wall = round(item.yaw_deg / 90) % 4
        along = item.y_m if wall % 2 == 0 else item.x_m
        return self.at_wall(model, wall, along + shift_m, z_m)

    def fits(self, item: Item, *, may_block: bool = False, among: list[Item] | None = None) -> bool:
        """Return whether an item is inside the room and overlaps no item or reserved space.

        Args:
            item: The item to check.
            may_block: Whether the item may overlap reserved space.
            among: The items that it must not overlap. The default is all items.
        """
        box = item.box_m
        inside = self.ground.holds(box)
        others = self.items if among is None else among
        reserved = [] if may_block else self.reserved
        return (
            inside
            and not any(boxes_intersect(box, other) for other in reserved)
            and not any(items_intersect(item, other) for other in others)
        )

    def add(self, item: Item | None, *, may_block: bool = False) -> Item | None:
        """Add an item if it fits, and return it, or None if it does not fit."""
        if item is None or not self.fits(item, may_block=may_block):
            return None
        self.items.append(item)
        return item

    def add_at_walls(
        self,
        model: Model,
        walls: tuple[int, ...] = (0, 1, 2, 3),
        *,
        along: tuple[float, ...] = (),
        clear_m: float = 0.0,
        z_m: float = 0.0,
    ) -> Item | None:
        """Place a model against one of several walls, and return its item or None.

        None means that the model does not fit.

        Args:
            model: The model to place.
            walls: Indices of the walls to try, in turn.
            along: Fractions of the wall length to try first. Random positions are tried next.
            clear_m: Depth of the floor area in front of the item that is reserved.
            z_m: Height of the bottom of the item.
        """
        half = model.size_m[1] / 2
        for n in range(len(walls) * (len(along) + TRIES // 4)):
            wall = walls[n % len(walls)]
            side = self.ground.walls[wall]
            length = side.length_m
            turn = n // len(walls)
            share = along[turn] if turn < len(along) else float(self.rng.random())
            middle = side.first_m + min(max(length * share, half), length - half)
            item = self.at_wall(model, wall, middle, z_m)
            front = self.front_box(item, clear_m)
            if self.fits(item) and (clear_m == 0 or self._is_free(front)):
                self.items.append(item)
                if clear_m:
                    self.reserved.append(front)
                return item
        return None

    def add_in_corner(self, model: Model, *, near: Item | None = None) -> Item | None:
        """Place a small model in a free corner or beside ``near``, and return its item or None."""
        width, depth, _ = self.size_m
        inset_x, inset_y = model.size_m[0] / 2 + 0.06, model.size_m[1] / 2 + 0.06
        spots = [(x, y) for x in (inset_x, width - inset_x) for y in (inset_y, depth - inset_y)]
        if near is not None:
            aside = (near.model.size_m[1] + model.size_m[1]) / 2 + 0.06
            back = -near.model.size_m[0] / 2 + model.size_m[0] / 2
            spots = [near.point(back, aside), near.point(back, -aside)]
        for n in self.rng.permutation(len(spots)):
            x, y = spots[int(n)]
            yaw = 0.0 if x < width / 2 else 180.0  # Its front looks into the room.
            placed = self.add(snap_to_voxels(Item(model, x, y, 0.0, yaw)))
            if placed:
                return placed
        return None

    def add_before(self, model: Model, anchor: Item, gap_m: float) -> Item | None:
        """Place a model in front of another item, facing the item."""
        away = anchor.model.size_m[0] / 2 + gap_m + model.size_m[0] / 2
        x, y = anchor.point(away, 0.0)
        yaw = (anchor.yaw_deg + 180.0) % 360
        return self.add(snap_to_voxels(Item(model, x, y, anchor.z_m, yaw)), may_block=True)

    def add_upon(
        self, model: Model, base: Item, front_m: float, left_m: float, *, top_m: float | None = None
    ) -> Item | None:
        """Place a model on top of another item at a local position, with the same orientation."""
        x, y = base.point(front_m, left_m)
        top = base.z_m + (base.model.size_m[2] if top_m is None else top_m)
        return self.add(snap_to_voxels(Item(model, x, y, top, base.yaw_deg)), may_block=True)

    def reserve_beside(self, item: Item, width_m: float) -> None:
        """Reserve the floor on both sides of an item."""
        x0, y0, _, x1, y1, _ = item.box_m
        if round(item.yaw_deg) % 180 == 0:
            self.reserved.append((x0, y0 - width_m, 0.0, x1, y1 + width_m, 2.0))
        else:
            self.reserved.append((x0 - width_m, y0, 0.0, x1 + width_m, y1, 2.0))

    def front_box(self, item: Item, depth_m: float) -> Box:
        """Return the box of free space up to ``depth_m`` in front of an item."""
        half, wide = item.model.size_m[0] / 2, item.model.size_m[1] / 2
        ax, ay = item.point(half, -wide)
        bx, by = item.point(half + depth_m, wide)
        return (min(ax, bx), min(ay, by), item.z_m, max(ax, bx), max(ay, by), item.z_m + 1.8)

    def _is_free(self, box: Box) -> bool:
        return not any(boxes_intersect(box, other.box_m) for other in self.items)


def snap_to_voxels(item: Item) -> Item:
    """Move an item by less than 2 cm, so that its bounding box is aligned with voxels."""
    x0, y0, z0, *_ = item.box_m

    def shift(value: float) -> float:
        return round(value / STEP_M) * STEP_M - value

    return Item(
        item.model, item.x_m + shift(x0), item.y_m + shift(y0), item.z_m + shift(z0), item.yaw_deg
    )


def paths_are_clear(plan: Plan, *doors_m: tuple[float, float], body_m: float = 0.24) -> bool:
    """Return whether a person who enters through any door can reach most of the free floor.

    The floor is divided into squares of 10 cm, and furniture is enlarged by ``body_m``, half the
    width of a person. All doors must lead to the same part of the floor.
    """
    x, y, free = _free_floor(plan, body_m)
    parts, _ = label_components(free, corners=False)
    if not parts.any():
        return False
    starts = set()
    for door_m in doors_m:
        distance = np.where(free, np.hypot(x - door_m[0], y - door_m[1]), np.inf)
        starts.add(int(parts.reshape(-1)[int(distance.argmin())]))
        if distance.min() >= 1.0:
            return False
    reached = int(np.isin(parts, sorted(starts)).sum())
    return len(starts) == 1 and reached >= 0.75 * free.sum() and reached * SQUARE_M**2 > 1.2


def _free_floor(plan: Plan, body_m: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the x and y of squares of 10 cm and whether a body fits there, each [X, Y]."""
    nx, ny = (int(side / SQUARE_M) for side in plan.size_m[:2])
    rows, columns = (np.arange(nx) + 0.5) * SQUARE_M, (np.arange(ny) + 0.5) * SQUARE_M
    x, y = np.meshgrid(rows, columns, indexing="ij")
    free = (x > body_m) & (x < plan.size_m[0] - body_m)
    free &= (y > body_m) & (y < plan.size_m[1] - body_m)
    if plan.ground.blocks or plan.ground.cuts or plan.ground.roofs:
        low = plan.ground.built(x, y) | (plan.ground.ceiling_m(x, y) < 1.8)
        free &= ~dilate_mask(low, 2)
    pits = [(a, b, 0.0, c, d, 1.0) for a, b, c, d in plan.pits]
    for x0, y0, z0, x1, y1, z1 in [*(item.box_m for item in plan.items), *pits]:
        if z0 < 1.9 and z1 > 0.05:
            free &= ~((x > x0 - body_m) & (x < x1 + body_m) & (y > y0 - body_m) & (y < y1 + body_m))
    return x, y, free


def chairs_around(plan: Plan, board: Item, chair: Model, *, ends: bool) -> None:
    """Place chairs at the long sides of a table, and optionally at its ends, facing the table."""
    depth, width, _ = board.model.size_m
    count = max(1, int(width / 0.62))
    spots = [
        (s, (n + 0.5) * width / count - width / 2, True) for s in (1, -1) for n in range(count)
    ]
    if ends:
        spots += [(1, 0.0, False), (-1, 0.0, False)]
    gap = 0.06
    for side, place, is_long in spots:
        away = (depth if is_long else width) / 2 + gap + chair.size_m[0] / 2
        x, y = board.point(side * away, place) if is_long else board.point(place, side * away)
        turn = (180.0 if side > 0 else 0.0) if is_long else (-90.0 if side > 0 else 90.0)
        plan.add(snap_to_voxels(Item(chair, x, y, 0.0, (board.yaw_deg + turn) % 360)))


def pendant_over(plan: Plan, board: Item, colour: Colour) -> None:
    """Place a pendant lamp above the middle of a table."""
    lamp = decor.pendant(plan.size_m[2] - 1.6, colour)
    drop = plan.size_m[2] - lamp.size_m[2]
    plan.add(snap_to_voxels(Item(lamp, board.x_m, board.y_m, drop, 0.0)), may_block=True)


def pictures_over(plan: Plan, below: Item, z_m: float, count: int = 2) -> None:
    """Place pictures on the wall behind an item."""
    for n in range(count):
        model = decor.picture(plan.rng.uniform(0.5, 0.8), plan.rng.uniform(0.4, 0.6), plan.rng)
        plan.add(plan.behind(below, model, z_m, (n - (count - 1) / 2) * 0.95))


def picture_anywhere(plan: Plan) -> None:
    """Place a picture on a wall that has space for it."""
    model = decor.picture(0.8, 0.6, plan.rng)
    plan.add_at_walls(model, along=(0.5, 0.35, 0.65), z_m=1.4)


def rug_around(item: Item, front_m: float, aside_m: float, colour: Colour) -> Rug:
    """Return a rug that extends beyond an item."""
    x0, y0, _, x1, y1, _ = item.box_m
    grow_x, grow_y = (front_m, aside_m) if round(item.yaw_deg) % 180 == 0 else (aside_m, front_m)
    return Rug(
        round_to_step(x0 - grow_x),
        round_to_step(y0 - grow_y),
        round_to_step(x1 + grow_x),
        round_to_step(y1 + grow_y),
        colour,
    )

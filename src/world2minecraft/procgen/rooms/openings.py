"""Doors and windows of a room, which are chosen before the room is furnished."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from world2minecraft.core.types import Opening
from world2minecraft.procgen.rooms.decor import curtain, door
from world2minecraft.procgen.rooms.floor_shapes import Ground
from world2minecraft.procgen.rooms.furniture_model import Colour, round_to_step
from world2minecraft.procgen.rooms.placement import Item, Plan

DOOR_M = (0.90, 2.04)
DOOR_SWING_M = 0.9
SILL_M, HEAD_M = 0.96, 2.1
RECESS_M = 0.06  # Depth of windows and door leaves in their wall, in metres.


@dataclass(frozen=True)
class Hole:
    """A wall opening from ``first_m`` to ``last_m`` along the wall with index ``wall``."""

    kind: Literal["window", "door", "doorway"]
    wall: int
    first_m: float
    last_m: float
    sill_m: float
    head_m: float

    def opening(self, ground: Ground) -> Opening:
        """Return the opening in the form of a layout."""
        wall = ground.walls[self.wall]
        start, end = (np.array(wall.point(along)) for along in (self.first_m, self.last_m))
        return Opening(self.kind, start, end, self.sill_m, self.head_m)


def choose_openings(plan: Plan, *, walls: tuple[int, ...]) -> tuple[Hole, ...]:
    """Choose a door and one or two windows, and reserve the space in front of them.

    Args:
        plan: The empty plan. Its ``reserved`` boxes are extended.
        walls: Indices of at least two walls that can have openings.
    """
    rng = plan.rng
    order = [int(wall) for wall in rng.permutation(walls)]
    side = plan.ground.walls[order[0]]
    near = rng.random() < 0.5
    first = side.first_m + round_to_step(0.2 if near else side.length_m - 0.2 - DOOR_M[0])
    holes = [Hole("door", order[0], first, first + DOOR_M[0], 0.0, DOOR_M[1])]
    for wall in order[1 : 2 + int(rng.integers(2))]:
        side = plan.ground.walls[wall]
        wide = min(round_to_step(rng.uniform(1.1, 1.6)), round_to_step(side.length_m - 0.5))
        first = side.first_m + round_to_step(side.length_m / 2 - wide / 2 + rng.uniform(-0.2, 0.2))
        holes.append(Hole("window", wall, first, first + wide, SILL_M, HEAD_M))
    for hole in holes:
        reserve_before(plan, hole)
    return tuple(holes)


def reserve_before(plan: Plan, hole: Hole) -> None:
    """Reserve the swing area of a door or the space in front of a window."""
    far = 0.2 if hole.kind == "window" else DOOR_SWING_M
    aside = 0.34 if hole.kind == "window" else 0.04
    low, high = (hole.sill_m, hole.head_m) if hole.kind == "window" else (0.0, 2.1)
    rect = plan.ground.walls[hole.wall].rect(hole.first_m - aside, hole.last_m + aside, 0.0, far)
    plan.reserved.append((*rect[:2], low, *rect[2:], high))


def hang_curtains(plan: Plan, holes: tuple[Hole, ...], colour: Colour) -> None:
    """Add curtains on both sides of each window if there is space."""
    for hole in holes:
        if hole.kind != "window":
            continue
        for long in (True, False):
            bottom = 0.06 if long else hole.sill_m - 0.1
            model = curtain(0.30, hole.head_m + 0.14 - bottom, colour)
            spots = (hole.first_m - 0.16, hole.last_m + 0.16)
            items = [plan.at_wall(model, hole.wall, along, bottom) for along in spots]
            if all(plan.fits(item, may_block=True) for item in items):
                plan.items.extend(items)
                break


def door_item(plan: Plan, hole: Hole, colour: Colour) -> Item:
    """Return the item of a door leaf in its wall."""
    model = door(hole.last_m - hole.first_m, hole.head_m, colour)
    middle = (hole.first_m + hole.last_m) / 2
    return plan.at_wall(model, hole.wall, middle, 0.0, -model.size_m[0])


def door_step_m(plan: Plan, hole: Hole) -> tuple[float, float]:
    """Return the floor position of a person who has just entered through a door."""
    item = door_item(plan, hole, (0, 0, 0))
    return item.point(0.5, 0.0)

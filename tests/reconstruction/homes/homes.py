"""A small home, cut into runs of one room each, every one in a frame of its own."""

import numpy as np

from world2minecraft.formats.roomplan import CapturedPlan, PlanObject, PlanRoom, PlanSurface
from world2minecraft.reconstruction.floorplans import layouts_of
from world2minecraft.reconstruction.floorplans.plan_grid import rasterize_plan
from world2minecraft.reconstruction.homes import Run

KITCHEN = (0.0, 0.0, 3.6, 2.8)
HALL = (3.76, 0.0, 5.2, 4.0)
BED = (0.0, 2.96, 3.6, 6.0)


def room(box, doors=(), objects=(), name=""):
    """A room of a box x0 y0 x1 y1; a door is (start, end, head) on one of its walls."""
    x0, y0, x1, y1 = box
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], float)
    pairs = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    walls = tuple(PlanSurface("wall", a, b, 0.0, 2.5) for a, b in pairs)
    openings = tuple(
        PlanSurface("door", np.array(a, float), np.array(b, float), 0.0, head)
        for a, b, head in doors
    )
    return PlanRoom(name, walls, openings, tuple(objects))


def table(x, y, yaw_deg=0.0):
    return PlanObject("table", np.array([x, y, 0.37]), np.array([0.8, 1.4, 0.74]), yaw_deg)


def run_of(name, *rooms):
    """A finished run of rooms, as their plan alone gives it."""
    plan = CapturedPlan(tuple(rooms))
    held = rasterize_plan(plan)
    return Run(name, held.grid, held.instances, held.placements, layouts_of(plan))


def kitchen():
    """A door to the hall 0.8 m wide, and one to the bedroom 1.0 m wide."""
    doors = [((3.6, 1.0), (3.6, 1.8), 2.0), ((1.2, 2.8), (2.2, 2.8), 2.2)]
    return run_of("kitchen", room(KITCHEN, doors, [table(1.2, 1.2, 90.0)]))


def hall():
    return run_of("hall", room(HALL, [((3.76, 1.0), (3.76, 1.8), 2.0)]))


def bedroom():
    doors = [((1.2, 2.96), (2.2, 2.96), 2.2)]
    return run_of("bed", room(BED, doors, [table(2.6, 4.8)]))

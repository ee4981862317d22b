"""Stairs of a house: the flight, the hole in the slab above it, and the rail around the hole."""

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.houses.house_plan import STAIR_M, Flight, HousePlan
from world2minecraft.procgen.rooms.furniture_model import Colour, Model, Part, shade, whole
from world2minecraft.procgen.rooms.ground import Box
from world2minecraft.procgen.rooms.place import Item

OBJS = int(SemanticClass.OBJS)
STEP_THICK_M = 0.26  # From a step's top down to the underside of the flight.
HEADROOM_M = 2.0  # Building codes ask for 1.9 to 2.1 m over the line of walk.
RAIL_M, RAIL_THICK_M, POST_GAP_M = 0.9, 0.04, 0.12  # Codes: 0.9 m high, under 12 cm between.


def stairs(flight: Flight, wood: Colour) -> Model:
    """A flight whose front, +x, is where one begins to climb; its last riser is the slab's edge."""
    treads = flight.risers - 1
    d, w, h = (whole(v) for v in (treads * flight.tread_m, STAIR_M, treads * flight.rise_m))
    parts = []
    for n in range(treads):
        top, near = flight.rise_m * (n + 1), d / 2 - n * flight.tread_m
        far, low = near - flight.tread_m, max(0.0, top - STEP_THICK_M)
        parts.append(Part((far, -w / 2, low, near, w / 2, top - 0.04), shade(wood, 0.8), "wood"))
        parts.append(Part((far, -w / 2, top - 0.04, near, w / 2, top), wood, "wood"))
    return Model("stairs", OBJS, (d, w, h), tuple(parts))


def railing(length_m: float, wood: Colour) -> Model:
    """A rail on posts along its left-right axis."""
    d, w, h = RAIL_THICK_M, whole(length_m), RAIL_M
    count = max(2, round(w / (POST_GAP_M + RAIL_THICK_M)) + 1)
    parts = [Part((-d / 2, -w / 2, h - 0.06, d / 2, w / 2, h), wood, "wood")]
    for n in range(count):
        y = -w / 2 + whole((w - RAIL_THICK_M) * n / (count - 1))
        parts.append(Part((-d / 2, y, 0.0, d / 2, y + RAIL_THICK_M, h - 0.06), (236, 234, 228)))
    return Model("railing", OBJS, (d, w, h), tuple(parts))


def stairwell(plan: HousePlan, flight: Flight) -> Box:
    """Return the hole in the slab over the flight, x0 y0 z0 x1 y1 z1."""
    x0, y0, x1, y1 = flight.rect
    # The first step over which the ceiling would be too low, and one before it.
    first = max(0, int((plan.height_m - HEADROOM_M) / flight.rise_m) - 1)
    start = whole(y0 + first * flight.tread_m)
    return x0, start, plan.height_m, x1, y1, plan.pitch_m


def stair_items(plan: HousePlan, flight: Flight, wood: Colour) -> tuple[list[Item], list[Item]]:
    """Return what belongs to the stairs on the ground storey and on the upper one."""
    x0, y0, x1, y1 = flight.rect
    steps = Item(stairs(flight, wood), (x0 + x1) / 2, (y0 + y1) / 2, 0.0, 270.0)
    _, start, _, _, end, level = stairwell(plan, flight)
    half = RAIL_THICK_M / 2
    along = Item(railing(end - start, wood), x1 + half, (start + end) / 2, level, 0.0)
    across = railing(x1 + RAIL_THICK_M - x0, wood)
    ahead = Item(across, (x0 + x1) / 2 + half, start - half, level, 270.0)
    return [steps], [along, ahead]

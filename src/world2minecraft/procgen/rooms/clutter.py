"""Clutter for furnished rooms: displaced chairs, loose objects and objects with irregular shapes.

Clutter objects do not collide with other items, and the room remains reachable from every door.
"""

import numpy as np

from world2minecraft.procgen.rooms.clutter_models import (
    IRREGULAR,
    ON_BEDS,
    ON_FLOORS,
    ON_TABLES,
    ModelFactory,
)
from world2minecraft.procgen.rooms.furniture_model import Model
from world2minecraft.procgen.rooms.placement import Item, Plan, paths_are_clear

Doors = list[tuple[float, float]]
WIDE_BODY_M, NARROW_BODY_M = 0.32, 0.24  # Half a person's width, with and without ease.
MAX_ASKEW_DEG = 20
PULLED_M = 0.30  # How far a chair is left from its table at most.
SEATS = ("chair", "office_chair", "stool", "armchair")
TABLE_THINGS_PER_M2 = 5.0
FLOOR_THINGS_PER_M2 = 0.7
ODD_THINGS = 3
TRIES = 12
# What objects stand on: the height of its top in metres where that is not the model's own.
BED_TOPS = {"bed": 0.56, "sofa": 0.46}
TOPS: dict[str, float | None] = {
    **dict.fromkeys(
        (
            "coffee_table", "kitchen_table", "dining_table", "meeting_table", "play_table", "desk",
            "dresser", "sideboard", "nightstand", "tv_board", "toy_shelf", "bookshelf",
            "shoe_cabinet", "filing_cabinet", "bench",
        )
    ),
    "counter": 0.90,
}  # fmt: skip


def scatter(plan: Plan, clutter: float, rng: np.random.Generator, doors_m: Doors) -> None:
    """Add clutter to a furnished room.

    Args:
        plan: The room. Its items are modified.
        clutter: Amount of clutter, from 0 (none) to 1.
        rng: Random generator.
        doors_m: Position on the floor behind each door.
    """
    if clutter <= 0:
        return
    wide = paths_are_clear(plan, *doors_m, body_m=WIDE_BODY_M)
    body_m = WIDE_BODY_M if wide else NARROW_BODY_M
    _turn_seats(plan, clutter, rng, doors_m, body_m)
    for _ in range(round(clutter * ODD_THINGS * rng.uniform(0.6, 1.2))):
        _lay(plan, IRREGULAR, rng, doors_m, body_m)
    for base in list(plan.items):
        _cover(plan, base, clutter, rng)
    area = plan.size_m[0] * plan.size_m[1]
    for _ in range(round(clutter * area * FLOOR_THINGS_PER_M2)):
        _lay(plan, ON_FLOORS, rng, doors_m, body_m)


def _turn_seats(
    plan: Plan, clutter: float, rng: np.random.Generator, doors_m: Doors, body_m: float
) -> None:
    """Pull chairs out and rotate them, if there is space."""
    for n, seat in enumerate(plan.items):
        if seat.model.name not in SEATS or rng.random() > 0.3 + 0.7 * clutter:
            continue
        for _ in range(TRIES):
            turn = float(rng.integers(-MAX_ASKEW_DEG, MAX_ASKEW_DEG + 1))
            x, y = seat.point(-float(rng.uniform(0.02, PULLED_M * clutter + 0.04)), 0.0)
            moved = Item(seat.model, x, y, seat.z_m, (seat.yaw_deg + turn) % 360)
            others = [*plan.items[:n], *plan.items[n + 1 :]]
            if not plan.fits(moved, may_block=True, among=others):
                continue
            plan.items[n] = moved
            if paths_are_clear(plan, *doors_m, body_m=body_m):
                break
            plan.items[n] = seat


def _lay(
    plan: Plan,
    makers: tuple[ModelFactory, ...],
    rng: np.random.Generator,
    doors_m: Doors,
    body_m: float,
) -> None:
    """Place an object on the floor, half of the time at a wall, without blocking paths."""
    model = makers[int(rng.integers(len(makers)))](rng)
    for _ in range(TRIES):
        if plan.add(_floor_spot(plan, model, rng)) is None:
            continue
        if paths_are_clear(plan, *doors_m, body_m=body_m):
            return
        plan.items.pop()


def _floor_spot(plan: Plan, model: Model, rng: np.random.Generator) -> Item:
    if rng.random() < 0.5:
        wall = int(rng.integers(4))
        side = plan.ground.walls[wall]
        return plan.at_wall(
            model, wall, side.first_m + side.length_m * float(rng.random()), 0.0, 0.04
        )
    x, y = (float(rng.uniform(0.2, side - 0.2)) for side in plan.size_m[:2])
    return Item(model, x, y, 0.0, float(rng.integers(360)))


def _cover(plan: Plan, base: Item, clutter: float, rng: np.random.Generator) -> None:
    """Place objects on a table, a chest or a bed."""
    name = base.model.name
    if name in BED_TOPS:
        makers, top, count = ON_BEDS, BED_TOPS[name], rng.binomial(2, clutter)
    elif name in TOPS:
        depth, width, high = base.model.size_m
        own = TOPS[name]
        makers, top = ON_TABLES, high if own is None else own
        count = round(clutter * depth * width * TABLE_THINGS_PER_M2 * rng.uniform(0.4, 1.4))
    else:
        return
    for _ in range(int(count)):
        _put_upon(plan, base, makers, top, rng)


def _put_upon(
    plan: Plan, base: Item, makers: tuple[ModelFactory, ...], top_m: float, rng: np.random.Generator
) -> None:
    model = makers[int(rng.integers(len(makers)))](rng)
    depth, width, _ = base.model.size_m
    reach = float(np.hypot(*model.size_m[:2])) / 2
    if 2 * reach > min(depth, width) + 0.04 or base.z_m + top_m + model.size_m[2] > plan.size_m[2]:
        return
    others = [item for item in plan.items if item is not base]
    for _ in range(TRIES):
        front = float(rng.uniform(-1, 1)) * max(0.0, depth / 2 - reach)
        left = float(rng.uniform(-1, 1)) * max(0.0, width / 2 - reach)
        x, y = base.point(front, left)
        turn = float(rng.integers(-MAX_ASKEW_DEG, MAX_ASKEW_DEG + 1))
        item = Item(model, x, y, base.z_m + top_m, (base.yaw_deg + turn) % 360)
        if plan.fits(item, may_block=True, among=others):
            plan.items.append(item)
            return

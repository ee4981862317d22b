"""Disorder in fully furnished rooms: furniture askew, and objects that partly hide each other.

Chairs are pushed under tables, curtains drawn over windows, boxes and baskets left in front of
cabinets, and rugs and furniture turned. The room remains reachable from every door.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.procgen.rooms.clutter import Doors
from world2minecraft.procgen.rooms.clutter_models import bag, carton, laundry
from world2minecraft.procgen.rooms.decor import curtain
from world2minecraft.procgen.rooms.floor_shapes import Box
from world2minecraft.procgen.rooms.furniture_model import Bar, Part, round_to_step
from world2minecraft.procgen.rooms.household_models import laundry_basket
from world2minecraft.procgen.rooms.openings import Hole
from world2minecraft.procgen.rooms.placement import (
    Item,
    Plan,
    Rug,
    boxes_intersect,
    items_intersect,
    paths_are_clear,
    snap_to_voxels,
)

MAX_RUG_DEG, MAX_TURN_DEG = 14, 9
PUSHED_M = (0.30, 0.24, 0.18, 0.12)  # How far a chair is pushed under its table.
MAX_DRAWN = 0.5  # Share of a window that one curtain covers at most.
FRONT_GAPS_M = (0.02, 0.06, 0.12)
CHAIRS = frozenset(("chair", "stool"))
LOOSE = frozenset(
    (
        "sofa", "coffee_table", "side_table", "ottoman", "bench", "blanket_chest", "plant", "bin",
        "floor_lamp", "laundry_basket", "drying_rack", "ironing_board", "play_table", "toy_shelf",
        "nightstand", "shoe_rack", "box", "mirror",
    )
)  # fmt: skip
HIDDEN = frozenset(
    (
        "wardrobe", "bookshelf", "dresser", "sideboard", "cupboard", "filing_cabinet", "tv_board",
        "display_cabinet", "bath_cabinet", "shelf", "shoe_cabinet", "toy_shelf", "counter",
        "washing_machine", "dryer",
    )
)  # fmt: skip


def disarrange(
    plan: Plan,
    holes: tuple[Hole, ...],
    clutter: float,
    rng: np.random.Generator,
    doors_m: Doors,
    body_m: float,
) -> None:
    """Turn furniture, push chairs under tables, draw curtains and leave boxes before cabinets.

    Args:
        plan: The furnished room. Its items are modified.
        holes: The doors and windows of the room.
        clutter: Amount of disorder, from 0 (none) to 1.
        rng: Random generator.
        doors_m: Position on the floor behind each door.
        body_m: Half the width of a person who must reach the free floor.
    """
    for hole in holes:
        if hole.kind == "window" and rng.random() < clutter:
            _draw_curtain(plan, hole, rng)
    for chair in [item for item in plan.items if item.model.name in CHAIRS]:
        if rng.random() < 0.5 * clutter:
            _push_under(plan, chair)
    for base in [item for item in plan.items if item.model.name in LOOSE]:
        if rng.random() < clutter and base.z_m < 0.01:
            _turn(plan, base, rng, doors_m, body_m)
    for cabinet in [item for item in plan.items if item.model.name in HIDDEN]:
        if rng.random() < 0.5 * clutter:
            _leave_before(plan, cabinet, rng, doors_m, body_m)


def turn_rugs(rugs: tuple[Rug, ...], clutter: float, rng: np.random.Generator) -> tuple[Rug, ...]:
    """Return rugs that are no longer parallel to the walls, in tidy rooms the same rugs."""
    if clutter <= 0:
        return rugs
    most = MAX_RUG_DEG * clutter
    return tuple(rug._replace(turn_deg=float(rng.uniform(-most, most))) for rug in rugs)


def _draw_curtain(plan: Plan, hole: Hole, rng: np.random.Generator) -> None:
    """Draw one curtain of a window over a part of it, above the sill if furniture is before it."""
    side = plan.ground.walls[hole.wall]
    ends = [side.point(hole.first_m - 0.16, 0.05), side.point(hole.last_m + 0.16, 0.05)]
    hung = [
        item
        for item in plan.items
        if item.model.name == "curtain"
        and min(np.hypot(item.x_m - x, item.y_m - y) for x, y in ends) < 0.06
    ]
    if not hung:
        return
    drawn = hung[int(rng.integers(len(hung)))]
    more = round_to_step(float(rng.uniform(0.2, MAX_DRAWN)) * (hole.last_m - hole.first_m))
    others = [item for item in plan.items if item not in hung]
    for bottom in (drawn.z_m, hole.sill_m - 0.1):
        items = [_rehung(plan, hole, item, more if item is drawn else 0.0, bottom) for item in hung]
        if all(plan.fits(item, may_block=True, among=others) for item in items):
            plan.items[:] = others + items
            return


def _rehung(plan: Plan, hole: Hole, old: Item, more_m: float, bottom_m: float) -> Item:
    """Return a curtain that is wider towards the middle of its window, from another height."""
    along = old.y_m if plan.ground.walls[hole.wall].turn % 2 == 0 else old.x_m
    inward = 1 if along < (hole.first_m + hole.last_m) / 2 else -1
    top = old.z_m + old.size_m[2]
    model = curtain(old.size_m[1] + more_m, top - bottom_m, old.model.parts[0].colour)
    return plan.at_wall(model, hole.wall, along + inward * more_m / 2, bottom_m)


def _push_under(plan: Plan, chair: Item) -> None:
    """Push a chair forward until it would touch something, such as under its table."""
    n = plan.items.index(chair)
    others = [*plan.items[:n], *plan.items[n + 1 :]]
    for ahead in PUSHED_M:
        x, y = chair.point(ahead, 0.0)
        moved = snap_to_voxels(Item(chair.model, x, y, chair.z_m, chair.yaw_deg))
        near = [other for other in others if items_intersect(moved, other)]
        if near and not any(parts_intersect(moved, other) for other in near):
            plan.items[n] = moved
            return


def parts_intersect(a: Item, b: Item) -> bool:
    """Return whether parts of two items overlap, as their axis-aligned boxes."""
    second = [_part_box(b, part) for part in b.model.parts]
    return any(
        boxes_intersect(_part_box(a, part), other) for part in a.model.parts for other in second
    )


def _part_box(item: Item, part: Part | Bar) -> Box:
    x0, y0, z0, x1, y1, z1 = part.box_m
    corners = [item.point(x, y) for x in (x0, x1) for y in (y0, y1)]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    return min(xs), min(ys), item.z_m + z0, max(xs), max(ys), item.z_m + z1


def _turn(plan: Plan, base: Item, rng: np.random.Generator, doors_m: Doors, body_m: float) -> None:
    """Turn furniture by a few degrees with what stands on it, if there is space."""
    riders = [item for item in plan.items if item is not base and _stands_on(item, base)]
    others = [item for item in plan.items if item is not base and item not in riders]
    for _ in range(4):
        turn = float(rng.integers(2, MAX_TURN_DEG + 1)) * (1 if rng.random() < 0.5 else -1)
        angle = abs(np.radians(turn))
        d, w, _ = base.size_m
        gap = (d * np.cos(angle) + w * np.sin(angle) - d) / 2 + 0.02
        x, y = base.point(gap, 0.0)
        moved = [Item(base.model, x, y, base.z_m, (base.yaw_deg + turn) % 360)]
        for item in riders:
            moved.append(_carried(item, base, moved[0], turn))
        if not all(plan.fits(item, may_block=True, among=others) for item in moved):
            continue
        before = list(plan.items)
        new = dict(zip([id(base), *map(id, riders)], moved, strict=True))
        plan.items[:] = [new.get(id(item), item) for item in plan.items]
        if paths_are_clear(plan, *doors_m, body_m=body_m):
            return
        plan.items[:] = before


def _stands_on(item: Item, base: Item) -> bool:
    x0, y0, z0, x1, y1, z1 = base.box_m
    return x0 < item.x_m < x1 and y0 < item.y_m < y1 and z0 + 0.2 < item.z_m < z1 + 0.01


def _carried(item: Item, base: Item, moved: Item, turn_deg: float) -> Item:
    """Return an item that stands on ``base`` after ``base`` was moved and turned."""
    angle = -np.radians(base.yaw_deg)
    x, y = item.x_m - base.x_m, item.y_m - base.y_m
    front = x * np.cos(angle) - y * np.sin(angle)
    left = x * np.sin(angle) + y * np.cos(angle)
    at = moved.point(float(front), float(left))
    return replace(item, x_m=at[0], y_m=at[1], yaw_deg=(item.yaw_deg + turn_deg) % 360)


def _leave_before(
    plan: Plan, cabinet: Item, rng: np.random.Generator, doors_m: Doors, body_m: float
) -> None:
    """Leave a box, a bag or a basket on the floor right in front of a cabinet."""
    makers = (carton, carton, bag, laundry_basket, laundry)
    model = makers[int(rng.integers(len(makers)))](rng)
    half = max(0.0, (cabinet.size_m[1] - model.size_m[1]) / 2)
    for gap in FRONT_GAPS_M:
        away = cabinet.size_m[0] / 2 + gap + float(np.hypot(*model.size_m[:2])) / 2
        x, y = cabinet.point(away, float(rng.uniform(-half, half)))
        yaw = (cabinet.yaw_deg + float(rng.integers(-25, 26))) % 360
        item = plan.add(Item(model, x, y, 0.0, yaw), may_block=True)
        if item is None:
            continue
        if paths_are_clear(plan, *doors_m, body_m=body_m):
            return
        plan.items.remove(item)

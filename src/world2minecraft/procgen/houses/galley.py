"""The kitchen of a house: one run of counters along whichever wall the doors leave free."""

from world2minecraft.procgen.rooms import decor, seating, storage
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style
from world2minecraft.procgen.rooms.furniture_model import Model
from world2minecraft.procgen.rooms.place import Item, Plan, overlap, snapped
from world2minecraft.procgen.rooms.relations import (
    Rug,
    chairs_around,
    pendant_over,
    picture_anywhere,
)

LOW_M = 0.5  # What is kept free from below this height is a way; above it, a window's air.
WIDTHS_M = ((1.0, 1.6), (0.8, 1.2), (0.6, 0.8))  # Of the counters beside and under the sink.
TABLE_TRIES = 24


def furnish_galley(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """A fridge, a counter, a cooker under its hood and a sink in one row, and a table."""
    walls = [int(wall) for wall in plan.rng.permutation(4)]
    placed = None
    for wall in sorted(walls, key=lambda n: -plan.ground.walls[n].length_m):
        for counters in WIDTHS_M:
            for backwards in (False, True):
                placed = placed or _run(plan, style, wall, counters, backwards)
    if placed is None:
        return None
    _, corner, cooker, sink = placed
    _hang(plan, style, corner, cooker, sink)
    plan.add_upon(decor.microwave(), corner, -0.1, 0.0, top_m=0.9)
    for item in placed:
        plan.reserved.append(plan.front_box(item, 0.8))
    _table(plan, style)
    plan.add_at_walls(decor.crate((0.3, 0.4, 0.3), (190, 150, 104)))
    plan.add_in_corner(decor.plant(plan.rng.uniform(0.8, 1.1), plan.rng))
    picture_anywhere(plan)
    return ()


def _run(
    plan: Plan, style: Style, wall: int, counters: tuple[float, float], backwards: bool
) -> list[Item] | None:
    """Place the row along a wall from its start, or from its end, if all of it stands free."""
    cool = storage.fridge(WHITE if style.front != WHITE else (190, 192, 196))
    models: list[Model] = [
        cool,
        storage.counter(counters[0], style.front, style.worktop),
        storage.oven(style.front, style.worktop),
        storage.counter(counters[1], style.front, style.worktop, sink=True),
    ]
    side = plan.ground.walls[wall]
    at, items = (side.last_m if backwards else side.first_m), []
    for model in models:
        half = model.size_m[1] / 2 * (-1 if backwards else 1)
        items.append(plan.at_wall(model, wall, at + half))
        at += 2 * half
    if not all(_stands(plan, item) for item in items):
        return None
    plan.items += items
    return items


def _stands(plan: Plan, item: Item) -> bool:
    """Tell whether a piece fits; a sink may stand under a window, a fridge not before one."""
    box = item.box_m
    tall = item.model.name == "fridge"
    kept = [other for other in plan.reserved if tall or other[2] < LOW_M]
    return plan.fits(item, may_block=True) and not any(overlap(box, other) for other in kept)


def _hang(plan: Plan, style: Style, corner: Item, cooker: Item, sink: Item) -> None:
    """Hang the hood and the cupboards where no window is."""
    hung = [(decor.hood(), cooker, 1.56)]
    for base in (corner, sink):
        hung.append((storage.wall_cabinet(base.model.size_m[1], style.front), base, 1.44))
    for model, base, z_m in hung:
        back = (model.size_m[0] - base.model.size_m[0]) / 2
        plan.add(snapped(Item(model, *base.point(back, 0.0), z_m, base.yaw_deg)))


def _table(plan: Plan, style: Style) -> None:
    """Put a table with chairs where the room has space, if it has."""
    rng = plan.rng
    model = seating.table("kitchen_table", 0.8, float(rng.choice([0.9, 1.2])), 0.74, style.wood)
    for _ in range(TABLE_TRIES):
        x, y = (side * rng.uniform(0.25, 0.75) for side in plan.size_m[:2])
        item = snapped(Item(model, x, y, 0.0, 90.0 * int(rng.integers(2))))
        chair = seating.chair(style.wood, style.cloth)
        before = len(plan.items)
        board = plan.add(item)
        if board is None:
            continue
        chairs_around(plan, board, chair, ends=False)
        if len(plan.items) - before >= 3:  # A table with two chairs at least.
            plan.add_upon(decor.bowl(), board, 0.0, 0.0)
            pendant_over(plan, board, (60, 64, 66))
            return
        del plan.items[before:]

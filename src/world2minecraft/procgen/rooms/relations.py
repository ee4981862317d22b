"""What stands in relation to what: chairs around a table, a lamp over it, pictures over a chest."""

from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms.furniture_model import Colour, Model, whole
from world2minecraft.procgen.rooms.place import Item, Plan, snapped

Rug = tuple[float, float, float, float, Colour]  # x0 y0 x1 y1 and its colour


def chairs_around(plan: Plan, board: Item, chair: Model, *, ends: bool) -> None:
    """Put chairs at the long sides of a table, and at its ends, all facing it."""
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
        plan.add(snapped(Item(chair, x, y, 0.0, (board.yaw_deg + turn) % 360)))


def pendant_over(plan: Plan, board: Item, colour: Colour) -> None:
    """Hang a lamp over the middle of a table."""
    lamp = decor.pendant(plan.size_m[2] - 1.6, colour)
    drop = plan.size_m[2] - lamp.size_m[2]
    plan.add(snapped(Item(lamp, board.x_m, board.y_m, drop, 0.0)), may_block=True)


def pictures_over(plan: Plan, below: Item, z_m: float, count: int = 2) -> None:
    """Hang pictures on the wall behind an item."""
    wall = round(below.yaw_deg / 90) % 4
    along = below.y_m if wall % 2 == 0 else below.x_m
    for n in range(count):
        model = decor.picture(plan.rng.uniform(0.5, 0.8), plan.rng.uniform(0.4, 0.6), plan.rng)
        shift = (n - (count - 1) / 2) * 0.95
        plan.add(plan.at_wall(model, wall, along + shift, z_m))


def picture_anywhere(plan: Plan) -> None:
    """Hang a picture on a wall that has room for it."""
    model = decor.picture(0.8, 0.6, plan.rng)
    plan.add_at_walls(model, along=(0.5, 0.35, 0.65), z_m=1.4)


def rug_around(item: Item, front_m: float, aside_m: float, colour: Colour) -> Rug:
    """Return a rug that reaches out from under an item."""
    x0, y0, _, x1, y1, _ = item.box_m
    grow_x, grow_y = (front_m, aside_m) if round(item.yaw_deg) % 180 == 0 else (aside_m, front_m)
    return (whole(x0 - grow_x), whole(y0 - grow_y), whole(x1 + grow_x), whole(y1 + grow_y), colour)

"""The recipes of a bathroom, a hall, an office and a children's room; as in ``daily_rooms``."""

from world2minecraft.procgen.rooms import bathroom as washing
from world2minecraft.procgen.rooms import decor, seating, storage
from world2minecraft.procgen.rooms import play_and_hall as playing
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style
from world2minecraft.procgen.rooms.furniture_model import Model
from world2minecraft.procgen.rooms.placement import (
    Item,
    Plan,
    Rug,
    chairs_around,
    pictures_over,
    rug_around,
    snapped,
)


def shuffled_walls(plan: Plan) -> tuple[int, ...]:
    """Return the four main walls in a random order."""
    return tuple(int(wall) for wall in plan.rng.permutation(4))


def furnish_bathroom(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """A tub or a shower, a washstand under its mirror, a toilet; a washing machine if it fits."""
    rng = plan.rng
    walls = shuffled_walls(plan)
    tub = washing.bathtub(1.7) if rng.random() < 0.6 else washing.shower()
    bath = plan.add_at_walls(tub, walls, along=(0.0, 1.0), clear_m=0.3)
    basin = plan.add_at_walls(
        washing.washstand(style.front), walls[1:] + walls[:1], along=(0.5, 0.3, 0.7), clear_m=0.6
    )
    seat = plan.add_at_walls(
        washing.toilet(), walls[2:] + walls[:2], along=(0.2, 0.8, 0.5), clear_m=0.5
    )
    if bath is None or basin is None or seat is None:
        return None
    glass = washing.mirror(0.7)
    plan.add(_behind(plan, basin, glass, 1.14))
    plan.add_at_walls(washing.washing_machine(), walls, along=(0.0, 1.0), clear_m=0.5)
    tall = storage.cabinet("bath_cabinet", (0.34, 0.4, 1.7), 1, 2, WHITE, WHITE)
    plan.add_at_walls(tall, walls, along=(0.0, 1.0), clear_m=0.4)
    plan.add_at_walls(washing.towel(style.cloth), walls, z_m=0.8)
    plan.add_in_corner(decor.waste_bin((200, 202, 204)))
    return (rug_around(basin, 0.5, 0.0, style.second_cloth),)


def _behind(plan: Plan, item: Item, model: Model, z_m: float) -> Item:
    """Return a model on the wall behind an item."""
    wall = round(item.yaw_deg / 90) % 4
    return plan.at_wall(model, wall, item.y_m if wall % 2 == 0 else item.x_m, z_m)


def furnish_hall(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Coats over a bench, a flat cupboard for shoes under a mirror, an umbrella stand."""
    rng = plan.rng
    walls = tuple(int(wall) for wall in rng.permutation(len(plan.ground.walls)))
    shoes = plan.add_at_walls(playing.shoe_cabinet(WHITE), walls)
    if shoes is not None:
        side = min((n for n in range(len(plan.ground.walls))), key=lambda n: _gap_m(plan, shoes, n))
        along = shoes.y_m if plan.ground.walls[side].turn % 2 == 0 else shoes.x_m
        plan.add(plan.at_wall(washing.mirror(0.6), side, along, 1.24))
        plan.add_upon(decor.vase(style.second_cloth), shoes, 0.0, 0.2)
    hung = plan.add_at_walls(playing.coats(rng, style.wood), walls, z_m=0.94)
    if hung is not None:
        ahead = hung.point(0.08, 0.0)
        plan.add(snapped(Item(playing.bench(style.wood), *ahead, 0.0, hung.yaw_deg)))
    plan.add_at_walls(decor.picture(0.5, 0.6, rng), walls, z_m=1.4)
    plan.add_in_corner(decor.waste_bin((70, 78, 92)))
    middle = plan.ground.walls[1].point(plan.size_m[0] / 2, plan.size_m[1] / 2)
    if plan.ground.blocks:
        return ()
    return ((middle[0] - 0.8, middle[1] - 0.4, middle[0] + 0.8, middle[1] + 0.4, style.cloth),)


def _gap_m(plan: Plan, item: Item, wall: int) -> float:
    """Return how far an item's back is from a wall that it could stand at."""
    side = plan.ground.walls[wall]
    if side.turn != round(item.yaw_deg / 90) % 4:
        return 1e9
    x, y = item.point(-item.model.size_m[0] / 2, 0.0)
    off = abs((x if side.turn % 2 == 0 else y) - side.at_m)
    along = y if side.turn % 2 == 0 else x
    return off if side.first_m <= along <= side.last_m else 1e9


def furnish_office(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Two desks with their chairs, a small table to talk at, files, a whiteboard."""
    rng = plan.rng
    walls = shuffled_walls(plan)
    places = []
    for wall in walls:
        if len(places) < 2:
            place = _work_place(plan, style, wall)
            places += [place] if place else []
    if not places:
        return None
    files = storage.cabinet("filing_cabinet", (0.46, 0.84, 1.2), 2, 3, (190, 194, 198), WHITE)
    chest = plan.add_at_walls(files, walls[::-1], along=(0.0, 1.0, 0.5), clear_m=0.5)
    if chest is not None:
        plan.add_upon(playing.printer(), chest, 0.0, 0.1)
    table = seating.table("meeting_table", 0.9, 1.2, 0.74, WHITE)
    middle = (plan.size_m[0] * rng.uniform(0.4, 0.6), plan.size_m[1] * rng.uniform(0.4, 0.6))
    board = plan.add(snapped(Item(table, *middle, 0.0, 90.0 * int(rng.integers(2)))))
    if board is not None:
        chairs_around(plan, board, seating.chair(style.dark_wood, style.cloth), ends=False)
    plan.add_at_walls(playing.whiteboard(), walls, along=(0.5, 0.3, 0.7), z_m=0.94)
    shelf = storage.bookshelf(0.9, 1.9, style.wood, rng)
    plan.add_at_walls(shelf, walls[::-1], along=(0.0, 1.0), clear_m=0.4)
    plan.add_in_corner(decor.plant(rng.uniform(1.0, 1.4), rng))
    plan.add_in_corner(decor.waste_bin((90, 96, 104)), near=places[0])
    return ()


def _work_place(plan: Plan, style: Style, wall: int) -> Item | None:
    """Place a desk at a wall with its chair, screen and keyboard."""
    model = seating.desk(plan.rng.uniform(1.4, 1.6), style.wood, WHITE)
    desk = plan.add_at_walls(model, (wall,), along=(0.5, 0.3, 0.7), clear_m=0.9)
    if desk is None:
        return None
    plan.add_before(seating.office_chair((52, 56, 66)), desk, 0.06)
    plan.add_upon(decor.monitor(), desk, -0.16, 0.0)
    plan.add_upon(decor.keyboard(), desk, 0.12, 0.0)
    plan.add_upon(decor.book_pile(plan.rng), desk, 0.0, -model.size_m[1] / 2 + 0.2)
    return desk


def furnish_children(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """A small bed in a corner, a desk, a low shelf of toys, a little table with stools."""
    rng = plan.rng
    walls = shuffled_walls(plan)
    bed = plan.add_at_walls(
        seating.bed(0.9, style.wood, playing.bright(rng)), walls, along=(0.0, 1.0), clear_m=0.3
    )
    if bed is None:
        return None
    wardrobe = storage.cabinet("wardrobe", (0.58, 1.0, 1.9), 2, 1, WHITE, style.wood)
    plan.add_at_walls(wardrobe, walls[::-1], along=(0.0, 1.0), clear_m=0.5)
    desk = plan.add_at_walls(
        seating.desk(1.1, style.wood, WHITE), walls[1:], along=(0.5, 0.3, 0.7), clear_m=0.7
    )
    if desk is not None:
        plan.add_before(seating.chair(style.wood, playing.bright(rng)), desk, 0.06)
        plan.add_upon(decor.table_lamp(style.dark_wood), desk, -0.16, 0.36)
        plan.add_upon(decor.book_pile(rng), desk, 0.0, -0.3)
    plan.add_at_walls(playing.toy_shelf(style.wood, rng), walls, along=(0.5,), clear_m=0.4)
    table = seating.table("play_table", 0.5, 0.6, 0.46, style.wood)
    middle = (plan.size_m[0] * rng.uniform(0.4, 0.6), plan.size_m[1] * rng.uniform(0.4, 0.6))
    low = plan.add(snapped(Item(table, *middle, 0.0, 0.0)))
    if low is not None:
        chairs_around(plan, low, playing.stool(playing.bright(rng)), ends=False)
    pictures_over(plan, bed, 1.3, count=1)
    x, y = plan.size_m[0] / 2, plan.size_m[1] / 2
    return ((x - 0.9, y - 0.7, x + 0.9, y + 0.7, style.second_cloth),)

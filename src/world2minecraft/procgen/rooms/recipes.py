"""Kinds of rooms, with their sizes, floors and furnishing recipes.

A recipe furnishes a ``Plan`` by relations between items, such as a sofa against a wall and a
television opposite it. It returns the rugs, or None if the room has no space for its main
furniture.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.procgen.rooms import bathroom_fittings as washing
from world2minecraft.procgen.rooms import children_and_hall_furniture as playing
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms import household_models as household
from world2minecraft.procgen.rooms import seats_beds_tables as seating
from world2minecraft.procgen.rooms import storage_furniture as storage
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style
from world2minecraft.procgen.rooms.furniture_model import Model, round_to_step
from world2minecraft.procgen.rooms.placement import (
    Item,
    Plan,
    Rug,
    chairs_around,
    pendant_over,
    picture_anywhere,
    pictures_over,
    rug_around,
    snap_to_voxels,
)

BASE_KINDS = ("bed", "dining", "kitchen", "living", "study")


def furnish_living(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a living room with a sofa, a television opposite and a low table on a rug.

    Returns None if the main furniture does not fit.
    """
    rng = plan.rng
    long_walls = (1, 3) if plan.size_m[0] >= plan.size_m[1] else (0, 2)
    walls = tuple(int(wall) for wall in rng.permutation(long_walls))
    couch_model = seating.sofa(rng.uniform(1.8, 2.2), style.cloth, style.second_cloth, style.wood)
    couch = plan.add_at_walls(couch_model, walls, along=(0.5, 0.42, 0.58))
    if couch is None:
        return None
    wall = round(couch.yaw_deg / 90) % 4
    along = couch.y_m if wall % 2 == 0 else couch.x_m
    board_model = storage.cabinet("tv_board", (0.42, 1.6, 0.48), 3, 1, WHITE, style.wood)
    across = plan.ground.walls[(wall + 2) % 4]
    share = (along - across.first_m) / across.length_m
    board = plan.add_at_walls(board_model, ((wall + 2) % 4,), along=(share,), clear_m=0.5)
    if board is None:
        return None
    plan.add_upon(decor.tv(rng.uniform(1.1, 1.3)), board, 0.0, 0.0)
    plan.add_upon(decor.book_pile(rng), board, 0.04, -0.68)
    low = plan.add_before(seating.table("coffee_table", 0.6, 1.1, 0.42, style.wood), couch, 0.38)
    if low is None:
        return None
    plan.add_upon(decor.book_pile(rng), low, 0.06, 0.3)
    plan.add_upon(decor.vase(style.second_cloth), low, -0.08, -0.24)
    easy = seating.armchair(style.second_cloth, style.wood)
    _beside_low_table(plan, low, easy)
    plan.add_in_corner(decor.floor_lamp((250, 232, 190)), near=couch)
    plan.add_at_walls(
        storage.bookshelf(rng.uniform(0.8, 1.1), 1.9, style.wood, rng),
        clear_m=0.4,
        along=(0.1, 0.9),
    )
    plan.add_in_corner(decor.plant(rng.uniform(1.1, 1.5), rng))
    pictures_over(plan, couch, 1.3)
    return (rug_around(low, 0.5, 0.55, style.second_cloth),)


def _beside_low_table(plan: Plan, low: Item, easy: Model) -> None:
    for side in (1, -1) if plan.rng.random() < 0.5 else (-1, 1):
        away = low.model.size_m[1] / 2 + 0.34 + easy.size_m[0] / 2
        x, y = low.point(0.12, side * away)
        if plan.add(snap_to_voxels(Item(easy, x, y, 0.0, (low.yaw_deg - side * 90) % 360))):
            return


def furnish_bed(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a bedroom with a bed between two nightstands, a wardrobe and a dresser.

    Returns None if the bed does not fit.
    """
    rng = plan.rng
    width = float(rng.choice([1.4, 1.6, 1.8]))
    walls = shuffled_walls(plan)
    bed = plan.add_at_walls(
        seating.bed(width, style.wood, style.cloth), walls, along=(0.5, 0.45, 0.55), clear_m=0.5
    )
    if bed is None:
        return None
    stand = storage.cabinet("nightstand", (0.42, 0.44, 0.52), 1, 2, style.wood, style.wood)
    back = -(bed.model.size_m[0] - stand.size_m[0]) / 2
    for side in (1, -1):
        aside = side * (width / 2 + stand.size_m[1] / 2 + 0.04)
        x, y = bed.point(back, aside)
        placed = plan.add(snap_to_voxels(Item(stand, x, y, 0.0, bed.yaw_deg)), may_block=False)
        if placed:
            plan.add_upon(decor.table_lamp(style.dark_wood), placed, -0.04, 0.0)
    plan.reserve_beside(bed, 0.5)
    closet = storage.cabinet("wardrobe", (0.6, rng.uniform(1.2, 1.8), 2.06), 3, 1, WHITE, WHITE)
    others = tuple(int(w) for w in rng.permutation(4) if w != round(bed.yaw_deg / 90) % 4)
    plan.add_at_walls(closet, others, along=(0.0, 1.0), clear_m=0.5)
    dresser = storage.cabinet("dresser", (0.48, 1.1, 0.84), 2, 3, style.wood, style.wood)
    chest = plan.add_at_walls(dresser, others, clear_m=0.4)
    if chest:
        plan.add_upon(decor.vase(style.second_cloth), chest, 0.0, 0.3)
        pictures_over(plan, chest, 1.25, count=1)
    plan.add_in_corner(decor.plant(rng.uniform(0.9, 1.3), rng))
    pictures_over(plan, bed, 1.35)
    return (rug_around(bed, 0.55, 0.45, style.second_cloth),)


def furnish_kitchen(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a kitchen with counters in an L, cupboards above, a fridge and a small table.

    Returns None if the counters or the table do not fit.
    """
    rng = plan.rng
    wall = 1 if plan.size_m[0] >= plan.size_m[1] else 0
    run = _kitchen_run(plan, style, wall)
    if run is None:
        return None
    _kitchen_arm(plan, style, wall)
    width = float(rng.choice([0.9, 1.2]))
    table = seating.table("kitchen_table", 0.8, width, 0.74, style.wood)
    along, away = 0.62 * plan.size_m[1 - wall % 2], 0.68 * plan.size_m[wall % 2]
    x, y = (along, away) if wall == 1 else (away, along)
    board = plan.add(snap_to_voxels(Item(table, x, y, 0.0, 90.0 * wall)))
    if board is None:
        return None
    chairs_around(plan, board, seating.chair(style.wood, style.cloth), ends=False)
    plan.add_upon(decor.bowl(), board, 0.0, 0.0)
    pendant_over(plan, board, (60, 64, 66))
    plan.add_at_walls(decor.crate((0.3, 0.4, 0.3), (190, 150, 104)))
    plan.add_in_corner(decor.plant(rng.uniform(0.8, 1.1), rng))
    picture_anywhere(plan)
    return ()


def _kitchen_run(plan: Plan, style: Style, wall: int) -> Item | None:
    """Place a counter, cooker, sink and fridge along a wall, with cabinets above them."""
    front, worktop = style.front, style.worktop
    corner, cooker = storage.counter(1.0, front, worktop), storage.oven(front, worktop)
    cool = storage.fridge(WHITE if front != WHITE else (190, 192, 196))
    rest = plan.wall_length(wall) - corner.size_m[1] - cooker.size_m[1] - cool.size_m[1]
    sink = storage.counter(min(1.6, rest - 0.02), front, worktop, sink=True)
    placed, at = [], 0.0
    for model in (corner, cooker, sink, cool):
        placed.append(plan.add(plan.at_wall(model, wall, at + model.size_m[1] / 2)))
        at += model.size_m[1]
    if not all(placed):
        return None
    left, stove = corner.size_m[1], cooker.size_m[1]
    hanging = [
        (decor.hood(), left + stove / 2, 1.56),
        (storage.wall_cabinet(left, front), left / 2, 1.44),
        (storage.wall_cabinet(sink.size_m[1], front), left + stove + sink.size_m[1] / 2, 1.44),
    ]
    for model, along, z_m in hanging:
        plan.add(plan.at_wall(model, wall, along, z_m))
    plan.add_upon(decor.microwave(), placed[0], -0.1, 0.0, top_m=0.9)
    return placed[0]


def _kitchen_arm(plan: Plan, style: Style, wall: int) -> None:
    """Place the other arm of the L along the adjacent wall."""
    arm_wall = 1 - wall
    for length in (1.6, 1.2, 0.8):
        arm = storage.counter(length, style.front, style.worktop)
        item = plan.add(plan.at_wall(arm, arm_wall, 0.64 + arm.size_m[1] / 2))
        if item:
            plan.add_upon(decor.kettle((196, 60, 52)), item, -0.06, 0.2)
            plan.add_upon(decor.vase(style.second_cloth), item, -0.1, -0.3)
            top = storage.wall_cabinet(length - 0.2, style.front)
            plan.add(plan.at_wall(top, arm_wall, 0.64 + length / 2, 1.44))
            plan.reserved.append(plan.front_box(item, 0.7))
            return


def furnish_dining(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a dining room with a long table, chairs, a pendant lamp and a sideboard.

    Returns None if the table does not fit.
    """
    rng = plan.rng
    along_x = plan.size_m[0] >= plan.size_m[1]
    length = float(rng.choice([1.6, 1.8, 2.0]))
    table = seating.table("dining_table", 0.9, length, 0.74, style.wood)
    yaw = 90.0 if along_x else 0.0
    item = Item(table, plan.size_m[0] / 2, plan.size_m[1] / 2, 0.0, yaw)
    board = plan.add(snap_to_voxels(item))
    if board is None:
        return None
    chairs_around(plan, board, seating.chair(style.wood, style.cloth), ends=True)
    plan.add_upon(decor.vase(style.second_cloth), board, 0.0, 0.0)
    plan.add_upon(decor.bowl(), board, 0.1, 0.45)
    pendant_over(plan, board, style.second_cloth)
    side = storage.cabinet("sideboard", (0.46, 1.6, 0.84), 4, 1, style.wood, style.dark_wood)
    chest = plan.add_at_walls(side, shuffled_walls(plan), along=(0.5,))
    if chest:
        plan.add_upon(decor.table_lamp(style.dark_wood), chest, 0.0, 0.6)
        plan.add_upon(decor.bowl(), chest, 0.0, -0.3)
        pictures_over(plan, chest, 1.35)
    tall = storage.cabinet("cupboard", (0.42, 0.9, 1.9), 2, 2, style.wood, style.wood)
    plan.add_at_walls(tall, along=(0.0, 1.0))
    plan.add_in_corner(decor.plant(rng.uniform(1.1, 1.5), rng))
    picture_anywhere(plan)
    return (rug_around(board, 0.7, 0.7, style.second_cloth),)


def furnish_study(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a study with a desk, a chair, bookshelves, boxes and an armchair.

    Returns None if the desk or its chair does not fit.
    """
    rng = plan.rng
    walls = shuffled_walls(plan)
    desk = plan.add_at_walls(
        seating.desk(rng.uniform(1.4, 1.7), style.wood, WHITE), walls, along=(0.5, 0.4, 0.6),
        clear_m=0.9,
    )  # fmt: skip
    if desk is None:
        return None
    worker = plan.add_before(seating.office_chair((52, 56, 66)), desk, 0.06)
    if worker is None:
        return None
    plan.add_upon(decor.monitor(), desk, -0.16, 0.0)
    plan.add_upon(decor.keyboard(), desk, 0.12, 0.0)
    plan.add_upon(decor.table_lamp(style.dark_wood), desk, -0.16, desk.model.size_m[1] / 2 - 0.2)
    plan.add_upon(decor.book_pile(rng), desk, 0.0, -desk.model.size_m[1] / 2 + 0.2)
    for share in (0.0, 1.0, 0.5):
        shelf = storage.bookshelf(rng.uniform(0.8, 1.1), 1.9, style.wood, rng)
        plan.add_at_walls(shelf, walls[1:] + walls[:1], along=(share,), clear_m=0.4)
    plan.add_in_corner(seating.armchair(style.cloth, style.wood))
    plan.add_in_corner(decor.waste_bin((90, 96, 104)), near=desk)
    plan.add_in_corner(decor.plant(rng.uniform(1.0, 1.4), rng))
    crate = plan.add_at_walls(decor.crate((0.36, 0.46, 0.34), (196, 158, 112)))
    if crate:
        plan.add_upon(decor.crate((0.3, 0.36, 0.26), (184, 146, 102)), crate, 0.0, 0.02)
    pictures_over(plan, desk, 1.4, count=1)
    centre = (plan.size_m[0] / 2, plan.size_m[1] / 2)
    return (Rug(centre[0] - 0.8, centre[1] - 0.6, centre[0] + 0.8, centre[1] + 0.6, style.cloth),)


def shuffled_walls(plan: Plan) -> tuple[int, ...]:
    """Return the indices of the four main walls in random order."""
    return tuple(int(wall) for wall in plan.rng.permutation(4))


def furnish_bathroom(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a bathroom with a bathtub or shower, a washstand, a mirror and a toilet.

    A washing machine is added if it fits. Returns None if the main fittings do not fit.
    """
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
    plan.add(plan.behind(basin, glass, 1.14))
    plan.add_at_walls(washing.washing_machine(), walls, along=(0.0, 1.0), clear_m=0.5)
    tall = storage.cabinet("bath_cabinet", (0.34, 0.4, 1.7), 1, 2, WHITE, WHITE)
    plan.add_at_walls(tall, walls, along=(0.0, 1.0), clear_m=0.4)
    plan.add_at_walls(washing.towel(style.cloth), walls, z_m=0.8)
    plan.add_in_corner(decor.waste_bin((200, 202, 204)))
    return (rug_around(basin, 0.5, 0.0, style.second_cloth),)


def furnish_hall(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a hall with coats above a bench, a shoe cabinet with a mirror, and a bin."""
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
        plan.add(snap_to_voxels(Item(playing.bench(style.wood), *ahead, 0.0, hung.yaw_deg)))
    plan.add_at_walls(decor.picture(0.5, 0.6, rng), walls, z_m=1.4)
    plan.add_in_corner(decor.waste_bin((70, 78, 92)))
    middle = plan.ground.walls[1].point(plan.size_m[0] / 2, plan.size_m[1] / 2)
    if plan.ground.blocks:
        return ()
    return (Rug(middle[0] - 0.8, middle[1] - 0.4, middle[0] + 0.8, middle[1] + 0.4, style.cloth),)


def _gap_m(plan: Plan, item: Item, wall: int) -> float:
    """Return the distance from the back of an item to a wall."""
    side = plan.ground.walls[wall]
    if side.turn != round(item.yaw_deg / 90) % 4:
        return 1e9
    x, y = item.point(-item.model.size_m[0] / 2, 0.0)
    off = abs((x if side.turn % 2 == 0 else y) - side.at_m)
    along = y if side.turn % 2 == 0 else x
    return off if side.first_m <= along <= side.last_m else 1e9


def furnish_office(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish an office with two desks, a meeting table, a filing cabinet and a whiteboard.

    Returns None if no desk fits.
    """
    rng = plan.rng
    walls = shuffled_walls(plan)
    places = []
    for wall in walls:
        if len(places) < 2:
            place = place_desk(plan, style, wall)
            places += [place] if place else []
    if not places:
        return None
    files = storage.cabinet("filing_cabinet", (0.46, 0.84, 1.2), 2, 3, (190, 194, 198), WHITE)
    chest = plan.add_at_walls(files, walls[::-1], along=(0.0, 1.0, 0.5), clear_m=0.5)
    if chest is not None:
        plan.add_upon(playing.printer(), chest, 0.0, 0.1)
    table = seating.table("meeting_table", 0.9, 1.2, 0.74, WHITE)
    middle = (plan.size_m[0] * rng.uniform(0.4, 0.6), plan.size_m[1] * rng.uniform(0.4, 0.6))
    board = plan.add(snap_to_voxels(Item(table, *middle, 0.0, 90.0 * int(rng.integers(2)))))
    if board is not None:
        chairs_around(plan, board, seating.chair(style.dark_wood, style.cloth), ends=False)
    plan.add_at_walls(playing.whiteboard(), walls, along=(0.5, 0.3, 0.7), z_m=0.94)
    shelf = storage.bookshelf(0.9, 1.9, style.wood, rng)
    plan.add_at_walls(shelf, walls[::-1], along=(0.0, 1.0), clear_m=0.4)
    plan.add_in_corner(decor.plant(rng.uniform(1.0, 1.4), rng))
    plan.add_in_corner(decor.waste_bin((90, 96, 104)), near=places[0])
    return ()


def place_desk(plan: Plan, style: Style, wall: int) -> Item | None:
    """Place a desk with its chair, monitor and keyboard at a wall, if the desk fits."""
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
    """Furnish a children's room with a small bed, a desk, a toy shelf and a table with stools.

    Returns None if the bed does not fit.
    """
    rng = plan.rng
    walls = shuffled_walls(plan)
    bed = plan.add_at_walls(
        seating.bed(0.9, style.wood, playing.bright_colour(rng)),
        walls,
        along=(0.0, 1.0),
        clear_m=0.3,
    )
    if bed is None:
        return None
    wardrobe = storage.cabinet("wardrobe", (0.58, 1.0, 1.9), 2, 1, WHITE, style.wood)
    plan.add_at_walls(wardrobe, walls[::-1], along=(0.0, 1.0), clear_m=0.5)
    desk = plan.add_at_walls(
        seating.desk(1.1, style.wood, WHITE), walls[1:], along=(0.5, 0.3, 0.7), clear_m=0.7
    )
    if desk is not None:
        plan.add_before(seating.chair(style.wood, playing.bright_colour(rng)), desk, 0.06)
        plan.add_upon(decor.table_lamp(style.dark_wood), desk, -0.16, 0.36)
        plan.add_upon(decor.book_pile(rng), desk, 0.0, -0.3)
    plan.add_at_walls(playing.toy_shelf(style.wood, rng), walls, along=(0.5,), clear_m=0.4)
    table = seating.table("play_table", 0.5, 0.6, 0.46, style.wood)
    middle = (plan.size_m[0] * rng.uniform(0.4, 0.6), plan.size_m[1] * rng.uniform(0.4, 0.6))
    low = plan.add(snap_to_voxels(Item(table, *middle, 0.0, 0.0)))
    if low is not None:
        chairs_around(plan, low, playing.stool(playing.bright_colour(rng)), ends=False)
    pictures_over(plan, bed, 1.3, count=1)
    x, y = plan.size_m[0] / 2, plan.size_m[1] / 2
    return (Rug(x - 0.9, y - 0.7, x + 0.9, y + 0.7, style.second_cloth),)


def furnish_laundry(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a laundry with a washing machine beside a dryer, a sink, a shelf and racks.

    Returns None if the machines or the sink do not fit.
    """
    rng = plan.rng
    walls = shuffled_walls(plan)
    washer, dryer = washing.washing_machine(), household.dryer()
    first = plan.add_at_walls(washer, walls, along=(0.3, 0.0, 1.0), clear_m=0.6)
    if first is None:
        return None
    aside = (washer.size_m[1] + dryer.size_m[1]) / 2
    spots = [first.point(0.0, side * aside) for side in (1, -1)]
    second = any(plan.add(snap_to_voxels(Item(dryer, x, y, 0.0, first.yaw_deg))) for x, y in spots)
    sink = storage.counter(0.8, style.front, style.worktop, sink=True)
    basin = plan.add_at_walls(sink, walls, along=(0.0, 1.0, 0.5), clear_m=0.6)
    if not second or basin is None:
        return None
    plan.add_at_walls(household.utility_shelf(rng), walls, along=(0.0, 1.0), clear_m=0.3)
    tall = storage.cabinet("cupboard", (0.4, 0.6, 1.9), 1, 2, WHITE, WHITE)
    plan.add_at_walls(tall, walls, along=(0.0, 1.0), clear_m=0.3)
    plan.add_at_walls(household.drying_rack(rng), walls, along=(0.5, 0.3, 0.7))
    if plan.add_at_walls(household.ironing_board(style.cloth), walls, along=(0.5, 0.7)) is None:
        plan.add_at_walls(household.folded_ironing_board(style.cloth), walls)
    plan.add_in_corner(household.laundry_basket(rng))
    plan.add_in_corner(decor.waste_bin((200, 202, 204)))
    return ()


@dataclass(frozen=True)
class Kind:
    """A kind of room, with the ranges of its inner sides in metres, its floor and its recipe."""

    short_m: tuple[float, float]
    long_m: tuple[float, float]
    floor: str  # planks or tiles
    furnish: "Callable[[Plan, Style], tuple[Rug, ...] | None]"
    title: str  # What people call it, with its article.


KINDS: dict[str, Kind] = {
    "living": Kind((3.6, 4.4), (4.4, 5.4), "planks", furnish_living, "a living room"),
    "bed": Kind((3.2, 3.8), (3.8, 4.6), "planks", furnish_bed, "a bedroom"),
    "kitchen": Kind((2.9, 3.5), (3.7, 4.6), "tiles", furnish_kitchen, "a kitchen"),
    "dining": Kind((3.4, 4.0), (4.2, 5.0), "planks", furnish_dining, "a dining room"),
    "study": Kind((3.0, 3.6), (3.6, 4.4), "planks", furnish_study, "a study"),
    "bathroom": Kind((1.9, 2.4), (2.5, 3.3), "tiles", furnish_bathroom, "a bathroom"),
    "hall": Kind((1.6, 2.1), (3.2, 4.8), "tiles", furnish_hall, "a hall"),
    "office": Kind((3.2, 4.0), (4.0, 5.2), "planks", furnish_office, "an office"),
    "children": Kind((2.8, 3.4), (3.4, 4.4), "planks", furnish_children, "a children's room"),
    "laundry": Kind((2.3, 2.9), (3.1, 4.0), "tiles", furnish_laundry, "a laundry"),
}
# Training sets draw kinds by seed from these: a later kind would change the rooms of their seeds.
TRAINING_KINDS = tuple(name for name in KINDS if name != "laundry")


def find_kind(name: str) -> str:
    """Return the kind of room with a name: that of ``KINDS``, or what people call it.

    Raises:
        UnknownNameError: If there is no such kind.

    Example:
        >>> find_kind("bedroom"), find_kind("Living_Room"), find_kind("office")
        ('bed', 'living', 'office')
    """
    words = name.lower().replace("_", " ").replace("-", " ")
    for kind, made in KINDS.items():
        if words in (kind, made.title.partition(" ")[2]):
            return kind
    raise UnknownNameError("room kind", name, KINDS)


def room_title(kind: str) -> str:
    """Return what people call a kind of room or a house, with its article and a capital letter.

    Example:
        >>> room_title("bed"), room_title("office"), room_title("house")
        ('A bedroom', 'An office', 'A house')
    """
    title = KINDS[kind].title if kind in KINDS else f"a {kind}"
    return title[0].upper() + title[1:]


def random_size(kind: Kind, rng: np.random.Generator) -> tuple[float, float, float]:
    """Return a random width, depth and height for a kind of room, in multiples of 2 cm."""
    short, long = (
        round_to_step(rng.uniform(*kind.short_m)),
        round_to_step(rng.uniform(*kind.long_m)),
    )
    height = round_to_step(rng.uniform(2.4, 2.7))
    return (long, short, height) if rng.random() < 0.6 else (short, long, height)

"""Full furnishing: what people expect in a room beyond the main furniture of its recipe.

A recipe places the main furniture. ``furnish_fully`` then adds radiators, lamps and the further
pieces of the kind of room wherever they fit, and leaves the ways from the doors clear. It draws
from its own random generator, so that the furniture of the recipe is the same with or without it.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.procgen.rooms import bathroom_fittings as washing
from world2minecraft.procgen.rooms import clutter_models as small
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms import household_models as household
from world2minecraft.procgen.rooms import seats_beds_tables as seating
from world2minecraft.procgen.rooms import storage_furniture as storage
from world2minecraft.procgen.rooms.children_and_hall_furniture import bright_colour
from world2minecraft.procgen.rooms.clutter import scatter
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style
from world2minecraft.procgen.rooms.disorder import disarrange, turn_rugs
from world2minecraft.procgen.rooms.furniture_model import Model
from world2minecraft.procgen.rooms.openings import Hole, hang_curtains
from world2minecraft.procgen.rooms.placement import (
    Item,
    Plan,
    Rug,
    items_intersect,
    paths_are_clear,
    picture_anywhere,
    snap_to_voxels,
)
from world2minecraft.procgen.rooms.recipes import place_desk

FURNISHINGS = ("basic", "full")
RADIATOR_M = (0.12, 0.10)  # Height of its bottom, and what it is shorter than its window.
BED_CLEAR_M = 0.5  # What the recipe reserves before the foot of a bed.
CORNER_ALONG = (0.0, 1.0)


@dataclass(frozen=True)
class Completion:
    """A room whose furnishing is being completed.

    Attributes:
        plan: The room with the furniture of its recipe.
        style: The colours of the room.
        rng: Random generator.
        doors_m: Position on the floor behind each door.
        body_m: Half the width of a person who must reach the free floor.
    """

    plan: Plan
    style: Style
    rng: np.random.Generator
    doors_m: list[tuple[float, float]]
    body_m: float

    def find(self, *names: str) -> Item | None:
        """Return the first item with one of the names, or None."""
        return next((item for item in self.plan.items if item.model.name in names), None)

    def stand(
        self, model: Model, *, along: tuple[float, ...] = (), clear_m: float = 0.0, z_m: float = 0.0
    ) -> Item | None:
        """Place a model at any wall if no way is blocked, and return its item or None."""
        reserved = len(self.plan.reserved)
        walls = tuple(int(wall) for wall in self.rng.permutation(4))
        item = self.plan.add_at_walls(model, walls, along=along, clear_m=clear_m, z_m=z_m)
        if item is not None and not self._reachable():
            self.plan.items.remove(item)
            del self.plan.reserved[reserved:]
            return None
        return item

    def hang(self, model: Model, z_m: float) -> Item | None:
        """Hang a model on a wall, with its bottom ``z_m`` above the floor."""
        return self.stand(model, along=(0.5, 0.3, 0.7), z_m=z_m)

    def hang_over(self, model: Model, below: Item | None, z_m: float) -> Item | None:
        """Hang a model on the wall behind an item, or anywhere if there is no space."""
        if below is not None:
            placed = self.plan.add(self.plan.behind(below, model, z_m))
            if placed is not None:
                return placed
        return self.hang(model, z_m)

    def place(self, model: Model, spots: Iterable[tuple[float, float, float]]) -> Item | None:
        """Place a model at the first x, y and yaw where it fits and blocks no way."""
        for x, y, yaw in spots:
            item = self.plan.add(snap_to_voxels(Item(model, x, y, 0.0, yaw % 360)))
            if item is not None and self._reachable():
                return item
            if item is not None:
                self.plan.items.remove(item)
        return None

    def beside(self, model: Model, anchor: Item | None, gap_m: float = 0.02) -> Item | None:
        """Place a model beside an item, with its back in line with the item's."""
        if anchor is None:
            return None
        aside = (anchor.size_m[1] + model.size_m[1]) / 2 + gap_m
        back = (model.size_m[0] - anchor.size_m[0]) / 2
        sides = (aside, -aside) if self.rng.random() < 0.5 else (-aside, aside)
        return self.place(model, [(*anchor.point(back, left), anchor.yaw_deg) for left in sides])

    def corner(self, model: Model) -> Item | None:
        """Place a model in a corner, or else at a wall."""
        item = self.plan.add_in_corner(model)
        if item is not None and not self._reachable():
            self.plan.items.remove(item)
            item = None
        return item if item is not None else self.stand(model)

    def upon(self, model: Model, base: Item | None, *, top_m: float | None = None) -> Item | None:
        """Place a model at a free spot on an item."""
        if base is None:
            return None
        depth, width, _ = base.size_m
        front, left = (depth - model.size_m[0]) / 2, (width - model.size_m[1]) / 2
        if min(front, left) < 0:
            return None
        for _ in range(8):
            at = (float(self.rng.uniform(-1, 1)) * front, float(self.rng.uniform(-1, 1)) * left)
            item = self.plan.add_upon(model, base, *at, top_m=top_m)
            if item is not None:
                return item
        return None

    def exchange(self, old: Item | None, model: Model) -> Item | None:
        """Replace an item by a model at the same place if the model fits there.

        Pictures in its way are taken down.
        """
        if old is None:
            return None
        back = (model.size_m[0] - old.size_m[0]) / 2
        item = snap_to_voxels(Item(model, *old.point(back, 0.0), old.z_m, old.yaw_deg))
        others = [
            other
            for other in self.plan.items
            if other is not old
            and not (other.model.name == "picture" and items_intersect(other, item))
        ]
        if not self.plan.fits(item, among=others):
            return None
        self.plan.items[:] = [*others, item]
        return item

    def _reachable(self) -> bool:
        return paths_are_clear(self.plan, *self.doors_m, body_m=self.body_m)


def check_furnishing(furnishing: str) -> None:
    """Check the name of a furnishing.

    Raises:
        UnknownNameError: If it is unknown.
    """
    if furnishing not in FURNISHINGS:
        raise UnknownNameError("furnishing", furnishing, FURNISHINGS)


def furnish_fully(
    room: Completion, kind: str, holes: tuple[Hole, ...], rugs: tuple[Rug, ...], clutter: float
) -> tuple[Rug, ...]:
    """Complete a room, hang its curtains, bring it into disorder and return its rugs.

    Objects get the classes that the vocabulary gives to their names.

    Args:
        room: The room with the furniture of its recipe. The items of its plan are modified.
        kind: The kind of room, one of ``KINDS``.
        holes: The doors and windows of the room.
        rugs: The rugs of the recipe.
        clutter: Amount of clutter and disorder, from 0 (tidy) to 1.
    """
    plan = room.plan
    complete_room(room, kind, holes)
    hang_curtains(plan, holes, room.style.curtain)
    if clutter > 0:
        disarrange(plan, holes, clutter, room.rng, room.doors_m, room.body_m)
        scatter(plan, clutter, room.rng, room.doors_m)
    plan.items[:] = [_with_own_class(item) for item in plan.items]
    return turn_rugs(rugs, clutter, room.rng)


def complete_room(room: Completion, kind: str, holes: tuple[Hole, ...]) -> None:
    """Add to a furnished room what people expect in a room of its kind.

    Args:
        room: The room. The items of its plan are modified.
        kind: The kind of room, one of ``KINDS``.
        holes: The doors and windows of the room.
    """
    drawn, room.plan.rng = room.plan.rng, room.rng
    ADDITIONS[kind](room)
    _heat(room, holes)
    if room.find("pendant") is None:
        _light(room)
    room.plan.rng = drawn


def _with_own_class(item: Item) -> Item:
    """Return an item with the class that the vocabulary gives to its name."""
    entry = read_vocabulary().find(item.model.name.replace("_", " "))
    if entry is None or entry.class_id not in OBJECT_CLASSES:
        return item
    return replace(item, model=replace(item.model, class_id=entry.class_id))


def _heat(room: Completion, holes: tuple[Hole, ...]) -> None:
    """Add a radiator under each window that has space under it."""
    for hole in holes:
        if hole.kind != "window" or hole.sill_m < 0.8:
            continue
        z_m, less = RADIATOR_M
        model = household.radiator(hole.last_m - hole.first_m - less)
        middle = (hole.first_m + hole.last_m) / 2
        room.plan.add(room.plan.at_wall(model, hole.wall, middle, z_m))


def _light(room: Completion) -> None:
    """Add one lamp below the ceiling, or two in a long room."""
    model = household.ceiling_lamp()
    width, depth, height = room.plan.size_m
    long = max(width, depth) > 4.6
    for share in (0.3, 0.7) if long else (0.5,):
        across = (share, 0.5) if width >= depth else (0.5, share)
        spot = (width * across[0], depth * across[1], height - model.size_m[2], 0.0)
        room.plan.add(snap_to_voxels(Item(model, *spot)), may_block=True)


def _complete_bathroom(room: Completion) -> None:
    style, rng = room.style, room.rng
    tub = room.find("bathtub", "shower")
    if tub is not None and tub.model.name == "bathtub":
        room.stand(washing.shower(0.86), along=CORNER_ALONG, clear_m=0.3)
        if rng.random() < 0.5:
            curtain = household.shower_curtain(tub.size_m[1], style.cloth)
            back = (tub.size_m[0] - curtain.size_m[0]) / 2
            room.plan.add_upon(curtain, tub, back, 0.0)
    basin = room.find("washstand")
    if room.find("mirror") is None:
        room.hang_over(washing.mirror(0.7), basin, 1.14)
    if room.find("washing_machine") is None and rng.random() < 0.5:
        room.stand(washing.washing_machine(), along=CORNER_ALONG, clear_m=0.4)
    room.stand(household.laundry_basket(rng, 0.36), along=CORNER_ALONG)
    if room.find("bath_cabinet") is None:
        tall = storage.cabinet("bath_cabinet", (0.34, 0.4, 1.7), 1, 2, WHITE, WHITE)
        room.stand(tall, along=CORNER_ALONG, clear_m=0.3)
    room.hang(household.towel_radiator(style.second_cloth), 0.5)
    if room.find("towel") is None:
        room.hang(washing.towel(style.cloth), 0.8)
    if room.find("bin") is None:
        room.corner(decor.waste_bin((200, 202, 204)))
    room.upon(small.bottle(rng), room.find("washing_machine"))
    room.upon(small.potted_plant(rng), room.find("washing_machine"))


def _complete_kitchen(room: Completion) -> None:
    style, rng = room.style, room.rng
    counters = [item for item in room.plan.items if item.model.name == "counter"]
    machine = household.dishwasher(style.front, style.worktop)
    ends = [*counters[::-1], room.find("sink_counter")]
    if all(room.beside(machine, end, 0.0) is None for end in ends):
        room.stand(machine, along=CORNER_ALONG, clear_m=0.5)
    for base in counters:
        room.upon(small.bottle(rng), base, top_m=0.90)
        room.upon(small.potted_plant(rng), base, top_m=0.90)
    room.corner(decor.waste_bin((176, 180, 184)))
    room.hang(household.wall_clock(), 1.8)
    room.hang(household.wall_shelf(0.8, style.wood, rng), 1.44)
    room.hang(washing.towel(style.cloth), 0.9)
    board = room.find("kitchen_table")
    for _ in range(2):
        room.upon(small.plate(rng), board)
        room.upon(small.cup(rng), board)


def _complete_bed(room: Completion) -> None:
    style, rng = room.style, room.rng
    bed = room.find("bed")
    if room.find("wardrobe") is None:
        for width, clear_m in ((1.0, 0.4), (0.8, 0.4), (0.8, 0.0)):
            closet = storage.cabinet("wardrobe", (0.6, width, 2.06), 2, 1, WHITE, WHITE)
            if room.stand(closet, along=CORNER_ALONG, clear_m=clear_m) is not None:
                break
    if bed is not None:
        chest = household.blanket_chest(style.dark_wood)
        own = room.plan.front_box(bed, BED_CLEAR_M)
        room.plan.reserved[:] = [box for box in room.plan.reserved if box != own]
        away = (bed.size_m[0] + chest.size_m[0]) / 2 + 0.04
        room.place(chest, [(*bed.point(away, 0.0), bed.yaw_deg)])
    dresser = room.find("dresser")
    if rng.random() < 0.5:
        room.hang_over(washing.mirror(0.8), dresser, 1.1)
    room.stand(household.standing_mirror(style.wood), along=(0.2, 0.8), clear_m=0.3)
    room.corner(seating.armchair(style.second_cloth, style.wood))
    room.corner(household.laundry_basket(rng))
    for item in [item for item in room.plan.items if item.model.name == "nightstand"]:
        room.upon(small.cup(rng), item)
    room.upon(decor.book_pile(rng), dresser)
    if room.find("picture") is None:
        picture_anywhere(room.plan)


def _complete_study(room: Completion) -> None:
    style, rng = room.style, room.rng
    files = storage.cabinet("filing_cabinet", (0.46, 0.46, 1.04), 1, 3, (190, 194, 198), WHITE)
    chest = room.stand(files, along=CORNER_ALONG, clear_m=0.4)
    room.upon(small.potted_plant(rng), chest)
    if room.find("bin") is None:
        room.corner(decor.waste_bin((90, 96, 104)))
    easy = room.find("armchair")
    lamp = decor.floor_lamp((250, 232, 190))
    if room.beside(lamp, easy) is None:
        room.corner(lamp)
    room.hang_over(household.wall_shelf(1.0, style.wood, rng), room.find("desk"), 1.5)
    room.hang(household.wall_clock(), 1.8)
    room.upon(small.cup(rng), room.find("desk"))
    if room.find("plant") is None:
        room.corner(decor.plant(1.1, rng))


def _complete_living(room: Completion) -> None:
    style, rng = room.style, room.rng
    great: tuple[Callable[[], Model], ...] = (
        lambda: household.piano(style.dark_wood),
        household.fireplace,
        lambda: storage.cabinet(
            "sideboard", (0.46, 1.6, 0.84), 4, 1, style.wood, style.dark_wood
        ),
    )  # fmt: skip
    made = great[int(rng.integers(len(great)))]()
    placed = room.stand(made, along=(0.5, 0.3, 0.7), clear_m=0.6)
    if placed is not None and made.name == "piano":
        stool = household.piano_stool(style.cloth)
        away = (made.size_m[0] + stool.size_m[0]) / 2 - 0.04
        at = placed.point(away, 0.0)
        seat = Item(stool, *at, 0.0, (placed.yaw_deg + 180) % 360)
        room.plan.add(snap_to_voxels(seat), may_block=True)
    elif placed is not None:
        room.upon(household.candles(), placed)
        room.upon(decor.vase(style.second_cloth), placed)
    couch = room.find("sofa")
    table = room.beside(household.side_table(style.wood), couch, 0.04)
    if table is not None:
        room.plan.add_upon(decor.table_lamp(style.dark_wood), table, 0.0, 0.0)
    room.corner(household.ottoman(style.second_cloth))
    room.stand(household.display_cabinet(style.wood, rng), along=CORNER_ALONG, clear_m=0.3)
    room.hang(household.wall_shelf(1.0, style.wood, rng), 1.5)
    room.hang(household.wall_clock(), 1.8)
    room.upon(small.cup(rng), room.find("coffee_table"))
    if room.find("picture") is None:
        picture_anywhere(room.plan)


def _complete_dining(room: Completion) -> None:
    style, rng = room.style, room.rng
    board = room.find("dining_table")
    if board is not None:
        depth, width, _ = board.size_m
        count = max(1, int(width / 0.62))
        for front in (-1, 1):
            for n in range(count):
                left = (n + 0.5) * width / count - width / 2
                room.plan.add_upon(small.plate(rng), board, front * (depth / 2 - 0.18), left)
    room.upon(household.candles(), board)
    cabinet = household.display_cabinet(style.wood, rng)
    room.stand(cabinet, along=CORNER_ALONG, clear_m=0.3)
    room.hang(washing.mirror(0.8), 1.1)
    room.hang(household.wall_clock(), 1.8)
    for _ in range(2):
        room.hang(household.wall_lamp(style.second_cloth), 1.5)
    room.upon(small.bottle(rng), room.find("sideboard"))


def _complete_children(room: Completion) -> None:
    style, rng = room.style, room.rng
    cloth = bright_colour(rng)
    bunk = household.bunk_bed(style.wood, cloth, bright_colour(rng))
    bed = room.exchange(room.find("bed"), bunk) if rng.random() < 0.5 else None
    if bed is None:
        room.exchange(room.find("bed"), household.single_bed(style.wood, cloth))
    chest = household.blanket_chest(style.wood)
    room.upon(small.teddy(rng), room.stand(chest, clear_m=0.3) or room.stand(chest))
    shelf = storage.bookshelf(0.8, 1.14, style.wood, rng)
    room.stand(shelf, along=CORNER_ALONG, clear_m=0.3)
    large = (small.beanbag, small.rocking_horse, small.easel)
    room.corner(large[int(rng.integers(len(large)))](rng))
    room.hang(household.wall_shelf(0.8, style.wood, rng), 1.3)
    if room.find("play_table") is None:
        table = seating.table("play_table", 0.5, 0.6, 0.46, style.wood)
        room.stand(table, clear_m=0.3)
    room.upon(small.bricks(rng), room.find("play_table"))
    room.upon(small.teddy(rng), room.find("toy_shelf"))
    for maker in (small.ball, small.teddy, small.bricks):
        room.stand(maker(rng))
    room.corner(decor.waste_bin(bright_colour(rng)))


def _complete_hall(room: Completion) -> None:
    style, rng = room.style, room.rng
    room.stand(household.shoe_rack(style.wood, rng))
    room.corner(household.umbrella_stand(rng))
    room.corner(household.coat_stand(rng))
    room.hang(household.wall_clock(), 1.8)
    for _ in range(2):
        room.hang(household.wall_lamp(style.cloth), 1.6)
    room.corner(decor.plant(0.9, rng))
    room.upon(decor.bowl(), room.find("shoe_cabinet"))
    room.upon(small.bag(rng), room.find("bench"))


def _complete_laundry(room: Completion) -> None:
    rng = room.rng
    room.hang(household.wall_shelf(0.8, room.style.wood, rng), 1.5)
    for name in ("washing_machine", "dryer"):
        room.upon(small.bottle(rng), room.find(name))
    room.upon(small.laundry(rng), room.find("dryer"))
    room.stand(household.laundry_basket(rng))
    room.corner(small.carton(rng))
    room.hang(washing.towel(room.style.cloth), 0.9)


def _complete_office(room: Completion) -> None:
    style, rng = room.style, room.rng
    for wall in rng.permutation(4):
        items, reserved = list(room.plan.items), len(room.plan.reserved)
        desk = place_desk(room.plan, style, int(wall))
        if desk is not None and paths_are_clear(room.plan, *room.doors_m, body_m=room.body_m):
            break
        room.plan.items[:] = items
        del room.plan.reserved[reserved:]
    files = storage.cabinet("filing_cabinet", (0.46, 0.46, 1.04), 1, 3, (190, 194, 198), WHITE)
    room.upon(small.potted_plant(rng), room.stand(files, along=CORNER_ALONG, clear_m=0.4))
    room.corner(household.coat_stand(rng))
    if room.find("bin") is None:
        room.corner(decor.waste_bin((90, 96, 104)))
    room.hang(household.wall_clock(), 1.8)
    for item in [item for item in room.plan.items if item.model.name == "desk"]:
        room.upon(small.cup(rng), item)
    room.upon(small.laptop(rng), room.find("meeting_table"))
    picture_anywhere(room.plan)


ADDITIONS: dict[str, Callable[[Completion], None]] = {
    "living": _complete_living,
    "bed": _complete_bed,
    "kitchen": _complete_kitchen,
    "dining": _complete_dining,
    "study": _complete_study,
    "bathroom": _complete_bathroom,
    "hall": _complete_hall,
    "office": _complete_office,
    "children": _complete_children,
    "laundry": _complete_laundry,
}

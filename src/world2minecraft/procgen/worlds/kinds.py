"""Which kinds the rooms of a house are of, and what more stands in those of the metric kinds."""

from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.recipes import KINDS
from world2minecraft.procgen.worlds.display_stands import HOME
from world2minecraft.procgen.worlds.house import BlockHouse
from world2minecraft.procgen.worlds.recipes import PICTURES
from world2minecraft.procgen.worlds.task import BOARDS, Task

BECOMES: dict[str, tuple[tuple[str, float], ...]] = {
    "study": (("library", 0.2), ("music", 0.2), ("workshop", 0.1), ("shop", 0.1)),
    "office": (("shop", 0.3), ("gallery", 0.1), ("workshop", 0.15)),
    "dining": (
        ("cafe", 0.12), ("office", 0.1), ("study", 0.08), ("games", 0.06), ("music", 0.06),
    ),
    "children": (
        ("office", 0.12), ("study", 0.1), ("games", 0.06), ("library", 0.05), ("music", 0.04),
        ("cafe", 0.03),
    ),
    "bed": (("children", 0.08),),
    "bathroom": (("laundry", 0.12),),
}  # fmt: skip
SHOWING = ("shop", "storage", "greenhouse", "gallery", "workshop")  # Every house has one,
SHOWING_SHARES = (0.4, 0.2, 0.15, 0.1, 0.15)
MANY_ROOMS = 8  # So many have two.
SPARE = ("children", "dining", "study", "office")  # of these, where it has one.
MORE: dict[str, tuple[str, ...]] = {  # Further furniture of the metric kinds.
    "living": (
        "piano", "grand_piano", "fireplace", "aquarium", "bookcase", "display_cabinet",
        "grandfather_clock", "corner_sofa", "indoor_tree", "bust", "globe_lamp", "arc_lamp",
        "corner_sofa_leather", "corner_sofa_white", "cube_shelf", "planter_box",
    ),
    "bed": (
        "single_bed", "vanity", "standing_mirror", "blanket_chest", "crib", "ottoman", "radiator",
        "chair_padded", "chest_of_drawers", "palm", "double_bed_low", "paper_lamp",
    ),
    "kitchen": (
        "dishwasher", "fridge_double", "oven_tower", "pantry_rack", "pedal_bin", "radiator",
        "wall_shelf", "counter", "microwave", "kitchen_island",
    ),
    "bathroom": ("towel_radiator", "laundry_basket", "shower_curtain", "wall_mirror", "fern"),
    "dining": (
        "display_cabinet", "sideboard", "table_console", "grandfather_clock", "fireplace", "plant",
        "vase", "bonsai", "piano",
    ),
    "study": (
        "bookcase", "armchair_wing", "globe_lamp", "filing_cabinet", "bust", "bookcase_low",
        "desk_partners", "radiator", "cactus",
    ),
    "children": ("bunk_bed_pine", "crate", "bicycle", "cube_shelf", "chair_child", "box", "crib"),
    "office": (
        "locker", "filing_cabinet", "projector_screen", "desk_white", "office_chair", "cactus",
        "fir", "desk_drawers", "monitor_wide",
    ),
    "hall": (
        "coat_stand", "shoe_rack", "table_console", "bicycle", "standing_mirror", "wall_mirror",
        "radiator",
    ),
}  # fmt: skip
CARRIERS = (int(SemanticClass.TABLE), int(SemanticClass.FURN))
LOW_M = 1.3  # One sees what stands on a cupboard as high as this.
SHELVES = {  # How many shelves hang in a room at most.
    "living": 2, "bed": 1, "children": 2, "office": 2, "study": 2, "dining": 1, "kitchen": 1,
    "hall": 2, "library": 1, "games": 1, "music": 1,
}  # fmt: skip
SHELF_M = 1.3


def with_own_kinds(house: BlockHouse, rng: np.random.Generator) -> BlockHouse:
    """Return a house of which some rooms are of further kinds; one at least shows wares."""
    rooms = []
    for room in house.rooms:
        kind, draw = room.kind, rng.random()
        for name, share in BECOMES.get(room.kind, ()):
            draw -= share
            if draw < 0:
                kind = name
                break
        rooms.append(replace(room, kind=kind))
    wanted = 1 + (len(rooms) >= MANY_ROOMS)
    for _ in range(wanted - sum(room.kind in SHOWING for room in rooms)):
        changed = [room.number for room in rooms if room.kind in SPARE]
        if changed:
            number = changed[int(rng.integers(len(changed)))]
            kind = SHOWING[int(rng.choice(len(SHOWING), p=SHOWING_SHARES))]
            rooms[number] = replace(rooms[number], kind=kind)
    # A metric kind is furnished by the metric plan, which then must know of it.
    cells = tuple(
        replace(cell, kind=room.kind) if room.kind in KINDS else cell
        for cell, room in zip(house.plan.cells, rooms, strict=True)
    )
    return replace(house, rooms=tuple(rooms), plan=replace(house.plan, cells=cells))


def _lay_about(task: Task) -> None:
    """Put small things of a home on half of the low cupboards and tables of a room."""
    room, furnisher = task.room, task.furnisher
    for thing in [thing for thing in furnisher.things if thing.room == room.number]:
        low = thing.high[2] - room.ground <= round(LOW_M * furnisher.house.blocks_per_metre)
        if thing.class_id in CARRIERS and low and task.rng.random() < 0.55:
            task.show.put_on(thing, (HOME,), most=1 + int(task.rng.integers(2)))


def _high(task: Task) -> int:
    """Return the layer of a shelf at the height of one's eyes."""
    return round(SHELF_M * task.furnisher.house.blocks_per_metre)


def furnish_more(task: Task, wall_lamps: int = 0) -> None:
    """Set further furniture, pictures, lamps and small wares into a room of a metric kind."""
    room, rng = task.room, task.rng
    names = MORE.get(room.kind, ())
    for number in rng.permutation(len(names))[: 2 + int(rng.integers(3))].tolist():
        task.wall(names[number])
    _lay_about(task)
    for _ in range(3 if room.kind == "children" else 0):
        task.show.put_bed(room)
    for _ in range(int(rng.integers(3)) + (room.kind == "hall")):
        task.wall(*PICTURES, above_m=1.0)
    if room.kind in ("living", "study", "hall", "children") and rng.random() < 0.5:
        task.show.hang_on_walls(room, 2, 6)
    if rng.random() < 0.35 and room.kind != "bathroom":
        task.wall("wall_shelf", above_m=1.3)
    for _ in range(SHELVES.get(room.kind, 0)):
        if rng.random() < 0.75:
            task.show.put_rack(room, (_high(task),), task.one(*BOARDS), most=10)
    for _ in range(wall_lamps):
        task.wall("wall_lamp", above_m=1.4)

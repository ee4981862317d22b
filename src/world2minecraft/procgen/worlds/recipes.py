"""Recipes for rooms of block houses: additional kinds of rooms, and extra furniture.

Each recipe is a list of steps that are tried in order. Furniture that does not fit is left out.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.procgen.rooms.recipes import KINDS
from world2minecraft.procgen.worlds.block_house import BlockHouse, BlockRoom
from world2minecraft.procgen.worlds.decoration import hang_one
from world2minecraft.procgen.worlds.furnishing import Furnisher, PlacedFurniture
from world2minecraft.procgen.worlds.wares_and_stands import HOME, StandBuilder

BOARDS = (  # Blocks with a slab that racks are made of, light and dark.
    "oak", "spruce", "birch", "jungle", "acacia", "dark_oak", "mangrove", "cherry", "bamboo",
    "bamboo_mosaic", "crimson", "warped", "smooth_stone", "stone", "smooth_quartz", "andesite",
    "polished_andesite", "polished_diorite", "polished_granite", "brick", "mud_brick",
    "stone_brick", "sandstone", "smooth_sandstone", "cut_sandstone", "smooth_red_sandstone",
    "purpur", "prismarine", "prismarine_brick", "dark_prismarine", "nether_brick",
    "red_nether_brick", "blackstone", "polished_blackstone", "polished_deepslate",
    "deepslate_tile", "end_stone_brick", "waxed_cut_copper", "waxed_oxidized_cut_copper",
    "waxed_weathered_cut_copper", "waxed_exposed_cut_copper", "quartz", "diorite", "granite",
    "cobblestone", "mossy_cobblestone", "cobbled_deepslate", "deepslate_brick",
    "polished_blackstone_brick", "red_sandstone", "cut_red_sandstone", "mossy_stone_brick",
)  # fmt: skip
PILLARS = (
    "quartz_pillar[axis=y]", "purpur_pillar[axis=y]", "polished_basalt[axis=y]",
    "chiseled_quartz_block", "chiseled_stone_bricks", "chiseled_deepslate", "chiseled_sandstone",
    "chiseled_red_sandstone", "chiseled_polished_blackstone", "bone_block[axis=y]",
    "polished_deepslate", "stripped_dark_oak_log[axis=y]", "stripped_birch_log[axis=y]",
    "smooth_stone", "cut_sandstone", "stripped_cherry_log[axis=y]", "gilded_blackstone",
)  # fmt: skip
RIMS = (
    "bricks", "mud_bricks", "spruce_planks", "stone_bricks", "mossy_cobblestone", "cut_sandstone",
    "stripped_oak_log[axis=x]", "prismarine_bricks", "smooth_quartz", "packed_mud", "calcite",
)  # fmt: skip
PICTURES = ("picture", "portrait")
# Which kind a room of a metric house may become, and how often.
KIND_CHANGES: dict[str, tuple[tuple[str, float], ...]] = {
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
WARE_KINDS = ("shop", "storage", "greenhouse", "gallery", "workshop")  # Every house has one,
WARE_KIND_SHARES = (0.4, 0.2, 0.15, 0.1, 0.15)
MANY_ROOMS = 8  # Number of rooms from which a house has two.
CONVERTIBLE_KINDS = ("children", "dining", "study", "office")  # of these, where it has one.
EXTRA_DESIGNS: dict[str, tuple[str, ...]] = {  # Further furniture of the metric kinds.
    "living": (
        "piano", "grand_piano", "fireplace", "aquarium", "bookcase", "display_cabinet",
        "grandfather_clock", "corner_sofa", "indoor_tree", "bust", "arc_lamp", "paper_lamp",
        "corner_sofa_leather", "corner_sofa_white", "cube_shelf", "planter_box", "armchair_white",
        "ottoman", "palm", "table_side", "vase", "stool_padded", "blanket_chest", "table_bar",
    ),
    "bed": (
        "vanity", "standing_mirror", "blanket_chest", "crib", "ottoman", "radiator", "armchair",
        "chair_padded", "chest_of_drawers", "palm", "paper_lamp", "bookcase_low", "lamp",
        "laundry_basket", "plant", "desk_white", "tv_stand", "stool_padded", "coat_stand",
    ),
    "kitchen": (
        "dishwasher", "fridge_double", "oven_tower", "pantry_rack", "pedal_bin", "radiator",
        "counter", "kitchen_island", "table_bistro", "stool_bar", "crate", "washer_dryer", "fern",
        "bench", "display_cabinet",
    ),
    "bathroom": (
        "towel_radiator", "laundry_basket", "shower_curtain", "fern", "stool", "pedal_bin",
        "washing_machine", "plant", "bench_stone", "vanity", "shower",
    ),
    "dining": (
        "display_cabinet", "sideboard", "table_console", "grandfather_clock", "fireplace", "plant",
        "vase", "bonsai", "piano", "cabinet", "bench", "plant_flowering", "table_side", "radiator",
        "bust", "arc_lamp", "aquarium",
    ),
    "study": (
        "bookcase", "armchair_wing", "filing_cabinet", "bust", "bookcase_low", "desk_partners",
        "radiator", "cactus", "lamp", "cube_shelf", "armchair_leather", "grandfather_clock",
        "sofa_two_seats", "plant", "table_side", "box", "stool_lab",
    ),
    "children": (
        "bunk_bed_pine", "crate", "bicycle", "cube_shelf", "chair_child", "box", "crib", "desk",
        "stool", "bookcase_low", "ottoman", "plant", "aquarium", "lamp", "chest_of_drawers",
        "single_bed_white", "blanket_chest",
    ),
    "office": (
        "locker", "filing_cabinet", "projector_screen", "desk_white", "office_chair", "cactus",
        "fir", "desk_drawers", "bookcase", "cabinet", "pedal_bin", "coat_stand", "table_trestle",
        "radiator", "sofa_armless", "plant", "arc_lamp",
    ),
    "hall": (
        "coat_stand", "shoe_rack", "table_console", "bicycle", "standing_mirror", "bench",
        "radiator", "plant", "chest_of_drawers", "grandfather_clock", "palm", "blanket_chest",
        "vase", "box", "stool",
    ),
}  # fmt: skip
EXTRAS = (4, 7)  # How many of them a room gets, at least and at most, where they fit.
SMALL_DESIGNS: dict[str, tuple[str, ...]] = {  # What is put on the tables and cupboards of a kind.
    "living": ("candles", "flowers", "table_lamp", "fern", "bonsai", "vase"),
    "bed": ("table_lamp", "candles", "flowers", "box", "fern", "tv_tube"),
    "kitchen": ("microwave", "flowers", "fern", "candles", "box"),
    "dining": ("candles", "flowers", "vase", "bonsai", "table_lamp"),
    "study": ("desk_lamp", "monitor", "monitor_wide", "bonsai", "table_lamp", "box"),
    "office": ("desk_lamp", "monitor", "monitor_wide", "cactus", "fern", "box"),
    "children": ("desk_lamp", "box", "monitor", "tv_tube", "fern"),
    "hall": ("flowers", "vase", "table_lamp", "candles", "fern"),
    "bathroom": ("candles", "flowers", "fern", "bonsai"),
}  # fmt: skip
SMALL_SHARE = 0.45  # Of the low tables and cupboards.
PICTURE_SHARE = 0.6  # Of the rooms.
CARRIERS = (int(SemanticClass.TABLE), int(SemanticClass.FURN))
LOW_M = 1.3  # What stands on a cupboard up to this height is visible.
SHELVES = {  # How many shelves hang in a room at most.
    "living": 2, "bed": 1, "children": 2, "office": 2, "study": 2, "dining": 1, "kitchen": 1,
    "hall": 2, "library": 1, "games": 1, "music": 1,
}  # fmt: skip
SHELF_M = 1.3


@dataclass(frozen=True)
class RecipeContext:
    """The room, furnisher and random generator of a recipe."""

    furnisher: Furnisher
    show: StandBuilder
    room: BlockRoom
    rng: np.random.Generator

    def one(self, *choices: str) -> str:
        """Return a random choice of several strings."""
        return choices[int(self.rng.integers(len(choices)))]

    def wall(self, *names: str, above_m: float | None = None) -> PlacedFurniture | None:
        """Place one of several designs at a wall, and return it or None."""
        scale = self.furnisher.house.blocks_per_metre
        above = None if above_m is None else round(above_m * scale)
        number = self.furnisher.put_at_wall(names, self.room, self.rng, above=above)
        return self.furnisher.of(number) if number else None

    def free(self, *names: str) -> PlacedFurniture | None:
        """Place one of several designs on the floor, and return it or None."""
        number = self.furnisher.put_free(names, self.room, self.rng)
        return self.furnisher.of(number) if number else None

    def hang(self, name: str, count: int) -> None:
        """Hang a row of ``count`` copies of a design from the ceiling."""
        for n in range(count):
            hang_one(self.furnisher, self.room, name, (n + 0.5) / count, self.rng)

    def on(self, thing: PlacedFurniture | None, *names: str) -> None:
        """Place one of several small designs on top of a piece of furniture, if it is not None."""
        if thing is not None:
            self.furnisher.put_on(names, thing, self.rng)

    def seats(self, table: PlacedFurniture | None, most: int, *names: str) -> None:
        """Place at most ``most`` seats of one design around a table, facing it."""
        if table is None:
            return
        name = self.one(*names)
        for turns in self.rng.permutation(4)[:most].tolist():
            found = self.furnisher.design(name, self.room, turns, self.rng)
            if found is None:
                return
            # A seat that looks along a turn stands on the other side of the table.
            axis, low = turns % 2, [0, 0, self.room.ground]
            sides = (found.size[0], found.size[2])
            low[axis] = table.low[axis] - sides[axis] if turns < 2 else table.high[axis]
            other = 1 - axis
            low[other] = (table.low[other] + table.high[other] - sides[other]) // 2
            self.furnisher.put(name, found, low, self.room, turns, ((0, 0), (1, 0), (0, 1)))

    def racks(self, count: int, boards: tuple[int, ...] | None = None) -> int:
        """Place ``count`` racks of one material along the walls.

        Returns:
            The number of decorative blocks on the racks.
        """
        board, held = self.one(*BOARDS), 0
        for _ in range(count):
            levels = (
                boards or ((0, 2, 4, 6), (0, 3, 5), (0, 2, 5), (1, 3, 5))[int(self.rng.integers(4))]
            )
            own = tuple(level for level in levels if level < self.room.height - 1)
            held += self.show.put_rack(self.room, own, board)
        return held


def _shop(task: RecipeContext) -> None:
    task.racks(4)
    counter = task.free("counter", "table_bar", "kitchen_island")
    pillar = task.one(*PILLARS, "barrel", "hay_block", "stripped_spruce_log[axis=y]")
    for _ in range(6):
        task.show.put_plinth(task.room, pillar, 2 + int(task.rng.integers(2)))
    task.wall("coffee_table_stone", "table_trestle", "table_side")
    if counter is not None:
        task.show.put_on(counter, most=2)
    task.show.put_bed(task.room)
    task.show.hang_on_walls(task.room, 6, 7)


def _storage(task: RecipeContext) -> None:
    task.racks(2, (0, 2, 4, 6))
    for _ in range(4):
        box = task.wall("crate", "box", "pantry_rack", "blanket_chest", "locker")
        if box is not None:
            task.show.put_on(box, most=1)
    for _ in range(5):
        task.show.put_plinth(task.room, task.one("barrel", "hay_block", "oak_planks"), 1)
    for _ in range(3):
        task.show.put_bed(task.room)
    task.show.hang_on_walls(task.room, 4, 6)


def _greenhouse(task: RecipeContext) -> None:
    rim = task.one(*RIMS)
    task.show.put_trough(task.room, rim, "water", (3, 4))
    for size in ((2, 5), (5, 2), (2, 4), (3, 3)):
        task.show.put_trough(task.room, rim, "soil", size)
    for _ in range(4):
        task.wall("indoor_tree", "palm", "fir", "cactus", "planter_box", "plant", "plant_flowering")
    task.wall("bench", "bench_stone")
    task.racks(1, (1, 4))
    task.hang("hanging_plant", 3)
    task.show.hang_from_ceiling(task.room, 8)


def _workshop(task: RecipeContext) -> None:
    bench = task.wall("table_trestle", "desk_drawers", "dining_table_steel")
    task.on(bench, "desk_lamp", "lantern_lamp")
    task.seats(bench, 1, "stool_lab", "stool")
    if bench is not None:
        task.show.put_on(bench, most=3)
    task.racks(2, (2, 4, 6))
    task.wall("locker", "filing_cabinet", "pantry_rack")
    task.wall("bicycle")
    for _ in range(5):
        task.show.put_plinth(task.room, task.one("smooth_stone", "oak_log[axis=y]"), 1)
    task.show.hang_on_walls(task.room, 8, 5)


def _library(task: RecipeContext) -> None:
    for _ in range(6):
        task.wall("bookcase", "bookcase", "bookcase_low", "cube_shelf", "display_cabinet")
    desk = task.free("desk_partners", "round_table", "desk")
    task.seats(desk, 2, "chair_carver", "chair_high_back", "office_chair_executive")
    task.on(desk, "table_lamp", "candles")
    chair = task.wall("armchair_wing", "armchair_leather")
    if chair is not None:
        task.wall("lamp", "arc_lamp", "paper_lamp")
    task.wall("bust", "vase", "grandfather_clock")
    task.racks(1, (3, 5))


def _music(task: RecipeContext) -> None:
    piano = task.free("grand_piano") or task.wall("piano")
    task.seats(piano, 1, "stool_piano")
    task.wall("sofa_chesterfield", "sofa_two_seats", "sofa_leather")
    for _ in range(3):
        task.wall("chair_padded", "armchair", "bust", "indoor_tree", "display_cabinet")
    task.wall("picture", "portrait", above_m=1.1)
    task.racks(1, (2, 4))


def _games(task: RecipeContext) -> None:
    task.free("pool_table", "table_tennis")
    bar = task.wall("table_bar", "counter")
    task.seats(bar, 2, "stool_bar")
    if bar is not None:
        task.show.put_on(bar, most=3)
    task.wall("sofa_wooden_arms", "sofa_armless", "bench")
    stand = task.wall("tv_stand", "sideboard")
    task.on(stand, "tv_tube", "tv_on_foot")
    task.show.hang_on_walls(task.room, 5, 6)


def _laundry(task: RecipeContext) -> None:
    for _ in range(3):
        task.wall("washing_machine", "washer_dryer", "washing_machine")
    task.wall("sink_unit", "pedestal_basin")
    for _ in range(2):
        task.wall("laundry_basket", "towel_radiator", "shoe_rack")
    task.racks(1, (5,))


def _cafe(task: RecipeContext) -> None:
    bar = task.wall("counter", "table_bar")
    task.seats(bar, 2, "stool_bar")
    if bar is not None:
        task.show.put_on(bar, most=4)
    for _ in range(4):
        table = task.free("table_bistro", "round_table_white", "round_table_dark", "picnic_table")
        task.seats(table, 3, "chair_cafe", "chair_white", "stool_padded")
        task.on(table, "candles", "flowers")
    task.racks(1, (3, 5))
    for _ in range(2):
        task.wall("display_cabinet", "plant", "palm")


def _gallery(task: RecipeContext) -> None:
    pillar = task.one(*PILLARS)
    for _ in range(14):
        task.show.put_plinth(task.room, pillar, 2 + int(task.rng.integers(3)))
    for _ in range(4):
        task.wall(*PICTURES, above_m=1.0)
    task.free("bench", "bench_stone", "ottoman")
    task.wall("bust", "vase", "standing_mirror")
    task.show.hang_on_walls(task.room, 6, 6)


BLOCK_RECIPES: dict[str, Callable[[RecipeContext], None]] = {
    "shop": _shop, "storage": _storage, "greenhouse": _greenhouse, "workshop": _workshop,
    "library": _library, "music": _music, "games": _games, "laundry": _laundry, "cafe": _cafe,
    "gallery": _gallery,
}  # fmt: skip


def assign_room_kinds(house: BlockHouse, rng: np.random.Generator) -> BlockHouse:
    """Change the kinds of some rooms, so that at least one displays decorative blocks."""
    rooms = []
    for room in house.rooms:
        kind, draw = room.kind, rng.random()
        for name, share in KIND_CHANGES.get(room.kind, ()):
            draw -= share
            if draw < 0:
                kind = name
                break
        rooms.append(replace(room, kind=kind))
    wanted = 1 + (len(rooms) >= MANY_ROOMS)
    for _ in range(wanted - sum(room.kind in WARE_KINDS for room in rooms)):
        changed = [room.number for room in rooms if room.kind in CONVERTIBLE_KINDS]
        if changed:
            number = changed[int(rng.integers(len(changed)))]
            kind = WARE_KINDS[int(rng.choice(len(WARE_KINDS), p=WARE_KIND_SHARES))]
            rooms[number] = replace(rooms[number], kind=kind)
    # A metric kind is furnished by the metric plan, which then must know of it.
    cells = tuple(
        replace(cell, kind=room.kind) if room.kind in KINDS else cell
        for cell, room in zip(house.plan.cells, rooms, strict=True)
    )
    return replace(house, rooms=tuple(rooms), plan=replace(house.plan, cells=cells))


def _lay_about(task: RecipeContext) -> None:
    """Place small designs and blocks on half of the low cupboards and tables of a room."""
    room, furnisher = task.room, task.furnisher
    small = SMALL_DESIGNS[room.kind]
    for thing in [thing for thing in furnisher.things if thing.room == room.number]:
        low = thing.high[2] - room.ground <= round(LOW_M * furnisher.house.blocks_per_metre)
        if thing.class_id not in CARRIERS or not low:
            continue
        if task.rng.random() < SMALL_SHARE:
            task.on(thing, *small)
        if task.rng.random() < SMALL_SHARE:
            task.show.put_on(thing, (HOME,), most=1 + int(task.rng.integers(2)))


def _high(task: RecipeContext) -> int:
    """Return the layer of a shelf at eye height."""
    return round(SHELF_M * task.furnisher.house.blocks_per_metre)


def add_furniture(task: RecipeContext, *, by_night: bool) -> None:
    """Add extra furniture, a picture, lamps and small blocks to a room of a metric kind."""
    room, rng = task.room, task.rng
    left = int(rng.integers(EXTRAS[0], EXTRAS[1] + 1))
    for name in task.furnisher.rarest_first(EXTRA_DESIGNS.get(room.kind, ()), rng):
        if left and task.wall(name):
            left -= 1
    if by_night:
        task.wall("lamp", "arc_lamp", "paper_lamp")
    _lay_about(task)
    if rng.random() < PICTURE_SHARE:
        task.wall(*PICTURES, above_m=1.0)
    if room.kind in ("living", "study", "hall", "children") and rng.random() < 0.5:
        task.show.hang_on_walls(room, 2, 6, home=True)
    if rng.random() < 0.2 and room.kind != "bathroom":
        task.wall("wall_shelf", above_m=1.3)
    if room.kind in ("living", "kitchen", "dining") and rng.random() < 0.5:
        task.hang("hanging_plant", 1)
    board = task.furnisher.looks[room.number].wood
    for _ in range(SHELVES.get(room.kind, 0)):
        if rng.random() < 0.75:
            task.show.put_rack(room, (_high(task),), board, most=10, home=True)
    if by_night or rng.random() < 0.4:
        task.wall("wall_lamp", above_m=1.4)

"""Recipes of the rooms that metric houses do not know: shops, winter gardens, workshops and more.

Each is a list of steps, tried in order; what finds no place is left out.
"""

from collections.abc import Callable

from world2minecraft.procgen.worlds.task import Task

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
# Which kind a room of a metric house may become, and how often.
PICTURES = ("picture", "portrait")


def _shop(task: Task) -> None:
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


def _storage(task: Task) -> None:
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


def _greenhouse(task: Task) -> None:
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


def _workshop(task: Task) -> None:
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


def _library(task: Task) -> None:
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


def _music(task: Task) -> None:
    piano = task.free("grand_piano") or task.wall("piano")
    task.seats(piano, 1, "stool_piano")
    task.wall("sofa_chesterfield", "sofa_two_seats", "sofa_leather")
    for _ in range(3):
        task.wall("chair_padded", "armchair", "bust", "indoor_tree", "display_cabinet")
    task.wall("picture", "portrait", above_m=1.1)
    task.racks(1, (2, 4))


def _games(task: Task) -> None:
    task.free("pool_table", "table_tennis")
    bar = task.wall("table_bar", "counter")
    task.seats(bar, 2, "stool_bar")
    if bar is not None:
        task.show.put_on(bar, most=3)
    task.wall("sofa_wooden_arms", "sofa_armless", "bench")
    stand = task.wall("tv_stand", "sideboard")
    task.on(stand, "tv_tube", "tv_on_foot")
    task.show.hang_on_walls(task.room, 5, 6)


def _laundry(task: Task) -> None:
    for _ in range(3):
        task.wall("washing_machine", "washer_dryer", "washing_machine")
    task.wall("sink_unit", "pedestal_basin")
    for _ in range(2):
        task.wall("laundry_basket", "towel_radiator", "shoe_rack")
    task.racks(1, (5,))


def _cafe(task: Task) -> None:
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


def _gallery(task: Task) -> None:
    pillar = task.one(*PILLARS)
    for _ in range(14):
        task.show.put_plinth(task.room, pillar, 2 + int(task.rng.integers(3)))
    for _ in range(4):
        task.wall(*PICTURES, above_m=1.0)
    task.free("bench", "bench_stone", "ottoman")
    task.wall("bust", "vase", "standing_mirror")
    task.show.hang_on_walls(task.room, 6, 6)


OWN: dict[str, Callable[[Task], None]] = {
    "shop": _shop, "storage": _storage, "greenhouse": _greenhouse, "workshop": _workshop,
    "library": _library, "music": _music, "games": _games, "laundry": _laundry, "cafe": _cafe,
    "gallery": _gallery,
}  # fmt: skip

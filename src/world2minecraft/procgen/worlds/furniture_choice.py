"""Choice of library designs and their materials for items of a layout.

A layout contains, for example, a sofa, and the library has eleven designs for it. A random design
is chosen, so that a series of houses shows all of them, with the wood, cloth and stone of the room.
"""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from world2minecraft.furniture.block_designs import BlockDesign
from world2minecraft.furniture.materials import (
    Material,
    Swatch,
    kinds,
    list_swatches,
    shape_of,
    with_swatch,
)
from world2minecraft.furniture.template import Template
from world2minecraft.procgen.worlds.styles import RoomLook

# The designs that can represent an item of a layout, by the name of the item.
DESIGNS: dict[str, tuple[str, ...]] = {
    "armchair": (
        "armchair", "armchair_leather", "armchair_white", "armchair_wing", "armchair_wooden_arms",
    ),
    "bath_cabinet": ("wall_cabinet_glass", "wall_cabinet", "wall_mirror"),
    "bathtub": ("bathtub", "bathtub_freestanding"),
    "bed": (
        "double_bed", "double_bed_boxed", "double_bed_king", "double_bed_low", "poster_bed",
    ),
    "narrow_bed": (
        "single_bed", "single_bed_boxed", "single_bed_footboard", "single_bed_white", "bunk_bed",
        "bunk_bed_pine",
    ),
    "bench": ("bench", "bench_stone", "ottoman", "blanket_chest"),
    "bin": ("pedal_bin", "laundry_basket"),
    "bookshelf": ("bookcase", "bookcase_low", "cube_shelf", "display_cabinet"),
    "box": ("box", "crate"),
    "cat_tree": ("coat_stand", "pantry_rack"),
    "chair": (
        "chair", "chair_cafe", "chair_carver", "chair_high_back", "chair_padded", "chair_white",
    ),
    "child_chair": ("chair_child", "stool", "stool_padded"),
    "coats": ("coat_stand", "standing_mirror"),
    "coffee_table": (
        "coffee_table", "coffee_table_round", "coffee_table_stone", "coffee_table_white",
    ),
    "counter": ("counter",),
    "cupboard": ("cabinet", "display_cabinet", "chest_of_drawers", "grandfather_clock"),
    "curtain": ("curtain_single", "curtain_sheer"),
    "desk": ("desk", "desk_drawers", "desk_partners", "desk_white"),
    "dining_table": (
        "dining_table", "dining_table_dark", "dining_table_stone", "dining_table_white",
        "table_trestle", "dining_table_steel",
    ),
    "dresser": ("chest_of_drawers", "sideboard", "vanity", "cabinet"),
    "easel": ("standing_mirror", "bust"),
    "filing_cabinet": ("filing_cabinet", "locker"),
    "floor_lamp": ("lamp", "paper_lamp", "arc_lamp"),
    "floor_vase": ("vase", "plant_flowering", "bust"),
    "fridge": ("fridge", "fridge_double"),
    "gym_ball": ("ottoman",),
    "hood": ("range_hood",),
    "kitchen_table": (
        "round_table", "round_table_dark", "round_table_white", "table_bistro", "table_bar",
        "dining_table", "dining_table_steel", "kitchen_island",
    ),
    "laundry": ("laundry_basket",),
    "microwave": ("microwave",),
    "mirror": ("wall_mirror",),
    "monitor": ("monitor", "monitor_wide"),
    "nightstand": ("nightstand", "table_side"),
    "office_chair": ("office_chair", "office_chair_executive", "office_chair_mesh"),
    "oven": ("stove", "dishwasher", "oven_tower"),
    "pendant": ("pendant_lamp", "globe_lamp", "lantern_lamp"),
    "picture": ("picture", "portrait"),
    "plant": ("plant", "plant_flowering", "indoor_tree", "palm", "fir", "cactus", "bonsai"),
    "play_table": ("table_side", "coffee_table", "coffee_table_round"),
    "potted_plant": ("fern", "flowers", "bonsai"),
    "printer": ("microwave",),
    "rocking_horse": ("stool_padded", "chair_child"),
    "rug": ("rug", "rug_checked", "rug_round", "rug_striped"),
    "sculpture": ("bust", "vase"),
    "shoe_cabinet": ("shoe_rack", "blanket_chest", "table_console", "cabinet"),
    "shower": ("shower",),
    "sideboard": ("sideboard", "bookcase_low", "chest_of_drawers"),
    "sink_counter": ("sink_unit",),
    "sofa": (
        "sofa", "sofa_armless", "sofa_chesterfield", "sofa_leather", "sofa_two_seats",
        "sofa_white", "sofa_wooden_arms",
    ),
    "stool": ("stool", "stool_padded", "stool_lab", "stool_piano", "stool_bar"),
    "table_lamp": ("table_lamp", "desk_lamp", "candles"),
    "teddy": ("box",),
    "toilet": ("toilet",),
    "towel": ("towel_radiator",),
    "toy_shelf": ("cube_shelf", "bookcase_low"),
    "tv": ("wall_tv", "tv_on_foot", "tv_on_foot", "tv_tube"),
    "tv_board": ("tv_stand", "sideboard"),
    "vase": ("flowers", "fern", "candles"),
    "wall_cabinet": ("wall_cabinet", "wall_cabinet_glass", "wall_shelf"),
    "wardrobe": ("wardrobe", "wardrobe_panels", "wardrobe_sliding"),
    "washing_machine": ("washing_machine", "washer_dryer"),
    "washstand": ("pedestal_basin", "vanity", "sink_unit"),
    "whiteboard": ("projector_screen",),
}  # fmt: skip
# Items of a layout that look the same within a room, such as the chairs at one table.
ALIKE = ("chair", "stool", "nightstand", "wall_cabinet", "office_chair", "counter")
# The most of a design that a room has. The limit of all others is 1.
MOST_A_ROOM: dict[str, int] = {
    **dict.fromkeys(DESIGNS["chair"] + DESIGNS["stool"] + DESIGNS["child_chair"], 8),
    **dict.fromkeys(DESIGNS["office_chair"] + DESIGNS["desk"], 4),
    **dict.fromkeys(DESIGNS["curtain"] + DESIGNS["rug"] + DESIGNS["bookshelf"], 4),
    **dict.fromkeys(("ceiling_lamp", "pendant_lamp", "globe_lamp", "lantern_lamp"), 3),
    **dict.fromkeys(("curtain", "roller_blind", "venetian_blind", "counter", "locker"), 4),
    **dict.fromkeys(DESIGNS["wall_cabinet"] + DESIGNS["nightstand"], 2),
    **dict.fromkeys(DESIGNS["armchair"] + DESIGNS["narrow_bed"] + DESIGNS["kitchen_table"], 2),
    **dict.fromkeys(("crate", "box", "hanging_plant", "washing_machine", "planter_box"), 2),
}
# Groups of designs of which a room has at most one.
ONE_OF: tuple[tuple[str, ...], ...] = (
    ("picture", "portrait", "wall_mirror"),
    ("standing_mirror", "vanity"),
    ("radiator", "towel_radiator"),
    DESIGNS["tv"],
)
ACCENT_SHARE = 0.6  # Probability of a room's accent for upholstery; else it is neutral.
PLAIN = ("curtain", "curtain_sheer", "curtain_single", "shower_curtain")  # Always neutral.


def designs_for(name: str, size_m: Sequence[float]) -> tuple[str, ...]:
    """Return the names of the designs for an item of a layout, if there are any."""
    depth, width, height = size_m
    if name == "bed" and min(depth, width) < 1.3:
        name = "narrow_bed"
    if name in ("chair", "stool") and height < 0.62 and width < 0.4:
        name = "child_chair"
    return DESIGNS.get(name, ())


def room_allows(name: str, placed: Counter[str]) -> bool:
    """Return whether a room that holds some designs may get another one of a name."""
    if placed[name] >= MOST_A_ROOM.get(name, 1):
        return False
    return not any(name in group and any(placed[one] for one in group) for group in ONE_OF)


def recolour_design(
    design: BlockDesign, template: Template, look: RoomLook, rng: np.random.Generator
) -> BlockDesign:
    """Return a design whose recolourable materials are replaced by those of the room."""
    blocks = list(design.blocks)
    values: dict[str, str] = {}
    for role in sorted({block.role for block in blocks}):
        material = template.materials.get(role)
        if material is None or material.kind not in kinds():
            continue
        border = template.family == "rug" and not material.takes_colour
        if not (material.takes_colour or border):
            continue
        own = [n for n, block in enumerate(blocks) if block.role == role]
        shapes = frozenset(
            shape for n in own if (shape := shape_of(blocks[n].state, material.kind))
        )
        if border:
            value = look.second_cloth
        else:
            value = values.setdefault(material.kind, _value(material, template, look, rng))
        swatch = next((s for s in find_swatches(material.kind, shapes) if s.value == value), None)
        for n in own:
            shape = shape_of(blocks[n].state, material.kind)
            if shape and swatch:
                blocks[n] = blocks[n]._replace(state=with_swatch(blocks[n].state, shape, swatch))
    return BlockDesign(tuple(blocks), design.size, design.materials)


def find_swatches(kind: str, shapes: frozenset[str]) -> tuple[Swatch, ...]:
    """Return the materials of a kind that have all the given shapes.

    The result includes materials that are never chosen by colour.
    """
    offered = {s.value: s for s in list_swatches(kind, shapes)}
    for value, blocks in kinds()[kind].blocks.items():
        if value not in offered and shapes <= set(blocks):
            offered[value] = Swatch(kind, value, blocks["full"])
    return tuple(offered.values())


def _value(material: Material, made: Template, look: RoomLook, rng: np.random.Generator) -> str:
    accented = rng.random() < ACCENT_SHARE or made.family == "rug"
    accented &= made.name not in PLAIN
    cloth = look.cloth if accented else look.second_cloth
    return {
        "wood": look.wood,
        "cloth": cloth,
        "paint": cloth,
        "stone": look.stone,
    }.get(material.kind, material.value)

"""Furniture families: shapes shared by many designs, as metric parts and as vanilla blocks.

A design is a small data file that names its family and defines sizes, parameters, options and
materials (``design_files``). The family, an object in ``families/``, builds parts and blocks from
them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from world2minecraft.core.registry import Registry
from world2minecraft.furniture.template import Build, Design, Span

_FOLDER = "world2minecraft.furniture.families"


@dataclass(frozen=True, eq=False)
class Family:
    """A furniture shape with parameters and options.

    build: Function from a depth, width, height and look to metric parts.
    design: Function from a size and look to vanilla blocks, or an empty list if parts are better.
    roles: Roles of the parts and blocks, for which a design must define materials.
    parameters: Ranges of the parameters of ``build`` and ``design``. A design may narrow them.
    options: Valid words for each option, of which the first is the default.
    """

    build: Build
    design: Design
    roles: tuple[str, ...]
    parameters: Mapping[str, Span] = field(default_factory=dict)
    options: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


FAMILIES = Registry(
    "furniture family",
    {
        "chair": f"{_FOLDER}.chairs:CHAIR",
        "office_chair": f"{_FOLDER}.chairs:OFFICE_CHAIR",
        "stool": f"{_FOLDER}.chairs:STOOL",
        "pedestal_stool": f"{_FOLDER}.chairs:PEDESTAL_STOOL",
        "armchair": f"{_FOLDER}.sofas:ARMCHAIR",
        "sofa": f"{_FOLDER}.sofas:SOFA",
        "corner_sofa": f"{_FOLDER}.sofas:CORNER_SOFA",
        "bench": f"{_FOLDER}.sofas:BENCH",
        "single_bed": f"{_FOLDER}.beds:SINGLE_BED",
        "double_bed": f"{_FOLDER}.beds:DOUBLE_BED",
        "bunk_bed": f"{_FOLDER}.beds:BUNK_BED",
        "poster_bed": f"{_FOLDER}.beds:POSTER_BED",
        "crib": f"{_FOLDER}.beds:CRIB",
        "table": f"{_FOLDER}.tables:TABLE",
        "low_table": f"{_FOLDER}.tables:LOW_TABLE",
        "round_table": f"{_FOLDER}.tables:ROUND_TABLE",
        "desk": f"{_FOLDER}.tables:DESK",
        "game_table": f"{_FOLDER}.tables:GAME_TABLE",
        "net_table": f"{_FOLDER}.tables:NET_TABLE",
        "picnic_table": f"{_FOLDER}.tables:PICNIC_TABLE",
        "wall_screen": f"{_FOLDER}.screens:WALL_SCREEN",
        "standing_screen": f"{_FOLDER}.screens:STANDING_SCREEN",
        "box_screen": f"{_FOLDER}.screens:BOX_SCREEN",
        "cupboard": f"{_FOLDER}.cases:CASE",
        "glass_case": f"{_FOLDER}.cases:CASE",
        "lidded_chest": f"{_FOLDER}.cases:CASE",
        "bookcase": f"{_FOLDER}.shelving:BOOKCASE",
        "cube_shelf": f"{_FOLDER}.shelving:CUBES",
        "boards": f"{_FOLDER}.shelving:BOARDS",
        "counter": f"{_FOLDER}.kitchen:COUNTER",
        "sink": f"{_FOLDER}.kitchen:SINK",
        "stove": f"{_FOLDER}.kitchen:STOVE",
        "fridge": f"{_FOLDER}.kitchen:FRIDGE",
        "oven_tower": f"{_FOLDER}.kitchen:TOWER",
        "hood": f"{_FOLDER}.kitchen:HOOD",
        "island": f"{_FOLDER}.kitchen:ISLAND",
        "appliance": f"{_FOLDER}.kitchen:APPLIANCE",
        "bin": f"{_FOLDER}.kitchen:BIN",
        "toilet": f"{_FOLDER}.bath:TOILET",
        "tub": f"{_FOLDER}.bath:TUB",
        "basin": f"{_FOLDER}.bath:BASIN",
        "shower": f"{_FOLDER}.bath:SHOWER",
        "lamp": f"{_FOLDER}.lights:LAMP",
        "desk_lamp": f"{_FOLDER}.lights:DESK_LAMP",
        "arc_lamp": f"{_FOLDER}.lights:ARC_LAMP",
        "pendant": f"{_FOLDER}.lights:PENDANT",
        "chandelier": f"{_FOLDER}.lights:CHANDELIER",
        "wall_lamp": f"{_FOLDER}.lights:WALL_LAMP",
        "glow_lamp": f"{_FOLDER}.lights:GLOW",
        "plant": f"{_FOLDER}.greenery:PLANT",
        "tree": f"{_FOLDER}.greenery:TREE",
        "cactus": f"{_FOLDER}.greenery:CACTUS",
        "potted": f"{_FOLDER}.greenery:POTTED",
        "planter": f"{_FOLDER}.greenery:PLANTER",
        "hanging_plant": f"{_FOLDER}.greenery:HANGING",
        "bonsai": f"{_FOLDER}.greenery:BONSAI",
        "curtain": f"{_FOLDER}.hangings:CURTAIN",
        "blind": f"{_FOLDER}.hangings:BLIND",
        "framed": f"{_FOLDER}.hangings:FRAMED",
        "wall_mirror": f"{_FOLDER}.hangings:WALL_MIRROR",
        "ribbed": f"{_FOLDER}.hangings:RIBBED",
        "standing_mirror": f"{_FOLDER}.hangings:STANDING_MIRROR",
        "rug": f"{_FOLDER}.hangings:RUG",
        "fireplace": f"{_FOLDER}.decor:FIREPLACE",
        "tall_clock": f"{_FOLDER}.decor:TALL_CLOCK",
        "aquarium": f"{_FOLDER}.decor:AQUARIUM",
        "on_plinth": f"{_FOLDER}.decor:ON_PLINTH",
        "upright_piano": f"{_FOLDER}.decor:UPRIGHT_PIANO",
        "grand_piano": f"{_FOLDER}.decor:GRAND_PIANO",
        "bicycle": f"{_FOLDER}.decor:BICYCLE",
        "coat_stand": f"{_FOLDER}.decor:COAT_STAND",
        "stack": f"{_FOLDER}.decor:STACK",
        "candles": f"{_FOLDER}.decor:CANDLES",
        "box": f"{_FOLDER}.decor:BOX",
    },
)

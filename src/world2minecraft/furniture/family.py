"""A family: the shape that many designs share, as metric parts and as vanilla blocks.

A design is a small data file that names its family and gives it sizes, parameters, options and
materials (``reading.py``); the family, one value in ``families/``, makes of them what stands there.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from world2minecraft.furniture.template import Build, Design, Span
from world2minecraft.registry import Registry

_FOLDER = "world2minecraft.furniture.families"


@dataclass(frozen=True, eq=False)
class Family:
    """One shape with parameters and options.

    build: metric parts of a given depth, width, height and look.
    design: vanilla blocks of a given size and look; an empty list where the parts are better.
    roles: what a design must give a material: the roles of its parts and blocks.
    parameters: the spans of what ``build`` and ``design`` read; a design may narrow them.
    options: for each choice the words it may be; the first is meant where a design says nothing.
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
        "armchair": f"{_FOLDER}.sofas:ARMCHAIR",
        "sofa": f"{_FOLDER}.sofas:SOFA",
        "corner_sofa": f"{_FOLDER}.sofas:CORNER_SOFA",
        "bench": f"{_FOLDER}.sofas:BENCH",
        "single_bed": f"{_FOLDER}.beds:SINGLE_BED",
        "double_bed": f"{_FOLDER}.beds:DOUBLE_BED",
        "bunk_bed": f"{_FOLDER}.beds:BUNK_BED",
        "table": f"{_FOLDER}.tables:TABLE",
        "low_table": f"{_FOLDER}.tables:LOW_TABLE",
        "round_table": f"{_FOLDER}.tables:ROUND_TABLE",
        "desk": f"{_FOLDER}.tables:DESK",
        "wall_screen": f"{_FOLDER}.screens:WALL_SCREEN",
        "standing_screen": f"{_FOLDER}.screens:STANDING_SCREEN",
        "cupboard": f"{_FOLDER}.cupboards:CUPBOARD",
        "counter": f"{_FOLDER}.cupboards:COUNTER",
        "bookcase": f"{_FOLDER}.cupboards:BOOKCASE",
        "lamp": f"{_FOLDER}.small_things:LAMP",
        "plant": f"{_FOLDER}.small_things:PLANT",
        "box": f"{_FOLDER}.small_things:BOX",
    },
)

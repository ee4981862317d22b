"""Colours for what a plan names: RoomPlan measures shapes alone, so these are only plausible.

They part furniture from floor and walls, which one colour of wood for all would not.
"""

from world2minecraft.core.classes import SemanticClass

Colour = tuple[int, int, int]
STRUCTURE: dict[int, Colour] = {
    int(SemanticClass.FLOOR): (188, 166, 134),
    int(SemanticClass.WALL): (236, 233, 226),
    int(SemanticClass.CEILING): (246, 245, 242),
    int(SemanticClass.WINDOW): (176, 205, 224),
}
DOOR: Colour = (150, 112, 74)
OTHER: Colour = (150, 146, 140)
THINGS: dict[str, Colour] = {
    "storage": (120, 84, 56),
    "refrigerator": (226, 228, 230),
    "stove": (206, 207, 208),
    "bed": (206, 212, 222),
    "sink": (232, 234, 236),
    "washerDryer": (232, 233, 235),
    "toilet": (240, 240, 240),
    "bathtub": (240, 240, 240),
    "oven": (60, 60, 64),
    "dishwasher": (214, 216, 218),
    "table": (128, 82, 48),
    "sofa": (84, 104, 124),
    "chair": (78, 54, 38),
    "fireplace": (140, 78, 62),
    "television": (24, 24, 27),
    "stairs": (146, 108, 74),
    # RoomPlan knows none of these; other plans do.
    "curtain": (196, 186, 172),
    "lamp": (238, 226, 196),
    "mirror": (190, 208, 214),
    "picture": (170, 140, 100),
    "plant": (76, 122, 62),
    "rug": (146, 92, 84),
}


def colour_of(category: str) -> Colour:
    """Return the colour of a thing by RoomPlan's category."""
    return THINGS.get(category, OTHER)

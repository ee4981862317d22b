"""Mapping of RoomPlan's furniture categories to classes and templates."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import nearest_quarter_turns
from world2minecraft.core.types import OWN_CELLS
from world2minecraft.formats.roomplan import PlanObject

CHAIR, BED, SOFA = SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA
TABLE, TVS, FURN, OBJS = (
    SemanticClass.TABLE,
    SemanticClass.TVS,
    SemanticClass.FURN,
    SemanticClass.OBJS,
)
CLASSES = {
    "storage": FURN,
    "refrigerator": FURN,
    "stove": FURN,
    "bed": BED,
    "sink": FURN,
    "washerDryer": FURN,
    "toilet": FURN,
    "bathtub": FURN,
    "oven": FURN,
    "dishwasher": FURN,
    "table": TABLE,
    "sofa": SOFA,
    "chair": CHAIR,
    "fireplace": FURN,
    "television": TVS,
    "stairs": OBJS,
}
HUNG_FROM_M = 0.6  # Objects whose bottom is higher hang on a wall.
TALL_M, DEEP_M = 1.4, 0.42  # Wardrobes are deeper than bookcases.


def class_of(item: PlanObject) -> int:
    """Return the class of a plan object; unknown categories are ``objs``."""
    return int(CLASSES.get(item.category, OBJS))


def template_of(item: PlanObject, floor_z_m: float) -> str:
    """Return the name of the template for a plan object, by category, attributes and size."""
    if item.design:
        return item.design
    depth, width, height = item.size_m.tolist()
    bottom = float(item.center_m[2]) - height / 2 - floor_z_m
    words = " ".join(sorted(item.words)).lower()
    choose = {
        "storage": lambda: _storage(depth, width, height, bottom, words),
        "refrigerator": lambda: "fridge_double" if width > 0.8 else "fridge",
        "stove": lambda: "stove",
        "oven": lambda: "oven_tower" if bottom + height > 1.3 else "stove",
        "bed": lambda: _bed(width, height),
        "sink": lambda: "vanity" if bottom < 0.3 else OWN_CELLS,
        "washerDryer": lambda: "washer_dryer" if height > 1.3 else "washing_machine",
        "toilet": lambda: "toilet",
        "bathtub": lambda: "bathtub",
        "dishwasher": lambda: "dishwasher",
        "table": lambda: _table(depth, width, height, words),
        "sofa": lambda: _sofa(depth, width, height, words),
        "chair": lambda: _chair(width, height, words),
        "fireplace": lambda: "fireplace",
        "television": lambda: "wall_tv" if bottom > HUNG_FROM_M else "tv_on_foot",
    }
    return choose[item.category]() if item.category in choose else OWN_CELLS


def front_of(item: PlanObject, walls: list[tuple[np.ndarray, np.ndarray]]) -> int:
    """Return the quarter turns of a plan object's front.

    If the front faces a nearby wall, the object is turned around to face away from it.

    Args:
        item: Plan object, whose yaw gives the direction of its front in RoomPlan's convention.
        walls: Start and end, float64 [2] each, of the walls of its room.
    """
    turns = nearest_quarter_turns(item.yaw_deg)
    if item.design:
        return turns
    ahead = np.array([np.cos(np.radians(90 * turns)), np.sin(np.radians(90 * turns))])
    half = item.size_m[0] / 2
    before, behind = (
        _wall_distance(item.center_m[:2] + sign * half * ahead, walls) for sign in (1, -1)
    )
    backwards = item.category not in ("table", "chair") and before < 0.15 and behind > before + 0.3
    return (turns + 2) % 4 if backwards else turns


def _wall_distance(point: np.ndarray, walls: list[tuple[np.ndarray, np.ndarray]]) -> float:
    away = [np.inf]
    for start, end in walls:
        along = end - start
        share = np.clip((point - start) @ along / max(float(along @ along), 1e-9), 0, 1)
        away.append(float(np.linalg.norm(point - start - share * along)))
    return min(away)


def _storage(depth: float, width: float, height: float, bottom: float, words: str) -> str:
    if bottom > HUNG_FROM_M:
        return "wall_shelf" if "shelf" in words else "wall_cabinet"
    if height > TALL_M:
        return "bookcase" if depth < DEEP_M or "shelf" in words else "wardrobe"
    if "shelf" in words:
        return "bookcase_low"
    if 0.8 <= height <= 1.05 and depth > 0.5 and width > 0.5:
        return "counter"
    if height < 0.65 and width < 0.7:
        return "nightstand"
    return "sideboard" if width > 1.3 and height < 1.0 else "cabinet"


def _bed(width: float, height: float) -> str:
    if height > 1.4:
        return "bunk_bed"
    return "double_bed" if width > 1.25 else "single_bed"


def _table(depth: float, width: float, height: float, words: str) -> str:
    if height < 0.58 or "coffee" in words:
        return "coffee_table"
    if "circular" in words or "elliptic" in words:
        return "round_table"
    return "desk" if min(depth, width) < 0.75 and max(depth, width) > 0.95 else "dining_table"


def _sofa(depth: float, width: float, height: float, words: str) -> str:
    if height < 0.5:
        return "ottoman"
    corner = "lshaped" in words or "sectional" in words
    return "corner_sofa" if corner or (depth > 1.35 and width > 1.7) else "sofa"


def _chair(width: float, height: float, words: str) -> str:
    if "stool" in words or height < 0.6:
        return "stool"
    if "swivel" in words:
        return "office_chair"
    return "armchair" if width > 0.7 else "chair"

"""Selection of furniture designs for layout objects by their names.

The longest known words at the end of a name determine the design. Without a known word, class and
size determine it, and otherwise the object is built as a plain box.
"""

import re
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.files import read_json
from world2minecraft.core.types import OWN_CELLS, LayoutObject
from world2minecraft.formats.roomplan import PlanObject
from world2minecraft.reconstruction.floorplans.furniture_categories import (
    HUNG_FROM_M,
    template_of,
)

TABLE = Path(__file__).parent / "data" / "designs.json"
# RoomPlan's category of each class, for objects without a known word.
CATEGORIES = {
    SemanticClass.CHAIR: "chair",
    SemanticClass.BED: "bed",
    SemanticClass.SOFA: "sofa",
    SemanticClass.TABLE: "table",
    SemanticClass.TVS: "television",
    SemanticClass.FURN: "storage",
}


class Design(NamedTuple):
    """A furniture template, or ``cells``, and the category that determines its colour."""

    template: str
    category: str


@lru_cache(maxsize=1)
def designs() -> dict[str, Design]:
    """Return the designs by the words that identify them."""
    return {word: Design(*pair) for word, pair in read_json(TABLE).items()}


def design_of(item: LayoutObject, floor_z_m: float = 0.0) -> Design:
    """Return the furniture design for an object.

    Example:
        >>> import numpy as np
        >>> wide = LayoutObject(6, np.zeros(3), np.array([2.0, 1.6, 0.5]), 0.0, "children_bed_2")
        >>> design_of(wide).template
        'double_bed'
    """
    category = CATEGORIES.get(SemanticClass(item.class_id), "")
    known = _named(item.name)
    if known is not None:
        # The class decides the category, so that the built object counts as the stated class.
        return known if not category else Design(known.template, category)
    if not category:
        return Design(OWN_CELLS, _hint(item, floor_z_m))
    thing = PlanObject(category, item.center_m, item.size_m, item.yaw_deg)
    return Design(template_of(thing, floor_z_m), category)


def _named(name: str) -> Design | None:
    words = re.findall(r"[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
    for length in (2, 1):
        for start in range(len(words) - length, -1, -1):
            found = designs().get("_".join(words[start : start + length]))
            if found is not None:
                return found
    return None


def _hint(item: LayoutObject, floor_z_m: float) -> str:
    """Return the category of an unknown object, which is "lamp" or ""."""
    bottom_m = float(item.center_m[2] - item.size_m[2] / 2) - floor_z_m
    lit = "lamp" in item.name.lower() or "light" in item.name.lower()
    return "lamp" if lit or bottom_m > 3 * HUNG_FROM_M else ""

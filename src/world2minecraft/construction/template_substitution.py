"""Library templates for objects that are not recognizable at few blocks per metre.

Built from its cells at two blocks per metre, a sofa is a wall with a dent and a plant a green box.
A design of about the same size is recognizable.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.construction.colour_sources import ColourSamples, ColourSource
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OWN_CELLS, Placement
from world2minecraft.furniture import Span, Template, template, templates_of_class

# What people know by its shape; a cupboard is known by its place and colour.
KNOWN_BY_SHAPE = tuple(SemanticClass[name] for name in ("CHAIR", "BED", "SOFA", "TABLE"))
SLACK = 0.15  # By what share a side may lie beyond the sizes of a design.
PLANT = "plant"
GREEN_HUE_DEG, GREEN_CHROMA = (105.0, 165.0), 0.04  # Oklab; leaves in sun and shade.


def substitute_templates(
    placements: Sequence[Placement],
    cells_of: Callable[[Placement], np.ndarray],
    colour_source: ColourSource,
) -> list[Placement]:
    """Replace placements whose own cells are not recognizable with library designs.

    Args:
        placements: Placements of a whole room.
        cells_of: Function that returns the cells, int [N, 3], of a placement.
        colour_source: Colours of the cells.
    """
    count = Counter(one.object_id for one in placements)
    renewed = []
    for one in placements:
        cells = cells_of(one)
        colours, usable = colour_source.colours_of(ColourSamples(cells, cells))
        colour = np.median(colours[usable], axis=0) if usable.any() else None
        renewed.append(substitute_template(one, count[one.object_id] == 1, colour))
    return renewed


def substitute_template(placement: Placement, alone: bool, colour: np.ndarray | None) -> Placement:
    """Return a placement with a design of its class if its own cells would not be recognizable.

    Args:
        placement: A placement; only those built from cells are changed.
        alone: Whether it is the only placement of its object.
        colour: Oklab colour of its cells, float [3], or None if unknown.
    """
    if placement.template != OWN_CELLS or not alone:
        return placement
    offered = [one for one in _candidates(placement.class_id, colour) if _fits(one, placement)]
    if not offered:
        return placement
    ious = {other.template: other.iou for other in reversed(placement.alternatives)}
    best = max(offered, key=lambda one: (ious.get(one.name, 0.0), one.name))
    return replace(placement, template=best.name, parameters={})


def _candidates(class_id: int, colour: np.ndarray | None) -> Sequence[Template]:
    if class_id in KNOWN_BY_SHAPE:
        return templates_of_class(class_id)
    return (template(PLANT),) if class_id == SemanticClass.OBJS and is_green(colour) else ()


def is_green(colour: np.ndarray | None) -> bool:
    """Return whether an Oklab colour, float [3], is that of leaves."""
    if colour is None:
        return False
    hue = float(np.degrees(np.arctan2(colour[2], colour[1])))
    low, high = GREEN_HUE_DEG
    return bool(low <= hue <= high and np.hypot(colour[1], colour[2]) >= GREEN_CHROMA)


def _fits(one: Template, placement: Placement) -> bool:
    return all(_holds(*pair) for pair in zip(one.size_m, placement.size_m.tolist(), strict=True))


def _holds(span: Span, side: float) -> bool:
    return (1 - SLACK) * span.minimum <= side <= (1 + SLACK) * span.maximum

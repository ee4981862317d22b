"""Every design of the library is chosen for the object that it shows."""

from dataclasses import replace

import numpy as np
import pytest
from label_grids import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import ObjectInstance, OccupancyGrid
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.furniture import TEMPLATES, Template, template, template_cells
from world2minecraft.reconstruction.retrieval import place_templates

BOTTOMS = {"wall": 15, "ceiling": 30}  # Others begin above the floor, in layer 1.
# Designs with the shape, size and name of another that comes first, and no colour of their own.
SAME_AS = {
    "monitor_wide": "monitor",
    "single_bed_boxed": "single_bed",
    "wall_cabinet_glass": "wall_cabinet",
}


def shown(one: Template) -> tuple[OccupancyGrid, ObjectInstance]:
    """Return a room with a design of typical size in its colour, and the named object there."""
    labels = np.zeros((60, 70, 50), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[7] = SemanticClass.WALL
    cells = template_cells(one, one.typical_m, shift=(8, 14, BOTTOMS.get(one.mount, 1)))
    if one.mount == "ceiling":
        labels[:, :, cells[:, 2].max() + 1] = SemanticClass.CEILING
    at = tuple(cells.T)
    labels[at] = one.class_id
    grid = grid_of(labels)
    colour, instance = grid.colour.copy(), grid.instance.copy()
    colour[at] = one.suits[0] if one.suits else 0
    instance[at] = 1
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    middle_m = grid.origin_m + (low + high) / 2 * grid.voxel_m
    size_m = (high - low) * grid.voxel_m
    found = ObjectInstance(1, one.class_id, middle_m, size_m, 0.0, cells.astype(np.int32), 1.0)
    entry = read_vocabulary().of_template(one.name)
    if entry is not None:
        found = replace(found, name=entry.name, name_confidence=0.95)
    return replace(grid, colour=colour, instance=instance), found


@pytest.mark.parametrize("name", TEMPLATES.names())
def test_a_design_is_chosen_for_what_it_shows(name):
    grid, found = shown(template(name))
    (placed,) = place_templates(grid, (found,))
    assert placed.template == SAME_AS.get(name, name)

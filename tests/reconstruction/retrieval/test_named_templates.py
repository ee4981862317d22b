"""Templates by name: of those that fit about as well, the one that shows what the object is."""

from dataclasses import replace

import numpy as np
import pytest
from label_grids import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.furniture import template, template_cells
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates
from world2minecraft.reconstruction.retrieval.furniture_placement import named_templates


def seen_as(name, class_id):
    """Return a room with a template whose cells have a class, and the object found there."""
    one = template(name)
    labels = np.zeros((50, 54, 34), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[7] = SemanticClass.WALL
    labels[tuple(template_cells(one, one.typical_m, shift=(8, 14, 1)).T)] = class_id
    found = find_objects(grid_of(labels))
    (instance,) = found.instances
    return found.grid, instance


@pytest.mark.parametrize("name", ["toilet", "bathtub", "washing_machine", "fridge", "piano"])
def test_a_named_object_becomes_what_it_is_whatever_its_class(name):
    entry = read_vocabulary().of_template(name)
    grid, found = seen_as(name, SemanticClass.OBJS)
    named = replace(found, name=entry.name, name_confidence=0.9)
    (placed,) = place_templates(grid, (named,))
    assert placed.template in entry.templates
    assert placed.class_id == SemanticClass.OBJS


def test_a_name_does_not_outweigh_a_shape():
    grid, found = seen_as("double_bed", SemanticClass.BED)
    named = replace(found, name="nightstand", name_confidence=0.9)
    (placed,) = place_templates(grid, (named,))
    assert read_vocabulary().of_template(placed.template).class_id == SemanticClass.BED


@pytest.mark.parametrize("name", ["wardrobe", "cabinet", "chest of drawers"])
def test_designs_of_one_shape_are_told_apart_by_name(name):
    entry = read_vocabulary().names[name]
    grid, found = seen_as(entry.templates[0], SemanticClass.FURN)
    (placed,) = place_templates(grid, (replace(found, name=name, name_confidence=0.95),))
    assert placed.template in entry.templates


def test_the_method_of_the_paper_takes_no_name():
    grid, found = seen_as("toilet", SemanticClass.OBJS)
    named = replace(found, name="toilet", name_confidence=1.0)
    chosen = RetrievalParameters(paper_compat=True)
    (plain,) = place_templates(grid, (found,), chosen)
    (placed,) = place_templates(grid, (named,), chosen)
    assert placed.template == plain.template != "toilet"


def test_every_name_with_templates_can_be_matched():
    _, found = seen_as("chair", SemanticClass.CHAIR)
    for entry in read_vocabulary().names.values():
        sure = replace(found, name=entry.name, name_confidence=0.8)
        assert [one.name for one in named_templates(sure)] == list(entry.templates)
        assert named_templates(replace(sure, name_confidence=0.4)) == ()

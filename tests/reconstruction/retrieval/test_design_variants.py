"""Which design of a family stands for a match: by size and colour, the same for a whole set."""

from dataclasses import replace
from itertools import count

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from label_grids import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture import template, template_cells
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates
from world2minecraft.reconstruction.retrieval.variants import Choice, Offer, choose

NUMBERS = count(1)
BROWN, WHITE, RED = (90, 58, 34), (242, 241, 236), (160, 36, 33)


def _choice(name, rgb=None, size_m=None, offered=()):
    one = template(name)
    size = np.array(size_m or one.typical_m)
    number = next(NUMBERS)
    placement = Placement(number, one.class_id, name, np.zeros(3), size, 0, 0.9, one.complete())
    offers = tuple(Offer(other, 0.9, {}) for other in (name, *offered))
    colour = None if rgb is None else srgb_to_oklab(np.array(rgb, np.uint8))
    return Choice(placement, offers, colour)


SOFAS = ("sofa_leather", "sofa_white")


@pytest.mark.parametrize(
    ("rgb", "template_name"),
    [(BROWN, "sofa_leather"), (WHITE, "sofa_white"), (RED, "sofa"), (None, "sofa")],
)
def test_colour_decides_among_designs_of_one_size(rgb, template_name):
    (placement,) = choose([_choice("sofa", rgb, offered=SOFAS)])
    assert placement.template == template_name


def test_pale_wood_is_neither_stone_nor_steel():
    offered = ("dining_table_stone", "dining_table_steel", "dining_table_white")
    (placement,) = choose([_choice("dining_table", (176, 161, 134), offered=offered)])
    assert placement.template == "dining_table"


def test_size_decides_where_colour_says_nothing():
    wide, narrow = (2.1, 2.0, 1.1), (2.05, 1.5, 0.95)
    kings = ("double_bed_king",)
    found = choose(
        [_choice("double_bed", RED, wide, kings), _choice("double_bed", RED, narrow, kings)]
    )
    assert [one.template for one in found] == ["double_bed_king", "double_bed"]


def test_a_set_stays_a_set():
    shades = [(90, 58, 34), (96, 62, 40), (84, 52, 30)]
    choices = [_choice("chair", rgb, offered=("chair_carver",)) for rgb in shades]
    assert {one.template for one in choose(choices)} in ({"chair"}, {"chair_carver"})
    refused = [*choices[:2], choices[2]._replace(offers=choices[2].offers[:1])]
    assert {one.template for one in choose(refused)} == {"chair"}


def test_the_runs_of_one_object_share_a_design():
    rows = [("sofa", BROWN, (0.92, 2.0, 0.85), SOFAS), ("sofa", WHITE, (0.92, 1.2, 0.85), SOFAS)]
    one, other = (_choice(*row) for row in rows)
    assert len({run.template for run in choose([one, other])}) == 2
    other = other._replace(placement=replace(other.placement, object_id=one.placement.object_id))
    assert len({run.template for run in choose([one, other])}) == 1


def test_what_has_no_offers_stays():
    plain = _choice("sofa", BROWN)._replace(offers=())
    assert choose([plain]) == (plain.placement,)


@given(st.permutations(range(4)))
def test_the_order_of_objects_does_not_matter(order):
    rows = [(BROWN, 2.0), (WHITE, 2.0), (RED, 1.3), (BROWN, 1.95)]
    choices = [_choice("sofa", rgb, (0.92, wide, 0.85), SOFAS) for rgb, wide in rows]
    straight = [one.template for one in choose(choices)]
    mixed = [one.template for one in choose([choices[index] for index in order])]
    assert mixed == [straight[index] for index in order]


def _room_with_sofa(rgb):
    one = template("sofa")
    cells = template_cells(one, one.typical_m, shift=(8, 14, 1))
    labels = np.zeros((40, 62, 30), np.uint8)
    labels[:, :, 0], labels[7] = SemanticClass.FLOOR, SemanticClass.WALL
    labels[tuple(cells.T)] = one.class_id
    grid = grid_of(labels)
    colour = grid.colour.copy()
    colour[tuple(cells.T)] = rgb
    return replace(grid, colour=colour)


@pytest.mark.parametrize(("on", "expected"), [(True, "sofa_leather"), (False, "sofa")])
def test_a_brown_sofa_that_was_scanned_is_a_leather_one(on, expected):
    found = find_objects(_room_with_sofa(BROWN))
    (placement,) = place_templates(found.grid, found.instances, RetrievalParameters(variants=on))
    assert placement.template == expected
    assert placement.iou >= 0.9
    assert set(placement.parameters) == set(template(expected).parameters)


@pytest.mark.parametrize(
    ("size_m", "rgb", "template_name"),
    [
        ((0.6, 0.6, 0.85), WHITE, "washing_machine"),
        ((0.6, 0.6, 0.85), BROWN, "cabinet"),
        ((0.4, 0.45, 0.55), BROWN, "nightstand"),
        ((0.4, 1.6, 0.48), BROWN, "tv_stand"),
    ],
)
def test_a_closed_box_is_what_it_is_by_size_and_colour(size_m, rgb, template_name):
    offered = ("nightstand", "tv_stand", "washing_machine")
    within = [name for name in offered if all(map(_holds, size_m, template(name).size_m))]
    (placement,) = choose([_choice("cabinet", rgb, size_m, within)])
    assert placement.template == template_name


def _holds(side, span):
    return span.minimum <= side <= span.maximum

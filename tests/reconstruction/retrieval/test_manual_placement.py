"""Furniture that was chosen for an object: in its place, in the turn asked for, always put."""

import numpy as np
import pytest
from label_grids import grid_of

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import Layout, ObjectInstance
from world2minecraft.furniture import template, template_cells
from world2minecraft.reconstruction.instances import find_objects, measure_object
from world2minecraft.reconstruction.retrieval import fit_template, place_templates, ranked_matches

NAMES = ["chair", "sofa", "double_bed", "desk", "bookcase"]


def found_object(name: str, quarter_turns: int = 0):
    """Return a room with one template in it, and the object that stage 5 finds there."""
    one = template(name)
    labels = np.zeros((50, 54, 34), np.uint8)
    labels[:, :, 0] = 2
    labels[7] = 3
    labels[tuple(template_cells(one, one.typical_m, shift=(8, 14, 1)).T)] = one.class_id
    grid = grid_of(np.ascontiguousarray(turn_grid(labels, quarter_turns)))
    found = find_objects(grid)
    return found.grid, found.instances[0]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("turns", [0, 1])
def test_the_right_template_is_put_as_a_match_puts_it(name, turns):
    grid, one = found_object(name, turns)
    (matched,) = place_templates(grid, (one,))
    placed = fit_template(grid, one, name)
    assert placed.quarter_turns == matched.quarter_turns == turns
    assert np.allclose(placed.center_m, matched.center_m)
    assert np.allclose(placed.size_m, matched.size_m) and placed.iou == matched.iou


@pytest.mark.parametrize("turns", range(4))
def test_the_turn_that_is_asked_for_is_taken(turns):
    grid, one = found_object("double_bed")
    placed = fit_template(grid, one, "double_bed", turns)
    assert placed.quarter_turns == turns
    assert np.abs(placed.center_m - one.center_m)[:2].max() < 0.6


def test_object_without_cells_keeps_its_place():
    grid, found = found_object("chair")
    no_cells = np.zeros((0, 3), np.int32)
    one = ObjectInstance(4, 5, found.center_m, found.size_m, 90.0, no_cells, 0.5)
    placed = fit_template(grid, one, "armchair")
    assert placed.quarter_turns == 1 and placed.iou == 0 and placed.object_id == 4
    assert np.allclose(placed.center_m[:2], one.center_m[:2], atol=1e-3)
    bottoms = [p.center_m[2] - p.size_m[2] / 2 for p in (placed, one)]
    assert bottoms[0] == pytest.approx(bottoms[1], abs=0.04)
    assert fit_template(grid, one, "cells").size_m == pytest.approx(one.size_m)


def test_object_of_own_cells_takes_their_box():
    grid, one = found_object("desk", 1)
    placed = fit_template(grid, one, "cells", 1)
    low, high = one.cells.min(axis=0), one.cells.max(axis=0) + 1
    sides = (high - low) * grid.voxel_m
    assert placed.template == "cells" and np.allclose(placed.size_m, sides[[1, 0, 2]])


def test_it_stays_within_the_rooms():
    grid, one = found_object("sofa")
    edge = float(one.center_m[0])  # A room that ends in the middle of the sofa.
    room = Layout(np.array([[edge, 0.0], [4.0, 0.0], [4.0, 4.3], [edge, 4.3]]), 2.5)
    placed = fit_template(grid, one, "sofa", None, (room,))
    assert placed.center_m[0] - placed.size_m[0] / 2 >= edge - 1e-6


def test_an_unknown_template_is_refused():
    grid, one = found_object("chair")
    with pytest.raises(UnknownNameError, match="did you mean 'armchair'"):
        fit_template(grid, one, "armchiar")


@pytest.mark.parametrize("name", NAMES)
def test_the_right_template_is_the_best_of_those_offered(name):
    grid, one = found_object(name)
    ranked = ranked_matches(grid, one)
    assert ranked[0][0] == name and 1 <= len(ranked) <= 5
    assert len({row[0] for row in ranked}) == len(ranked)


def test_measured_tells_an_object_as_stage_five_does():
    grid, one = found_object("sofa", 1)
    again = measure_object(grid, 9, one.class_id, one.cells)
    assert again.id == 9 and again.yaw_deg == one.yaw_deg
    assert np.allclose(again.center_m, one.center_m) and np.allclose(again.size_m, one.size_m)
    other = measure_object(grid, 9, 10, one.cells)
    assert other.class_id == 10 and (grid.labels[tuple(one.cells.T)] == 7).all()

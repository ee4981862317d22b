"""Template matching: what was put is found again, turned with the room, by fair evidence."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from label_grids import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Layout
from world2minecraft.furniture import TEMPLATES, surface_cells, template, template_cells
from world2minecraft.furniture.rasterization import best_shift, count_overlaps
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.retrieval import (
    RetrievalParameters,
    fit_template,
    place_templates,
    ranked_matches,
)
from world2minecraft.reconstruction.retrieval.placement_settling import floor_under_m

NAMES = [name for name in TEMPLATES.names() if template(name).matched]
FULL_IOU = 0.9


def _room(name, quarter_turns, size_m=None, *, hidden=False, wall=True, lift=None, **parameters):
    """Return a room with a template at a wall behind it, all turned together.

    ``hidden`` makes what no camera sees unseen: the inside of the object.
    """
    one = template(name)
    bottom = lift or (13 if one.mount == "wall" else 1)
    at = (8, 14, bottom)
    cells = template_cells(one, size_m or one.typical_m, parameters, shift=at)
    labels = np.zeros((58, 62, 40), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    if wall:
        labels[7] = SemanticClass.WALL
    labels[tuple(cells.T)] = one.class_id
    if hidden:
        solid = labels == one.class_id
        labels[solid & ~surface_cells(solid)] = 255
    return np.ascontiguousarray(turn_grid(labels, quarter_turns))


def _furnished(grid, **changed):
    found = find_objects(grid)
    return found, place_templates(found.grid, found.instances, RetrievalParameters(**changed))


@pytest.mark.parametrize("hidden", [False, True])
@pytest.mark.parametrize("name", NAMES)
def test_a_template_that_stands_in_a_room_is_recovered(name, hidden):
    for turns in range(template(name).turns):
        _, placements = _furnished(grid_of(_room(name, turns, hidden=hidden)))
        (placement,) = placements
        assert (placement.template, placement.quarter_turns) == (name, turns)
        assert placement.iou >= FULL_IOU
        assert np.abs(placement.size_m - template(name).typical_m).max() <= 0.08 + 1e-9


def test_what_stands_upstairs_is_matched_as_it_is_below():
    below = _room("chair", 1)
    labels = np.zeros((*below.shape[:2], 80), np.uint8)
    labels[:, :, 0], labels[:, :, 34:74] = SemanticClass.FLOOR, below
    outline = np.array([[0.0, 0.0], [4.96, 0.0], [4.96, 4.64], [0.0, 4.64]])
    rooms = [Layout(outline, 2.5), Layout(outline, 2.5, floor_z_m=34 * 0.08)]
    (one,) = (found := find_objects(grid_of(labels))).instances
    (placed,) = place_templates(found.grid, [one], None, rooms)
    _, (wanted,) = _furnished(grid_of(below))
    assert (placed.template, placed.quarter_turns) == (wanted.template, wanted.quarter_turns)
    assert placed.iou == wanted.iou
    np.testing.assert_allclose(placed.size_m, wanted.size_m)
    rise = np.array([0, 0, 34 * 0.08])
    np.testing.assert_allclose(placed.center_m, wanted.center_m + rise, atol=1e-6)
    assert ranked_matches(found.grid, one, rooms=rooms)[0][0] == "chair"
    assert fit_template(found.grid, one, "chair", None, rooms).iou == wanted.iou


def test_the_floor_under_a_thing_is_that_of_its_storey():
    hall = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    rooms = [Layout(hall, 5.0), Layout(hall + np.array([5.0, 0.0]), 2.4, floor_z_m=2.7)]
    for middle, floor in (
        ((1, 1, 4.0), 0.0),  # A lamp in a hall of two storeys hangs over the hall's floor.
        ((6, 1, 3.1), 2.7),
        ((6, 1, 2.66), 2.7),  # A rug that lies a little in its floor.
        ((6, 1, 2.3), 0.0),
        ((4.5, 1, 3.1), 2.7),  # In a wall between both.
    ):
        assert floor_under_m(np.array(middle), rooms, 0.08) == floor
    assert floor_under_m(np.array([1, 1, 3.1]), (), 0.08) == 0.0
    assert floor_under_m(np.array([1, 1, -2.0]), [Layout(hall, 2.2, floor_z_m=-2.5)], 0.08) == -2.5


@pytest.mark.parametrize("name", ["chair", "sofa", "double_bed", "desk", "bookcase", "monitor"])
def test_turning_the_room_turns_the_placement(name):
    labels = _room(name, 0, hidden=True)
    _, (straight,) = _furnished(grid_of(labels))
    _, (turned,) = _furnished(grid_of(np.ascontiguousarray(turn_grid(labels, 1))))
    assert turned.template == straight.template
    assert turned.quarter_turns == (straight.quarter_turns + 1) % 4
    assert turned.iou == straight.iou
    np.testing.assert_allclose(turned.size_m, straight.size_m)
    x, y, z = straight.center_m
    np.testing.assert_allclose(turned.center_m, [62 * 0.08 - y, x, z], atol=1e-9)


@settings(max_examples=12)
@given(
    st.sampled_from(["chair", "armchair", "sofa", "single_bed", "dining_table", "counter"]),
    st.tuples(*[st.floats(0.1, 0.9)] * 3),
)
@example("dining_table", (0.75, 0.125, 0.5))  # 13.1 cells wide: 12 fit as well.
def test_sizes_within_the_spans_are_recovered(name, shares):
    spans = template(name).size_m
    size = tuple(a + (b - a) * share for (a, _, b), share in zip(spans, shares, strict=True))
    _, placements = _furnished(grid_of(_room(name, 0, size)))
    (placement,) = placements
    assert placement.iou >= FULL_IOU
    np.testing.assert_allclose(placement.size_m, size, atol=1.2 * 0.08)


@pytest.mark.parametrize(
    ("name", "parameter", "value"),
    [
        ("chair", "seat_height", 0.54),
        ("armchair", "seat_height", 0.35),
        ("corner_sofa", "side", -1.0),
        ("plant", "pot_share", 0.45),
    ],
)
def test_parameters_are_fitted(name, parameter, value):
    given_values = {parameter: value}
    size = template(name).typical_m
    _, (placement,) = _furnished(grid_of(_room(name, 0, **given_values)))
    assert placement.template == name
    fitted = template_cells(template(name), size, placement.parameters)
    np.testing.assert_array_equal(fitted, template_cells(template(name), size, given_values))


def test_a_table_seen_from_above_stands_on_the_floor():
    labels = _room("dining_table", 0)
    top = labels.shape[2] - 1 - np.argmax((labels == 8).any(axis=(0, 1))[::-1])
    labels[8:20, 14:34, 1:top] = 255
    _, (placement,) = _furnished(grid_of(labels))
    assert placement.template in ("dining_table", "desk", "round_table")
    np.testing.assert_allclose(placement.center_m[2] - placement.size_m[2] / 2, 0.0, atol=1e-6)
    assert placement.iou >= FULL_IOU


def test_cells_that_were_never_seen_count_only_for_the_paper():
    labels = _room("cabinet", 0, hidden=True)
    _, (fair,) = _furnished(grid_of(labels))
    _, (exact,) = _furnished(grid_of(labels), paper_compat=True)
    assert fair.iou == 1.0
    own = np.count_nonzero(labels == SemanticClass.FURN)
    box = int(np.prod(np.round(exact.size_m / 0.08)))
    assert exact.iou == pytest.approx(own / box, abs=1e-4)


def test_alternatives_are_the_next_best_and_no_more_than_asked():
    _, (placement,) = _furnished(grid_of(_room("chair", 1)), alternatives=3)
    assert len(placement.alternatives) == 3
    chosen = (placement.template, placement.quarter_turns)
    assert chosen not in [(a.template, a.quarter_turns) for a in placement.alternatives]
    assert all(a.iou <= placement.iou for a in placement.alternatives)


def test_what_no_template_explains_is_built_from_its_own_cells():
    labels = _room("chair", 0)
    labels[labels == 5] = 0
    for step in range(14):
        labels[20 + step : 23 + step, 20 + step : 23 + step, 1 + step : 3 + step] = 5
    found, (placement,) = _furnished(grid_of(labels))
    assert placement.template == "cells"
    assert placement.iou < RetrievalParameters().min_iou
    np.testing.assert_allclose(placement.center_m, found.instances[0].center_m, atol=1e-4)
    assert placement.alternatives[0].iou == placement.iou


def test_an_object_without_cells_has_no_placement():
    found = find_objects(grid_of(_room("chair", 0)))
    (instance,) = found.instances
    empty = type(instance)(
        instance.id, 5, instance.center_m, instance.size_m, 0.0, np.zeros((0, 3), np.int32), 0.5
    )
    assert place_templates(found.grid, [empty]) == ()


@given(st.integers(0, 2**32 - 1))
def test_the_fast_overlap_is_the_slow_one(seed):
    rng = np.random.default_rng(seed)
    solid = rng.random((3, 4, 2)) < 0.6
    code = rng.integers(0, 4, (6, 5, 5)).astype(np.uint8)
    corners = rng.integers(-2, 5, (5, 3)).astype(np.int64)
    slow = np.zeros((5, 3), np.int64)
    for index, corner in enumerate(corners):
        for cell in np.argwhere(solid) + corner:
            inside = (cell >= 0).all() and (cell < code.shape).all()
            kind = int(code[tuple(cell)]) if inside else 1
            slow[index] += [kind == 2, kind == 1, kind == 3]
    np.testing.assert_array_equal(count_overlaps(solid, code, corners), slow)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"min_iou": 1.5}, "furnish.min_iou must be between 0 and 1, got 1.5"),
        ({"shift_cells": 9}, "furnish.shift_cells must be between 0 and 8, got 9"),
        ({"max_runs": 0}, "furnish.max_runs must be above 0, got 0"),
    ],
)
def test_parameters_out_of_bounds_are_refused(changed, message):
    with pytest.raises(UsageError) as refused:
        RetrievalParameters(**changed)
    assert str(refused.value) == message


@given(st.integers(0, 2**32 - 1))
def test_the_best_shift_is_that_of_all_scores(seed):
    rng = np.random.default_rng(seed)
    solid = rng.random((3, 4, 2)) < 0.6
    solid[0, 0, 0] = True
    code = rng.integers(0, 4, (6, 5, 5)).astype(np.uint8)
    corners = rng.integers(-2, 5, (8, 3)).astype(np.int64)
    own, weight = max(int((code == 2).sum()), 1), 0.25
    counts = count_overlaps(solid, code, corners)
    ious = counts[:, 0] / (own + counts[:, 1])
    scores = ious - weight * counts[:, 2] / np.count_nonzero(solid)
    best = int(np.argmax(np.round(scores, 12)))
    assert best_shift(solid, code, corners, own, weight) == (best, scores[best], ious[best])

"""Objects that are no box: cut into runs that are."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from label_grids import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import ObjectInstance
from world2minecraft.furniture import surface_cells
from world2minecraft.reconstruction.instances import InstanceParameters, find_objects
from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates
from world2minecraft.reconstruction.retrieval.object_evidence import evidence_of
from world2minecraft.reconstruction.retrieval.rectangle_decomposition import (
    cut_into_runs,
    largest_rectangle,
)

FURN, WALL = int(SemanticClass.FURN), int(SemanticClass.WALL)


def _kitchen(hidden=True, kettle=False):
    """Return an L of counters in a corner, a tall cupboard at its end, cupboards over one leg."""
    labels = np.zeros((60, 50, 34), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[0], labels[:, 0] = WALL, WALL
    labels[1:40, 1:9, 1:12] = FURN
    labels[1:9, 9:36, 1:12] = FURN
    labels[40:48, 1:9, 1:26] = FURN
    if hidden:
        solid = labels > 0
        labels[solid & ~surface_cells(solid)] = 255
    if kettle:
        labels[20:23, 3:6, 12:15] = SemanticClass.OBJS
        labels[20:23, 3:6, 11] = 255
    return labels


def _l_and_cupboard(labels):
    """Return the grid with its L of counters as one object and the tall cupboard as another."""
    grid = grid_of(labels)
    cells = np.argwhere(labels == FURN).astype(np.int32)
    tall = cells[:, 0] >= 40
    instance = np.zeros(labels.shape, np.uint16)
    objects = []
    for number, mine in enumerate((cells[~tall], cells[tall]), 1):
        instance[tuple(mine.T)] = number
        low, high = mine.min(0) * 0.08, (mine.max(0) + 1) * 0.08
        x, y, z = high - low
        middle = (low + high) / 2 + grid.origin_m
        objects.append(ObjectInstance(number, FURN, middle, np.array([y, x, z]), 90.0, mine, 1.0))
    return replace(grid, instance=instance), objects


@pytest.mark.parametrize("hidden", [False, True])
@pytest.mark.parametrize("kettle", [False, True])
def test_an_l_of_counters_becomes_its_runs(hidden, kettle):
    grid, furn = _l_and_cupboard(_kitchen(hidden, kettle))
    placements = place_templates(grid, furn)
    assert {placement.object_id for placement in placements} == {one.id for one in furn}
    large = [one for one in placements if one.template != "cells"]
    assert len(large) == 3
    assert min(one.iou for one in large) >= 0.9
    tall = max(large, key=lambda one: one.size_m[2])
    assert tall.template == "wardrobe"
    np.testing.assert_allclose(tall.center_m[:2], [44 * 0.08, 5 * 0.08], atol=0.0801)
    low = sorted((one for one in large if one is not tall), key=lambda one: one.quarter_turns)
    assert [one.quarter_turns for one in low] == [0, 1]


def test_a_box_is_not_cut():
    labels = np.zeros((40, 40, 20), np.uint8)
    labels[10:30, 10:18, 1:12] = FURN
    found = find_objects(grid_of(labels))
    assert len(place_templates(found.grid, found.instances)) == 1


def test_the_paper_cuts_nothing():
    found = find_objects(grid_of(_kitchen()), InstanceParameters(paper_compat=True))
    whole = RetrievalParameters(paper_compat=True)
    assert len(place_templates(found.grid, found.instances, whole)) == 1


def test_every_own_cell_is_in_exactly_one_run():
    grid = grid_of(_kitchen())
    cells = np.argwhere(grid.labels == FURN).astype(np.int32)
    evidence = evidence_of(grid, cells, (1, 1, 1), False)
    runs = cut_into_runs(evidence, 8, 6)
    joined = np.concatenate(runs) + evidence.corner
    assert len(joined) == len(cells)
    np.testing.assert_array_equal(np.unique(joined, axis=0), np.unique(cells, axis=0))


@given(st.integers(0, 2**32 - 1), st.tuples(st.integers(1, 7), st.integers(1, 7)))
def test_the_largest_rectangle_is_the_best_of_all(seed, shape):
    rng = np.random.default_rng(seed)
    kinds = rng.integers(0, 4, shape)
    mask, hidden = (kinds > 1).astype(np.uint8), (kinds == 1).astype(np.uint8)
    best = 0
    for x0, y0 in np.ndindex(shape):
        for x1 in range(x0 + 1, shape[0] + 1):
            for y1 in range(y0 + 1, shape[1] + 1):
                if (mask + hidden)[x0:x1, y0:y1].all():
                    best = max(best, int(mask[x0:x1, y0:y1].sum()))
    area, x0, y0, x1, y1 = largest_rectangle(mask, hidden)
    assert area == best
    assert int(mask[x0:x1, y0:y1].sum()) == best
    assert (mask + hidden)[x0:x1, y0:y1].all()

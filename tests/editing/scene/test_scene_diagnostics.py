"""Diagnostics: each reason is found where it is, stated in words, and gone after the repair."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from voxel_scenes import VOXEL_M, grid_of, object_at, random_scene, seeds

from world2minecraft.core.types import Alternative
from world2minecraft.editing.scene import SceneDraft, parse_command, runs_of_cells
from world2minecraft.editing.scene.diagnostics import find_diagnostics


def table(iou=0.8, at=1, **changed) -> SceneDraft:
    """A table of 4 x 4 cells, ``at`` cells above the floor's layer."""
    labels, instance = np.zeros((12, 12, 10), np.uint8), np.zeros((12, 12, 10), np.uint16)
    labels[:, :, 0] = 2
    labels[4:8, 4:8, at], instance[4:8, 4:8, at] = 8, 3
    if at > 1:
        labels[5, 8:, at] = 3  # A bracket to the wall, so that it does not float.
        labels[:, 11, :] = 3
    one = object_at(3, 8, np.argwhere(instance == 3), iou)
    placed = replace(one.placements[0], **changed)
    grid = grid_of(labels, instance)
    sure = np.where(grid.labels > 0, 1, grid.confidence).astype(np.float16)
    one = replace(one, confidence=1.0, placements=(placed,))
    return SceneDraft(replace(grid, confidence=sure), [one])


def told(draft):
    return [(one.kind, one.why, one.object_id) for one in find_diagnostics(draft)]


def test_a_scene_without_faults_has_no_diagnostics():
    assert told(table()) == []


@pytest.mark.parametrize(
    ("draft", "expected"),
    [
        (table(0.31), ("low_iou", "table: template plain has low IoU 31%", 3)),
        (
            table(0.8, template="cells"),
            ("no_template", "table: no furniture template fits, built from its voxels", 3),
        ),
        (
            table(alternatives=(Alternative("plain", 0, 0.8), Alternative("desk_long", 0, 0.79))),
            ("near_tie", "table: desk long fits almost as well, IoU 79% against 80%", 3),
        ),
        (
            table(alternatives=(Alternative("plain", 3, 0.8),)),
            ("near_tie", "table: plain rotated to 270° fits almost as well, IoU 80% against 80%",
             3),
        ),
        (
            table(alternatives=(Alternative("desk", 0, 0.8), Alternative("desk", 1, 0.78))),
            ("near_tie", "table: desk rotated to 90° fits almost as well, IoU 78% against 80%", 3),
        ),
        (
            table(at=4),
            ("unsupported", "table: no support, only observed air below", 3),
        ),
    ],
    ids=lambda one: one[0] if isinstance(one, tuple) else "",
)  # fmt: skip
def test_an_uncertain_object_is_reported_in_a_sentence(draft, expected):
    assert told(draft) == [expected]


def test_only_the_worst_reason_of_an_object_is_reported():
    draft = table(0.4, at=4)
    assert [one.kind for one in find_diagnostics(draft)] == ["unsupported"]


def test_what_was_not_seen_below_may_carry():
    draft = table(at=4)
    labels = draft.labels.copy()
    labels[4:8, 4:8, 1:4] = 255
    grid = grid_of(labels, draft.instance)
    sure = np.where(labels % 255 > 0, 1, grid.confidence).astype(np.float16)
    assert told(SceneDraft(replace(grid, confidence=sure), draft.objects.values())) == []


def test_uncertain_cells_are_reported_and_repaired_ones_are_not():
    draft = table()
    labels, grid = draft.labels.copy(), draft.grid()
    labels[1, 1, 1:3] = 11  # Crumbs on the floor,
    labels[10, 10, 6] = 5  # one in the air,
    sure, source = grid.confidence.copy(), grid.source.copy()
    sure[labels > 0] = 1
    sure[0:6, 0:6, 0] = 0.25  # a patch of the floor that is not sure,
    source[6:, 6:, 0] = 2  # and one that was completed.
    grid = replace(grid, labels=labels, confidence=sure, source=source)
    draft = SceneDraft(grid, draft.objects.values())
    assert told(draft) == [
        ("floater", "1 chair cell floating in the air", 0),
        ("unsure_cells", "36 floor cells, confidence 25%", 0),
        ("crumb", "2 object cells without an object", 0),
        ("completed", "36 floor cells, completed but not observed", 0),
    ]
    at_m = find_diagnostics(draft)[0].at_m
    assert np.allclose(at_m, np.array([10.5, 10.5, 6.5]) * VOXEL_M)
    for cells, class_id in (
        (np.argwhere(np.isin(labels, (5, 11))), 0),
        (np.argwhere(labels[:, :, :1] == 2), 3),
    ):
        runs = runs_of_cells(cells, draft.shape).tolist()
        command = parse_command({"op": "set_cells", "cells": runs, "class_id": class_id})
        draft.apply(command.plan(draft, None))  # type: ignore[arg-type]
    assert told(draft) == []


@given(seeds)
def test_diagnostics_are_ordered_and_name_each_object_once(seed):
    draft = random_scene(seed)
    found = find_diagnostics(draft)
    assert [one.doubt for one in found] == sorted((one.doubt for one in found), reverse=True)
    numbers = [one.object_id for one in found if one.object_id]
    assert len(numbers) == len(set(numbers)) and set(numbers) <= set(draft.objects)
    assert all(0 <= one.doubt <= 1 and one.why for one in found)
    assert {one.kind for one in find_diagnostics(draft)} <= {
        "low_confidence", "low_iou", "floater", "unsupported", "crumb", "unsure_cells",
    }  # fmt: skip

"""The script of the refinement benchmark: what it calls wrong, and that it does the plain thing."""

import numpy as np
import pytest
from benchmarks.refinement import (
    TruePlane,
    Wanted,
    agreement,
    defects_of,
    hole_share,
    next_gesture,
)

from world2minecraft.core.types import OBSERVED, LayoutObject, OccupancyGrid
from world2minecraft.editing.scene import SceneDraft, objects_of, parse_command
from world2minecraft.furniture import template, template_cells
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.sceneforge.stage_tools import tools_of

TOOLS = tools_of()
SILL = np.array([0, 2])  # The wall begins over the floor.
FURNITURE = {"chair": ((30, 32, 1), 0), "double_bed": ((4, 6, 1), 0), "cabinet": ((36, 6, 1), 1)}


@pytest.fixture
def room():
    """A draft of a room with a chair, a bed and a cabinet as they truly are, and its truth."""
    labels = np.zeros((48, 46, 28), np.uint8)
    labels[:, :, 0], labels[:2] = 2, 3
    things = []
    instance = np.zeros(labels.shape, np.int64)
    for name, (at, turns) in FURNITURE.items():
        one = template(name)
        cells = template_cells(one, one.typical_m, None, turns, at)
        labels[tuple(cells.T)] = one.class_id
        instance[tuple(cells.T)] = len(things) + 1
        low, high = cells.min(axis=0), cells.max(axis=0) + 1
        center = (low + high) / 2 * 0.08 - np.array([0, 0, 0.08])
        size = np.array(one.typical_m)
        things.append(LayoutObject(one.class_id, center, size, 90.0 * turns, name))
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=np.full(labels.shape, OBSERVED, np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )
    found = find_objects(grid)
    draft = SceneDraft(found.grid, objects_of(found.instances))
    floor = np.argwhere(np.ones((48, 46), bool))
    wall = np.column_stack([np.ones(46 * 24, int), np.argwhere(np.ones((46, 24), bool)) + SILL])
    planes = (
        TruePlane("floor", np.insert(floor, 2, 0, axis=1)[:, None], 2),
        TruePlane("wall 1", wall[:, None], 0),
    )
    return draft, Wanted(tuple(things), labels.copy(), instance, planes)


def the(draft, class_id):
    return next(one.id for one in draft.objects.values() if one.class_id == class_id)


def done(draft, gesture):
    draft.apply(parse_command(gesture).plan(draft, TOOLS))


def test_nothing_is_wrong_with_the_truth(room):
    draft, wanted = room
    defects = defects_of(draft, wanted)
    assert defects.total == 0 and len(defects.pairs) == 3
    assert agreement(draft, wanted) == 1 and next_gesture(draft, TOOLS, wanted) is None


FAULTS = (
    ({"op": "relabel_objects", "ids": [6], "class_id": 7}, 2, "relabel_objects"),
    ({"op": "delete_objects", "ids": [5]}, 1, "add_object"),
    ({"op": "turn_objects", "ids": [6], "quarter_turns": 2}, 1, "turn_objects"),
    ({"op": "move_object", "id": 5, "to_m": [2.6, 2.0, 0.5]}, 2, "move_object"),
    ({"op": "split_object", "id": 6, "parts": 2}, 3, "merge_objects"),
    ({"op": "fill_box", "low": [10, 30, 0], "high": [22, 40, 0], "class_id": 0}, 1, "fill_holes"),
    (
        {"op": "fill_box", "low": [20, 20, 20], "high": [22, 22, 22], "class_id": 10},
        1,
        "delete_component",
    ),
)


@pytest.mark.parametrize(("wrong", "count", "op"), FAULTS, ids=[row[2] for row in FAULTS])
def test_each_fault_is_counted_and_put_right_by_one_gesture(room, wrong, count, op):
    draft, wanted = room
    numbers = {one.class_id: one.id for one in draft.objects.values()}  # Named by class above.
    if "id" in wrong:
        wrong = wrong | {"id": numbers[wrong["id"]]}
    if "ids" in wrong:
        wrong = wrong | {"ids": [numbers[one] for one in wrong["ids"]]}
    done(draft, wrong)
    assert defects_of(draft, wanted).total == count
    before = draft.labels.copy(), dict(draft.objects)
    gesture = next_gesture(draft, TOOLS, wanted)
    assert gesture is not None and gesture["op"] == op
    assert np.array_equal(draft.labels, before[0]) and draft.objects == before[1]
    done(draft, gesture)
    assert defects_of(draft, wanted).total == 0


def test_a_part_of_two_things_is_split_where_they_part(room):
    draft, wanted = room
    bed, cabinet = the(draft, 6), the(draft, 10)
    done(draft, {"op": "merge_objects", "ids": [bed, cabinet]})
    gestures = []
    while (gesture := next_gesture(draft, TOOLS, wanted)) and len(gestures) < 5:
        gestures.append(gesture["op"])
        done(draft, gesture)
    assert {"split_object", "relabel_objects"} <= set(gestures) and len(gestures) <= 3
    assert defects_of(draft, wanted).total == 0 and agreement(draft, wanted) == 1


def test_the_share_of_holes_is_of_the_places_of_the_plane(room):
    draft, wanted = room
    floor = wanted.planes[0]
    assert hole_share(draft, floor) == 0
    done(draft, {"op": "fill_box", "low": [40, 0, 0], "high": [47, 22, 0], "class_id": 0})
    assert hole_share(draft, floor) == pytest.approx(8 * 23 / (48 * 46))

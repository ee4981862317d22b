"""Commands on named cells: done and undone they are nothing, and objects stay consistent."""

import numpy as np
import pytest
from hypothesis import given
from voxel_scenes import TOOLS, done, grid_of, held, object_at, random_scene, seeds

from world2minecraft.core.errors import UsageError
from world2minecraft.editing.scene import SceneDraft, parse_command, runs_of_cells
from world2minecraft.editing.scene.object_conversion import connected_component, connected_parts
from world2minecraft.editing.scene.voxel_commands import infer_colours

STEPS = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def slow_component(labels, seed):
    """Cell by cell, breadth first."""
    seen, queue = {seed}, [seed]
    while queue:
        here = queue.pop(0)
        for step in STEPS:
            there = tuple(a + b for a, b in zip(here, step, strict=True))
            inside = all(0 <= a < side for a, side in zip(there, labels.shape, strict=True))
            if inside and there not in seen and labels[there] == labels[seed]:
                seen.add(there)
                queue.append(there)
    return sorted(seen)


def some_cells(draft, rng, share=0.3):
    chosen = np.argwhere(rng.random(draft.shape) < share)
    return runs_of_cells(chosen, draft.shape).tolist()


def random_command(draft, seed):
    rng = np.random.default_rng(seed)
    op = ("set_cells", "fill_box", "delete_component", "paste", "relabel_class", "delete_class")[
        seed % 6
    ]
    cell = [int(rng.integers(side)) for side in draft.shape]
    other = [int(rng.integers(-2, side + 2)) for side in draft.shape]
    locked = rng.choice(12, rng.integers(3), replace=False).tolist()
    classes = rng.choice([1, 2, 3, 4, 5, 8, 11], 2, replace=False).tolist()
    fields = {
        "set_cells": {"cells": some_cells(draft, rng), "class_id": int(rng.choice([0, 3, 5, 8]))},
        "fill_box": {"low": cell, "high": other, "class_id": int(rng.choice([0, 2, 5, 8]))},
        "delete_component": {"cell": cell},
        "paste": {
            "cells": some_cells(draft, rng),
            "by": [int(rng.integers(-2, 3)) for _ in range(3)],
            "mirror": (None, "x", "y", "z")[seed % 4],
        },
        "relabel_class": {"from_id": classes[0], "to_id": classes[1]},
        "delete_class": {"class_id": classes[0]},
    }
    return parse_command({"op": op, "locked": locked, **fields[op]})


@given(seeds)
def test_a_command_done_and_undone_changes_nothing(seed):
    draft = random_scene(seed)
    before = held(draft)
    command = random_command(draft, seed)
    locked = np.isin(draft.labels, command.locked)
    was = draft.labels.copy()
    try:
        done(draft, command)
    except UsageError:
        assert held(draft) == before
        return
    assert (draft.labels == was)[locked].all()
    assert (draft.labels != was).any() or command.op in ("set_cells", "delete_class")


@given(seeds)
def test_a_component_is_what_a_flood_reaches(seed):
    draft = random_scene(seed)
    cell = tuple(int(a) for a in np.random.default_rng(seed).integers(draft.shape))
    fast = [tuple(one) for one in connected_component(draft.labels, cell).tolist()]
    assert fast == slow_component(draft.labels, cell)


@given(seeds)
def test_parts_are_apart_and_hold_together(seed):
    mask = np.random.default_rng(seed).random((4, 4, 4)) < 0.3
    cells = np.argwhere(mask)
    parts = connected_parts(cells)
    assert sorted(np.concatenate([*parts, np.zeros(0, int)]).tolist()) == list(range(len(cells)))
    for one in parts:
        for other in parts:
            gap = np.abs(cells[one][:, None] - cells[other][None])
            near = gap.sum(axis=2) == 1
            assert near.any() == (one is other and len(one) > 1)


def two_chairs() -> SceneDraft:
    """Chair 1 at x = 0 and chair 2 at x = 4, both of two cells, and a table at y = 2."""
    labels, instance = np.zeros((5, 3, 2), np.uint8), np.zeros((5, 3, 2), np.uint16)
    labels[0, 0], labels[4, 0], labels[:, 2, 0] = 5, 5, 8
    instance[0, 0], instance[4, 0], instance[:, 2, 0] = 1, 2, 3
    colour = np.full((5, 3, 2, 3), 9, np.uint8)
    colour[0, 0] = (200, 0, 0)
    objects = [object_at(n, 8 if n == 3 else 5, np.argwhere(instance == n)) for n in (1, 2, 3)]
    return SceneDraft(grid_of(labels, instance, colour), objects)


def painted(draft, cells, class_id, **fields):
    runs = runs_of_cells(np.array(cells), draft.shape).tolist()
    command = {"op": "set_cells", "cells": runs, "class_id": class_id, **fields}
    return done(draft, parse_command(command))


def test_a_painted_cell_joins_the_touching_object_of_its_class():
    draft = two_chairs()
    assert painted(draft, [(1, 0, 0)], 5).counts_as == "add"
    assert draft.instance[1, 0, 0] == 1
    assert draft.colour[1, 0, 0].tolist() == [200, 0, 0], "the colour of the nearest of its class"
    assert draft.source[1, 0, 0] == 1 and draft.confidence[1, 0, 0] == 1


@given(seeds)
def test_a_new_cell_takes_the_nearest_colour_of_its_class(seed):
    draft = random_scene(seed)
    rng = np.random.default_rng(seed)
    cells = rng.permutation(np.argwhere(draft.labels % 255 == 0))[:5]
    class_id = int(rng.choice([2, 5, 6]))
    colours = infer_colours(draft, cells, np.full(len(cells), class_id, np.uint8))
    known = np.argwhere((draft.labels == class_id) & draft.colour.any(axis=-1))
    for cell, colour in zip(cells, colours, strict=True):
        gaps = ((known - cell) ** 2).sum(axis=1)
        nearest = known[gaps == gaps.min()] if len(known) and gaps.min() <= 36 else []
        allowed = [draft.colour[tuple(one)].tolist() for one in nearest] or [[0, 0, 0]]
        assert colour.tolist() in allowed


def test_many_objects_lose_their_last_cells_at_once():
    labels = np.zeros((40, 2, 1), np.uint8)
    labels[:, 0], instance = 5, np.zeros((40, 2, 1), np.uint16)
    instance[:, 0, 0] = np.arange(1, 41)
    objects = [object_at(n, 5, np.argwhere(instance == n)) for n in range(1, 41)]
    draft = SceneDraft(grid_of(labels, instance), objects)
    painted(draft, [(x, 0, 0) for x in range(30)], 0)
    assert sorted(draft.objects) == list(range(31, 41))


def test_a_bridge_joins_the_object_with_most_shared_faces():
    draft = two_chairs()
    painted(draft, [(x, 0, 0) for x in (1, 2, 3)], 5)
    assert draft.instance[1:4, 0, 0].tolist() == [1, 1, 1]
    draft = two_chairs()
    painted(draft, [(1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 0, 1)], 5)
    assert draft.instance[1:4, 0, 0].tolist() == [2, 2, 2]


def test_what_touches_none_of_its_class_belongs_to_none():
    draft = two_chairs()
    painted(draft, [(2, 0, 0), (2, 1, 0)], 10)
    assert not draft.instance[2, :2].any()
    assert not draft.colour[2, 0, 0].any(), "no cell of the class gives it a colour"


def test_an_object_is_removed_only_with_its_last_cell():
    draft = two_chairs()
    before = draft.objects[2]
    operation = painted(draft, [(4, 0, 0)], 0)
    assert operation.counts_as == "delete" and draft.objects[2] is before
    operation = painted(draft, [(4, 0, 1)], 3)
    assert [one.id for one in operation.objects_before] == [2]
    assert sorted(draft.objects) == [1, 3]


def test_cells_are_handed_to_another_object():
    draft = two_chairs()
    painted(draft, [(4, 0, 0), (4, 0, 1)], 5, instance=1)
    assert sorted(draft.objects) == [1, 3]
    painted(draft, [(4, 0, 0)], 5, instance=0)
    assert draft.instance[4, 0].tolist() == [0, 1]


def test_what_most_cells_undergo_is_counted():
    draft = two_chairs()
    assert painted(draft, [(0, 2, 0), (1, 2, 0), (1, 1, 0)], 3).counts_as == "relabel"


def test_relabelled_objects_get_furniture_of_their_class():
    draft = two_chairs()
    operation = done(draft, parse_command({"op": "relabel_class", "from_id": 5, "to_id": 7}))
    assert operation.counts_as == "relabel"
    assert [draft.objects[n].class_id for n in (1, 2, 3)] == [7, 7, 8]
    assert draft.objects[1].placements[0].class_id == 7
    done(draft, parse_command({"op": "relabel_class", "from_id": 7, "to_id": 3}))
    assert sorted(draft.objects) == [3] and draft.counts[3] == 4


def test_a_class_goes_with_the_objects_that_have_no_cells():
    draft = two_chairs()
    alone = object_at(8, 5, np.array([[1, 1, 1]]))
    draft.objects[8] = alone
    done(draft, parse_command({"op": "delete_class", "class_id": 5}))
    assert sorted(draft.objects) == [3] and draft.counts[5] == 0


def test_a_mirrored_copy_stands_where_it_is_put():
    draft = two_chairs()
    runs = runs_of_cells(np.array([(0, 0, 0), (0, 0, 1), (1, 2, 0)]), draft.shape).tolist()
    done(draft, parse_command({"op": "paste", "cells": runs, "by": [1, 0, 0], "mirror": "x"}))
    assert draft.labels[2, 0].tolist() == [5, 5] and draft.labels[1, 0].tolist() == [0, 0]
    assert draft.colour[2, 0, 0].tolist() == [200, 0, 0]


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        (
            {"op": "set_cells", "cells": [[0, 2]], "class_id": 5},
            "nothing to change: all cells already have this class or are locked",
        ),
        (
            {"op": "set_cells", "cells": [[2, 2]], "class_id": 5, "instance": 77},
            "object 77 not found; omit instance to join the adjacent object",
        ),
        (
            {"op": "set_cells", "cells": [[2, 2]], "class_id": 5, "instance": 3},
            "object 3 has class table, not chair; relabel it first, or use its class",
        ),
        (
            {"op": "set_cells", "cells": [[2, 99]], "class_id": 5},
            "a run of cells extends beyond the grid of 30 cells",
        ),
        (
            {"op": "fill_box", "low": [9, 9, 9], "high": [8, 8, 8], "class_id": 5},
            "the box from [9, 9, 9] to [8, 8, 8] is outside the grid of shape (5, 3, 2)",
        ),
        (
            {"op": "fill_box", "low": [0, 0, 0], "high": [0, 0, 1], "class_id": 5},
            "nothing to change: all cells in the box already have this class or are locked",
        ),
        (
            {"op": "delete_component", "cell": [5, 0, 0]},
            "cell [5, 0, 0] is outside the grid of [5, 3, 2] cells",
        ),
        (
            {"op": "delete_component", "cell": [1, 0, 0]},
            "cell [1, 0, 0] is empty; choose an occupied cell",
        ),
        (
            {"op": "delete_component", "cell": [0, 0, 0], "locked": [5]},
            "chair is locked; unlock it in the class legend first",
        ),
        ({"op": "delete_class", "class_id": 6}, "the scene has no cells or objects of class bed"),
        (
            {"op": "relabel_class", "from_id": 8, "to_id": 5, "locked": [8]},
            "table is locked; unlock it in the class legend first",
        ),
        (
            {"op": "paste", "cells": [[2, 2]], "by": [0, 0, 0]},
            "nothing to paste: all of these cells are empty",
        ),
        (
            {"op": "paste", "cells": [[0, 2]], "by": [0, 0, 10**30]},
            "nothing to change: the copy is outside the grid or identical to the existing cells",
        ),
    ],
)
def test_impossible_edits_are_refused_with_a_reason(fields, text):
    draft = two_chairs()
    with pytest.raises(UsageError) as refusal:
        parse_command(fields).plan(draft, TOOLS)
    assert str(refusal.value) == text

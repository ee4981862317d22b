"""Which cells make an object: split, merged, relabelled, found anew, snapped; and the laws."""

import numpy as np
import pytest
from edit_scenes import state
from hypothesis import given
from hypothesis import strategies as st
from object_scenes import CHAIR, LAMP, TABLE, furnished_room, plain_tools, put
from test_scene_objects import done, refusal

from world2minecraft.core.types import ObjectInstance
from world2minecraft.editing.scene import parse_command
from world2minecraft.editing.scene.object_grouping import cluster_cells

COMMANDS = (
    {"op": "relabel_objects", "ids": [CHAIR, LAMP], "class_id": 10},
    {"op": "split_object", "id": TABLE, "parts": 2},
    {"op": "split_object", "id": TABLE, "plane": {"axis": "x", "at_m": 1.5}},
    {"op": "split_objects", "ids": [TABLE, CHAIR]},
    {"op": "merge_objects", "ids": [TABLE, CHAIR]},
    {"op": "recluster", "density_kernel": 3, "density_threshold": 0.2, "cluster_radius": 2},
    {"op": "snap_object", "id": CHAIR, "to": "wall"},
    {"op": "snap_object", "id": LAMP, "to": "floor"},
)


def cells_held(draft) -> tuple:
    """What all cells are and whose."""
    return draft.labels.tobytes(), draft.instance.tobytes()


def lifted_room():
    """The room with its lamp 0.2 m over the floor."""
    draft = furnished_room()
    done(draft, op="move_object", id=LAMP, to_m=[2.0, 0.5, 0.7])
    return draft


@pytest.mark.parametrize("fields", COMMANDS, ids=lambda fields: fields["op"])
def test_a_command_changes_the_scene_and_its_inverse_restores_it(fields):
    draft = lifted_room()
    before = state(draft)
    operation = parse_command(fields).plan(draft, plain_tools())
    assert state(draft) == before, "a plan must not change the scene"
    draft.apply(operation)
    assert state(draft) != before
    draft.apply(operation.inverse())
    assert state(draft) == before


def test_objects_split_at_once_are_each_split_as_alone():
    at_once, alone = furnished_room(), furnished_room()
    done(at_once, op="split_objects", ids=[TABLE, CHAIR], parts=3)
    for number in (TABLE, CHAIR):
        done(alone, op="split_object", id=number, parts=3)
    assert cells_held(at_once) == cells_held(alone)
    assert sorted(at_once.objects) == sorted(alone.objects) and len(at_once.objects) == 7


@given(st.sampled_from([{"parts": 2}, {"parts": 3}, {"parts": 8}]), st.booleans())
def test_split_then_merged_is_the_same_object(how, by_plane):
    draft = furnished_room()
    cells, one = cells_held(draft), draft.objects[TABLE]
    how = {"plane": {"axis": "y", "at_m": 0.9}} if by_plane else how
    done(draft, op="split_object", id=TABLE, **how)
    new = sorted(set(draft.objects) - {CHAIR, TABLE, LAMP})
    assert len(new) == how.get("parts", 2) - 1
    assert sum(len(draft.cells_of(n)) for n in [TABLE, *new]) == 96
    done(draft, op="merge_objects", ids=[TABLE, *new])
    assert cells_held(draft) == cells and set(draft.objects) == {CHAIR, TABLE, LAMP}
    assert np.allclose(draft.objects[TABLE].center_m, one.center_m)
    assert np.allclose(draft.objects[TABLE].size_m, one.size_m)


def test_a_plane_cuts_at_its_place_and_the_larger_part_keeps_id():
    draft = furnished_room()
    done(draft, op="split_object", id=TABLE, plane={"axis": "x", "at_m": 1.4})
    assert draft.cells_of(TABLE)[:, 0].min() == 14 and len(draft.cells_of(TABLE)) == 64
    (new,) = set(draft.objects) - {CHAIR, TABLE, LAMP}
    assert draft.objects[new].class_id == 8 and len(draft.cells_of(new)) == 32


def test_split_separates_two_things_by_position():
    draft = furnished_room()
    put(draft.labels, draft.instance, (5, 14, 1), (3, 3, 5), 5, CHAIR)
    done(draft, op="split_object", id=CHAIR, parts=2)
    (new,) = set(draft.objects) - {CHAIR, TABLE, LAMP}
    assert draft.cells_of(new)[:, 1].min() == 14 and draft.cells_of(CHAIR)[:, 1].max() == 8


def test_merged_objects_take_the_class_of_the_first():
    draft = furnished_room()
    operation = done(draft, op="merge_objects", ids=[TABLE, CHAIR, CHAIR])
    assert operation.counts_as == "other" and CHAIR not in draft.objects
    assert len(draft.cells_of(TABLE)) == 176
    assert (draft.labels[draft.instance == TABLE] == 8).all()


def test_relabelling_keeps_cells_and_box_and_changes_furniture():
    draft = furnished_room()
    before = draft.objects[CHAIR]
    operation = done(draft, op="relabel_objects", ids=[CHAIR, TABLE], class_id=8)
    assert operation.counts_as == "relabel" and len(operation.objects_after) == 1
    one = draft.objects[CHAIR]
    assert one.class_id == 8 and (draft.labels[draft.instance == CHAIR] == 8).all()
    assert np.array_equal(one.center_m, before.center_m) and one.yaw_deg == before.yaw_deg
    assert one.placements[0].template == "cells"


def test_recluster_keeps_ids_of_objects_with_shared_cells():
    draft = furnished_room()
    parted = {"chair": (5, 5, 7), "rest": (7, 5, 9)}

    def find(grid, parameters):
        assert parameters == {"density_kernel": 5, "density_threshold": 0.3, "cluster_radius": 1.5}
        instance = np.zeros(grid.shape, np.uint16)
        found = []
        for number, (low, _, high) in enumerate(parted.values(), start=1):
            cells = np.argwhere(grid.labels == 5).astype(np.int32)
            cells = cells[(cells[:, 0] >= low) & (cells[:, 0] < high)]
            instance[tuple(cells.T)] = number
            found.append(ObjectInstance(number, 5, [0, 0, 0], [1, 1, 1], 0.0, cells, 1.0))
        return instance, tuple(found)

    tools = plain_tools()._replace(find=find)
    figures = {"density_kernel": 5, "density_threshold": 0.3, "cluster_radius": 1.5}
    command = parse_command({"op": "recluster", "class_id": 5, **figures})
    draft.apply(command.plan(draft, tools))
    assert set(draft.objects) == {CHAIR, TABLE, LAMP, 4}
    assert len(draft.cells_of(CHAIR)) == 40 and len(draft.cells_of(4)) == 40
    assert len(draft.cells_of(TABLE)) == 96


def test_snap_moves_an_object_to_its_support_or_nearest_wall():
    draft = lifted_room()
    done(draft, op="snap_object", id=LAMP, to="floor")
    assert draft.objects[LAMP].center_m[2] == pytest.approx(0.5)
    done(draft, op="move_object", id=CHAIR, to_m=[1.5, 1.0, 0.95])
    operation = done(draft, op="snap_object", id=CHAIR, to="floor")
    assert operation.counts_as == "move"
    assert draft.cells_of(CHAIR)[:, 2].min() == 5  # On the table.
    done(draft, op="move_object", id=CHAIR, to_m=[0.6, 1.5, 0.25])
    done(draft, op="snap_object", id=CHAIR, to="wall")
    assert draft.cells_of(CHAIR)[:, 0].min() == 1


@given(st.integers(2, 8), st.integers(2, 40), st.randoms(use_true_random=False))
def test_clusters_are_repeatable_and_separate_distant_cells(count, size, chance):
    cells = np.array([[chance.randrange(9) for _ in range(3)] for _ in range(size)])
    cells = np.unique(cells, axis=0)
    once = cluster_cells(cells, count)
    assert np.array_equal(once, cluster_cells(cells.copy(), count))
    assert once.min() >= 0 and once.max() < count
    far = np.concatenate([cells, cells + np.array([100, 0, 0])])
    two = cluster_cells(far, 2)
    assert (two[: len(cells)] == two[0]).all() and (two[len(cells) :] == 1 - two[0]).all()


def test_golden_refusals():
    assert refusal(op="split_object", id=TABLE, plane={"axis": "z", "at_m": 3}) == (
        "object 2 (table) is on one side of the plane; move the plane into its cells"
    )
    assert refusal(op="split_object", id=LAMP, parts=2) == (
        "object 3 (object) has too few cells to split"
    )
    assert refusal(op="split_object", id=TABLE) == (
        "split_object: split_object: Value error, specify either parts or plane, not "
        "{'op': 'split_object', 'id': 2}"
    )
    assert refusal(op="merge_objects", ids=[CHAIR, CHAIR]) == (
        "merging requires at least two different objects"
    )
    assert refusal(op="relabel_objects", ids=[CHAIR], class_id=5) == (
        "nothing to change: all objects already have this class"
    )
    assert refusal(op="snap_object", id=CHAIR, to="floor") == (
        "object 1 (chair) is already on the floor"
    )
    assert refusal(op="recluster", density_kernel=0, density_threshold=0, cluster_radius=1) == (
        "recluster: density_kernel: Input should be greater than or equal to 1, not 0"
    )

"""Commands on whole objects: what they do, their laws, and what they say when they cannot."""

from dataclasses import replace

import numpy as np
import pytest
from edit_scenes import state
from hypothesis import given
from hypothesis import strategies as st
from object_scenes import CHAIR, LAMP, SHAPE, TABLE, furnished_room, plain_tools

from world2minecraft.core.errors import UsageError
from world2minecraft.editing.scene import parse_command

TOOLS = plain_tools()
COMMANDS = (
    {"op": "delete_objects", "ids": [CHAIR, TABLE]},
    {"op": "move_object", "id": CHAIR, "to_m": [1.2, 1.4, 0.25]},
    {"op": "turn_objects", "ids": [CHAIR, TABLE, LAMP], "quarter_turns": 1},
    {"op": "duplicate_object", "id": TABLE},
    {"op": "duplicate_object", "id": CHAIR, "to_m": [2.0, 1.6, 0.25]},
    {"op": "add_object", "class_id": 5, "at_m": [1.9, 1.5, 1.0]},
    {"op": "set_template", "id": CHAIR, "template": "armchair", "quarter_turns": 2},
    {"op": "rematch", "ids": [CHAIR, TABLE]},
)


def done(draft, **fields):
    """Do a command to a draft, and return the operation."""
    operation = parse_command(fields).plan(draft, TOOLS)
    draft.apply(operation)
    return operation


def refusal(**fields) -> str:
    """What a command says that cannot be done to the room."""
    draft = furnished_room()
    before = state(draft)
    with pytest.raises(UsageError) as caught:
        parse_command(fields).plan(draft, TOOLS)
    assert state(draft) == before
    return str(caught.value)


@pytest.mark.parametrize("fields", COMMANDS, ids=lambda fields: fields["op"])
def test_a_command_changes_the_scene_and_its_inverse_restores_it(fields):
    draft = furnished_room()
    before = state(draft)
    operation = parse_command(fields).plan(draft, TOOLS)
    assert state(draft) == before, "a plan must not change the scene"
    draft.apply(operation)
    assert state(draft) != before
    draft.apply(operation.inverse())
    assert state(draft) == before


def test_deletion_leaves_observed_empty_cells_and_the_floor():
    draft = furnished_room()
    cells = draft.cells_of(CHAIR)
    structure = (draft.labels > 0) & (draft.labels < 5)
    operation = done(draft, op="delete_objects", ids=[CHAIR, CHAIR])
    assert (operation.counts_as, operation.class_id) == ("delete", 5)
    assert CHAIR not in draft.objects and len(draft.cells_of(CHAIR)) == 0
    held = draft.contents(cells)
    assert not held.labels.any() and (held.source == 1).all() and (held.confidence == 1).all()
    assert np.array_equal((draft.labels > 0) & (draft.labels < 5), structure)


def test_a_moved_object_takes_its_cells_and_furniture_along():
    draft = furnished_room()
    cells = draft.cells_of(CHAIR)
    held = draft.contents(cells)
    operation = done(draft, op="move_object", id=CHAIR, to_m=[0.7, 1.43, 0.25])
    assert operation.counts_as == "move"
    there = draft.cells_of(CHAIR)
    assert np.array_equal(there, cells + np.array([0, 7, 0]))
    for name in ("labels", "confidence", "colour", "source"):
        assert np.array_equal(getattr(draft.contents(there), name), getattr(held, name))
    one = draft.objects[CHAIR]
    assert one.center_m.tolist() == [0.7, 1.4, 0.25]
    assert one.placements[0].center_m.tolist() == [0.7, 1.4, 0.25]


@given(st.integers(0, 15), st.integers(5, 10), st.integers(0, 8))
def test_moved_there_and_back_through_free_space_is_the_identity(x, y, z):
    draft = furnished_room()
    done(draft, op="delete_objects", ids=[TABLE])
    before, objects = (draft.labels.copy(), draft.instance.copy()), state(draft)[6:]
    start = draft.objects[CHAIR].center_m
    to = start + 0.1 * np.array([x, y, z]) + 1e-3
    done(draft, op="move_object", id=CHAIR, to_m=to.tolist())
    done(draft, op="move_object", id=CHAIR, to_m=start.tolist())
    assert np.array_equal(draft.labels, before[0]) and np.array_equal(draft.instance, before[1])
    assert state(draft)[6:] == objects


@given(st.integers(-5, 14), st.integers(-5, 10), st.integers(-1, 9))
def test_moving_overwrites_neither_structure_nor_other_objects(x, y, z):
    draft = furnished_room()
    other = (draft.labels % 255 > 0) & (draft.instance != CHAIR)
    held = draft.labels[other].copy(), draft.instance[other].copy()
    to = draft.objects[CHAIR].center_m + 0.1 * np.array([x, y, z])
    if (x, y, z) == (0, 0, 0):
        return
    done(draft, op="move_object", id=CHAIR, to_m=to.tolist())
    assert np.array_equal(draft.labels[other], held[0])
    assert np.array_equal(draft.instance[other], held[1])
    assert len(draft.cells_of(CHAIR)) <= 80


@given(st.sampled_from([1, 2, 3, -1]), st.sampled_from([CHAIR, TABLE, LAMP]))
def test_quarter_turns_that_make_whole_ones_are_the_identity(turns, number):
    draft = furnished_room()
    labels, instance, objects = draft.labels.copy(), draft.instance.copy(), state(draft)[6:]
    for _ in range(4):
        done(draft, op="turn_objects", ids=[number], quarter_turns=turns)
    assert np.array_equal(draft.labels, labels) and np.array_equal(draft.instance, instance)
    assert state(draft)[6:] == objects


def test_turning_moves_own_cells_but_not_those_of_a_template():
    draft = furnished_room()
    chair, table = draft.cells_of(CHAIR), draft.cells_of(TABLE)
    operation = done(draft, op="turn_objects", ids=[CHAIR, TABLE], quarter_turns=1)
    assert (operation.counts_as, operation.class_id) == ("orient", None)
    assert draft.objects[CHAIR].yaw_deg == 180 and draft.objects[TABLE].yaw_deg == 90
    assert draft.objects[CHAIR].placements[0].quarter_turns == 2
    assert np.array_equal(draft.cells_of(CHAIR), chair)
    now = draft.cells_of(TABLE)
    assert (np.ptp(now, axis=0) + 1).tolist() == [4, 6, 4]
    assert len(now) == len(table)


def test_a_runs_placements_turn_about_the_middle_of_their_object():
    draft = furnished_room()
    one = draft.objects[CHAIR]
    wing = replace(one.placements[0], center_m=np.array([1.0, 0.7, 0.25]))
    draft.objects[CHAIR] = replace(one, placements=(*one.placements, wing))
    done(draft, op="turn_objects", ids=[CHAIR], quarter_turns=1)
    assert draft.objects[CHAIR].placements[1].center_m.tolist() == [0.7, 1.0, 0.25]


def test_deleting_a_duplicate_restores_the_cells():
    draft = furnished_room()
    labels, instance = draft.labels.copy(), draft.instance.copy()
    operation = done(draft, op="duplicate_object", id=TABLE)
    assert operation.counts_as == "add"
    (new,) = set(draft.objects) - {CHAIR, TABLE, LAMP}
    assert len(draft.cells_of(new)) == len(draft.cells_of(TABLE)) == 96
    assert draft.objects[new].class_id == 8
    done(draft, op="delete_objects", ids=[new])
    assert np.array_equal(draft.labels, labels) and np.array_equal(draft.instance, instance)


def test_an_added_chair_stands_on_the_floor_or_on_a_table():
    draft = furnished_room()
    done(draft, op="add_object", class_id=5, at_m=[2.0, 1.5, 1.2], quarter_turns=3)
    (new,) = set(draft.objects) - {CHAIR, TABLE, LAMP}
    one = draft.objects[new]
    assert one.placements[0].template == "chair" and one.yaw_deg == 270
    assert draft.cells_of(new)[:, 2].min() == 1
    assert abs(one.center_m[2] - one.size_m[2] / 2) < 1e-9
    assert np.abs(one.center_m[:2] - [2.0, 1.5]).max() <= 0.05 + 1e-9
    done(draft, op="add_object", class_id=11, at_m=[1.5, 1.0, 0.9], template="box")
    assert draft.cells_of(max(draft.objects))[:, 2].min() == 5


def test_an_added_piece_faces_away_from_the_wall_by_default():
    draft = furnished_room()
    done(draft, op="add_object", class_id=7, at_m=[0.55, 1.3, 0.0], template="sofa")
    assert draft.objects[max(draft.objects)].yaw_deg == 0


def test_set_template_sets_the_box_and_counts_a_pure_turn():
    draft = furnished_room()
    first = done(draft, op="set_template", id=CHAIR, template="armchair", quarter_turns=-1)
    assert first.counts_as == "other" and len(first.cells) == 0
    assert draft.objects[CHAIR].yaw_deg == 270 and draft.objects[CHAIR].confidence == 1
    again = done(draft, op="set_template", id=CHAIR, template="armchair", quarter_turns=0)
    assert again.counts_as == "orient"


def test_golden_refusals():
    assert refusal(op="delete_objects", ids=[9]) == "object 9 not found; objects: 1, 2, 3"
    assert refusal(op="move_object", id=CHAIR, to_m=[0.72, 0.68, 0.25]) == (
        "object 1 (chair) is already at to_m, which is less than a cell away"
    )
    assert refusal(op="move_object", id=CHAIR, to_m=[9, 0.7, 0.25]) == (
        "object 1 (chair) would leave the grid; its centre must be in x 0.20 to 2.20, "
        "y 0.20 to 1.80, z 0.15 to 1.25 m"
    )
    assert refusal(op="turn_objects", ids=[CHAIR], quarter_turns=0) == (
        "quarter_turns must be 1 to 3, or negative for clockwise"
    )
    assert refusal(op="add_object", class_id=5, at_m=[-4, 0, 0]) == (
        "at_m is outside the grid, which spans x 0.00 to 2.40, y 0.00 to 2.00, z -0.10 to 1.50 m"
    )
    assert refusal(op="add_object", class_id=5, at_m=[1, 1, 0], template="sofa") == (
        "sofa is for class sofa, but the object is a chair; relabel it first"
    )
    assert refusal(op="set_template", id=CHAIR, template="armchiar") == (
        "no template is named 'armchiar'; did you mean 'armchair'?"
    )
    assert refusal(op="rematch", ids=[LAMP]) == (
        "object 3 has no cells to match; choose a template for it"
    )
    assert refusal(op="move_object", id=0, to_m=[0, 0, 0]) == (
        "move_object: id: Input should be greater than or equal to 1, not 0"
    )
    assert refusal(op="add_object", class_id=3, at_m=[0, 0, 0]) == (
        "add_object: class_id: Input should be greater than or equal to 5, not 3"
    )


def test_a_turn_that_would_leave_the_grid_is_refused():
    draft = furnished_room()
    done(draft, op="move_object", id=TABLE, to_m=[1.5, 1.8, 0.2])
    with pytest.raises(UsageError, match="would leave the grid; move it inward"):
        done(draft, op="turn_objects", ids=[TABLE], quarter_turns=1)
    assert draft.shape == SHAPE

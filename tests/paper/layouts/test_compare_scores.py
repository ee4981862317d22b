"""What counts as outside and as a collision, on scenes whose figures are known by hand."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Layout, LayoutObject, Opening, Placement
from world2minecraft.paper.layouts import ComparedScene, Margins, score_scene, summary_of
from world2minecraft.paper.layouts.score_table import layout_table, other_table
from world2minecraft.paper.layouts.scores import integrity

ROOM = Layout([[0, 0], [4, 0], [4, 3], [0, 3]], 2.5)


def thing(x, y, size=(1.0, 1.0, 1.0), z=None, yaw=0.0, kind=SemanticClass.TABLE):
    z = size[2] / 2 if z is None else z
    return LayoutObject(int(kind), np.array([x, y, z]), np.array(size), yaw)


def scene(*objects, rooms=(ROOM,), **more):
    return ComparedScene("room", "method", rooms, objects, **more)


def test_a_good_room_has_no_fault():
    told = score_scene(scene(thing(0.5, 0.5), thing(2, 0.5), thing(3.5, 2.5)))
    assert not (told.outside or told.reaching or told.colliding or told.overlapping)


@pytest.mark.parametrize(
    ("item", "outside", "reaching"),
    [
        (thing(0.45, 1), False, False),  # 5 cm into the wall
        (thing(0.39, 1), False, True),  # 11 cm: 1 % of it is farther out than 10 cm
        (thing(0.37, 1), True, True),
        (thing(0.37, 0.37), True, True),
        (thing(1, 1, (0.2, 0.2, 2.55)), False, False),
        (thing(1, 1, (0.2, 0.2, 2.65)), True, False),
        (thing(2, 1.5, (3.0, 3.0, 1.0), yaw=45), True, True),
    ],
)
def test_out_of_bounds(item, outside, reaching):
    told = score_scene(scene(item))
    assert (bool(told.outside), bool(told.reaching)) == (outside, reaching)


def test_guessed_ceilings_make_nothing_too_high():
    tall = scene(thing(1, 1, (0.2, 0.2, 3.0)))
    assert score_scene(tall).outside == (0,)
    assert score_scene(replace(tall, is_height_stated=False)).outside == ()


def test_what_stands_in_any_room_is_within():
    other = Layout([[5, 0], [8, 0], [8, 3], [5, 3]], 2.5)
    assert score_scene(scene(thing(6, 1), rooms=(ROOM, other))).outside == ()
    assert score_scene(scene(thing(4.5, 1), rooms=(ROOM, other))).outside == (0,)


@pytest.mark.parametrize(
    ("one", "other", "collide", "overlap"),
    [
        (thing(1, 1), thing(2, 1), False, False),  # they touch
        (thing(1, 1), thing(1.99, 1), False, True),  # 1 cm
        (thing(1, 1), thing(1.9, 1), True, True),
        (thing(1, 1), thing(1, 1, (0.3, 0.3, 0.2), z=1.08), False, True),  # a lamp on a table
        (thing(1, 1, (3, 2, 0.02)), thing(1, 1), False, True),  # a table on a rug
        (thing(1, 1), thing(1, 1, (0.5, 0.5, 0.5), z=2.0), False, False),  # a lamp over it
        (thing(1, 1), thing(1.9, 1.9, yaw=45), False, False),  # boxes around them meet
    ],
)
def test_collisions(one, other, collide, overlap):
    told = score_scene(scene(one, other))
    assert (bool(told.colliding), bool(told.overlapping)) == (collide, overlap)


def test_two_placements_of_one_object_do_not_collide():
    def run(number, x):
        return Placement(number, int(SemanticClass.FURN), "counter", np.array([x, 1, 0.45]),
                         np.array([0.6, 2.0, 0.9]), 0, 0.8)  # fmt: skip

    assert score_scene(scene(run(1, 1.0), run(1, 1.3))).overlapping == ()
    assert score_scene(scene(run(1, 1.0), run(2, 1.3))).overlapping == ((0, 1),)


def test_margins_are_checked_and_heeded():
    with pytest.raises(UsageError, match="tolerances must be 0 or more"):
        Margins(depth_m=-1)
    close = scene(thing(1, 1), thing(1.99, 1))
    assert score_scene(close, Margins(shared=0.0, depth_m=0.0)).colliding == ((0, 1),)


things = st.builds(
    lambda x, y, a, b, c, yaw: thing(x, y, (a, b, c), yaw=yaw),
    st.floats(-1, 5), st.floats(-1, 4), st.floats(0.1, 2), st.floats(0.1, 2), st.floats(0.1, 2),
    st.floats(0, 360),
)  # fmt: skip


@settings(max_examples=20)
@given(st.lists(things, max_size=5), st.floats(-3, 3), st.floats(-3, 3), st.integers(0, 3))
def test_scores_do_not_hang_on_where_the_frame_lies(objects, x, y, quarters):
    """A quarter turn and a shift of all leave every count but rounding's as it is."""
    turn = np.round([[np.cos(quarters * np.pi / 2), -np.sin(quarters * np.pi / 2)],
                     [np.sin(quarters * np.pi / 2), np.cos(quarters * np.pi / 2)]])  # fmt: skip
    room = replace(ROOM, floor_polygon_m=ROOM.floor_polygon_m @ turn.T + [x, y])
    moved = [
        replace(
            item,
            center_m=np.array([*(turn @ item.center_m[:2] + [x, y]), item.center_m[2]]),
            yaw_deg=item.yaw_deg + 90 * quarters,
        )
        for item in objects
    ]
    here, there = score_scene(scene(*objects)), score_scene(scene(*moved, rooms=(room,)))
    assert abs(len(here.outside) - len(there.outside)) <= 1
    assert len(here.colliding) == pytest.approx(len(there.colliding), abs=1)


@settings(max_examples=20)
@given(st.lists(things, max_size=6))
def test_what_collides_overlaps(objects):
    told = score_scene(scene(*objects))
    assert set(told.colliding) <= set(told.overlapping)
    assert told.overlapping == tuple(sorted(told.overlapping))


def test_integrity_counts_true_categories():
    assert integrity(frozenset(), frozenset()) == (1.0, 1.0)
    assert integrity(frozenset({5}), frozenset()) == (1.0, 0.0)
    assert integrity(frozenset({5, 6}), frozenset({6, 7, 8})) == (1 / 3, 0.5)


def test_a_summary_is_over_all_objects_and_all_scenes():
    window = Opening("window", [1, 0], [2, 0], 0.9, 2.0)
    true = score_scene(
        scene(
            thing(1, 1), thing(3, 1, kind=SemanticClass.BED),
            rooms=(replace(ROOM, openings=(window,)),),
        )
    )  # fmt: skip
    bad = score_scene(scene(thing(-3, 1), thing(2, 1), thing(2.1, 1), unplaced=("lamp",)))
    good = score_scene(scene(thing(1, 1)))
    told = summary_of([bad, good], [true, None])
    assert (told["scenes"], told["objects"], told["unplaced"]) == (2, 4, 1)
    assert told["out_of_bounds"] == 0.25 and told["scenes_out_of_bounds"] == 0.5
    assert told["collisions"] == 0.5 and told["scenes_with_collisions"] == 0.5
    assert told["semantic_integrity"] == 0.5 and told["semantic_precision"] == 1.0
    assert told["semantic_integrity_with_structure"] == pytest.approx(4 / 6, abs=1e-4)
    assert told["solid_collisions"] == 0.5
    assert summary_of([bad])["semantic_integrity"] is None
    with pytest.raises(UsageError, match="no scene"):
        summary_of([])


def test_tables_have_a_cell_for_each_head():
    told = {"LayoutGPT": summary_of([score_scene(scene(thing(-3, 1)))])}
    for table in (layout_table(told), other_table(told)):
        assert len(table[0]) == len(table[1])
    assert layout_table(told)[1][3] == "1.000 (0.206 to 1.000)"
    assert layout_table(told)[1][6] == ""

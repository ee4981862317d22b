"""Object F1 and orientation: matched by class and place, each object once."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.types import LayoutObject, Placement
from world2minecraft.evaluation.metrics.objects import (
    ObjectCounts,
    count_objects,
    match_objects,
    turn_between_deg,
)


def thing(class_id, x, y=0.0, yaw_deg=0.0):
    return LayoutObject(class_id, np.array([x, y, 0.4]), np.array([0.5, 0.5, 0.8]), yaw_deg)


THINGS = st.lists(
    st.builds(thing, st.sampled_from([5, 8]), st.sampled_from([0.0, 0.2, 0.4, 0.7]), st.just(0.0)),
    max_size=4,
)


def slow_best_matching(found, true):
    """The most pairs that any one-to-one matching has, by trying all."""
    if len(found) > len(true):
        found, true = true, found
    best = 0
    for chosen in permutations(range(len(true)), len(found)):
        pairs = 0
        for m, n in enumerate(chosen):
            apart = np.linalg.norm(found[m].center_m - true[n].center_m)
            pairs += found[m].class_id == true[n].class_id and apart <= 0.3
        best = max(best, pairs)
    return best


@given(THINGS, THINGS)
def test_as_many_match_as_can(found, true):
    assert len(match_objects(found, true)) == slow_best_matching(found, true)


@given(THINGS)
def test_objects_match_themselves(things):
    counts = count_objects(things, things)
    assert counts.f1 == (1.0 if things else 0.0)
    assert counts.matched.sum() == len(things)


@given(THINGS, THINGS)
def test_precision_and_recall_change_places(found, true):
    one, other = count_objects(found, true), count_objects(true, found)
    assert (one.precision, one.recall, one.f1) == (other.recall, other.precision, other.f1)


def test_a_scene_by_hand():
    true = [thing(5, 0.0, yaw_deg=0), thing(5, 1.0, yaw_deg=90), thing(8, 3.0), thing(7, 5.0)]
    found = [thing(5, 0.1, yaw_deg=350), thing(5, 1.2, yaw_deg=270), thing(10, 3.0), thing(7, 5.31)]
    counts = count_objects(found, true)
    # The chairs match, the table has the wrong class, the sofa lies 31 cm off.
    assert counts.matched.sum() == 2
    assert counts.f1 == pytest.approx(2 * 2 / 8)
    assert counts.class_f1[5] == 1.0 and counts.class_f1[7] == 0.0
    assert (counts.turns_right, counts.turns_asked) == (1, 2)
    assert counts.orientation_right == 0.5


def test_tables_have_no_front_to_be_right():
    counts = count_objects([thing(8, 0.0, yaw_deg=90)], [thing(8, 0.0)])
    assert counts.turns_asked == 0 and counts.orientation_right == 0.0


def test_scenes_add_up():
    one = count_objects([thing(5, 0.0)], [thing(5, 0.0)])
    other = count_objects([thing(5, 0.0)], [thing(5, 9.0)])
    both = one + other
    assert both.f1 == 0.5
    assert (both.turns_right, both.turns_asked) == (1, 1)


@given(THINGS, THINGS)
def test_empty_scenes_add_nothing_absent_classes_have_no_f1(found, true):
    counts = count_objects(found, true)
    more = counts + ObjectCounts()
    assert (more.turns_right, more.turns_asked) == (counts.turns_right, counts.turns_asked)
    assert more.class_f1.tolist() == counts.class_f1.tolist()
    assert not counts.class_f1[[1, 6, 7, 11]].any()


@pytest.mark.parametrize(("x", "matches"), [(0.5, 1), (0.5000001, 0)])
def test_what_lies_just_as_far_as_allowed_matches(x, matches):
    assert len(match_objects([thing(5, 0.0)], [thing(5, x)], distance_m=0.5)) == matches


def test_one_is_matched_among_many_that_lie_elsewhere():
    many = [thing(5, 9.0 + n) for n in range(9)]
    assert match_objects([thing(5, 0.25)], [*many, thing(5, 0.0)]) == [(0, 9)]
    assert match_objects([*many, thing(5, 0.0)], [thing(5, 0.25)]) == [(9, 0)]


def test_more_matches_go_before_nearer_ones():
    """Five that are each 29 cm off, though four of them would lie on another's place."""
    found, true = ([thing(5, 0.29 * (n + m)) for n in range(5)] for m in (0, 1))
    assert match_objects(found, true) == [(n, n) for n in range(5)]


def test_of_two_that_could_match_the_nearer_one_does():
    assert match_objects([thing(5, 0.1)], [thing(5, 0.3), thing(5, 0.0)]) == [(0, 1)]
    crossed = match_objects([thing(5, 0.0), thing(5, 0.2)], [thing(5, 0.25), thing(5, 0.05)])
    assert crossed == [(0, 1), (1, 0)]


def test_placements_are_turned_by_quarters():
    place = Placement(
        object_id=1,
        class_id=5,
        template="chair",
        center_m=np.array([0.0, 0.0, 0.4]),
        size_m=np.array([0.5, 0.5, 0.8]),
        quarter_turns=1,
        iou=0.5,
    )
    assert count_objects([place], [thing(5, 0.0, yaw_deg=90)]).turns_right == 1
    assert count_objects([place], [thing(5, 0.0, yaw_deg=270)]).turns_right == 0
    for yaw_deg, right in ((44, 0), (45, 1), (135, 1), (136, 0)):
        assert count_objects([place], [thing(5, 0.0, yaw_deg=yaw_deg)]).turns_right == right


@given(st.floats(-720, 720), st.floats(-720, 720))
def test_turns_lie_between_0_and_180_and_go_both_ways(a, b):
    turn = turn_between_deg(a, b)
    assert 0 <= turn <= 180
    assert turn == pytest.approx(turn_between_deg(b, a), abs=1e-6)
    assert turn == pytest.approx(turn_between_deg(a + 360, b), abs=1e-6)

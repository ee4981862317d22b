"""Openings that were found against the true ones, in cases that were counted by hand."""

import numpy as np

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import Layout, Opening
from world2minecraft.evaluation.scoring.observed_cells import Reached
from world2minecraft.evaluation.scoring.opening_scores import opening_facts

OUTLINE = np.array([[0, 0], [4, 0], [4, 3], [0, 3]], np.float64)
LEFT = np.array([[-4, 0], [0, 0], [0, 3], [-4, 3]], np.float64)


def opening(kind="window", x=1.0, width=1.0, sill=0.8, head=2.0, y=3.0) -> Opening:
    return Opening(kind, np.array([x, y]), np.array([x + width, y]), sill, head)


def room(*openings, outline=OUTLINE, floor_z_m=0.0) -> Layout:
    return Layout(outline, 2.5, openings, floor_z_m=floor_z_m)


def everywhere(value=1) -> Reached:
    flags = np.full((150, 120, 60), value, np.uint8)
    return Reached(flags, np.array([-60, -20, -5]), 0.08, np.zeros(0, np.int64))


def test_kinds_and_places_must_agree():
    true = [room(opening(), opening("door", x=3.0, width=0.8, sill=0.0))]
    found = [room(opening(x=1.2), opening("doorway", x=3.0, width=0.8, sill=0.0))]
    facts = opening_facts(found, true, np.eye(4), everywhere())
    assert (facts["found"], facts["true"], facts["matched"], facts["f1"]) == (2, 2, 1, 0.5)
    assert facts["by_kind"]["window"]["f1"] == 1.0 and facts["by_kind"]["door"]["f1"] == 0.0
    far = opening_facts([room(opening(x=1.4))], true, np.eye(4), everywhere())
    assert far["matched"] == 0


def test_the_truth_is_carried_into_the_frame():
    turn = rotation_about_z(90)
    start, end = turn[:2, :2] @ [1.0, 3.0], turn[:2, :2] @ [2.0, 3.0]
    found = [room(Opening("window", start, end, 0.8, 2.0))]
    assert opening_facts(found, [room(opening())], turn, everywhere())["f1"] == 1.0


def test_a_door_between_two_rooms_counts_once():
    door = Opening("door", np.array([0.0, 1.0]), np.array([0.0, 1.8]), 0.0, 2.0)
    behind = Opening("door", np.array([-0.12, 1.8]), np.array([-0.12, 1.0]), 0.0, 2.0)
    rooms = [room(door), room(behind, outline=LEFT)]
    facts = opening_facts(rooms[:1], rooms, np.eye(4), everywhere())
    assert (facts["true"], facts["f1"]) == (1, 1.0)


def test_what_no_ray_came_to_is_not_asked_for_but_may_be_found():
    true = [room(opening())]
    assert opening_facts([], true, np.eye(4), everywhere(0))["true"] == 0
    assert opening_facts([], true, np.eye(4), everywhere(1))["true"] == 1
    assert opening_facts(true, true, np.eye(4), everywhere(0))["f1"] == 1.0


def test_upper_floors_count_from_their_own():
    true = [room(opening(), floor_z_m=2.8)]
    assert opening_facts([room(opening())], true, np.eye(4), everywhere())["matched"] == 0
    assert opening_facts(true, true, np.eye(4), everywhere())["matched"] == 1

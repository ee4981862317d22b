"""Scores of fine names: right at the right place; the class alone claims nothing."""

import numpy as np
import pytest

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import LayoutObject, ObjectInstance
from world2minecraft.evaluation.scoring.object_scores import TrueObjects, name_facts

NO_CELLS = np.zeros((0, 3), np.int32)


def true(name, x, seen=True):
    item = LayoutObject(SemanticClass.FURN, np.array([x, 1, 0.5]), np.ones(3), 0.0, name)
    return item, seen


def found(name, x, number=1):
    size = np.ones(3)
    return ObjectInstance(
        number, SemanticClass.OBJS, np.array([x, 1, 0.5]), size, 0.0, NO_CELLS, 0.9, name, 0.8
    )


def facts(names, *pairs):
    items, seen = zip(*pairs, strict=True)
    return name_facts(names, TrueObjects(items, np.array(seen)))


def test_names_count_where_they_are_right():
    row = facts(
        [found("refrigerator", 1), found("toilet", 3), found("furniture", 5)],
        true("fridge", 1.1),
        true("wardrobe", 3),
        true("tv_board", 5),
    )
    assert row["matched"] == 1
    assert row["named"] == 2  # Furniture says no more than the class.
    assert row["precision"] == pytest.approx(1 / 2)
    assert row["recall"] == pytest.approx(1 / 3)
    assert row["f1"] == pytest.approx(0.4)


def test_unseen_and_unknown_things_excuse_what_is_found_there():
    row = facts(
        [found("toilet", 1), found("guitar", 3), found("sofa", 5)],
        true("toilet", 1),
        true("gizmo", 3),
        true("sofa", 5, seen=False),
    )
    assert row["f1"] == 1


def test_a_name_far_from_its_thing_is_wrong():
    assert facts([found("toilet", 2)], true("toilet", 1))["f1"] == 0


def test_a_truth_without_names_has_no_score():
    assert facts([found("toilet", 1)], true("", 1)) == {}

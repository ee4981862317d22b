"""What furniture can stand for."""

import numpy as np
import pytest

from world2minecraft.core.types import ObjectInstance, Placement
from world2minecraft.reconstruction.verification.built_names import built_thing, stands_for


def object_of(class_id: int, name: str, confidence: float = 0.9) -> ObjectInstance:
    cells = np.zeros((1, 3), np.int32)
    return ObjectInstance(
        1, class_id, [1, 1, 0.4], [0.5, 0.5, 0.8], 0.0, cells, 0.9, name, confidence
    )


def placed(class_id: int, template: str) -> list[Placement]:
    return [Placement(1, class_id, template, [1, 1, 0.4], [0.5, 0.5, 0.8], 0, 0.7)]


@pytest.mark.parametrize(
    ("class_id", "name", "template", "stands"),
    [
        (11, "toilet", "toilet", True),
        (11, "toilet", "armchair", False),
        (10, "washbasin", "armchair", False),
        (8, "desk", "dining_table", True),
        (10, "cabinet", "bookcase", False),
        (10, "furniture", "bookcase", True),
        (10, "furniture", "armchair", False),
        (5, "chair", "cells", True),
    ],
)
def test_what_furniture_stands_for(class_id, name, template, stands):
    assert stands_for(object_of(class_id, name), placed(class_id, template)) == stands


def test_an_unsure_name_leaves_the_class_to_decide():
    assert stands_for(object_of(10, "cabinet", 0.2), placed(10, "bookcase"))


def test_an_object_without_anything_built_is_lost():
    assert not stands_for(object_of(10, "cabinet"), [])


def test_unnamed_things_agree_with_no_name():
    unnamed = built_thing(object_of(11, "object", 0.3), placed(11, "cells"))
    assert unnamed.titles == ("object",) and not unnamed.nyu40


def test_names_come_from_what_is_built():
    thing = built_thing(object_of(11, "toilet"), placed(11, "armchair"))
    assert thing.titles == ("armchair",) and thing.nyu40 == {5}

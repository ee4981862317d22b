"""The cabinet beside a toilet is a washbasin, and no other cabinet is."""

from dataclasses import replace

import numpy as np
import pytest

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.reconstruction.naming.name_model import ObjectTraits
from world2minecraft.reconstruction.naming.room_context import find_washbasin


def voted(**shares: float) -> np.ndarray:
    votes = np.zeros(40)
    for name, share in shares.items():
        votes[nyu40_names()[name] - 1] = share
    return votes


def cabinet(width_m=0.9, top_m=0.9, counter=0.05) -> ObjectTraits:
    votes = voted(cabinet=0.8, counter=counter, wall=0.2 - counter)
    return ObjectTraits(SemanticClass.FURN, (0.5, width_m, top_m), 0.0, 0.1, 1.5, votes, 5_000)


TOILET = ObjectTraits(SemanticClass.OBJS, (0.7, 0.4, 0.8), 0.0, 0.1, 1.6, voted(toilet=1.0), 5_000)
NAMED = ("toilet", 0.9)


def test_the_cabinet_beside_a_toilet_is_the_washbasin():
    assert find_washbasin([TOILET, cabinet()], [NAMED, ("cabinet", 0.9)]) == 1


def test_of_two_it_is_the_one_with_more_of_a_counter():
    objects = [cabinet(counter=0.02), TOILET, cabinet(counter=0.1)]
    names = [("cabinet", 0.9), NAMED, ("cabinet", 0.9)]
    assert find_washbasin(objects, names) == 2
    assert find_washbasin(objects[::-1], names) == 0


@pytest.mark.parametrize("name", [("toilet", 0.4), ("armchair", 0.9)])
def test_without_a_sure_toilet_nothing_is_a_washbasin(name):
    assert find_washbasin([TOILET, cabinet()], [name, ("cabinet", 0.9)]) is None


@pytest.mark.parametrize("basin", ["washbasin", "sink"])
def test_a_room_with_a_basin_gets_no_other(basin):
    names = [NAMED, ("cabinet", 0.9), (basin, 0.5)]
    assert find_washbasin([TOILET, cabinet(), cabinet()], names) is None


@pytest.mark.parametrize(
    "other",
    [
        cabinet(top_m=2.0),
        cabinet(top_m=0.4),
        cabinet(width_m=3.0),
        cabinet(counter=0.0),
        replace(cabinet(), votes=voted(chair=0.5, counter=0.5)),
    ],
)
def test_what_is_not_shaped_or_voted_like_one_stays(other):
    assert find_washbasin([TOILET, other], [NAMED, ("cabinet", 0.9)]) is None

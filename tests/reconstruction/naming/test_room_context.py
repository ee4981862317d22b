"""The cabinet beside a toilet is a washbasin, a basin beside a refrigerator a sink."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES, OBJECT_CLASSES, SemanticClass
from world2minecraft.core.vocabulary import (
    NYU40_COUNT,
    label_id_names,
    nyu40_names,
    read_vocabulary,
)
from world2minecraft.reconstruction.naming.name_model import ObjectTraits
from world2minecraft.reconstruction.naming.room_context import CONFIDENCE, name_by_context


def voted(**shares: float) -> np.ndarray:
    votes = np.zeros(40)
    for name, share in shares.items():
        votes[nyu40_names()[name.replace("_", " ")] - 1] = share
    return votes


def cabinet(width_m=0.9, top_m=0.9, counter=0.05, **more) -> ObjectTraits:
    rest = 0.2 - counter - sum(more.values())
    votes = voted(cabinet=0.8, counter=counter, wall=rest, **more)
    return ObjectTraits(SemanticClass.FURN, (0.5, width_m, top_m), 0.0, 0.1, 1.5, votes, 5_000)


TOILET = ObjectTraits(SemanticClass.OBJS, (0.7, 0.4, 0.8), 0.0, 0.1, 1.6, voted(toilet=1.0), 5_000)
FRIDGE = ObjectTraits(
    SemanticClass.FURN, (0.6, 0.6, 1.8), 0.0, 0.1, 0.6, voted(refrigerator=1.0), 5_000
)
IN_BATHROOM, IN_KITCHEN = ("toilet", 0.9), ("refrigerator", 0.9)
CABINET = ("cabinet", 0.9)


def named(objects, names) -> list[str]:
    return [name for name, _ in name_by_context(objects, names)]


def test_the_cabinet_beside_a_toilet_is_the_washbasin():
    assert name_by_context([TOILET, cabinet()], [IN_BATHROOM, CABINET])[1] == (
        "washbasin",
        CONFIDENCE,
    )


def test_of_two_it_is_the_one_with_more_of_a_counter():
    objects = [cabinet(counter=0.02), TOILET, cabinet(counter=0.1)]
    names = [CABINET, IN_BATHROOM, CABINET]
    assert named(objects, names) == ["cabinet", "toilet", "washbasin"]
    assert named(objects[::-1], names) == ["washbasin", "toilet", "cabinet"]


@pytest.mark.parametrize("name", [("toilet", 0.4), ("armchair", 0.9)])
def test_without_a_sure_toilet_nothing_is_a_washbasin(name):
    assert named([TOILET, cabinet()], [name, CABINET]) == [name[0], "cabinet"]


@pytest.mark.parametrize("basin", ["washbasin", "sink"])
def test_a_bathroom_with_a_basin_gets_no_other(basin):
    names = [IN_BATHROOM, CABINET, (basin, 0.5)]
    assert named([TOILET, cabinet(), cabinet()], names) == ["toilet", "cabinet", basin]


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
    assert named([TOILET, other], [IN_BATHROOM, CABINET]) == ["toilet", "cabinet"]


def test_the_basin_beside_a_refrigerator_is_a_sink():
    names = [IN_KITCHEN, ("washbasin", 0.6)]
    assert name_by_context([FRIDGE, cabinet()], names)[1] == ("sink", 0.6)
    assert named([FRIDGE, cabinet(), TOILET], [*names, IN_BATHROOM])[1] == "washbasin"


def test_kitchens_have_cabinets_in_place_of_wardrobes():
    assert named([FRIDGE, cabinet()], [IN_KITCHEN, ("wardrobe", 0.7)])[1] == "cabinet"
    assert named([cabinet()], [("wardrobe", 0.7)]) == ["wardrobe"]


def test_wall_cabinets_make_a_kitchen_but_no_stove():
    objects = [cabinet(), cabinet(other_structure=0.15)]
    names = [("wall cabinet", 0.9), CABINET]
    assert named(objects, names)[1] == "cabinet"
    assert named(objects, [names[0], ("washbasin", 0.6)])[1] == "sink"


def test_the_counter_with_votes_for_a_sink_is_the_sink():
    counters = [cabinet(counter=0.1), cabinet(sink=0.04), cabinet(sink=0.02)]
    names = [IN_KITCHEN, CABINET, CABINET, CABINET]
    assert named([FRIDGE, *counters], names) == ["refrigerator", "cabinet", "sink", "cabinet"]
    assert "sink" not in named([FRIDGE, counters[0], counters[2]], names[:3])


def test_other_structure_beside_a_refrigerator_is_a_stove():
    stove = cabinet(width_m=0.6, other_structure=0.15)
    assert named([FRIDGE, stove], [IN_KITCHEN, CABINET])[1] == "stove"
    assert named([TOILET, stove], [("mirror", 0.9), CABINET])[1] == "cabinet"
    for other in (cabinet(width_m=0.6, other_structure=0.1), replace(stove, bottom_m=0.6)):
        assert named([FRIDGE, other], [IN_KITCHEN, CABINET])[1] == "cabinet"


def test_a_shower_needs_a_bathroom_or_a_label():
    box = ObjectTraits(
        SemanticClass.OBJS, (0.6, 0.6, 0.9), 0.3, 1, 1, voted(other_structure=0.7), 5_000
    )
    shower = ("shower", 0.84)
    assert named([box], [shower]) == ["object"]
    assert named([box, TOILET], [shower, IN_BATHROOM])[0] == "shower"
    votes = np.zeros(len(label_id_names()) - 1)
    votes[NYU40_COUNT + list(read_vocabulary().names).index("shower")] = 1.0
    assert named([replace(box, votes=votes)], [shower]) == ["shower"]


traits = st.builds(
    ObjectTraits,
    st.sampled_from(OBJECT_CLASSES),
    st.tuples(*[st.floats(0.05, 3)] * 3),
    st.floats(0, 2),
    st.floats(0, 9),
    st.floats(0, 9),
    st.lists(st.floats(0, 1), min_size=40, max_size=40).map(
        lambda row: np.array(row) / max(sum(row), 1e-6)
    ),
    st.floats(0, 1e5),
)
all_names = st.sampled_from([*read_vocabulary().names, *CLASS_DISPLAY_NAMES])


@given(st.lists(st.tuples(traits, st.tuples(all_names, st.floats(0, 1))), max_size=6))
def test_order_does_not_matter_and_once_is_enough(room):
    objects, names = [one for one, _ in room], [name for _, name in room]
    once = name_by_context(objects, names)
    assert name_by_context(objects, once) == once
    back = name_by_context(objects[::-1], names[::-1])[::-1]
    assert sorted(back) == sorted(once)

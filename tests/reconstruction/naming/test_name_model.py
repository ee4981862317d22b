"""Names of objects: from votes, size and place; the class where nothing is sure."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES, OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import Layout, LayoutObject
from world2minecraft.core.vocabulary import (
    MIN_NAME_CONFIDENCE,
    label_id_names,
    label_id_of,
    nyu40_names,
    read_vocabulary,
)
from world2minecraft.reconstruction.naming.name_model import (
    FEATURES,
    NameModel,
    calibrated,
    features_of,
    name_objects,
    read_name_model,
)
from world2minecraft.reconstruction.naming.object_traits import (
    layout_of,
    name_instances,
    traits_of,
)

FURN, OBJS, CHAIR, BED = (
    SemanticClass.FURN,
    SemanticClass.OBJS,
    SemanticClass.CHAIR,
    SemanticClass.BED,
)
VOTES = 3000  # Of an object that many views show.
ROOM = Layout(np.array([[0.0, 0], [4, 0], [4, 3], [0, 3]]), 2.6)


def box(class_id, x, y, size, bottom=0.0):
    center = np.array([x, y, bottom + size[2] / 2])
    return LayoutObject(int(class_id), center, np.array(size, float), 0.0)


def votes_for(*names):
    votes = np.zeros((len(names), 40))
    for row, name in enumerate(names):
        if name:
            votes[row, nyu40_names()[name] - 1] = VOTES
    return votes


def named(*pairs):
    items = [item for item, _ in pairs]
    return [name for name, _ in name_instances(items, (ROOM,), votes_for(*(v for _, v in pairs)))]


def test_votes_name_what_the_model_does_not_know():
    names = read_vocabulary().names
    told = {entry.nyu40 for entry in names.values() if entry.class_id in OBJECT_CLASSES}
    told -= {names[name].nyu40 for name in read_name_model().names}
    votes = np.eye(40)[[number - 1 for number in told]] * VOTES
    items = [box(OBJS, 1, 1, (0.5, 0.5, 0.5))] * len(told)
    found = name_objects(traits_of(items, ROOM, votes))
    assert [names[name].nyu40 for name, _ in found] == list(told) != []


def test_the_model_gives_names_of_the_vocabulary():
    model = read_name_model()
    assert set(model.names) <= set(read_vocabulary().names)
    assert len(model.names) > 40


@pytest.mark.parametrize(
    ("class_id", "size", "bottom", "vote", "name"),
    [
        (OBJS, (0.7, 0.4, 0.8), 0.0, "toilet", "toilet"),
        (FURN, (0.7, 0.7, 1.8), 0.0, "refrigerator", "refrigerator"),
        (FURN, (0.6, 1.6, 2.1), 0.0, "cabinet", "wardrobe"),
        (FURN, (0.4, 0.9, 2.0), 0.0, "bookshelf", "bookcase"),
        (BED, (2.0, 1.6, 0.6), 0.0, "bed", "bed"),
        (OBJS, (0.08, 0.8, 0.6), 1.3, "picture", "picture"),
        (OBJS, (0.1, 1.2, 1.4), 0.9, "blinds", "blind"),
        (OBJS, (0.3, 0.5, 0.2), 0.5, "pillow", "cushion"),
    ],
)
def test_votes_and_size_name_objects(class_id, size, bottom, vote, name):
    y = size[0] / 2 if vote == "picture" else 0.5
    item = replace(box(class_id, 1.5, y, size, bottom), yaw_deg=90.0)
    assert named((item, vote)) == [name]


def test_without_a_hint_the_name_is_that_of_the_class():
    uniform = NameModel(
        ("cat tree", "guitar", "toilet"),
        {
            "mean": np.zeros(FEATURES, np.float32),
            "scale": np.ones(FEATURES, np.float32),
            "w1": np.zeros((FEATURES, 4), np.float32),
            "b1": np.zeros(4, np.float32),
            "w2": np.zeros((4, 3), np.float32),
            "b2": np.zeros(3, np.float32),
        },
    )
    (trait,) = traits_of([box(FURN, 2, 1, (1, 1, 1))], ROOM, np.zeros((1, 40)))
    assert name_objects([trait], uniform) == [("furniture", pytest.approx(1 / 3))]
    (trait,) = traits_of([box(FURN, 2, 1, (1, 1, 1))], ROOM, votes_for("toilet"))
    assert name_objects([trait], uniform) == [("toilet", pytest.approx(1, abs=0.01))]


def test_the_share_and_the_number_of_votes_make_the_probability():
    votes = votes_for("toilet")
    votes[0, nyu40_names()["wall"] - 1] = VOTES
    ((name, chance),) = name_instances([box(OBJS, 2, 1, (0.7, 0.4, 0.8))], (ROOM,), votes)
    assert (name, chance) == ("toilet", pytest.approx(calibrated(0.5, 2 * VOTES)))
    votes[0, nyu40_names()["wall"] - 1] = 2 * VOTES
    ((name, less),) = name_instances([box(OBJS, 2, 1, (0.7, 0.4, 0.8))], (ROOM,), votes)
    assert name == "object" and less < 0.5 < chance


@given(st.floats(0, 1), st.floats(0, 1), st.floats(0, 1e6), st.floats(0, 1e6))
def test_confidence_rises_with_share_and_votes(one, other, few, many):
    low, high = sorted((one, other))
    few, many = sorted((few, many))
    assert 0 < calibrated(low, few) <= calibrated(high, few) <= calibrated(high, many) < 1


@given(
    st.sampled_from(OBJECT_CLASSES),
    st.tuples(*[st.floats(0.04, 4)] * 3),
    st.floats(0, 2),
    st.integers(0, 40),
)
def test_names_are_sure_or_of_the_class(class_id, size, bottom, vote):
    votes = np.zeros((1, 40))
    votes[0, :vote] = VOTES
    ((name, chance),) = name_instances([box(class_id, 2, 1, size, bottom)], (), votes)
    assert 0 <= chance <= 1
    if chance < MIN_NAME_CONFIDENCE or not vote:
        assert name == CLASS_DISPLAY_NAMES[class_id]
    else:
        assert name in read_vocabulary().names


def test_the_order_of_the_objects_plays_no_part():
    items = [box(CHAIR, 1, 1, (0.5, 0.5, 0.9)), box(FURN, 3, 1, (0.7, 0.4, 0.8))]
    votes = votes_for("chair", "toilet")
    rows = features_of(traits_of(items, ROOM, votes))
    turned = features_of(traits_of(items[::-1], ROOM, votes[::-1]))
    assert np.allclose(rows, turned[::-1])
    assert rows.shape == (2, FEATURES)
    assert features_of([]).shape == (0, FEATURES)


def test_an_object_belongs_to_the_room_around_it():
    other = Layout(np.array([[4.2, 0.0], [8, 0], [8, 3], [4.2, 3]]), 2.6)
    upper = replace(ROOM, floor_z_m=2.9)
    rooms = (ROOM, other, upper)
    assert layout_of(box(CHAIR, 1, 1, (0.5, 0.5, 0.9)), rooms) == 0
    assert layout_of(box(CHAIR, 6, 1, (0.5, 0.5, 0.9)), rooms) == 1
    assert layout_of(box(CHAIR, 1, 1, (0.5, 0.5, 0.9), 2.9), rooms) == 2
    assert layout_of(box(CHAIR, 1, 1, (0.5, 0.5, 0.9)), ()) == -1


def test_the_distance_to_the_wall_is_that_of_the_nearest_face():
    (trait,) = traits_of([box(FURN, 1.0, 0.5, (0.6, 0.4, 1.0))], ROOM, np.zeros((1, 40)))
    assert trait.wall_m == pytest.approx(0.3)
    assert trait.ceiling_m == pytest.approx(1.6)
    assert trait.bottom_m == pytest.approx(0)


def test_votes_for_names_decide_among_them():
    items = [box(FURN, 0.4, 1, (0.6, 0.6, 0.85)), box(FURN, 0.4, 2, (0.6, 0.6, 0.85))]
    votes = np.zeros((2, len(label_id_names()) - 1))
    votes[0, label_id_of("washing machine") - 1] = VOTES
    votes[1, label_id_of("oven") - 1] = VOTES
    (first, sure), (second, _) = name_instances(items, (ROOM,), votes)
    assert (first, second) == ("washing machine", "oven") and sure > 0.98

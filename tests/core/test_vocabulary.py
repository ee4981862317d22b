"""The vocabulary: every template and NYU40 class has a name, and a label means one name."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.vocabulary import (
    VOCABULARY_FILE,
    nyu40_classes,
    nyu40_names,
    read_vocabulary,
)
from world2minecraft.furniture.library import builtin_design_files

SHIPPED = read_vocabulary()


def test_every_template_shows_a_named_thing():
    named = [template for entry in SHIPPED.names.values() for template in entry.templates]
    shared = {template for template in named if named.count(template) > 1}
    assert shared == {"stove"}, "a stove has an oven; all others show one thing"
    assert SHIPPED.of_template("stove").name == "stove"
    shipped = set(builtin_design_files())
    assert set(named) == shipped
    for template in shipped:
        assert template in SHIPPED.of_template(template).templates
    assert SHIPPED.of_template("spaceship") is None


def test_every_nyu40_class_has_a_name():
    for name, number in nyu40_names().items():
        names = SHIPPED.of_nyu40(number)
        assert names, name
        assert SHIPPED.find(name).nyu40 == number


def test_names_have_classes_and_titles():
    assert 100 <= len(SHIPPED.names) <= 140
    folded = nyu40_classes()
    for entry in SHIPPED.names.values():
        assert entry.class_id in (*OBJECT_CLASSES, 1, 2, 3, 4)
        assert entry.title
        if entry.templates and entry.class_id in (5, 6, 7, 8):
            things = (entry.class_id, SemanticClass.FURN)
            assert folded[entry.nyu40] in things, entry.name


@given(st.sampled_from(sorted(SHIPPED.names)), st.sampled_from(["", " ", "-merged", "-other"]))
def test_names_find_themselves_in_any_spelling(name, ending):
    entry = SHIPPED.find(name.upper().replace(" ", "_") + ending)
    assert entry is SHIPPED.names[name]
    for label in entry.labels:
        assert SHIPPED.find(label) is entry


def test_labels_of_nothing_mean_no_name():
    table = SHIPPED.label_table()
    assert SHIPPED.find("sky") is None
    assert table["sky"] is None
    assert table["fridge"] == SemanticClass.FURN
    assert SHIPPED.find("gizmo") is None


def test_a_user_adds_a_name_and_takes_labels(tmp_path):
    own = tmp_path / "names.yaml"
    own.write_text(
        "Telescope: {class: objs, also: [spyglass, monitor], templates: [coat_stand]}\n"
        "toilet: [throne]\n"
        "nothing: [mirror]\n"
    )
    mine = read_vocabulary(own)
    assert mine.find("Spyglass").name == "telescope"
    assert mine.find("throne").name == "toilet"
    assert mine.find("water closet").name == "toilet"
    assert mine.find("monitor").name == "telescope"
    assert mine.find("mirror") is None
    assert mine.names["telescope"].nyu40 == 40
    assert mine.of_template("coat_stand").name == "telescope"
    assert SHIPPED.find("monitor").name == "monitor"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("lens: {class: glass}", "no class is named 'glass'"),
        ("lens: {clas: objs}", "in the entry 'lens', no setting is named 'clas'; did you mean"),
        ("lens: {nyu40: lenses}", "in the entry 'lens', no NYU40 class is named 'lenses'"),
        ("lens: {nyu40: [chair]}", "in the entry 'lens', no NYU40 class is named"),
        ("lens: {also: optics}", "in the entry 'lens', also must be a list"),
    ],
)
def test_a_wrong_entry_is_refused(tmp_path, text, reason):
    own = tmp_path / "names.yaml"
    own.write_text(text)
    with pytest.raises(DamagedFileError, match=reason):
        read_vocabulary(own)


def test_the_file_has_no_label_twice():
    lines = [line for line in VOCABULARY_FILE.read_text().splitlines() if line[:1] != "#"]
    assert lines
    labels = [x for entry in SHIPPED.names.values() for x in (entry.name, *entry.labels)]
    doubled = {label for label in labels if labels.count(label) > 1}
    assert not doubled
    assert not SHIPPED.silent & set(labels) - {"palm"}
    assert np.array_equal(nyu40_classes()[41:], np.full(65536 - 41, 255))

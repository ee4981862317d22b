"""Class ids of other programs: what each becomes, and what is refused by name."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.formats.class_ids import CLASS_SETS, read_class_set

OURS = st.sampled_from([*range(12), 255])
GRIDS = arrays(np.uint8, (3, 2, 2), elements=OURS)


def embodied(labels):
    """EmbodiedOcc's own ids: 0 is ignored, 12 is empty."""
    return np.where(labels == 0, 12, np.where(labels == 255, 0, labels))


@given(GRIDS, st.sampled_from([np.uint8, np.int64, np.float32]))
def test_ids_of_a_set_become_the_classes(labels, kind):
    for name in ("nyu12", "occscannet"):
        assert np.array_equal(read_class_set(name).convert(labels.astype(kind), "f"), labels)
    theirs = embodied(labels).astype(kind)
    assert np.array_equal(read_class_set("embodied").convert(theirs, "f"), labels)


@given(GRIDS, st.permutations(list(range(40))))
def test_a_file_of_ids_is_followed(tmp_path_factory, labels, order):
    """Any one-to-one list of ids leads back to the classes."""
    names = ["empty", "ceiling", "floor", "wall", "window", "chair", "bed", "sofa", "table"]
    names += ["tvs", "furn", "objs", "unknown"]
    path = tmp_path_factory.mktemp("ids") / "ids.yaml"
    path.write_text("".join(f"{order[n]}: {name}\n" for n, name in enumerate(names)))
    theirs = np.array(order[:13])[np.where(labels == 255, 12, labels)]
    assert np.array_equal(read_class_set(path).convert(theirs, "f"), labels)


def test_a_list_of_names_counts_from_0(tmp_path):
    path = tmp_path / "ids.yaml"
    path.write_text("[unknown, Wall, furniture, empty]")
    ids = read_class_set(path)
    assert ids.convert(np.array([0, 1, 2, 3]), "f").tolist() == [255, 3, 10, 0]
    shares = ids.convert_scores(np.array([[0.5, 0.25, 0.25, 0.0], [1.0, 0, 0, 0]]))
    assert shares[0, [3, 10]].tolist() == [0.5, 0.5] and not shares[1].any()


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.array([0, 12]), "f: contains the class id 12, which is empty in EmbodiedOcc; set "
         "classes to embodied"),
        (np.array([99, 255]), "f: contains the class id 99, which nyu12 does not have; set "
         "classes (--classes) to nyu12, embodied, occscannet or a YAML file of ids and names"),
        (np.array([-1, 2]), "f: contains the value -1, expected class ids from 0 to 65535"),
        (np.array([0.5]), "f: contains fractions, expected class ids; scores need one more axis, "
         "with a channel for each class"),
        (np.array([np.nan]), "f: contains NaN or infinity, expected class ids"),
        (np.array([True]), "f: must contain class ids or scores, got values of type bool"),
        (np.array(["a"]), "f: must contain class ids or scores, got values of type <U1"),
    ],
)  # fmt: skip
def test_other_values_are_refused(values, message):
    with pytest.raises(DamagedFileError) as caught:
        read_class_set("nyu12").convert(values, "f")
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{0: empty, 1: gizmo}", "'gizmo' is not a class; known: empty, ceiling"),
        ("{1: wall}", "no id is empty; add a line such as 0: empty"),
        ("{one: wall}", "'one' must be an id from 0 to 65535"),
        ("{0: empty, 1: [wall]}", "the class of 1 must be a name, got ['wall']"),
        ("wall", "expected lines such as 0: empty"),
        ("{0: [", "does not list class ids"),
    ],
)
def test_a_file_without_ids_is_refused(tmp_path, text, message):
    path = tmp_path / "ids.yaml"
    path.write_text(text)
    with pytest.raises(DamagedFileError) as caught:
        read_class_set(path)
    assert message in str(caught.value) and "\n" not in str(caught.value)
    with pytest.raises(UnknownNameError, match="no class set is named 'nyu21'"):
        read_class_set("nyu21")
    assert [read_class_set(name).count for name in CLASS_SETS] == [12, 13, 12]

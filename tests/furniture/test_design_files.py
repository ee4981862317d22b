"""Design files: what they may say, and what is told of those that say something else."""

import copy
import json
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import InputError, World2MinecraftError
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.furniture.design_files import design_from_json, read_design
from world2minecraft.furniture.library import builtin_design_files

CHAIR = json.loads(builtin_design_files()["chair"].read_text("utf-8"))


def _changed(*path, value=None, drop=False):
    raw = copy.deepcopy(CHAIR)
    place = raw
    for key in path[:-1]:
        place = place[key]
    if drop:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return raw


def test_a_design_file_is_what_it_says():
    chair = template("chair")
    assert (chair.title, chair.family, chair.mount, chair.turns) == ("Chair", "chair", "floor", 4)
    assert chair.size_m[2].typical == CHAIR["size_m"]["height"][1]
    assert chair.clearance_m == (0.6, 0.0, 0.0)
    assert chair.matched
    assert chair.options == {"arms": "none"}
    assert (chair.materials["seat"].kind, chair.materials["seat"].takes_colour) == ("wood", True)


def test_every_file_of_the_library_is_read_under_its_own_name():
    files = builtin_design_files()
    assert set(files) <= set(TEMPLATES.names())
    for name, path in files.items():
        assert read_design(path).name == name


@pytest.mark.parametrize(
    ("raw", "message"),
    [
        ([1], "a design must be a JSON object, got [1]"),
        (_changed("title", drop=True), "a design does not contain the key 'title'"),
        (
            _changed("colour", value=1),
            "a design contains the unknown key 'colour'; keys: name, title, class, family, size_m, "
            "front, clearance_m, materials, mount, turns, parameters, options, match, suits, "
            "stands_for",
        ),
        (
            _changed("class", value="wall"),
            "class must be one of chair, bed, sofa, table, tvs, furn, objs, got 'wall'",
        ),
        (
            _changed("family", value="chiar"),
            "no furniture family is named 'chiar'; did you mean 'chair'?",
        ),
        (
            _changed("size_m", "depth", value=[0.4, 0.3, 0.5]),
            "depth must increase from minimum to maximum, got [0.4, 0.3, 0.5]",
        ),
        (
            _changed("size_m", "depth", value=[0.4, 0.5]),
            "depth must be [minimum, typical, maximum], got [0.4, 0.5]",
        ),
        (
            _changed("size_m", "depth", value=[0.0, 0.3, 0.5]),
            "depth must be between 0.01 and 20, got 0.0",
        ),
        (_changed("turns", value=True), "turns must be one of 1, 2, 4, got True"),
        (
            _changed("options", value={"arms": "gold"}),
            'arms must be one of "none", "wood", got \'gold\'',
        ),
        (
            _changed("parameters", value={"legs": [1, 2, 3]}),
            "parameters contains the unknown key 'legs'; keys: seat_height",
        ),
        (_changed("materials", "leg", drop=True), "materials does not contain the key 'leg'"),
        (
            _changed("materials", "leg", "of", value="redwood"),
            "unknown wood 'redwood'; known: oak, spruce, birch, jungle, acacia, dark_oak, "
            "mangrove, cherry, crimson, warped",
        ),
        (
            _changed("materials", "leg", "kind", value="air"),
            "unknown kind of material 'air'; kinds: wood, cloth, paint, glass, stone, metal, "
            "plain, fixed",
        ),
        (
            _changed("materials", "leg", value={"kind": "fixed", "of": "gold_chair"}),
            "unknown block 'gold_chair'",
        ),
        (
            _changed("suits", value=["red"]),
            "a colour of suits must have the form #8a3b2c, got 'red'",
        ),
        (_changed("name", value="../chair"), None),
    ],
)
def test_what_no_design_may_say_is_refused(raw, message):
    with pytest.raises((ValueError, World2MinecraftError)) as caught:
        design_from_json(raw)
    if message is not None:
        assert str(caught.value) == message


def test_a_file_is_named_as_its_design(tmp_path):
    path = tmp_path / "stool.json"
    path.write_text(json.dumps(CHAIR))
    with pytest.raises(InputError) as caught:
        read_design(path)
    assert str(caught.value) == f"{path}: the design name must match the file name, got 'chair'"


@given(st.binary(max_size=200))
def test_any_bytes_are_refused_in_one_line(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("any") / "chair.json"
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_design(path)
    assert "\n" not in str(caught.value)


def _leaves(value, path=()):
    if isinstance(value, dict):
        for key, held in value.items():
            yield from _leaves(held, (*path, key))
    else:
        yield path


JUNK = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=9), st.lists(st.none())
)


@given(st.sampled_from(sorted(_leaves(CHAIR))), JUNK)
def test_any_value_gives_a_design_or_a_typed_error(path, value):
    with suppress(ValueError, World2MinecraftError):
        design_from_json(_changed(*path, value=value))


def test_a_deep_file_and_a_large_one_are_refused(tmp_path):
    for name, text in (("deep", "[" * 30_000), ("large", " " * 100_000)):
        path = tmp_path / f"{name}.json"
        path.write_text(text)
        with pytest.raises(InputError):
            read_design(path)

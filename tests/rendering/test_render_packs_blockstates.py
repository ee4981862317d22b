"""Which models a state is drawn as: variants, lists by weight, multipart conditions."""

import pytest

from world2minecraft.rendering.resource_packs.model_json import ModelPart, select_parts


def models(root, **properties) -> list[str]:
    return [part.model for part in select_parts(root, properties)]


def test_a_variant_is_found_by_a_part_of_the_properties():
    root = {"variants": {"facing=east,half=top": {"model": "a"}, "facing=west": {"model": "b"}}}
    assert models(root, facing="east", half="top", waterlogged="true") == ["a"]
    assert models(root, facing="west", half="top", waterlogged="false") == ["b"]


@pytest.mark.parametrize("key", ["", "normal"])
def test_one_variant_for_all_states(key):
    assert models({"variants": {key: {"model": "a"}}}, axis="y") == ["a"]


def test_a_property_that_a_state_lacks_counts_as_any():
    root = {"variants": {"axis=x": {"model": "a"}, "axis=y": {"model": "b"}}}
    assert models(root) == ["a"]


def test_no_variant_says_for_what():
    root = {"variants": {"axis=x": {"model": "a"}}}
    with pytest.raises(ValueError, match=r"^has no variant for 'axis=z'$"):
        select_parts(root, {"axis": "z"})


def test_of_a_list_the_heaviest_counts_and_the_first_of_equals():
    several = [{"model": "a"}, {"model": "b", "weight": 3}, {"model": "c", "weight": 3}]
    assert models({"variants": {"": several}}) == ["b"]
    assert models({"variants": {"": [{"model": "a"}, {"model": "a", "y": 90}]}}) == ["a"]
    assert models({"multipart": [{"apply": several}]}) == ["b"]


def test_turns_and_lock_are_read():
    turned = {"model": "a", "x": 90, "y": 270, "z": -90, "uvlock": True}
    assert select_parts({"variants": {"": turned}}, {}) == (ModelPart("a", 90, 270, 270, True),)


@pytest.mark.parametrize(
    ("when", "holds"),
    [
        ({}, True),
        ({"north": "true"}, True),
        ({"north": True}, True),
        ({"north": "false"}, False),
        ({"north": "true", "up": "false"}, False),
        ({"height": "none|low"}, True),
        ({"height": "!none|tall"}, True),
        ({"height": "!low"}, False),
        ({"level": 3}, True),
        ({"missing": "true"}, False),
        ({"OR": [{"north": "false"}, {"height": "low"}]}, True),
        ({"OR": [{"north": "false"}, {"height": "tall"}]}, False),
        ({"AND": [{"north": "true"}, {"height": "low|tall"}]}, True),
        ({"AND": [{"north": "true"}, {"OR": [{"up": "false"}, {"height": "none"}]}]}, False),
        ({"OR": [{"AND": [{"up": "true"}, {"north": "true"}]}, {"height": "none"}]}, True),
        ({"OR": [{"north": "true"}], "up": "false"}, False),
        ({"OR": []}, False),
        ({"AND": []}, True),
    ],
)
def test_conditions(when, holds):
    state = {"north": "true", "up": "true", "height": "low", "level": "3"}
    root = {"multipart": [{"when": when, "apply": {"model": "a"}}]}
    assert bool(select_parts(root, state)) == holds


def test_all_cases_that_hold_are_drawn_in_order():
    root = {
        "multipart": [
            {"apply": {"model": "post"}},
            {"when": {"north": "true"}, "apply": {"model": "side"}},
            {"when": {"east": "true"}, "apply": {"model": "side", "y": 90, "uvlock": True}},
        ]
    }
    parts = select_parts(root, {"north": "false", "east": "true"})
    assert parts == (ModelPart("post"), ModelPart("side", y_deg=90, uv_lock=True))


@pytest.mark.parametrize(
    ("root", "text"),
    [
        ({}, "contains neither variants nor multipart"),
        ({"variants": []}, "variants must be an object, got a list"),
        ({"variants": {"": 3}}, "a variant must be an object, got 3"),
        ({"variants": {"": {}}}, "model must be a string, got None"),
        ({"variants": {"": []}}, "contains an empty list of models"),
        ({"variants": {"": {"model": "a", "x": 45}}}, "x must be a multiple of 90, got 45"),
        ({"variants": {"": {"model": "a", "y": "90"}}}, "y must be a number, got '90'"),
        ({"variants": {"": [{"model": "a", "weight": None}]}}, "weight must be a number, got None"),
        ({"multipart": {}}, "multipart must be a list, got an object"),
        ({"multipart": [7]}, "a case of multipart must be an object, got 7"),
        ({"multipart": [{}]}, "a variant must be an object, got None"),
        ({"multipart": [{"when": [], "apply": {}}]}, "when must be an object, got a list"),
        ({"multipart": [{"when": {"a": None}}]}, "a value in when must be a string, got None"),
    ],
)
def test_what_is_wrong_is_said(root, text):
    with pytest.raises(ValueError) as caught:
        select_parts(root, {"a": "b"})
    assert str(caught.value) == text


def test_conditions_nested_without_end_are_refused():
    when: dict = {"a": "b"}
    for _ in range(40):
        when = {"OR": [when]}
    with pytest.raises(ValueError, match="nested too deep"):
        select_parts({"multipart": [{"when": when, "apply": {"model": "a"}}]}, {"a": "b"})

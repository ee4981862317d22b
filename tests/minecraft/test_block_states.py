import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraft.block_states import (
    BlockState,
    check_state,
    complete,
    known_blocks,
    parse_state,
    states_of,
)
from world2minecraft.minecraft.collision_shapes import boxes_of, is_full_cube

words = st.from_regex(r"[a-z0-9_]{1,8}", fullmatch=True)
names = st.builds("{}:{}".format, words, st.from_regex(r"[a-z0-9_./-]{1,8}", fullmatch=True))


@given(names, st.dictionaries(words, words, max_size=4))
def test_text_and_value_say_the_same(name, properties):
    state = BlockState(name, properties)
    assert parse_state(str(state)) == state
    assert dict(state.properties) == properties


@given(st.text(max_size=30))
def test_any_text_is_a_state_or_refused(text):
    try:
        assert parse_state(str(parse_state(text))) == parse_state(text)
    except UsageError as error:
        assert "\n" not in str(error) or "\n" in text


def test_the_canonical_text_names_the_namespace_and_sorts():
    text = "oak_stairs[ shape=straight, facing=east ]"
    assert str(parse_state(text)) == "minecraft:oak_stairs[facing=east,shape=straight]"
    assert str(parse_state("stone")) == str(parse_state("minecraft:stone[]")) == "minecraft:stone"


@pytest.mark.parametrize(
    "text",
    ["", "Stone", "stone[", "stone]", "stone[a]", "stone[a=]", "stone[a=b,a=c]", "a:b:c",
     "stone[A=b]", "stone[a=b]c", "stone[a=b,]", "minecraft:", ":stone", "sto ne", "x" * 2000],
)  # fmt: skip
def test_a_text_that_is_no_state_is_refused(text):
    with pytest.raises(UsageError):
        parse_state(text)


def test_what_the_errors_say():
    cases = {
        "oak_log[axis": "block state 'oak_log[axis' is invalid; expected text such as"
        " minecraft:oak_log[axis=y]",
        "Stone": "block name 'Stone' is invalid; expected a name such as minecraft:oak_log"
        " with lower-case letters, digits and _ . - /",
        "stone[a=B]": "property a=B of minecraft:stone is invalid; use lower-case letters,"
        " digits and _",
    }
    for text, message in cases.items():
        with pytest.raises(UsageError) as caught:
            parse_state(text)
        assert str(caught.value) == message


def test_missing_properties_are_the_defaults():
    assert str(complete(parse_state("oak_stairs[facing=east]"))) == (
        "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]"
    )
    assert str(complete(parse_state("oak_log"))) == "minecraft:oak_log[axis=y]"
    assert str(complete(parse_state("mod:sofa[side=left]"))) == "mod:sofa[side=left]"


def test_completing_twice_changes_nothing():
    for name in known_blocks():
        for state in states_of(name):
            assert complete(state) == state
        default = complete(BlockState(name))
        assert default in states_of(name)


def test_unknown_blocks_and_values_suggest_the_nearest():
    assert check_state(parse_state("oak_slab[type=top]"))
    for text, message in {
        "oak_stair": "no block is named 'minecraft:oak_stair'; did you mean 'minecraft:oak_stairs'",
        "oak_slab[typ=top]": "property of minecraft:oak_slab is named 'typ'; did you mean 'type'",
        "oak_slab[type=tops]": "no type value of .*oak_slab is named 'tops'; did you mean 'top'",
    }.items():
        with pytest.raises(UnknownNameError, match=message):
            check_state(parse_state(text))


def test_known_shapes():
    assert boxes_of("minecraft:air").shape == (0, 6)
    assert boxes_of("stone").tolist() == [[0, 0, 0, 1, 1, 1]]
    assert boxes_of("oak_slab[type=bottom]").tolist() == [[0, 0, 0, 1, 0.5, 1]]
    assert boxes_of("oak_slab").tolist() == boxes_of("oak_slab[type=bottom]").tolist()
    stairs = boxes_of("oak_stairs[facing=east,half=bottom,shape=straight]")
    assert [0.5, 0.5, 0, 1, 1, 1] in stairs.tolist()  # The high side is where it faces.
    assert boxes_of("oak_fence")[:, 4].max() == 1.5
    assert boxes_of("mod:wardrobe").tolist() == [[0, 0, 0, 1, 1, 1]]
    assert boxes_of("stone").dtype == np.float32


def test_full_cubes():
    assert is_full_cube("oak_planks") and is_full_cube("oak_slab[type=double]")
    assert not any(is_full_cube(text) for text in ("air", "oak_slab", "chest", "torch"))


def test_shapes_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        boxes_of("stone")[0] = 2

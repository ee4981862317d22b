"""Recipes: what is read, what is refused and with which words."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from texture_table import generator_table

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.rendering.textures import (
    GENERATORS,
    parse_recipe,
    recipe_of,
    texture_of,
    texture_sheet,
)
from world2minecraft.rendering.textures.__main__ import main


def test_one_texture_has_one_name():
    text = "own:planks#A2824E?gaps=none&boards=2"
    assert parse_recipe(text).text == "own:planks#a2824e?boards=2&gaps=none"
    assert texture_of(text) is texture_of("own:planks#a2824e?boards=2&gaps=none")


def test_a_written_recipe_is_read_again():
    text = recipe_of("bricks", (150, 96, 79), (167, 159, 151), rows=2)
    assert text == "own:bricks#96604f,#a79f97?rows=2"
    recipe = parse_recipe(text)
    assert recipe.colours == ((150, 96, 79), (167, 159, 151))
    assert recipe.number("rows") == 2


def test_accents_and_options_have_defaults():
    recipe = parse_recipe("own:rings#a88753")
    assert recipe.colours == ((168, 135, 83), (97, 74, 43))
    assert recipe.options == {"seed": 0, "contrast": 1.0}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "planks#a2824e",
            "invalid texture recipe 'planks#a2824e'; use the form own:planks#a2824e?boards=4",
        ),
        (
            "own:planks",
            "own:planks: invalid colour ''; use #rrggbb as in own:planks#a2824e?boards=4",
        ),
        (
            "own:planks#12345",
            "own:planks#12345: invalid colour '#12345'; use #rrggbb as in"
            " own:planks#a2824e?boards=4",
        ),
        (
            "own:wool#112233,#445566",
            "own:wool#112233,#445566: texture 'wool' accepts at most 1 colours, got 2",
        ),
        (
            "own:planks#a2824e?boards=3",
            "own:planks#a2824e?boards=3: boards must be one of 4, 1, 2, 8, got '3'",
        ),
        (
            "own:plain#a2824e?grain=nan",
            "own:plain#a2824e?grain=nan: grain must be a number from 0 to 3, got 'nan'",
        ),
        (
            "own:planks#a2824e?boards",
            "own:planks#a2824e?boards: invalid option 'boards'; use key=value and each key only "
            "once",
        ),
        (
            "own:planks#a2824e?boards=4&boards=4",
            "own:planks#a2824e?boards=4&boards=4: invalid option 'boards=4'; use key=value and "
            "each key only once",
        ),
    ],
)
def test_a_bad_recipe_is_refused(text, message):
    with pytest.raises(UsageError) as caught:
        texture_of(text)
    assert str(caught.value) == message


def test_an_unknown_name_brings_the_nearest():
    with pytest.raises(UnknownNameError, match="no texture is named 'plank'; did you mean 'plan"):
        texture_of("own:plank#a2824e")
    with pytest.raises(UnknownNameError, match="did you mean 'boards'"):
        texture_of("own:planks#a2824e?bords=4")


PIECES = st.sampled_from(
    [
        "own:",
        "planks",
        "#a2824e",
        ",",
        "?",
        "&",
        "=",
        "boards",
        "4",
        "seed",
        "nan",
        "1e999",
        "#",
        "é",
    ]
)


@given(st.lists(PIECES, max_size=12).map("".join))
def test_any_text_is_read_or_refused_with_words(text):
    try:
        recipe = parse_recipe(text)
    except UsageError as fault:
        assert str(fault)
    else:
        assert parse_recipe(recipe.text) == recipe


def test_a_long_recipe_is_refused():
    with pytest.raises(UsageError, match="invalid texture recipe"):
        texture_of("own:planks" + "#a2824e," * 100)


@pytest.mark.parametrize("size_px", [0, 8, 17, 256, -16])
def test_other_sizes_are_refused(size_px):
    with pytest.raises(UsageError) as caught:
        texture_of("own:plain#808080", size_px)
    assert str(caught.value) == f"the texture size must be 16, 32, 64, 128 pixels, got {size_px}"


def test_colours_are_levels():
    with pytest.raises(UsageError, match="three integers from 0 to 255"):
        recipe_of("plain", (256, 0, 0))


def test_the_sheet_shows_them_all():
    sheet = texture_sheet(16, columns=8)
    assert sheet.dtype.name == "uint8"
    assert sheet.shape[2] == 3
    assert len(GENERATORS) >= 60


def test_the_docs_have_the_table_of_today():
    page = Path(__file__).resolve().parents[2] / "docs" / "reference" / "textures.md"
    assert generator_table() in page.read_text(encoding="utf-8")


def test_the_sheet_is_written_as_a_picture(tmp_path):
    main([str(tmp_path / "sheet.png"), "16", "2"])
    with Image.open(tmp_path / "sheet.png") as picture:
        assert picture.width > 1000
    with pytest.raises(UsageError, match="usage: python -m world2minecraft.rendering.textures"):
        main([])

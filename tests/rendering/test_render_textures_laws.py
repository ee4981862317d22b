"""Every generator at every size: shape, mean colour, holes, and the same bytes again."""

import numpy as np
import pytest

from world2minecraft.rendering.textures import GENERATORS, SIZES_PX, parse_recipe, texture_of
from world2minecraft.rendering.textures.recipe import Choice


def variants(name: str) -> list[str]:
    """The sample of a generator, and one more for each word of its options."""
    sample = f"own:{name}{GENERATORS[name].sample}"
    base = sample.partition("?")[0]
    words = [
        f"{base}?{key}={word}"
        for key, option in GENERATORS[name].options.items()
        if isinstance(option, Choice)
        for word in option.words
    ]
    numbers = [
        f"{base}?{key}={option.high:g}"
        for key, option in GENERATORS[name].options.items()
        if not isinstance(option, Choice)
    ]
    return [sample, *words, *numbers]


def says(recipe: str, values: tuple[str, ...]) -> bool:
    """Whether a recipe has one of the values that a generator lists."""
    options = parse_recipe(recipe).options
    return any(
        value == "*" or str(options[value.partition("=")[0]]) == value.partition("=")[2]
        for value in values
    )


each = pytest.mark.parametrize("name", GENERATORS)


@each
@pytest.mark.parametrize("size_px", SIZES_PX)
def test_a_texture_has_every_map_in_its_size(name, size_px):
    texture = texture_of(f"own:{name}{GENERATORS[name].sample}", size_px)
    assert texture.colour.shape == (size_px, size_px, 4)
    for value, shape in (
        (texture.normal, (size_px, size_px, 3)),
        (texture.roughness, (size_px, size_px)),
        (texture.metal, (size_px, size_px)),
        (texture.emission, (size_px, size_px)),
    ):
        assert value is not None
        assert value.shape == shape
        assert value.dtype == np.uint8


@each
@pytest.mark.parametrize("size_px", SIZES_PX)
def test_the_mean_is_the_first_colour(name, size_px):
    for recipe in variants(name) if size_px == 16 else variants(name)[:1]:
        colour = texture_of(recipe, size_px).colour
        mean = colour[colour[..., 3] > 0][:, :3].mean(axis=0)
        assert np.abs(mean - parse_recipe(recipe).ink(0)).max() <= 2, recipe


@each
@pytest.mark.parametrize("colour", ["#000000", "#ffffff", "#ff0000", "#0a0a0a", "#f4f4f4"])
def test_the_mean_is_kept_at_the_ends(name, colour):
    recipe = f"own:{name}{colour}"
    made = texture_of(recipe).colour
    mean = made[made[..., 3] > 0][:, :3].mean(axis=0)
    assert np.abs(mean - parse_recipe(recipe).ink(0)).max() <= 2


@each
def test_holes_and_mixing_are_where_they_are_stated(name):
    for recipe in variants(name):
        texture, generator = texture_of(recipe), GENERATORS[name]
        alpha = texture.colour[..., 3]
        assert texture.translucent == says(recipe, generator.translucent), recipe
        if texture.translucent:
            assert ((alpha > 0) & (alpha < 255)).any()
            continue
        assert set(np.unique(alpha)) <= {0, 255}
        assert (alpha == 0).any() == says(recipe, generator.holes), recipe
        assert (alpha == 255).any()


@each
def test_the_same_recipe_gives_the_same_bytes(name):
    from world2minecraft.rendering.textures.synthesis import _made

    recipe = f"own:{name}{GENERATORS[name].sample}"
    first = texture_of(recipe)
    _made.cache_clear()
    again = texture_of(recipe)
    assert again is not first
    assert np.array_equal(first.colour, again.colour)
    assert np.array_equal(first.normal, again.normal)


def test_a_texture_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        texture_of("own:plain#808080").colour[0, 0] = 0

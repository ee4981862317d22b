"""Synthesis of textures from recipes, with identical bytes on every machine."""

from functools import lru_cache

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.rendering.texture import SIZES_PX, Texture
from world2minecraft.rendering.textures.canvas import canvas_of
from world2minecraft.rendering.textures.catalogue import GENERATORS
from world2minecraft.rendering.textures.recipe import (
    Recipe,
    join_recipe,
    read_options,
    rgb_of,
    split_recipe,
)
from world2minecraft.rendering.textures.texture_baking import texture_from

MAX_CACHED = 512  # Textures; 88 MB at 128 px.


def recipe_of(generator: str, *colours: tuple[int, int, int], **options: float | str) -> str:
    """Return the canonical recipe of a generator with colours (sRGB, 0 to 255) and options.

    Raises:
        UnknownNameError: If the generator or an option is unknown.
        UsageError: If a colour or the value of an option is invalid.

    Example:
        >>> recipe_of("planks", (162, 130, 78), boards=4)
        'own:planks#a2824e?boards=4'
    """
    for colour in colours:
        if len(colour) != 3 or not all(0 <= level <= 255 for level in colour):
            raise UsageError(f"a colour must be three integers from 0 to 255, got {colour}")
    inks = tuple("#{:02x}{:02x}{:02x}".format(*colour) for colour in colours)
    given = {key: str(value) for key, value in options.items()}
    return parse_recipe(join_recipe(generator, inks, given)).text


def parse_recipe(text: str) -> Recipe:
    """Parse and check a recipe, and fill in the defaults.

    Raises:
        UnknownNameError: If the generator or an option is unknown. The message suggests a name.
        UsageError: If the text is not a valid recipe, or if a value is invalid.

    Example:
        >>> parse_recipe("own:planks#A2824E?gaps=none&boards=2").text
        'own:planks#a2824e?boards=2&gaps=none'
    """
    name, inks, given = split_recipe(text)
    if name not in GENERATORS:
        raise UnknownNameError("texture", name, GENERATORS)
    generator = GENERATORS[name]
    most = len(generator.accents) + 1
    if len(inks) > most:
        raise UsageError(
            f"{text}: texture {name!r} accepts at most {most} colours, got {len(inks)}"
        )
    options = read_options(text, name, given, generator.all_options)
    colours = [rgb_of(ink) for ink in inks]
    colours += [accent.colour(colours[0]) for accent in generator.accents[len(inks) - 1 :]]
    return Recipe(name, tuple(colours), options, join_recipe(name, inks, given))


def texture_of(recipe: str, size_px: int = 16) -> Texture:
    """Return the texture of a recipe. It is cached, so its arrays are read-only.

    The mean sRGB of all texels that are not holes is within 2 of the recipe's first colour.

    Args:
        recipe: ``own:GENERATOR#rrggbb[,#rrggbb...][?key=value&key=value]``.
        size_px: Texture size in pixels: 16, 32, 64 or 128. The layout is the same for all sizes,
            with finer detail at larger sizes.

    Raises:
        UnknownNameError: If the generator or an option is unknown.
        UsageError: If the text is not a valid recipe, or if a value or the size is invalid.

    Example:
        >>> texture_of("own:wool#a12722").colour.shape
        (16, 16, 4)
    """
    if size_px not in SIZES_PX:
        sizes = ", ".join(map(str, SIZES_PX))
        raise UsageError(f"the texture size must be {sizes} pixels, got {size_px}")
    return _made(parse_recipe(recipe).text, size_px)


@lru_cache(maxsize=MAX_CACHED)
def _made(text: str, size_px: int) -> Texture:
    recipe = parse_recipe(text)
    canvas = canvas_of(size_px, recipe.seed)
    return texture_from(canvas, recipe, GENERATORS[recipe.generator].paint(canvas, recipe))

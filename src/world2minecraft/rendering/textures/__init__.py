"""Our own textures: painted from recipes, at 16 to 128 px, nothing taken from elsewhere (CC0).

``texture_of("own:planks#a2824e?boards=4", 64)`` gives colour, normals, roughness, metal and
emission; ``GENERATORS`` lists what there is, ``recipe_of`` writes a recipe, ``texture_sheet``
draws the whole set.
"""

from world2minecraft.rendering.textures.catalogue import GENERATORS, GROUPS
from world2minecraft.rendering.textures.generator import Accent, Generator
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.synthesis import (
    SIZES_PX,
    parse_recipe,
    recipe_of,
    texture_of,
)
from world2minecraft.rendering.textures.texture_sheet import texture_sheet

__all__ = [
    "GENERATORS",
    "GROUPS",
    "SIZES_PX",
    "Accent",
    "Generator",
    "Recipe",
    "parse_recipe",
    "recipe_of",
    "texture_of",
    "texture_sheet",
]

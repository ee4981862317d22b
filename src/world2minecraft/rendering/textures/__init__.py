"""Built-in textures, painted from recipes at 16 to 128 px, without third-party content (CC0).

``texture_of("own:planks#a2824e?boards=4", 64)`` returns colour, normals, roughness, metal and
emission. ``GENERATORS`` contains all generators, ``recipe_of`` writes a recipe, and
``texture_sheet`` shows all textures.
"""

from world2minecraft.rendering.texture import SIZES_PX
from world2minecraft.rendering.textures.catalogue import GENERATORS, GROUPS
from world2minecraft.rendering.textures.generator import Accent, Generator
from world2minecraft.rendering.textures.recipe import Recipe
from world2minecraft.rendering.textures.synthesis import parse_recipe, recipe_of, texture_of
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

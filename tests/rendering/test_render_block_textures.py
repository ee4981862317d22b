"""Skins become recipes, recipes become textures, and small pictures lie on them."""

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.rendering.block_models import BuiltinModels
from world2minecraft.rendering.block_models.face_pictures import (
    letters_of,
    load_pictures,
    picture_of,
)
from world2minecraft.rendering.block_models.models import model_of
from world2minecraft.rendering.block_models.rules import material_of
from world2minecraft.rendering.block_models.texture_recipes import (
    recipe_of,
    split_recipe,
    values_of,
)


def textures_of(state: str) -> set[str]:
    faces = [face for element in model_of(state).elements for face in element.faces]
    return {face.texture for face in faces if face is not None}


def test_all_textures_of_all_blocks_can_be_made():
    looks = BuiltinModels()
    names = set().union(*(textures_of(block) for block in known_blocks()))
    assert len(names) > 500
    for name in sorted(names):
        texture = looks.texture(name)
        assert texture is not None
        assert texture.colour.shape == (16, 16, 4)


def test_blocks_have_their_own_colour():
    for name in ("oak_planks", "red_wool", "stone", "lime_concrete", "white_terracotta"):
        (texture,) = textures_of(name)
        assert split_recipe(texture)[1][0] == colour_of(name)
        made = BuiltinModels().texture(texture)
        assert made is not None
        assert np.abs(made.colour[..., :3].mean((0, 1)) - colour_of(name)).max() <= 2


def test_a_recipe_is_spelled_in_one_way():
    values = values_of("minecraft:light_blue_bed", {"part": "head", "power": "15"})
    assert recipe_of("wool SELF".lower(), "minecraft:light_blue_bed", values) == "own:wool#3aafd9"
    assert recipe_of("a #FFFFFF z=1 b=2 #000000", "x:y", values) == "own:a#ffffff,#000000?b=2&z=1"
    assert recipe_of("a #102030*2", "x:y", values) == "own:a#204060"
    assert recipe_of("a #000000~#c80000~0.5", "x:y", values) == "own:a#640000"
    assert recipe_of("a {wire} part={part}", "x:y", values) == "own:a#ff150a?part=head"
    assert (values["stem"], values["last"], values["missing"]) == ("light_blue", "bed", "")


@pytest.mark.parametrize(
    ("name", "material"),
    [
        ("oak_slab", "oak_planks"),
        ("bamboo_stairs", "bamboo_planks"),
        ("stone_brick_wall", "stone_bricks"),
        ("waxed_cut_copper_slab", "cut_copper"),
        ("infested_stone_bricks", "stone_bricks"),
        ("white_carpet", "white_wool"),
        ("petrified_oak_slab", "oak_planks"),
        ("stone", "stone"),
    ],
)
def test_what_a_block_is_cut_from(name, material):
    assert material_of(f"minecraft:{name}") == f"minecraft:{material}"


def test_slabs_go_on_in_the_pattern_of_their_block():
    (whole,), (half,) = (model_of(name).elements for name in ("oak_planks", "oak_slab[type=top]"))
    for side in (0, 1, 3, 4, 5):
        one, other = whole.faces[side], half.faces[side]
        assert one is not None
        assert other is not None
        assert one.texture == other.texture
        assert np.allclose(one.uv, other.uv)


def test_pictures_are_square_and_all_letters_are_known():
    for name, picture in load_pictures().items():
        letters = letters_of(picture)
        assert letters.ndim == 2, name
        assert letters.shape[0] == letters.shape[1], name
        assert 16 % letters.shape[0] == 0, name
        for size_px in (16, 64):
            made = picture_of(f"own:picture#808080,#102030,#405060?name={name}", size_px)
            assert made.colour.shape == (size_px, size_px, 4), name


def test_a_picture_keeps_its_place_at_any_size():
    small, large = (picture_of("own:picture#db3b22?name=tnt_side", size) for size in (16, 64))
    assert (large.colour[26, 6, :3] < 60).all()  # A letter of TNT.
    assert (small.colour[6, 1, :3] < 60).all()
    assert large.colour.shape == (64, 64, 4)
    assert picture_of("own:picture#808080?name=web", 16).has_holes
    fire = picture_of("own:picture#f08a1e?name=fire", 16).emission
    assert fire is not None
    assert fire.max() == 255


def test_unknown_pictures_and_foreign_names():
    with pytest.raises(UnknownNameError, match="no picture is named 'tnt_sid'"):
        picture_of("own:picture#808080?name=tnt_sid", 16)
    assert BuiltinModels().texture("minecraft:block/stone") is None

"""States through a stack of small packs: models, parents, textures, tints, fluids, layers."""

import numpy as np
import pytest
from pack_making import (
    BLOCK,
    CUBE,
    MODEL,
    PICTURE,
    block_files,
    cube_files,
    folder_pack,
    one_model,
    plain,
    zip_pack,
)

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.rendering.block_elements import FACE_NAMES, BlockModel, ModelSourceStack
from world2minecraft.rendering.resource_packs import ResourcePackModels

RED, GREEN, BLUE = plain(200, 0, 0), plain(0, 200, 0), plain(0, 0, 200)


def looks_of(tmp_path, files, **options) -> ResourcePackModels:
    return ResourcePackModels([folder_pack(tmp_path / "pack", files)], **options)


def model_of(looks: ResourcePackModels, state: str) -> BlockModel:
    model = looks.model(state)
    assert model is not None, looks.problems
    return model


def textures_by_side(model: BlockModel, index: int = 0) -> dict[str, str]:
    faces = zip(FACE_NAMES, model.elements[index].faces, strict=True)
    return {name: face.texture for name, face in faces if face is not None}


def colour_at(looks: ResourcePackModels, state: str) -> list[int]:
    face = model_of(looks, state).elements[0].faces[0]
    assert face is not None
    texture = looks.texture(face.texture)
    assert texture is not None
    return texture.colour[0, 0].tolist()


@pytest.mark.parametrize("make", [folder_pack, zip_pack])
def test_a_cube_of_one_texture(tmp_path, make):
    looks = ResourcePackModels([make(tmp_path / "pack.zip", cube_files("stone", RED))])
    model = model_of(looks, "minecraft:stone")
    (element,) = model.elements
    assert (element.low, element.high, element.turn) == ((0, 0, 0), (1, 1, 1), None)
    assert set(textures_by_side(model).values()) == {"minecraft:block/stone"}
    assert colour_at(looks, "stone") == [200, 0, 0, 255]
    assert model.ambient_occlusion and not model.stand_in
    assert looks.problems == [] and looks.problem_count == 0
    assert looks.model("stone") is looks.model("stone")


def test_the_last_pack_wins_file_by_file(tmp_path):
    jar = zip_pack(tmp_path / "client.jar", cube_files("stone", RED) | cube_files("dirt", BLUE))
    pack = folder_pack(tmp_path / "mine", {PICTURE.format("stone"): GREEN})
    assert colour_at(ResourcePackModels([jar, pack]), "stone") == [0, 200, 0, 255]
    assert colour_at(ResourcePackModels([jar, pack]), "dirt") == [0, 0, 200, 255]
    assert colour_at(ResourcePackModels([pack, jar]), "stone") == [200, 0, 0, 255]


def test_a_stack_asks_the_packs_first_and_ours_for_the_rest(tmp_path):
    packs = looks_of(tmp_path, cube_files("stone", RED))

    class Ours:
        def model(self, state):
            return BlockModel(stand_in=True)

        def texture(self, name):
            return None

    stack = ModelSourceStack((packs, Ours()))
    assert stack.model("stone") is packs.model("stone")
    assert stack.model("minecraft:chest").stand_in
    assert packs.texture("own:stone#888888") is None


def test_mods_have_namespaces_of_their_own(tmp_path):
    files = {
        "assets/tmeo/blockstates/chair.json": {"variants": {"": {"model": "tmeo:block/chair"}}},
        "assets/tmeo/models/block/chair.json": {**CUBE, "textures": {"all": "tmeo:block/seat"}},
        "assets/tmeo/textures/block/seat.png": RED,
    }
    looks = ResourcePackModels([zip_pack(tmp_path / "mod.jar", files)])
    assert set(textures_by_side(model_of(looks, "tmeo:chair")).values()) == {"tmeo:block/seat"}
    assert looks.model("minecraft:chair") is None


def test_a_childs_elements_replace_and_its_textures_are_merged(tmp_path):
    half = [{"from": [0, 0, 0], "to": [16, 8, 16], "faces": {"up": {"texture": "#top"}}}]
    files = block_files("thing", one_model("thing"), top=RED, other=BLUE) | {
        MODEL.format("thing"): {
            "parent": "block/middle",
            "textures": {"top": "#deep", "deep": "block/top"},
        },
        MODEL.format("middle"): {
            "parent": "minecraft:block/base",
            "elements": half,
            "textures": {"top": "block/other"},
        },
        MODEL.format("base"): {**CUBE, "ambientocclusion": False, "display": {"gui": 3}},
    }
    model = model_of(looks_of(tmp_path, files), "thing")
    assert [element.high for element in model.elements] == [(1, 0.5, 1)]
    assert textures_by_side(model) == {"up": "minecraft:block/top"}
    assert not model.ambient_occlusion


def test_a_texture_may_be_an_object(tmp_path):
    model = {**CUBE, "textures": {"all": {"sprite": "block/thing", "force_translucent": True}}}
    looks = looks_of(tmp_path, block_files("thing", one_model("thing"), model, thing=RED))
    assert set(textures_by_side(model_of(looks, "thing")).values()) == {"minecraft:block/thing"}


@pytest.mark.parametrize(
    "model",
    [
        {"parent": "builtin/entity"},
        {"parent": "minecraft:builtin/generated", "textures": {"layer0": "block/thing"}},
        {"textures": {"particle": "block/thing"}},
        {},
        {"elements": []},
    ],
)
def test_what_the_game_draws_in_code_is_left_to_the_next_source(tmp_path, model):
    looks = looks_of(tmp_path, block_files("chest", one_model("chest"), model))
    assert looks.model("minecraft:chest") is None
    assert looks.problems == []


def test_defaults_fill_in_what_a_state_leaves_out(tmp_path):
    files = cube_files("oak_log", RED)
    files[BLOCK.format("oak_log")] = {
        "variants": {
            "axis=x": {"model": "block/none"},
            "axis=y": {"model": "block/oak_log"},
        }
    }
    assert looks_of(tmp_path, files).model("minecraft:oak_log") is not None


def test_a_block_is_found_by_the_name_of_an_older_or_newer_game(tmp_path):
    assert looks_of(tmp_path / "a", cube_files("short_grass", RED)).model("minecraft:grass")
    assert looks_of(tmp_path / "b", cube_files("grass", RED)).model("minecraft:short_grass")


def test_a_multipart_is_one_model_turned_part_by_part(tmp_path):
    side = {
        "textures": {"all": "block/fence"},
        "elements": [{"from": [7, 6, 0], "to": [9, 9, 8], "faces": {"north": {"texture": "#all"}}}],
    }
    post = {
        "multipart": [
            {"when": {"north": "true"}, "apply": {"model": "block/side"}},
            {"when": {"east": "true"}, "apply": {"model": "block/side", "y": 90, "uvlock": True}},
        ]
    }
    files = {BLOCK.format("fence"): post, MODEL.format("side"): side, PICTURE.format("fence"): RED}
    model = model_of(looks_of(tmp_path, files), "fence[north=true,east=true]")
    assert [one.low for one in model.elements] == [(7 / 16, 6 / 16, 0), (0.5, 6 / 16, 7 / 16)]
    assert textures_by_side(model, 1) == {"east": "minecraft:block/fence"}
    assert looks_of(tmp_path, files).model("fence[north=false,east=false]") is None


def test_shade_and_light_are_read(tmp_path):
    box = {**CUBE["elements"][0], "shade": False, "light_emission": 12}
    model = {"elements": [box], "textures": {"all": "block/lamp"}}
    looks = looks_of(tmp_path, block_files("lamp", one_model("lamp"), model, lamp=RED))
    (element,) = model_of(looks, "lamp").elements
    assert (element.shade, element.emission) == (False, 12)


def test_lamps_are_seen_at_full_brightness_while_they_are_lit(tmp_path):
    looks = looks_of(tmp_path, cube_files("redstone_lamp", RED) | cube_files("glowstone", RED))
    states = ("redstone_lamp[lit=true]", "redstone_lamp[lit=false]", "glowstone")
    light = [model_of(looks, state).elements[0].emission for state in states]
    assert light == [15, 0, 15]


def tinted_block(block: str, index: int = 0) -> dict:
    faces = {"up": {"texture": "#all", "tintindex": index}, "down": {"texture": "#all"}}
    box = {"from": [0, 0, 0], "to": [16, 16, 16], "faces": faces}
    model = {"elements": [box], "textures": {"all": f"block/{block}"}}
    return block_files(block, one_model(block), model, **{block: RED})


def tints_of(looks: ResourcePackModels, state: str) -> dict:
    faces = model_of(looks, state).elements[0].faces
    return {name: face.tint for name, face in zip(FACE_NAMES, faces, strict=True) if face}


@pytest.mark.parametrize(
    ("state", "tint"),
    [
        ("short_grass", (145, 189, 89)),
        ("oak_leaves", (119, 171, 47)),
        ("birch_leaves", (128, 167, 85)),
        ("spruce_leaves", (97, 153, 97)),
        ("vine[north=true]", (119, 171, 47)),
        ("lily_pad", (32, 128, 48)),
        ("redstone_wire[power=15]", (255, 51, 0)),
        ("redstone_wire[power=0]", (76, 0, 0)),
        ("melon_stem[age=7]", (224, 199, 28)),
        ("attached_pumpkin_stem", (224, 199, 28)),
        ("water_cauldron", (63, 118, 228)),
        ("stone", None),
    ],
)
def test_grey_faces_are_tinted_as_in_plains(tmp_path, state, tint):
    looks = looks_of(tmp_path, tinted_block(state.partition("[")[0]))
    assert tints_of(looks, state) == {"up": tint, "down": None}


def test_tints_can_be_set_by_name_or_by_a_packs_colour_map(tmp_path):
    files = tinted_block("short_grass")
    assert tints_of(looks_of(tmp_path, files, tints={"grass": (1, 2, 3)}), "short_grass")["up"] == (
        1,
        2,
        3,
    )
    colours = np.zeros((256, 256, 3), np.uint8)
    colours[173, 51] = (9, 8, 7)
    files["assets/minecraft/textures/colormap/grass.png"] = colours
    assert tints_of(looks_of(tmp_path, files), "short_grass")["up"] == (9, 8, 7)


def test_a_wrong_tint_is_refused(tmp_path):
    with pytest.raises(UnknownNameError, match="no tint is named 'gras'; did you mean 'grass'?"):
        looks_of(tmp_path, cube_files("stone", RED), tints={"gras": (0, 0, 0)})
    with pytest.raises(UsageError, match="tint grass must be red, green, blue from 0 to 255"):
        looks_of(tmp_path, cube_files("stone", RED), tints={"grass": (0, 0, 300)})


def grass_block() -> dict:
    """A cube of earth and, at the same place, its tinted sides."""
    sides = ("north", "south", "west", "east")
    earth = {"from": [0, 0, 0], "to": [16, 16, 16], "faces": {}}
    earth["faces"] = {name: {"texture": "#side"} for name in sides}
    earth["faces"]["up"] = {"texture": "#top", "tintindex": 0}
    over = {"from": [0, 0, 0], "to": [16, 16, 16], "faces": {}}
    over["faces"] = {name: {"texture": "#over", "tintindex": 0} for name in sides}
    names = {"side": "block/side", "top": "block/top", "over": "block/over"}
    fringe = np.zeros((16, 16, 4), np.uint8)
    fringe[:4] = 255
    return block_files(
        "grass_block",
        one_model("grass_block", y=90),
        {"elements": [earth, over], "textures": names},
        side=RED,
        top=plain(255, 255, 255),
        over=fringe,
    )


def test_elements_at_one_place_become_one_with_joined_textures(tmp_path):
    looks = looks_of(tmp_path, grass_block())
    (element,) = model_of(looks, "grass_block").elements
    up, north = element.faces[3], element.faces[4]
    assert up is not None and north is not None
    assert (up.texture, up.tint) == ("minecraft:block/top", (145, 189, 89))
    assert north.texture == "minecraft:block/side+minecraft:block/over*91bd59"
    texture = looks.texture(north.texture)
    assert texture is not None and not texture.has_holes
    assert texture.colour[0, 0].tolist() == [145, 189, 89, 255]
    assert texture.colour[8, 8].tolist() == [200, 0, 0, 255]


def fluid_files() -> dict:
    return {
        PICTURE.format("water_still"): plain(180, 180, 180, 170),
        PICTURE.format("water_flow"): plain(170, 170, 170, 170, side=32),
        PICTURE.format("lava_still"): plain(220, 90, 10),
    }


def test_water_and_lava_are_boxes_of_their_level(tmp_path):
    looks = looks_of(tmp_path, fluid_files())
    (water,) = model_of(looks, "minecraft:water[level=0]").elements
    assert water.high == pytest.approx((1, 8 / 9, 1))
    up, side = water.faces[3], water.faces[0]
    assert up is not None and side is not None
    assert (up.texture, up.tint) == ("minecraft:block/water_still", (63, 118, 228))
    assert side.texture == "minecraft:block/water_flow"
    np.testing.assert_allclose(side.uv @ [0, 8 / 9, 1, 1], [0.5, 1 / 18])
    texture = looks.texture(up.texture)
    assert texture is not None and texture.translucent
    (lava,) = model_of(looks, "minecraft:lava[level=6]").elements
    falling = model_of(looks, "minecraft:water[level=8]").elements[0]
    assert falling.high == (1, 1, 1)
    assert lava.high[1] == pytest.approx(2 / 9) and lava.emission == 15
    assert {face.texture for face in lava.faces if face} == {"minecraft:block/lava_still"}
    assert all(face.tint is None for face in lava.faces if face)


def test_a_pack_without_fluids_leaves_them_to_the_next(tmp_path):
    assert looks_of(tmp_path, cube_files("stone", RED)).model("minecraft:water") is None


def test_overlays_for_this_format_lie_over_the_pack(tmp_path):
    files = cube_files("stone", RED) | {
        "new/" + PICTURE.format("stone"): GREEN,
        "old/" + PICTURE.format("stone"): BLUE,
        "pack.mcmeta": {
            "overlays": {
                "entries": [
                    {"formats": {"min_inclusive": 40, "max_inclusive": 90}, "directory": "new"},
                    {"min_format": [10, 0], "max_format": 20, "directory": "old"},
                ]
            }
        },
    }
    assert colour_at(looks_of(tmp_path, files), "stone") == [0, 200, 0, 255]


@pytest.mark.parametrize("state", ["Not A State", "a:b:c", "stone[", "minecraft:stone[x]"])
def test_what_is_no_state_has_no_model(tmp_path, state):
    assert looks_of(tmp_path, cube_files("stone", RED)).model(state) is None


def test_the_same_packs_give_the_same_looks(tmp_path):
    looks = [looks_of(tmp_path, grass_block()) for _ in range(2)]
    first, second = (model_of(one, "grass_block").elements[0] for one in looks)
    for a, b in zip(first.faces, second.faces, strict=True):
        assert (a is None) == (b is None)
        if a and b:
            assert (a.texture, a.tint, a.uv.tolist()) == (b.texture, b.tint, b.uv.tolist())

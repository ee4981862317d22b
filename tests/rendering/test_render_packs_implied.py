"""Packs of textures alone: boxes wear the textures that a block's name implies."""

import numpy as np
import pytest
from pack_making import PICTURE, folder_pack, plain

from world2minecraft.minecraft.visual_shapes import visual_boxes
from world2minecraft.rendering.block_elements import FACE_NAMES, BlockModel
from world2minecraft.rendering.resource_packs import ResourcePackModels

RED = plain(200, 0, 0)


def model_of(tmp_path, state: str, *pictures: str) -> BlockModel | None:
    files = {PICTURE.format(name): RED for name in pictures}
    return ResourcePackModels([folder_pack(tmp_path / "pack", files)]).model(state)


def sides_of(model: BlockModel | None) -> dict[str, str]:
    assert model is not None
    faces = zip(FACE_NAMES, model.elements[0].faces, strict=True)
    return {name: face.texture.rpartition("/")[2] for name, face in faces if face}


def named(down: str, up: str, north: str, east: str, south: str, west: str) -> dict[str, str]:
    return {"down": down, "up": up, "north": north, "east": east, "south": south, "west": west}


@pytest.mark.parametrize(
    ("state", "picture"),
    [
        ("stone", "stone"),
        ("oak_stairs[facing=east,half=bottom,shape=straight]", "oak_planks"),
        ("stone_brick_slab[type=top]", "stone_bricks"),
        ("oak_fence[north=true]", "oak_planks"),
        ("purpur_slab", "purpur_block"),
        ("red_carpet", "red_wool"),
        ("glass_pane[east=true,west=true]", "glass"),
        ("smooth_quartz_stairs", "quartz_block_bottom"),
        ("waxed_copper_block", "copper_block"),
        ("infested_stone", "stone"),
        ("snow_block", "snow"),
        ("oak_door[half=upper]", "oak_door_top"),
        ("oak_trapdoor", "oak_trapdoor"),
        ("torch", "torch"),
    ],
)
def test_the_boxes_of_a_state_wear_the_texture_of_its_name(tmp_path, state, picture):
    model = model_of(tmp_path, state, picture)
    assert set(sides_of(model).values()) == {picture}
    assert model is not None
    boxes = [[*element.low, *element.high] for element in model.elements]
    np.testing.assert_allclose(boxes, visual_boxes(state), atol=1e-6)


@pytest.mark.parametrize(
    ("state", "sides"),
    [
        ("oak_log[axis=y]", named("t", "t", "s", "s", "s", "s")),
        ("oak_log[axis=x]", named("s", "s", "s", "t", "s", "t")),
        ("oak_log[axis=z]", named("s", "s", "t", "s", "t", "s")),
    ],
)
def test_a_log_shows_its_rings_at_its_ends(tmp_path, state, sides):
    model = model_of(tmp_path, state, "oak_log", "oak_log_top")
    names = {"s": "oak_log", "t": "oak_log_top"}
    assert sides_of(model) == {side: names[short] for side, short in sides.items()}


@pytest.mark.parametrize("facing", ["north", "east", "south", "west"])
def test_a_front_looks_where_the_block_faces(tmp_path, facing):
    pictures = ("furnace_side", "furnace_top", "furnace_front", "furnace_front_on")
    sides = sides_of(model_of(tmp_path, f"furnace[facing={facing},lit=false]", *pictures))
    assert [name for name, one in sides.items() if one == "furnace_front"] == [facing]
    assert sides["up"] == "furnace_top"
    lit = sides_of(model_of(tmp_path, f"furnace[facing={facing},lit=true]", *pictures))
    assert lit[facing] == "furnace_front_on"


def test_grass_is_tinted_above_and_a_plant_is_a_cross(tmp_path):
    model = model_of(tmp_path, "grass_block", "grass_block_top", "grass_block_side", "dirt")
    assert model is not None
    tints = [face.tint for face in model.elements[0].faces if face]
    assert tints == [None, None, None, (145, 189, 89), None, None]
    plant = model_of(tmp_path, "poppy", "poppy")
    assert plant is not None and len(plant.elements) == 2
    assert all(element.turn is not None for element in plant.elements)
    upper = model_of(tmp_path, "lilac[half=upper]", "lilac_top", "lilac_bottom")
    assert set(sides_of(upper).values()) == {"lilac_top"}
    assert model_of(tmp_path, "wheat[age=7]", "wheat_stage7") is not None


def test_blocks_of_newer_games_and_mods_are_cubes_or_crosses(tmp_path):
    cube = model_of(tmp_path, "minecraft:resin_block", "resin_block")
    assert set(sides_of(cube).values()) == {"resin_block"}
    stairs = "minecraft:resin_brick_stairs[facing=east,half=bottom,shape=straight]"
    model = model_of(tmp_path, stairs, "resin_bricks")
    assert model is not None and len(model.elements) == 2
    flower = RED.copy()
    flower[:, :5] = 0
    files = {PICTURE.format("open_eyeblossom"): flower}
    looks = ResourcePackModels([folder_pack(tmp_path / "flowers", files)])
    plant = looks.model("minecraft:open_eyeblossom")
    assert plant is not None and plant.elements[0].turn is not None


def test_a_renamed_plant_is_found_by_either_name(tmp_path):
    assert model_of(tmp_path / "a", "minecraft:short_grass", "short_grass") is not None
    assert model_of(tmp_path / "b", "minecraft:short_grass", "grass") is not None
    assert model_of(tmp_path / "c", "minecraft:grass", "short_grass") is not None


@pytest.mark.parametrize("state", ["chest", "red_bed", "oak_sign", "dirt", "water"])
def test_blocks_without_textures_are_left_to_the_next_source(tmp_path, state):
    assert model_of(tmp_path, state, "chest", "red_bed", "oak_sign", "oak_planks") is None


def test_a_model_without_its_parent_keeps_its_texture(tmp_path):
    files = {
        PICTURE.format("stone"): RED,
        "assets/minecraft/blockstates/stone.json": {"variants": {"": {"model": "block/stone"}}},
        "assets/minecraft/models/block/stone.json": {"parent": "block/cube_all"},
    }
    looks = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    assert looks.model("stone") is not None
    assert looks.problems == [
        "minecraft:stone: model minecraft:block/cube_all (parent of block/stone) not found in the "
        "packs or not readable; pass the game's client jar before the pack"
    ]

"""Packs through the whole renderer: what a ray meets has the colours that the pack says."""

from dataclasses import replace

import numpy as np
import pytest
from pack_making import PICTURE, block_files, cube_files, folder_pack, one_model, plain

from world2minecraft.core.coordinates import block_to_room, look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering import prepare_scene, render_volume
from world2minecraft.rendering.block_elements import FACE_NAMES, ModelSourceStack
from world2minecraft.rendering.plain_models import PlainModels
from world2minecraft.rendering.resource_packs import ResourcePackModels

CAMERA = Camera(64, 48, 60.0, 60.0, 32.0, 24.0)
COLOURS = {
    "west": (220, 30, 30),
    "east": (30, 200, 30),
    "down": (30, 30, 220),
    "up": (220, 220, 30),
    "north": (220, 30, 220),
    "south": (30, 220, 220),
}
AWAY = {"west": (-4, 0, 0), "east": (4, 0, 0), "up": (0.01, 4, 0), "down": (0.01, -4, 0)}
AWAY |= {"north": (0, 0, -4), "south": (0, 0, 4)}
TO_ROOM = block_to_room(np.zeros(2), 1.0)


def volume_of(*states: str) -> BlockVolume:
    """Blocks in a row to the south, the first at the origin."""
    cells = np.arange(1, len(states) + 1, dtype=np.uint16).reshape(1, 1, -1)
    return BlockVolume(
        states=cells,
        palette=("minecraft:air", *states),
        semantic=np.ones(cells.shape, np.uint8),
        instance=np.zeros(cells.shape, np.uint16),
        corner=(0, 0, 0),
        block_to_room=TO_ROOM,
    )


def room(point) -> np.ndarray:
    return (TO_ROOM @ [*point, 1.0])[:3]


def seen(tmp_path, files, states, side: str, target=(0.5, 0.5, 0.5)):
    packs = ResourcePackModels([folder_pack(tmp_path / "pack", files)])
    scene = prepare_scene(volume_of(*states), ModelSourceStack((packs, PlainModels())))
    eye = np.array(target) + AWAY[side]
    return render_volume(scene, CAMERA, look_at(room(eye), room(target)))


def hue(colour: np.ndarray) -> np.ndarray:
    """A colour without its brightness, which light changes."""
    return colour.astype(np.float64) / max(float(colour.max()), 1.0)


def six_sided(**turn) -> dict:
    box = {"from": [0, 0, 0], "to": [16, 16, 16]}
    box["faces"] = {name: {"texture": f"#{name}"} for name in FACE_NAMES}
    model = {"elements": [box], "textures": {name: f"block/{name}" for name in FACE_NAMES}}
    pictures = {name: plain(*colour) for name, colour in COLOURS.items()}
    return block_files("dice", one_model("dice", **turn), model, **pictures)


@pytest.mark.parametrize(
    ("turn", "side", "shown"),
    [
        ({}, "west", "west"),
        ({}, "up", "up"),
        ({}, "down", "down"),
        ({}, "north", "north"),
        ({"y": 90}, "east", "north"),
        ({"y": 90}, "south", "east"),
        ({"x": 90}, "down", "north"),
        ({"x": 270}, "up", "north"),
        ({"x": 90, "y": 90}, "east", "up"),
        ({"y": 180}, "up", "up"),
    ],
)
def test_each_side_shows_its_texture(tmp_path, turn, side, shown):
    picture = seen(tmp_path, six_sided(**turn), ["minecraft:dice"], side)
    assert picture.colour is not None
    middle = picture.colour[24, 32]
    assert np.abs(hue(middle) - hue(np.array(COLOURS[shown]))).max() < 0.12
    assert picture.depth_m[24, 32] == pytest.approx(3.5, abs=0.01)


def test_rays_pass_cutout_holes_and_hit_what_is_behind(tmp_path):
    bars = plain(230, 230, 230)
    bars[4:12, 4:12] = 0
    files = cube_files("bars", bars) | cube_files("wall", plain(220, 30, 30))
    picture = seen(tmp_path, files, ["minecraft:wall", "minecraft:bars"], "south", (0.5, 0.5, 1.5))
    assert picture.colour is not None
    assert picture.block_index[24, 32] == 0 and picture.block_index[24, 38] == 1
    assert np.abs(hue(picture.colour[24, 32]) - hue(np.array((220, 30, 30)))).max() < 0.12


def test_glass_of_a_pack_is_met_first_and_seen_through(tmp_path):
    files = cube_files("blue_stained_glass", plain(40, 40, 255, 100))
    files |= cube_files("wall", plain(255, 40, 40))
    states = ["minecraft:wall", "minecraft:blue_stained_glass"]
    picture = seen(tmp_path, files, states, "south", (0.5, 0.5, 1.5))
    assert picture.colour is not None
    assert picture.block_index[24, 32] == 1
    red, green, blue = picture.colour[24, 32].astype(int)
    assert red > green + 30 and blue > green + 10


def test_plant_crosses_are_visible_from_all_sides(tmp_path):
    tuft = np.zeros((16, 16, 4), np.uint8)
    tuft[8:] = (255, 255, 255, 255)
    files = {PICTURE.format("fern"): tuft}  # No model: that of a plant is implied.
    for side in ("north", "south", "west", "east"):
        picture = seen(tmp_path, files, ["minecraft:fern"], side)
        assert picture.colour is not None
        assert picture.block_index[30, 32] == 0
        assert picture.block_index[16, 32] == -1
        red, green, blue = picture.colour[30, 32].astype(int)
        assert green > red > blue  # Grass of plains.


def test_a_locked_texture_points_the_same_way_on_a_turned_block(tmp_path):
    half = plain(30, 30, 220)
    half[:8] = (220, 30, 30, 255)  # Red to the north.
    pictures = {}
    for name, turn in (("as_made", {}), ("locked", {"y": 90, "uvlock": True}), ("free", {"y": 90})):
        files = cube_files("half", half, **turn)
        colour = seen(tmp_path / name, files, ["minecraft:half"], "up").colour
        assert colour is not None
        pictures[name] = colour
    np.testing.assert_array_equal(pictures["locked"], pictures["as_made"])
    assert (pictures["free"] != pictures["as_made"]).any()


def test_a_pool_has_no_walls_within(tmp_path):
    files = {PICTURE.format("water_still"): plain(200, 200, 200, 120)}
    files |= cube_files("wall", plain(255, 255, 255))
    seen_through = []
    for count in (1, 3):
        states = ["minecraft:wall", *["minecraft:water[level=0]"] * count]
        volume = volume_of(*states)
        cells = np.minimum(volume.states, 2).astype(np.uint16)  # One state of water.
        volume = replace(volume, states=cells, palette=volume.palette[:3])
        packs = ResourcePackModels([folder_pack(tmp_path / str(count), files)])
        scene = prepare_scene(volume, ModelSourceStack((packs, PlainModels())))
        target = np.array([0.5, 0.5, count + 1])
        pose = look_at(room(target + np.array([0, 0, 3])), room(target))
        colour = render_volume(scene, CAMERA, pose).colour
        assert colour is not None
        seen_through.append(hue(colour[24, 32]))
    np.testing.assert_allclose(*seen_through, atol=0.1)

"""A picture of each feature, kept: what changes how worlds look changes one of these.

``W2M_GOLDEN=write pytest tests/rendering/test_render_golden.py`` writes them again; look at them
then.
"""

import os
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from world2minecraft.core.coordinates import apply, block_to_room, look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.minecraft.entities import block_display
from world2minecraft.rendering import LightSettings, prepare_scene, render_volume
from world2minecraft.rendering.path_tracing import render_photo

FOLDER = Path(__file__).parent / "golden"
CAMERA = Camera(96, 72, 70.0, 70.0, 48.0, 36.0)
MEAN, FAR, FAR_SHARE = 1.5, 12, 0.02  # Off in the mean; pixels that may be off farther.
EYE, TARGET = (1.6, 2.6, 1.6), (6.0, 1.4, 6.4)  # In cells of the room.
ROOM = {
    "floor": "oak_planks",
    "wall": "white_concrete",
    "window": "glass",
    "lamp": "lantern[hanging=false]",
}


@dataclass(frozen=True)
class Feature:
    """What stands in the room, and how it is drawn."""

    blocks: dict[tuple[int, int, int], str] = field(default_factory=dict)
    light: LightSettings = field(default_factory=lambda: LightSettings(exposure=1.5))
    texture_px: int = 16
    samples: int = 1
    display: bool = False
    photo: bool = False


def night() -> LightSettings:
    return LightSettings(hour=23.0, exposure=1.6)


PLANTS = {
    (4, 1, 4): "poppy",
    (5, 1, 5): "fern",
    (6, 1, 4): "oak_leaves[persistent=true]",
    (4, 1, 6): "oak_sapling",
    (6, 1, 6): "cactus",
}
CODE = {
    (4, 1, 5): "red_bed[facing=south,part=foot]",
    (4, 1, 6): "red_bed[facing=south,part=head]",
    (6, 1, 4): "chest[facing=west]",
    (6, 1, 6): "skeleton_skull[rotation=6]",
    (5, 1, 6): "oak_sign[rotation=6]",
    (7, 1, 5): "blue_banner[rotation=6]",
}
SHAPES = {
    (4, 1, 4): "oak_stairs[facing=south]",
    (5, 1, 5): "stone_slab[type=bottom]",
    (6, 1, 4): "oak_fence[south=true]",
    (6, 1, 5): "oak_fence[north=true]",
    (4, 1, 6): "bookshelf",
    (6, 1, 6): "oak_door[facing=west,half=lower]",
    (6, 2, 6): "oak_door[facing=west,half=upper]",
}
GLASS = {
    (4, 1, 5): "red_stained_glass",
    (5, 1, 4): "blue_stained_glass",
    (5, 2, 5): "glass",
    (6, 1, 6): "gold_block",
    (4, 1, 6): "water[level=0]",
}
LAMP = {(5, 1, 5): ROOM["lamp"], (6, 1, 4): "stone", (4, 1, 6): "crafting_table"}

FEATURES = {
    "shapes_by_day": Feature(SHAPES),
    "plants": Feature(PLANTS),
    "drawn_by_code": Feature(CODE),
    "glass_and_water": Feature(GLASS),
    "lamp_at_night": Feature(LAMP, night()),
    "sun_shadow": Feature(SHAPES, LightSettings(hour=9.5, exposure=1.2, sun_shadow=True)),
    "game_light": Feature(SHAPES, LightSettings(preset="game", exposure=1.0)),
    "neutral_light": Feature(SHAPES, LightSettings(preset="neutral")),
    "fine_textures": Feature(SHAPES, texture_px=64, samples=2),
    "display_entity": Feature(LAMP, display=True),
    "photo": Feature(LAMP, night(), photo=True),
}


def room(feature: Feature) -> BlockVolume:
    """A room of 10 x 5 x 10 cells with a window, and what the feature puts there."""
    palette = ["minecraft:air"]

    def number(state: str) -> int:
        full = f"minecraft:{state}"
        if full not in palette:
            palette.append(full)
        return palette.index(full)

    states = np.zeros((10, 5, 10), np.uint16)
    states[:, 0] = number(ROOM["floor"])
    for wall in (states[0], states[-1], states[:, :, 0], states[:, :, -1]):
        wall[:, 1:] = number(ROOM["wall"])
    states[:, -1] = number(ROOM["wall"])
    states[-1, 2:4, 3:6] = number(ROOM["window"])
    for cell, state in feature.blocks.items():
        states[cell] = number(state)
    filled = (states > 0).astype(np.uint8)
    entities = (
        block_display(
            "minecraft:red_wool", np.array([-1, 0, -0.3, 1, 0.6, 0.3]), (5.5, 65.5, 5.5),
            yaw_deg=30.0, class_id=7, instance=1,
        ),
    )  # fmt: skip
    return BlockVolume(
        states=states,
        palette=tuple(palette),
        semantic=filled,
        instance=filled.astype(np.uint16),
        corner=(0, 64, 0),
        block_to_room=block_to_room(np.array([0.0, 10.0]), 1.0),
        entities=entities if feature.display else (),
    )


def picture_of(feature: Feature) -> np.ndarray:
    volume = room(feature)
    eye, target = (
        apply(volume.block_to_room, np.add(volume.corner, place)) for place in (EYE, TARGET)
    )
    scene = prepare_scene(volume, texture_px=feature.texture_px, reach=1.0)
    pose = look_at(eye, target)
    if feature.photo:
        light = replace(feature.light, exposure=3.0)
        return render_photo(scene, CAMERA, pose, light=light, samples=8).colour
    picture = render_volume(
        scene, CAMERA, pose, outputs=("colour",), light=feature.light, samples=feature.samples
    )
    return picture.colour


@pytest.mark.parametrize("name", FEATURES)
def test_a_feature_looks_as_it_did(name):
    drawn = picture_of(FEATURES[name])
    path = FOLDER / f"{name}.png"
    if os.environ.get("W2M_GOLDEN") == "write":
        Image.fromarray(drawn).save(path, optimize=True)
    kept = np.asarray(Image.open(path).convert("RGB")).astype(int)
    off = np.abs(drawn.astype(int) - kept)
    assert off.mean() < MEAN
    assert (off.max(axis=-1) > FAR).mean() < FAR_SHARE


def test_the_pictures_differ_from_each_other():
    kept = [np.asarray(Image.open(FOLDER / f"{name}.png")).astype(int) for name in FEATURES]
    for index, one in enumerate(kept):
        for other in kept[index + 1 :]:
            assert np.abs(one - other).mean() > MEAN

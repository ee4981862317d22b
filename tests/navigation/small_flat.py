"""A small flat for the tests of navigation: two rooms, a doorway between them, some furniture.

Two blocks a metre. The west room is x 1 to 8, the east room x 10 to 17, both z 1 to 8; the floor
is layer 0, feet are at 65, the doorway is at x = 9, z = 4 and 5. In the west stand a red table
and a brown chair, in the east a piano and a brown chair.
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume, Layout
from world2minecraft.formats.layout import write_layouts
from world2minecraft.formats.world_labels import scene_from_volume, write_scene
from world2minecraft.minecraft.versions import DEFAULT_VERSION, game_version
from world2minecraft.minecraft.worlds.world_writer import write_world

PALETTE = (
    AIR,
    "minecraft:white_concrete",
    "minecraft:oak_planks",
    "minecraft:black_concrete",
    "minecraft:red_concrete",
    "minecraft:brown_concrete",
)
WALL, PLANKS, BLACK, RED, BROWN = range(1, 6)
# Where, what block, class, instance, design.
THINGS = (
    (np.s_[3:6, 1, 7:9], RED, 8, 1, ""),
    (np.s_[7, 1, 8], BROWN, 5, 2, ""),
    (np.s_[14:17, 1:3, 7:9], BLACK, 10, 3, "piano"),
    (np.s_[11, 1, 8], BROWN, 5, 4, ""),
)
SPAWN = (3.0, 65.0, 3.0)


def flat_volume() -> tuple[BlockVolume, np.ndarray, tuple[str, ...]]:
    """Return the flat, the design of each block, and the designs' names."""
    states = np.full((19, 7, 10), WALL, np.uint16)
    semantic = np.full(states.shape, 3, np.uint8)
    states[:, 0], semantic[:, 0] = PLANKS, 2
    semantic[:, 6] = 1
    for room in (np.s_[1:9, 1:6, 1:9], np.s_[10:18, 1:6, 1:9], np.s_[9, 1:5, 4:6]):
        states[room], semantic[room] = 0, 0
    instance = np.zeros(states.shape, np.uint16)
    design = np.zeros(states.shape, np.uint16)
    for where, block, class_id, number, name in THINGS:
        states[where], semantic[where], instance[where] = block, class_id, number
        design[where] = int(bool(name))
    to_room = block_to_room(np.array([0.0, 5.0]), 2.0)
    volume = BlockVolume(states, PALETTE, semantic, instance, (0, 64, 0), to_room)
    return volume, design, ("", "piano")


def write_flat(folder: Path) -> Path:
    """Write the flat as a generated house lies on disk, and return its folder."""
    volume, design, designs = flat_volume()
    version = game_version(DEFAULT_VERSION)
    place = folder / "world"
    write_world(volume, place, name="flat", spawn=SPAWN, spawn_yaw_deg=0.0, version=version)
    scene = scene_from_volume(
        volume,
        mc_version=version.name,
        data_version=version.data_version,
        spawn=SPAWN,
        spawn_yaw_deg=0.0,
        design=design,
        designs=designs,
    )
    write_scene(folder, scene)
    rooms = (_layout("living 1", 1, 9, volume), _layout("kitchen 2", 10, 18, volume))
    write_layouts(folder / "layout.json", rooms)
    return folder


def _layout(name: str, x0: int, x1: int, volume: BlockVolume) -> Layout:
    corners = np.array([[x0, 65, 9], [x1, 65, 9], [x1, 65, 1], [x0, 65, 1]], np.float64)
    points = corners @ volume.block_to_room[:3, :3].T + volume.block_to_room[:3, 3]
    return Layout(points[:, :2], 2.5, floor_z_m=float(points[0, 2]), name=name)

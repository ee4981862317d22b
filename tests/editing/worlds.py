"""Worlds that the tests of this folder build into."""

import hashlib
from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.nbt import Byte, Long, read_nbt, write_nbt
from world2minecraft.minecraft.worlds.anvil import pack_region
from world2minecraft.minecraft.worlds.in_place_editing import read_region_file
from world2minecraft.minecraft.worlds.world_reader import read_world
from world2minecraft.minecraft.worlds.world_writer import write_world

PALETTE = (
    AIR,
    "minecraft:chest[facing=north,type=single,waterlogged=false]",
    "minecraft:dirt",
    "minecraft:glass",
    "minecraft:stone",
)
SIGN = "minecraft:oak_sign[rotation=0,waterlogged=false]"


def plain(states: np.ndarray, palette: tuple[str, ...], corner, **held) -> BlockVolume:
    """A volume without labels, at four blocks a metre."""
    return BlockVolume(
        states.astype(np.uint16),
        palette,
        np.zeros(states.shape, np.uint8),
        np.zeros(states.shape, np.uint16),
        tuple(corner),
        block_to_room(np.array([0.0, 3.0]), 4.0),
        **held,
    )


def ground(seed: int = 0) -> BlockVolume:
    """Terrain over four regions with two chests and an entity of the user."""
    rng = np.random.default_rng(seed)
    shape = (60, 24, 52)
    corner = (-30, 56, -25)
    states = np.zeros(shape, np.uint16)
    states[:, :8] = rng.choice([2, 4], (60, 8, 52))
    states[:, 8:] = (rng.random((60, 16, 52)) < 0.1) * 4
    chests = ((-12, 60, -12), (20, 66, 20))
    for place in chests:
        states[tuple(np.array(place) - corner)] = 1
    states[0, 0, 0] = states[-1, -1, -1] = 4
    return plain(
        states,
        PALETTE,
        corner,
        block_entities=tuple(
            BlockEntity(p, "minecraft:chest", {"CustomName": f"chest {n}"})
            for n, p in enumerate(chests)
        ),
        entities=(Entity((3.5, 65.0, 3.5), "minecraft:armor_stand", {"Tags": ["mine"]}),),
    )


def write_ground(folder: Path, seed: int = 0, volume: BlockVolume | None = None) -> Path:
    """Write the terrain as a world, and give its chunks what only the game knows."""
    options = {"name": "Home", "spawn": (0.5, 90.0, 0.5), "spawn_yaw_deg": 0.0}
    write_world(volume or ground(seed), folder, **options)
    for path in sorted((folder / "region").glob("*.mca")):
        region = read_region_file(path)
        chunks = {}
        for place in region.records:
            _, root = read_nbt(region.chunk(place), path)
            root["ForgeCaps"] = {"mod:energy": Long(7), "mod:name": "a château"}
            root["InhabitedTime"] = Long(1234)
            root["isLightOn"] = Byte(1)
            root["Heightmaps"] = {"WORLD_SURFACE": np.arange(37)}
            root["sections"][0]["SkyLight"] = np.arange(2048).astype(np.int8)
            chunks[place] = write_nbt(root)
        data, outside = pack_region(chunks)
        path.write_bytes(data)
        assert not outside
    return folder


def room(corner=(-8, 60, -20), shape=(12, 6, 14)) -> BlockVolume:
    """A closed box with a floor, a sign and two entities in it, some of its box left out."""
    states = np.zeros(shape, np.uint16)
    states[2:, 0], states[2:, -1] = 1, 2
    states[2, :], states[-1, :], states[2:, :, 0], states[2:, :, -1] = 1, 1, 1, 1
    states[5, 1, 5] = 3
    x, y, z = corner
    return plain(
        states,
        (AIR, "minecraft:bricks", "minecraft:glass", SIGN),
        corner,
        block_entities=(
            BlockEntity((x + 5, y + 1, z + 5), "minecraft:sign", {"is_waxed": Byte(1)}),
        ),
        entities=(
            Entity((x + 6.5, y + 1.25, z + 5.0), "minecraft:block_display", {"width": 1.0}),
            Entity((x + 7.5, y + 1.25, z + 5.0), "minecraft:block_display", {"width": 2.0}),
        ),
    )


def tree(folder: Path) -> dict[str, str]:
    """The checksum of every file, and a mark for every folder."""
    return {
        path.relative_to(folder).as_posix(): (
            hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder"
        )
        for path in sorted(folder.rglob("*"))
        if path.name != "session.lock"
    }


def blocks_by_place(volume: BlockVolume) -> dict[tuple[int, int, int], str]:
    """The state of every block that is not air."""
    found = np.argwhere(volume.states)
    return {
        tuple((cell + volume.corner).tolist()): volume.palette[volume.states[tuple(cell)]]
        for cell in found
    }


def world_blocks(folder: Path) -> dict[tuple[int, int, int], str]:
    """The same of a world."""
    return blocks_by_place(read_world(folder))

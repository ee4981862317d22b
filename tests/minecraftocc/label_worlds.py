"""Small worlds that labels are tried on: odd shapes, plates, glass, plants, turned displays."""

import numpy as np

from world2minecraft.core.coordinates import block_to_room, look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.minecraft.entities import block_display

CAMERA = Camera(96, 72, 60.0, 60.0, 48.0, 36.0)
PALETTE = (
    "minecraft:air",
    "minecraft:white_concrete",
    "minecraft:oak_planks",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:oak_stairs[facing=north,half=top,shape=inner_left,waterlogged=false]",
    "minecraft:oak_slab[type=bottom,waterlogged=false]",
    "minecraft:glass_pane[east=true,north=false,south=false,waterlogged=false,west=true]",
    "minecraft:red_carpet",
    "minecraft:dandelion",
    "minecraft:barrier",
    "minecraft:oak_leaves[distance=1,persistent=true,waterlogged=false]",
    "minecraft:lantern[hanging=false,waterlogged=false]",
)
NAMES = ("", "chair_cafe", "rug_round")


def room_of_things(
    scale: float = 4.0, seed: int = 0, share: float = 0.12, displays: bool = True
) -> BlockVolume:
    """A closed box with things strewn over it; among them two turned displays."""
    rng = np.random.default_rng(seed)
    shape = (10, 8, 9)
    states = np.where(rng.random(shape) < share, rng.integers(2, len(PALETTE), shape), 0)
    states[[0, -1]] = states[:, :, [0, -1]] = 1
    states[:, [0, -1]] = 2
    semantic = np.where(states > 0, 5 + states % 7, 0)
    semantic[[0, -1]] = semantic[:, :, [0, -1]] = 3
    semantic[:, -1], semantic[:, 0] = 1, 2
    entities = [
        block_display("minecraft:oak_planks", np.array([0, 0, 0, 1.5, 0.1, 0.4]), (3.3, 66.0, 3.1),
                      yaw_deg=25.0, class_id=8, instance=7),
        block_display("minecraft:stone", np.array([0, 0, 0, 0.7, 1.2, 0.7]), (5.1, 64.5, 1.2),
                      yaw_deg=90.0, class_id=11, instance=9),
    ]  # fmt: skip
    return BlockVolume(
        states=states.astype(np.uint16),
        palette=PALETTE,
        semantic=semantic.astype(np.uint8),
        instance=(states * 3).astype(np.uint16),
        corner=(-1, 63, -1),
        block_to_room=block_to_room(np.array([0.0, 7 / scale]), scale),
        entities=tuple(entities) if displays else (),
    )


def designs_of(volume: BlockVolume) -> tuple[np.ndarray, tuple[str, ...]]:
    """Give some blocks a design."""
    codes = np.where(volume.instance % 2 == 1, 1 + volume.instance % 4 // 3, 0)
    return codes.astype(np.uint16), NAMES


def poses_in(volume: BlockVolume, count: int, seed: int) -> list[np.ndarray]:
    """Cameras in free cells that look anywhere."""
    rng = np.random.default_rng(seed)
    free = np.argwhere(volume.states == 0)
    found = []
    for cell in free[rng.integers(len(free), size=count)]:
        eye = volume.block_to_room @ [*(cell + volume.corner + rng.uniform(0.1, 0.9, 3)), 1]
        ahead = rng.normal(size=3) * [1, 1, 0.3]
        found.append(look_at(eye[:3], eye[:3] + ahead))
    return found

"""Small builds as a player makes them, at one block a metre: for the tests of block maps."""

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume

PLANKS, GLASS = "minecraft:oak_planks", "minecraft:glass"
DOOR = "minecraft:oak_door[facing=north,half={},hinge=left,open=false,powered=false]"
STAIR = "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]"
FENCE = "minecraft:oak_fence[east=false,north=false,south=false,waterlogged=false,west=false]"
PLATE = "minecraft:oak_pressure_plate[powered=false]"
BED = "minecraft:red_bed[facing=east,occupied=false,part={}]"


class Blocks:
    """A box of air that blocks are put into."""

    def __init__(self, *size: int):
        self.states = np.zeros(size, np.uint16)
        self.palette = [AIR]

    def put(self, place, state: str) -> None:
        if state not in self.palette:
            self.palette.append(state)
        self.states[place] = self.palette.index(state)

    def volume(self, scale: float = 1.0) -> BlockVolume:
        none = np.zeros(self.states.shape, np.uint16)
        return BlockVolume(
            self.states,
            tuple(self.palette),
            none.astype(np.uint8),
            none,
            (0, 60, 0),
            block_to_room(np.zeros(2), scale),
        )


def cottage() -> Blocks:
    """A room of 8 x 3 x 6 blocks inside, all of oak planks, with furniture of a player.

    The floor is layer 1, the ceiling layer 5; walls stand at x = 1 and 10, z = 1 and 8.
    """
    made = Blocks(12, 8, 10)
    made.put(np.s_[1:11, 1:6, 1:9], PLANKS)
    made.put(np.s_[2:10, 2:5, 2:8], AIR)
    made.put(np.s_[4:6, 3, 1], GLASS)
    made.put((8, 2, 8), DOOR.format("lower"))
    made.put((8, 3, 8), DOOR.format("upper"))
    made.put((2, 2, 2), STAIR)
    made.put((2, 2, 5), STAIR)
    made.put((2, 2, 6), STAIR)
    made.put((5, 2, 4), FENCE)
    made.put((5, 3, 4), PLATE)
    made.put((8, 2, 3), BED.format("foot"))
    made.put((9, 2, 3), BED.format("head"))
    made.put(np.s_[9, 2:4, 6], "minecraft:bookshelf")
    made.put((4, 2, 2), "minecraft:cauldron")
    made.put((3, 2, 7), "minecraft:potted_fern")
    made.put((9, 4, 2), "minecraft:lantern[hanging=true,waterlogged=false]")
    return made

"""A small house for the tests of the builder: two rooms below, one above, stairs, a doorway."""

import numpy as np

from world2minecraft.core.types import OccupancyGrid

VOXEL_M = 0.08
CEILING, FLOOR, WALL, OBJS = 1, 2, 3, 11
HEIGHT = 32  # Cells from the floor to the ceiling; the slab is three cells thick.
UPPER = HEIGHT + 3
DOOR = (20, 31)  # Cells along y of the doorway between the two rooms, 0.88 m.
SHAPE = (84, 54, 2 * HEIGHT + 6)


def house(door_shift: int = 0) -> OccupancyGrid:
    """Return a house of 6.4 x 4 m; its floors' tops lie at 0 and at 2.8 m.

    Ground storey: two rooms parted by a wall at x = 40 with a doorway 2.08 m high. Upper storey:
    one room, with a stairwell 2.4 x 0.96 m at high x over stairs of 0.2 m a step.
    """
    labels = np.full(SHAPE, 255, np.uint8)
    rooms = np.zeros(SHAPE[:2], bool)
    rooms[2:82, 2:52] = True
    ring = np.zeros_like(rooms)
    ring[1:83, 1:53] = True
    ring &= ~rooms
    for base in (1, 1 + UPPER):
        labels[rooms, base : base + HEIGHT] = 0
        labels[ring, base : base + HEIGHT] = WALL
        labels[rooms, base - 1] = FLOOR
        labels[rooms, base + HEIGHT] = CEILING
    labels[rooms, 1 + HEIGHT + 1] = 255
    labels[40, 2:52, 1 : 1 + HEIGHT] = WALL
    labels[40, DOOR[0] + door_shift : DOOR[1] + door_shift, 1:27] = 0
    labels[48:78, 38:50, 1 + HEIGHT : 1 + UPPER] = 0  # The stairwell.
    instance = np.zeros(SHAPE, np.uint16)
    for step in range(14):
        x = slice(47 + 2 * step, 49 + 2 * step)
        labels[x, 38:50, 1 : 1 + round(2.5 * (step + 1))] = OBJS
        instance[x, 38:50, 1 : 1 + round(2.5 * (step + 1))] = 1
    colour = np.full((*SHAPE, 3), 200, np.uint8)
    return OccupancyGrid(
        labels=labels,
        confidence=(labels != 255).astype(np.float16),
        colour=colour,
        source=(labels != 255).astype(np.uint8),
        instance=instance,
        voxel_m=VOXEL_M,
        origin_m=np.array([-0.16, -0.16, -VOXEL_M]),
    )

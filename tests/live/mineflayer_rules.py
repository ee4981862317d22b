"""Where mineflayer's player departs from the game's, as prismarine-physics 1.11 has it.

Three rules differ. The game moves a body along the longer side first, mineflayer always along x
first, which matters at corners alone. One who sneaks is kept from edges by what lies under the feet
in the game, and in mineflayer by any block in the cells around them. And one who lands in the tick
in which a wall stops him and steps along it lands in the game, and in mineflayer a tick later.
"""

import sys
from contextlib import contextmanager
from unittest.mock import patch

import numpy as np

from world2minecraft.minecraft.physics import body_box
from world2minecraft.minecraft.physics import collisions as sweep

BACK = 0.05  # Blocks by which one draws back.


@contextmanager
def mineflayer_rules(world):
    """Within it, our physics moves a player in a world as mineflayer does."""
    step = sys.modules["world2minecraft.minecraft.physics.player_motion"]
    of_the_game = sweep.sweep_with_step

    def x_first(boxes, box, way, touch=1e-7):
        gone, here = [0.0, 0.0, 0.0], box.copy()
        for axis in (1, 0, 2):
            gone[axis] = sweep.free_distance(boxes, here, axis, float(way[axis]), touch)
            here[[axis, 3 + axis]] += gone[axis]
        return tuple(gone)

    def climbed(boxes, box, way, height, touch=1e-7):
        return of_the_game(boxes, box, np.array([way[0], 0.0, way[2]]), height, touch)

    def kept_from_edges(boxes, body, way, scale):
        def is_over_nothing(x, z):
            box = body_box(body.position) + np.tile([x, 0.0, z], 2)
            return not len(world.near(box[:3], box[3:]))

        x, y, z = way.tolist()
        while x and is_over_nothing(x, 0.0):
            x = nearer(x)
        while z and is_over_nothing(0.0, z):
            z = nearer(z)
        while x and z and is_over_nothing(x, z):
            x, z = nearer(x), nearer(z)
        return np.array([x, y, z])

    with (
        patch.object(sweep, "swept", x_first),
        patch.object(step, "swept", x_first),
        patch.object(step, "climbed", climbed),
        patch.object(step, "_kept_from_edges", kept_from_edges),
    ):
        yield


def nearer(value):
    return 0.0 if abs(value) <= BACK else value - np.copysign(BACK, value)

"""The motion of the game's player: keys and boxes in, the next twentieth of a second out.

``step`` moves a ``Body`` among the boxes of a world by one tick. ``BlockWorld`` gives the
collision boxes of blocks, ``BoxWorld`` those of a list. ``find_standing_place``
finds where to begin.
"""

from world2minecraft.minecraft.physics.collisions import (
    BlockWorld,
    BoxWorld,
    World,
    find_standing_place,
)
from world2minecraft.minecraft.physics.player_body import (
    TICKS_PER_S,
    Body,
    Keys,
    body_box,
    eye_height,
)
from world2minecraft.minecraft.physics.player_motion import step

__all__ = [
    "TICKS_PER_S",
    "BlockWorld",
    "Body",
    "BoxWorld",
    "Keys",
    "World",
    "body_box",
    "eye_height",
    "find_standing_place",
    "step",
]

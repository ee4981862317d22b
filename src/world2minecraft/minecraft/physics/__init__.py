"""Simulation of the player's movement in ticks of 1/20 s.

``step`` advances a ``Body`` by one tick among the collision boxes of a world. ``BlockWorld``
contains the boxes of blocks, and ``BoxWorld`` contains a list of boxes. ``find_standing_place``
finds a free start position.
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

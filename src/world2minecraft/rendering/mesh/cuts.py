"""What is taken away so that one looks into a room: a bit for each way to cut it open."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.displays import display_cubes
from world2minecraft.rendering.cutaway import (
    without_ceiling,
    without_near_walls,
    without_partitions,
)

# Bits 0 to 3: the walls near an eye that stands towards (block x, block z) of these signs.
CORNERS = ((-1, -1), (-1, 1), (1, -1), (1, 1))
CEILING, PARTITIONS = 1 << 4, 1 << 5


def cuts_of(volume: BlockVolume) -> tuple[np.ndarray, np.ndarray]:
    """Return the cuts that take each block away, and each display entity.

    Bits 0 to 3 are the near walls of ``CORNERS``, bit 4 the ceiling and all above it, bit 5 the
    upper parts of walls between rooms.

    Returns:
        uint8 [X, Y, Z], and uint8 for each of ``display_cubes`` of the volume.
    """
    has_floor = bool((volume.semantic == SemanticClass.FLOOR).any())  # Else all would be outside.
    ways = [without_near_walls(volume, *corner) if has_floor else volume for corner in CORNERS]
    ways += [without_ceiling(volume), without_partitions(volume)]
    blocks = np.zeros(volume.states.shape, np.uint8)
    things = np.zeros(len(display_cubes(volume.entities)), np.uint8)
    for bit, cut in enumerate(ways):
        blocks |= ((cut.states != volume.states).astype(np.uint8)) << bit
        kept = {id(entity) for entity in cut.entities}
        gone = [id(one) not in kept for one in volume.entities if display_cubes((one,))]
        things |= np.array(gone, np.uint8) << bit
    return blocks, things

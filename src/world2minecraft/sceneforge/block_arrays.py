"""What stops a walker in a build, as arrays for the page."""

import numpy as np

from world2minecraft.minecraft.physics import BlockWorld


def collision_arrays(world: BlockWorld) -> dict[str, np.ndarray]:
    """Return the shape of each cell, the boxes of all shapes, and the first box of each shape."""
    starts = np.cumsum([0, *(len(shape) for shape in world.shapes)])
    return {
        "kinds": world.kinds,
        "boxes": np.concatenate(world.shapes).astype(np.float32),
        "starts": starts.astype(np.int32),
    }

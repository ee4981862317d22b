"""The part of a design that lies on the canvas, and what stands there."""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.morphology import dilate_faces


class Window(NamedTuple):
    """The part of a design that lies on the canvas, and what stands there."""

    box: tuple[slice, ...]  # of the design
    low: np.ndarray  # int [3], its first block on the canvas
    free: np.ndarray  # bool [X, Y, Z], nothing stands there
    wall: np.ndarray  # bool [X, Y, Z]
    held: np.ndarray  # bool [X, Y, Z], something stands there or beside it

    def is_flush(self, filled: np.ndarray) -> bool:
        """Whether most of a thing's blocks, bool [X, Y, Z], lie in a wall: a picture, a socket."""
        return bool((filled & self.wall).sum() > 0.5 * filled.sum())


def window_on(
    canvas: Canvas, within: np.ndarray, low: np.ndarray, shape: tuple[int, ...]
) -> Window:
    """Return the window of a design of a shape that begins at ``low``.

    Args:
        canvas: what is built so far.
        within: bool [X, Y, Z], where things may stand.
        low: int [3], the design's first block.
        shape: its blocks along each axis.
    """
    high = np.minimum(low + shape, np.array(canvas.lattice.shape) - 1)
    start = np.maximum(low, [1, 1, canvas.lattice.ground])
    stop = np.maximum(high, start)
    box = tuple(slice(int(a), int(b)) for a, b in zip(start - low, stop - low, strict=True))
    inside = tuple(slice(int(a), int(b)) for a, b in zip(start, stop, strict=True))
    around = tuple(slice(int(a) - 1, int(b) + 1) for a, b in zip(start, stop, strict=True))
    stands = canvas.states[around] > 0
    free = ~stands[1:-1, 1:-1, 1:-1] & within[inside]
    wall = canvas.semantic[inside] == SemanticClass.WALL
    return Window(box, start, free, wall, dilate_faces(stands)[1:-1, 1:-1, 1:-1])

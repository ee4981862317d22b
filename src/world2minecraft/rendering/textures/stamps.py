"""Leaves scattered over a canvas, one over another; they tile."""

from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.textures.canvas import SIDE, Canvas, hashed


class Stamps(NamedTuple):
    """The uppermost leaf at each texel, [N, N]: its number, -1 for none, and the place in it.

    ``along`` goes from -1 at its foot to 1 at its tip, ``across`` from -1 to 1 over its width.
    """

    identity: np.ndarray
    along: np.ndarray
    across: np.ndarray


def scatter(canvas: Canvas, count: int, length: float, width: float, salt: int) -> Stamps:
    """Return ``count`` pointed leaves; ``length`` and ``width`` are halves, in sixteenths."""
    identity = np.full(canvas.x.shape, -1, np.int64)
    along, across = np.zeros(canvas.x.shape), np.zeros(canvas.x.shape)
    random = hashed(canvas.seed, salt, np.arange(count * 4)).reshape(count, 4)
    for index, (middle_x, middle_y, turn, size) in enumerate(random):
        x = (canvas.x[0] - SIDE / 2 * middle_x) % SIDE - SIDE / 2
        y = ((canvas.y[:, 0] - SIDE / 2 * middle_y) % SIDE - SIDE / 2)[:, None]
        cosine, sine = np.cos(np.pi * turn), np.sin(np.pi * turn)
        scale = 1.0 + 0.25 * size
        first = (x * cosine + y * sine) / (length * scale)
        second = (y * cosine - x * sine) / (width * scale * np.maximum(1 - first * first, 1e-6))
        inside = (np.abs(first) < 1) & (np.abs(second) < 1)
        identity[inside] = index
        along[inside], across[inside] = first[inside], second[inside]
    return Stamps(identity, along, across)

"""What one sees around places: how far rays go, and what they end at.

Rays march through cells in short strides, all at once; where they cut a corner a little short,
no view is worse for it.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.views.hiding import Hiding

FAR_M = 12.0  # Rays end there.
STRIDE_BLOCKS = 0.35


class Around(NamedTuple):
    """What rays meet from N places, at P pitches and Y yaws: arrays [N, P, Y]."""

    far_m: np.ndarray  # float64, FAR_M where a ray meets nothing
    cell: np.ndarray  # int64, C-order index of the cell that it ends at, -1 for none


def look_around(
    hiding: Hiding, eyes: np.ndarray, yaws_deg: np.ndarray, pitches_deg: np.ndarray
) -> Around:
    """Cast rays from eyes, float64 [N, 3] in world blocks, to all pairs of pitch and yaw.

    Args:
        hiding: what hides the view.
        eyes: where from.
        yaws_deg: the game's, [Y].
        pitches_deg: the game's, down is positive, [P].
    """
    yaw, pitch = np.radians(yaws_deg)[None], np.radians(pitches_deg)[:, None]
    down = np.broadcast_to(-np.sin(pitch), (len(pitches_deg), len(yaws_deg)))
    rays = np.stack([-np.sin(yaw) * np.cos(pitch), down, np.cos(yaw) * np.cos(pitch)], axis=-1)
    count = rays.shape[0] * rays.shape[1]
    start = np.repeat(eyes - np.array(hiding.corner), count, axis=0)
    ahead = np.tile(rays.reshape(-1, 3), (len(eyes), 1)) * STRIDE_BLOCKS
    shape = np.array(hiding.hides.shape)
    limit = FAR_M * hiding.blocks_per_metre
    far, cell = np.full(len(start), limit), np.full(len(start), -1, np.int64)
    going = np.arange(len(start))
    for n in range(1, int(limit / STRIDE_BLOCKS) + 1):
        at = np.floor(start[going] + ahead[going] * n).astype(np.int64)
        inside = ((at >= 0) & (at < shape)).all(axis=1)
        going, at = going[inside], at[inside]
        met = hiding.hides[tuple(at.T)]
        hit = going[met]
        far[hit] = n * STRIDE_BLOCKS
        cell[hit] = np.ravel_multi_index(tuple(at[met].T), hiding.hides.shape)
        going = going[~met]
        if not len(going):
            break
    every = (len(eyes), *rays.shape[:2])
    return Around(far.reshape(every) / hiding.blocks_per_metre, cell.reshape(every))

"""Visibility around positions: which cells block the view, and how far rays reach.

All rays advance through cells in short steps at once. They may cut corners slightly, which does not
affect the choice of views. ``minecraft.physics.walk_graph`` determines where a player can stand.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.physics.walk_graph import is_door
from world2minecraft.minecraft.visual_shapes import visual_boxes

ROOF = 0.2  # Blocks: what is lower, such as a carpet, is no roof.
SIGHT_SHARE = 0.3  # Of a cell's side: what is narrower hides little.
MAX_VIEW_M = 12.0  # Rays end there.
STRIDE_BLOCKS = 0.35


@dataclass(frozen=True, eq=False)
class ViewBlockers:
    """The cells that block the view, and the cells with something above them.

    Both arrays are [X, Y, Z] in block axes, starting at ``corner``. Doors and gates do not block
    the view.
    """

    hides: np.ndarray  # bool [X, Y, Z]
    roofed: np.ndarray  # bool [X, Y, Z]
    corner: tuple[int, int, int]
    blocks_per_metre: float


def view_blockers_of(volume: BlockVolume) -> ViewBlockers:
    """Return the cells of a volume that block the view."""
    measures = np.array([_measures(state) for state in volume.palette], np.float32)
    top, width = measures[volume.states, 0], measures[volume.states, 1]
    roofs = (top > ROOF)[:, ::-1]
    return ViewBlockers(
        hides=width > SIGHT_SHARE,
        roofed=np.logical_or.accumulate(roofs, axis=1)[:, ::-1],
        corner=volume.corner,
        blocks_per_metre=volume.blocks_per_metre,
    )


@lru_cache(maxsize=1 << 14)
def _measures(state: str) -> tuple[float, float]:
    """Return how high a state fills its cell for a body, and the width that hides the view."""
    if is_door(state):
        return 0.0, 0.0
    boxes, seen = boxes_of(state), visual_boxes(state)
    top = float(boxes[:, 4].max()) if len(boxes) else 0.0
    if not len(seen):
        return top, 0.0
    size = seen[:, 3:].max(axis=0) - seen[:, :3].min(axis=0)
    return top, float(np.sort(size)[1])


class ViewRays(NamedTuple):
    """The results of rays from N positions at P pitches and Y yaws, as arrays [N, P, Y]."""

    far_m: np.ndarray  # float64, MAX_VIEW_M where a ray meets nothing
    cell: np.ndarray  # int64, C-order index of the cell that it ends at, -1 for none


def cast_view_rays(
    hiding: ViewBlockers, eyes: np.ndarray, yaws_deg: np.ndarray, pitches_deg: np.ndarray
) -> ViewRays:
    """Cast rays from eye positions in all combinations of pitch and yaw.

    Args:
        hiding: The cells that block the view.
        eyes: Eye positions in world blocks, float64 [N, 3].
        yaws_deg: Yaws in Minecraft's convention, [Y].
        pitches_deg: Pitches in Minecraft's convention (down is positive), [P].
    """
    yaw, pitch = np.radians(yaws_deg)[None], np.radians(pitches_deg)[:, None]
    down = np.broadcast_to(-np.sin(pitch), (len(pitches_deg), len(yaws_deg)))
    rays = np.stack([-np.sin(yaw) * np.cos(pitch), down, np.cos(yaw) * np.cos(pitch)], axis=-1)
    count = rays.shape[0] * rays.shape[1]
    start = np.repeat(eyes - np.array(hiding.corner), count, axis=0)
    ahead = np.tile(rays.reshape(-1, 3), (len(eyes), 1)) * STRIDE_BLOCKS
    shape = np.array(hiding.hides.shape)
    limit = MAX_VIEW_M * hiding.blocks_per_metre
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
    return ViewRays(far.reshape(every) / hiding.blocks_per_metre, cell.reshape(every))

"""The solid shapes of a scene, as its pictures show them: boxes, straight or turned.

In: the tables of ``rendering.scene``, so that what is labelled is what is seen. Out: for each element
of its table a box in blocks. A hole in a texture is no hole here: a pane, a plant, leaves and bars
are the boxes that their textures are drawn on. A shape thinner than ``LEAST_THICK_M`` is taken as
that thick, so that a plate without depth lies in a cell too.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.scene_tables import TURN, SceneTables

LEAST_THICK_M = 0.004
_STRAIGHT = 1e-6  # Blocks: what an edge may lean and still count as straight.


class SolidBoxes(NamedTuple):
    """The boxes of E elements, in blocks of the frame that each element is told in."""

    low: np.ndarray  # float64 [E, 3], of the straight box around each
    high: np.ndarray  # float64 [E, 3]
    centre: np.ndarray  # float64 [E, 3]
    half: np.ndarray  # float64 [E, 3, 3]: row a is half the edge along the box's own axis a
    straight: np.ndarray  # bool [E], whether the box is the straight one
    there: np.ndarray  # bool [E], whether it has a face


def solid_boxes(tables: SceneTables, metres_per_block: float) -> SolidBoxes:
    """Return the boxes of a scene's elements.

    Args:
        tables: the scene.
        metres_per_block: the size of its blocks.
    """
    low, high = tables.boxes[:, :3].astype(np.float64), tables.boxes[:, 3:].astype(np.float64)
    axes = np.tile(np.eye(3), (len(low), 1, 1))
    shift = np.zeros((len(low), 3))
    turned = np.flatnonzero(tables.traits[:, TURN] >= 0)
    if len(turned):
        to_frame = np.tile(np.eye(4), (len(turned), 1, 1))
        to_frame[:, :3] = tables.turns[tables.traits[turned, TURN]]
        back = np.linalg.inv(to_frame)
        axes[turned], shift[turned] = back[:, :3, :3].transpose(0, 2, 1), back[:, :3, 3]
    centre = np.einsum("ea,eab->eb", (low + high) / 2, axes) + shift
    lengths = np.linalg.norm(axes, axis=2)
    reach = np.maximum((high - low) / 2 * lengths, LEAST_THICK_M / 2 / metres_per_block)
    half = axes / np.maximum(lengths, 1e-12)[..., None] * reach[..., None]
    around = np.abs(half).sum(axis=1)
    leaning = np.sort(np.abs(half), axis=2)[..., :2].max(axis=(1, 2), initial=0.0)
    return SolidBoxes(
        low=centre - around,
        high=centre + around,
        centre=centre,
        half=np.ascontiguousarray(half),
        straight=leaning < _STRAIGHT,
        there=np.any(tables.layers >= 0, axis=1).astype(bool),
    )

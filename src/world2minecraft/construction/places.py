"""Where things may stand, and in which order they are set."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture.solids import OWN_CELLS
from world2minecraft.geometry.morphology import dilate

LAST = {int(SemanticClass.CHAIR): 1, int(SemanticClass.TVS): 2, int(SemanticClass.OBJS): 3}


def within_storeys(canvas: Canvas, footprints: Sequence[np.ndarray]) -> np.ndarray:
    """Return the blocks, bool [X, Y, Z], over the floor of their storey or in its walls."""
    within = np.zeros(canvas.states.shape, bool)
    walls = canvas.semantic == SemanticClass.WALL
    for (ground, top), footprint in zip(canvas.lattice.storeys, footprints, strict=True):
        columns = dilate(footprint, (1, 1)) | walls[:, :, ground:top].any(axis=2)
        within[:, :, ground:top] = columns[:, :, None]
    return within


def in_order(placement: Placement) -> tuple:
    """Large furniture first, then chairs, then what stands on things; templates before cells."""
    rank = LAST.get(placement.class_id, 0)
    own = placement.template == OWN_CELLS
    return rank, own, placement.object_id, placement.center_m.tolist(), placement.template

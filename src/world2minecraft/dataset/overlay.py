"""Labels drawn over their image: whether cells lie where the image shows them is seen at once.

Each pixel takes on the colour of the class of the cell it sees; cells are outlined where they
meet. What lies beyond the region stays as it is, a little darker.
"""

import numpy as np

from world2minecraft.classes import CLASS_COLOURS, CLASS_COUNT
from world2minecraft.dataset.values import OccLabels

UNKNOWN_COLOUR = (64, 64, 64)
SHARE = 0.55  # Of a pixel's colour that is the label's.
BEYOND = 0.55  # How bright stays what the region does not hold.
EDGE = 0.6  # How bright an outline is.


def overlay_labels(colour: np.ndarray, occ: OccLabels, cells: np.ndarray) -> np.ndarray:
    """Return an image with its labels drawn over it.

    Args:
        colour: uint8 [H, W, 3].
        occ: the labels.
        cells: int32 [H, W], ``cells_of_pixels``.

    Returns:
        uint8 [H, W, 3].
    """
    seen = cells >= 0
    legend = class_legend()[occ.labels.reshape(-1)[np.where(seen, cells, 0)]]
    mixed = np.where(seen[..., None], (1 - SHARE) * colour + SHARE * legend, BEYOND * colour)
    edge = np.zeros(cells.shape, bool)
    edge[:, 1:] |= cells[:, 1:] != cells[:, :-1]
    edge[1:] |= cells[1:] != cells[:-1]
    mixed[edge & seen] *= EDGE
    return np.round(mixed).astype(np.uint8)


def class_legend() -> np.ndarray:
    """Return the colour of each label, uint8 [256, 3]."""
    legend = np.full((256, 3), UNKNOWN_COLOUR, np.uint8)
    legend[:CLASS_COUNT] = CLASS_COLOURS
    return legend


def plan_of(occ: OccLabels, cell_px: int = 4) -> np.ndarray:
    """Return the region from above, the view upward: what its image says of each column.

    The highest cell below the ceiling that is hit shows its class; else a column is pale green
    where free, grey where something is occluded, dark where nothing is known.

    Args:
        occ: the labels.
        cell_px: the side of a cell in the plan.

    Returns:
        uint8 [H, W, 3], H by the region's depth and W by its width.
    """
    width, depth, _ = occ.region.shape
    plan = np.full((width, depth, 3), (40, 40, 40), np.uint8)
    plan[(occ.fine > 0).any(axis=2)] = (96, 96, 96)
    plan[occ.in_frustum.any(axis=2) & ~(occ.fine > 0).any(axis=2)] = (64, 64, 64)
    plan[occ.free.any(axis=2)] = (205, 235, 205)
    shown = occ.visible & (occ.labels != 1) & (occ.labels != 2)
    top = occ.region.shape[2] - 1 - np.argmax(shown[..., ::-1], axis=2)
    label = np.take_along_axis(occ.labels, top[..., None], axis=2)[..., 0]
    there = shown.any(axis=2)
    plan[there] = class_legend()[label[there]]
    picture = np.ascontiguousarray(plan.transpose(1, 0, 2)[::-1])
    return picture.repeat(cell_px, axis=0).repeat(cell_px, axis=1)

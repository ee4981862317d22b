"""Windows and doors: flat parts of a wall that lie back from its plane.

Glass gives depth seldom, and then lies some centimetres behind the wall. What stands back so and
begins above the floor is a window; what reaches down to the floor is a door leaf, class objs.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.classes import SemanticClass
from world2minecraft.geometry.parts import connected_parts
from world2minecraft.label.morphology import grown, opened
from world2minecraft.label.parameters import StructureParameters, within
from world2minecraft.label.relief import Relief
from world2minecraft.label.surface import Surface


def read_wall(
    surface: Surface, relief: Relief, parameters: StructureParameters
) -> tuple[np.ndarray, np.ndarray]:
    """Return what each place of a wall is, and how deep it lies.

    Returns:
        ``classes`` uint8 [A, B]: wall, window, or objs for the leaf of a door; ``depth_m`` float
        [A, B] along the relief's axis 0, that of the whole plane or of the whole opening.
    """
    low, high = parameters.opening_depth_m
    classes = np.full(relief.weight.shape, SemanticClass.WALL, np.uint8)
    depth_m = relief.plane_m.copy()
    gap = relief.gap_m
    recessed = relief.seen & (gap >= low) & (gap <= high)
    plane = relief.seen & (np.abs(gap) < low)
    parts, count = connected_parts(opened(recessed))
    bottom_m = surface.origin_m[2] + relief.box[2].start * surface.voxel_m
    for number, box in enumerate(ndimage.find_objects(parts, count), 1):
        part = parts == number
        kind = _kind(part[box], bottom_m + box[1].start * surface.voxel_m, surface, parameters)
        if kind is None or _framed(part, plane) < parameters.frame_share:
            continue
        whole = grown(part) & recessed
        classes[whole] = kind
        depth_m[whole] += np.median(gap[whole])
    return classes, depth_m


def _kind(
    part: np.ndarray, bottom_m: float, surface: Surface, parameters: StructureParameters
) -> SemanticClass | None:
    """Return what a recessed part, seen face on, is; None where it is too small or ragged."""
    width, height = np.array(part.shape) * surface.voxel_m
    if part.sum() * surface.voxel_m**2 < parameters.opening_area_m2 or part.mean() < 0.5:
        return None
    sized = within(width, parameters.window_size_m) and height >= parameters.window_size_m[0]
    if sized and bottom_m >= parameters.window_sill_m:
        return SemanticClass.WINDOW
    leaf = within(width, parameters.door_width_m) and height >= parameters.door_height_m
    return SemanticClass.OBJS if leaf else None


def _framed(part: np.ndarray, plane: np.ndarray) -> float:
    """Return the share of the ring around a part that lies on the wall's plane."""
    ring = grown(part, 3) & ~grown(part)
    return float(plane[ring].mean()) if ring.any() else 0.0

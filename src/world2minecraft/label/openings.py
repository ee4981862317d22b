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
from world2minecraft.label.surface import Surface
from world2minecraft.label.walls import WallRun, turned


def label_openings(
    surface: Surface,
    wall: np.ndarray,
    runs: list[WallRun],
    labels: np.ndarray,
    parameters: StructureParameters,
) -> None:
    """Write windows and door leaves over the wall cells of ``labels``, all [X, Y, Z]."""
    low, high = parameters.opening_depth_m
    for run in runs:
        outward = run.sign * turned(surface.points_m[..., run.axis], run.axis, run.sign)
        cells = turned(wall, run.axis, run.sign).copy()
        cells[:, : run.span[0]] = False
        cells[:, run.span[1] + 1 :] = False
        # Seen face on, along the wall and up: the mean depth of all points of a place. Where noise
        # spreads a face over two cells, each alone would read off by a centimetre or two.
        gap = outward - run.outward_m
        cells &= np.abs(gap) <= high
        weight = np.where(cells, turned(surface.hits, run.axis, run.sign), 0)
        total = weight.sum(axis=0)
        depth = (weight * gap).sum(axis=0) / np.maximum(total, 1)
        recessed = (total > 0) & (depth >= low) & (depth <= high)
        plane = (total > 0) & (np.abs(depth) < low)
        parts, _ = connected_parts(opened(recessed))
        for number, box in enumerate(ndimage.find_objects(parts), 1):
            part = parts == number
            kind = _kind(part[box], box[1].start, surface, parameters)
            if kind is not None and _framed(part, plane) >= parameters.frame_share:
                chosen = cells & (grown(part) & recessed)[None]
                turned(labels, run.axis, run.sign)[chosen] = kind


def _kind(
    part: np.ndarray, bottom_layer: int, surface: Surface, parameters: StructureParameters
) -> SemanticClass | None:
    """Return what a recessed part, seen face on, is; None where it is too small or ragged."""
    width, height = np.array(part.shape) * surface.voxel_m
    bottom = surface.origin_m[2] + bottom_layer * surface.voxel_m
    if part.sum() * surface.voxel_m**2 < parameters.opening_area_m2 or part.mean() < 0.5:
        return None
    sized = within(width, parameters.window_size_m) and height >= parameters.window_size_m[0]
    if sized and bottom >= parameters.window_sill_m:
        return SemanticClass.WINDOW
    leaf = within(width, parameters.door_width_m) and height >= parameters.door_height_m
    return SemanticClass.OBJS if leaf else None


def _framed(part: np.ndarray, plane: np.ndarray) -> float:
    """Return the share of the ring around a part that lies on the wall's plane."""
    ring = grown(part, 3) & ~grown(part)
    return float(plane[ring].mean()) if ring.any() else 0.0

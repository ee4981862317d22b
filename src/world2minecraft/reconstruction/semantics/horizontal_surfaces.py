"""Plates: horizontal surfaces seen from above, such as table tops, seats, beds and counters.

A table with its chairs is a single connected piece of voxels, which plates divide.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.geometry.morphology import dilate, erode, fill_gaps_and_holes, project_to_plan
from world2minecraft.reconstruction.layout.parameters import PlateParameters
from world2minecraft.reconstruction.layout.surface_cells import Surface

MAX_HEIGHTS = 40


@dataclass(frozen=True, eq=False)
class HorizontalSurface:
    """A horizontal surface. ``footprint`` is its outline from above with holes filled."""

    mask: np.ndarray  # bool [X, Y, Z]: its cells
    footprint: np.ndarray  # bool [X, Y]
    height_m: float
    layer: int  # The layer in which most of its cells lie.
    area_m2: float  # Of the footprint.
    length_m: float
    width_m: float  # The shorter side of its box seen from above.
    rim_share: float  # Of the seen cells under its rim, the share that is surface.


def find_horizontal_surfaces(
    surface: Surface, rest: np.ndarray, parameters: PlateParameters
) -> list[HorizontalSurface]:
    """Find the plates in a mask of cells, bool [X, Y, Z]; the largest of a height come first."""
    facing_up = rest.copy()
    facing_up[:, :, :-1] &= ~surface.occupied[:, :, 1:] | _next_is_level(surface)
    low, high = parameters.height_m
    height = surface.points_m[..., 2]
    facing_up &= (height >= low) & (height <= high)
    facing_up &= _neighbours(facing_up, height, parameters.gate_m) >= 2
    plates: list[HorizontalSurface] = []
    for _ in range(MAX_HEIGHTS):
        if facing_up.sum() * surface.voxel_m**2 < parameters.area_m2:
            break
        peak, _ = highest_peak(height[facing_up], parameters.gate_m)
        near = facing_up & (np.abs(height - peak) <= parameters.gate_m)
        plates.extend(_plates_at(surface, near, parameters))
        facing_up &= ~near
    return plates


def _next_is_level(surface: Surface) -> np.ndarray:
    """Return whether the cell above contains the same horizontal surface, split by noise."""
    height = surface.points_m[..., 2]
    return np.abs(height[:, :, 1:] - height[:, :, :-1]) <= 0.4 * surface.voxel_m


def _neighbours(mask: np.ndarray, height: np.ndarray, gate_m: float) -> np.ndarray:
    """Count, of the 8 columns around each cell of a mask, those at the same height."""
    padded = np.pad(mask, 1)
    heights = np.pad(np.where(mask, height, -1e3), 1, constant_values=-1e3)
    count = np.zeros(mask.shape, np.int8)
    x, y, z = mask.shape
    for dx in (0, 1, 2):
        for dy in (0, 1, 2):
            if dx == dy == 1:
                continue
            column = np.zeros(mask.shape, bool)
            for dz in (0, 1, 2):
                at = (slice(dx, dx + x), slice(dy, dy + y), slice(dz, dz + z))
                column |= padded[at] & (np.abs(heights[at] - height) <= gate_m)
            count += column
    return count


def _plates_at(
    surface: Surface, near: np.ndarray, parameters: PlateParameters
) -> list[HorizontalSurface]:
    """Return the plates among cells of one height, by decreasing area."""
    parts, count = label_components(project_to_plan(near))
    sizes = np.bincount(parts.reshape(-1), minlength=count + 1)[1:]
    found = []
    for part in np.argsort(-sizes, kind="stable") + 1:
        if sizes[part - 1] * surface.voxel_m**2 < parameters.area_m2:
            break
        found.append(_plate(surface, near & (parts == part)[:, :, None]))
    return found


def _plate(surface: Surface, mask: np.ndarray) -> HorizontalSurface:
    footprint = fill_gaps_and_holes(project_to_plan(mask))
    heights = surface.points_m[..., 2][mask]
    layer = int(np.bincount(np.nonzero(mask)[2]).argmax())
    rows, columns = np.nonzero(footprint)
    sides = sorted([np.ptp(rows) + 1, np.ptp(columns) + 1])
    return HorizontalSurface(
        mask=mask,
        footprint=footprint,
        height_m=float(np.median(heights)),
        layer=layer,
        area_m2=float(footprint.sum()) * surface.voxel_m**2,
        length_m=float(sides[1]) * surface.voxel_m,
        width_m=float(sides[0]) * surface.voxel_m,
        rim_share=_rim_share(surface, footprint, layer),
    )


def _rim_share(surface: Surface, footprint: np.ndarray, layer: int) -> float:
    """Return the share of surface among the seen cells under the rim of a plate.

    A column of the rim is closed at a height if a cell in it or in a neighbouring column is
    occupied, since fronts may be slightly recessed.
    """
    bottom = max(surface.floor_layer + 2, 0)
    if layer - 1 <= bottom:
        return 0.0
    inner = erode(footprint, 2)
    outer = dilate(footprint)
    rim = outer & ~inner
    band = slice(bottom, layer)
    front = rim[:, :, None] & surface.occupied[:, :, band]
    gap = (footprint & ~inner)[:, :, None] & surface.free[:, :, band]
    # Free cells just outside a closed front are no gaps in it: only those under the plate count.
    seen = front.sum() + gap.sum()
    return float(front.sum() / seen) if seen else 0.0

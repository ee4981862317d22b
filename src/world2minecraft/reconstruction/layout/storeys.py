"""The storeys of a house, each labelled separately.

A floor is a large horizontal plane that a person can stand on; its storey reaches up to the middle
of the slab above. Heights are measured from the floor of the storey, so the same rules apply to all
storeys.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.structure import find_ceiling
from world2minecraft.reconstruction.layout.surface_cells import Surface


@dataclass(frozen=True)
class Storey:
    """The layers ``low`` to ``high`` (exclusive) of a grid whose floor is at ``floor_z_m``."""

    floor_z_m: float
    low: int
    high: int

    def part(self, values: np.ndarray) -> np.ndarray:
        """Return the view of an array [X, Y, Z, ...] that belongs to the storey."""
        return values[:, :, self.low : self.high]

    def surface(self, surface: Surface) -> Surface:
        """Return the surface of the storey in its own frame, with the top of its floor at z = 0."""
        rise = np.array([0.0, 0.0, self.floor_z_m])
        corner = surface.origin_m + np.array([0.0, 0.0, self.low * surface.voxel_m])
        points = self.part(surface.points_m)
        return replace(
            surface,
            occupied=self.part(surface.occupied),
            free=self.part(surface.free),
            points_m=points - rise.astype(np.float32) if self.floor_z_m else points,
            hits=self.part(surface.hits),
            oklab=self.part(surface.oklab),
            origin_m=corner - rise,
        )


def find_storeys(surface: Surface, parameters: StructureParameters) -> tuple[Storey, ...]:
    """Return the storeys from the lowest up; the ground floor is always included."""
    floors = sorted([0.0, *_other_floors(surface, parameters)])
    height = surface.occupied.shape[2]
    if len(floors) == 1:
        return (Storey(0.0, 0, height),)
    edges = [0]
    for lower, upper in pairwise(floors):
        below = Storey(lower, edges[-1], surface.layers_below(upper - surface.voxel_m))
        ceiling_m = None
        if below.high > below.low:
            ceiling_m = find_ceiling(below.surface(surface), parameters)[1]
        top_m = upper - 1.5 * surface.voxel_m if ceiling_m is None else lower + ceiling_m
        edges.append(max(surface.layers_below((top_m + upper) / 2), edges[-1] + 1))
    return tuple(
        Storey(floor, low, high)
        for floor, low, high in zip(floors, edges, [*edges[1:], height], strict=True)
        if high > low
    )


def _other_floors(surface: Surface, parameters: StructureParameters) -> list[float]:
    """Return the heights of the floors above and below the ground floor."""
    standing = surface.occupied & _room_above(surface, parameters.standing_m)
    heights = surface.points_m[..., 2][standing]
    heights = heights[np.abs(heights) >= parameters.storey_m]
    needed = parameters.floor_area_m2 / surface.voxel_m**2
    found: list[float] = []
    while len(heights) >= needed:
        peak, count = highest_peak(heights, parameters.plane_gate_m)
        if count < needed:
            break
        if all(abs(peak - other) >= parameters.storey_m for other in found):
            found.append(round(peak, 6))
        heights = heights[np.abs(heights - peak) > parameters.plane_gate_m]
    return found


def _room_above(surface: Surface, standing_m: float) -> np.ndarray:
    """Return the cells with enough space above for a person, mostly seen as free, bool."""
    cells = surface.cells_of(standing_m)
    total = np.pad(surface.free.cumsum(axis=2, dtype=np.int32), ((0, 0), (0, 0), (1, 0)))
    above = np.zeros(surface.free.shape, np.int32)
    if surface.free.shape[2] > cells + 1:
        above[:, :, : -cells - 1] = total[:, :, cells + 2 :] - total[:, :, 1 : -cells - 1]
    return above >= 0.8 * cells

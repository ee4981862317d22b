"""The cells of a plan while they are painted, and the things that stand in them so far."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import (
    OBSERVED,
    UNSEEN,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.reconstruction.floorplans.colours import STRUCTURE, Colour
from world2minecraft.reconstruction.floorplans.furniture_categories import OWN_CELLS
from world2minecraft.reconstruction.floorplans.room_outlines import PlacedRoom

MOST_CELLS = 400_000_000
PAD = 3  # Cells around all rooms: a wall, and nothing known behind it.


class Canvas:
    """Labels, instances and colours over all rooms, ``first`` the index of cell (0, 0, 0)."""

    def __init__(self, rooms: Sequence[PlacedRoom], voxel_m: float):
        """Begin with nothing known.

        Raises:
            UsageError: the rooms are too large for such cells.
        """
        low = np.min([[*r.outline_m.min(axis=0), r.floor_z_m] for r in rooms], axis=0)
        high = np.max([[*r.outline_m.max(axis=0), r.floor_z_m + r.height_m] for r in rooms], axis=0)
        first = np.floor(low / voxel_m).astype(int) - PAD
        shape = np.ceil(high / voxel_m).astype(int) + PAD - first
        if np.prod(shape, dtype=np.float64) > MOST_CELLS:
            metres = " x ".join(f"{side * voxel_m:.0f}" for side in shape)
            raise UsageError(
                f"the plan is {metres} m large; give larger cells, such as --voxel 0.16"
            )
        self.voxel_m, self.first = voxel_m, first
        self.labels = np.full(shape, UNKNOWN, np.uint8)
        self.instance = np.zeros(shape, np.uint16)
        self.colour = np.zeros((*shape, 3), np.uint8)
        self.instances: list[ObjectInstance] = []
        self.placements: list[Placement] = []

    def middles_m(self) -> tuple[np.ndarray, np.ndarray]:
        """Return x [X, 1] and y [1, Y] of the cells' middles."""
        x, y = (
            (self.first[axis] + np.arange(self.labels.shape[axis]) + 0.5) * self.voxel_m
            for axis in (0, 1)
        )
        return x[:, None], y[None, :]

    def layers(self, low_m: float, high_m: float) -> slice:
        """Return the layers between two heights, one at least."""
        low, high = (round(value / self.voxel_m) - int(self.first[2]) for value in (low_m, high_m))
        return slice(max(low, 0), max(high, low + 1))

    def columns(self, points_m: np.ndarray) -> np.ndarray:
        """Return the columns, int [N, 2], of points [N, 2]."""
        cells = np.floor(points_m / self.voxel_m).astype(int) - self.first[:2]
        return np.clip(cells, 0, np.array(self.labels.shape[:2]) - 1)

    def add(
        self,
        cells: np.ndarray,
        class_id: int,
        template: str,
        turns: int,
        colour: Colour,
        box: tuple[np.ndarray, np.ndarray] | None = None,
        confidence: float = 1.0,
    ) -> None:
        """Put a thing into cells.

        Args:
            cells: int [N, 3].
            class_id: its object class.
            template: what stands for it.
            turns: quarter turns of its front.
            colour: sRGB.
            box: its first cell and its sides in cells; that of its cells where none is given.
            confidence: 0 to 1.
        """
        number = len(self.instances) + 1
        at = tuple(cells.T)
        self.labels[at], self.instance[at], self.colour[at] = class_id, number, colour
        low, sides = box or (cells.min(axis=0), np.ptp(cells, axis=0) + 1)
        own = sides[[1, 0, 2]] if turns % 2 else sides
        middle = np.round((low + sides / 2 + self.first) * self.voxel_m, 4)
        size, yaw = np.round(own * self.voxel_m, 4), 90.0 * turns
        found = ObjectInstance(
            number, class_id, middle, size, yaw, cells.astype(np.int32), confidence
        )
        iou = 0.0 if template == OWN_CELLS else 1.0
        self.instances.append(found)
        self.placements.append(Placement(number, class_id, template, middle, size, turns, iou))

    def grid(self) -> OccupancyGrid:
        """Return what was painted; structure takes its usual colours."""
        known = self.labels != UNKNOWN
        for class_id, colour in STRUCTURE.items():
            self.colour[self.labels == class_id] = colour
        return OccupancyGrid(
            labels=self.labels,
            confidence=known.astype(np.float16),
            colour=self.colour,
            source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
            instance=self.instance,
            voxel_m=self.voxel_m,
            origin_m=np.round(self.first * self.voxel_m, 9),
        )

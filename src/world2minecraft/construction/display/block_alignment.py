"""Alignment of a detailed object to the blocks of its room by less than a block.

Walls and floors are on the lattice, up to half a block away from their true planes. An object at a
wall must neither sink into the wall nor leave a gap, and an object on a table must move with it.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import UNSEEN_BLOCKS, Canvas
from world2minecraft.construction.display.boxes import Frame
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid

STANDS_M = 0.12  # A bottom this near to the floor stands on it: one and a half cells of 8 cm.
FLOOR_STANDS_M = 0.3  # The same of furniture that always stands on a floor.
LIES_M = 0.2  # Maximum gap between an object and its support, in metres.
AT_WALL_M = 0.17  # A side this near to a wall's cells stood at the wall: two cells of 8 cm.
AT_WALL_SHARE = 0.3  # Minimum share of a side that has a wall behind it.
MAX_BLOCKS = 1.25  # A wall's blocks stand off its plane by less; more would be another wall.
SUNK_COST = 8.0  # Blocks by which an object is moved rather than left completely in a wall.
WALLS = (int(SemanticClass.WALL), int(SemanticClass.WINDOW))
_EDGE = 1e-6


class Alignment(NamedTuple):
    """The frame of an object in the room before and after its alignment."""

    before: Frame
    after: Frame


class BlockAligner:
    """Aligns the objects of a room with its finished shell."""

    def __init__(self, canvas: Canvas, grid: OccupancyGrid):
        self.lattice = canvas.lattice
        self.solid = (canvas.states > 0) & ~canvas.mask_of(*UNSEEN_BLOCKS)
        self.grid = grid
        self.walls = np.isin(grid.labels, WALLS)
        self.placed: list[Alignment] = []

    def settle(self, frame: Frame, mount: str, carried: bool) -> Frame:
        """Align the frame of an object and remember it for the objects that rest on it.

        Args:
            frame: Frame in which the object was observed.
            mount: ``floor``, ``wall``, ``ceiling`` or ``any``, as stated by the template.
            carried: Whether the object may rest on another object.
        """
        moved = frame.moved(np.array([0.0, 0.0, self._rise(frame, mount)]))
        host = self._host_of(frame) if carried else None
        if host is not None:
            shift = host.after.base_m - host.before.base_m
            top = host.after.base_m[2] + host.after.size_m[2]
            moved = frame.moved(np.array([shift[0], shift[1], top - frame.base_m[2]]))
        else:
            moved = moved.moved(self._to_walls(moved))
        moved = moved.moved(self._out_of_walls(moved))
        self.placed.append(Alignment(frame, moved))
        return moved

    def _rise(self, frame: Frame, mount: str) -> float:
        """Return the distance in metres by which an object is raised to its floor or ceiling."""
        scale = self.lattice.blocks_per_metre
        bottom = float(self.lattice.coordinates_of(frame.base_m)[2])
        if mount == "ceiling":
            return self._to_ceiling(frame)
        ground = self.lattice.ground_under(bottom)
        over = (bottom - ground) / scale
        near = FLOOR_STANDS_M if mount == "floor" else STANDS_M
        return -over if over <= near else 0.0

    def _to_ceiling(self, frame: Frame) -> float:
        """Return the distance in metres from the top of a hanging object to the blocks above."""
        top_m = np.array([*frame.base_m[:2], frame.base_m[2] + frame.size_m[2]])
        x, y, top = self.lattice.coordinates_of(top_m)
        column = np.clip([int(x), int(y)], 0, np.array(self.lattice.shape[:2]) - 1)
        layers = np.flatnonzero(self.solid[column[0], column[1]])
        layers = layers[np.abs(layers - top) <= MAX_BLOCKS]
        if not len(layers):
            return 0.0
        return float(layers.min() - top) / self.lattice.blocks_per_metre

    def _host_of(self, frame: Frame) -> Alignment | None:
        """Return the highest object under the centre of a frame that supports it."""
        best = None
        for one in self.placed:
            low, high = one.before.bounds_m
            inside = (low[:2] <= frame.base_m[:2]).all() and (frame.base_m[:2] <= high[:2]).all()
            near = abs(high[2] - frame.base_m[2]) <= LIES_M
            if inside and near and (best is None or high[2] > best.before.bounds_m[1, 2]):
                best = one
        return best

    def _to_walls(self, frame: Frame) -> np.ndarray:
        """Return the shift in metres, float64 [3], that closes gaps to adjacent walls."""
        shift = np.zeros(3)
        if frame.yaw_deg % 90:
            return shift
        for axis in (0, 1):
            at = [self._is_at_wall(frame, axis, side) for side in (-1, 1)]
            if at[0] != at[1]:
                shift[axis] = self._gap(frame, axis, 1 if at[1] else -1)
        return shift / self.lattice.blocks_per_metre

    def _is_at_wall(self, frame: Frame, axis: int, side: int) -> bool:
        """Return whether cells of a wall are directly behind most of a side."""
        low, high = (frame.bounds_m - self.grid.origin_m) / self.grid.voxel_m
        reach = AT_WALL_M / self.grid.voxel_m
        low, high = low.copy(), high.copy()
        if side > 0:
            low[axis], high[axis] = high[axis] - 1, high[axis] + reach
        else:
            low[axis], high[axis] = low[axis] - reach, low[axis] + 1
        first = np.clip(np.floor(low + 0.5), 0, self.grid.shape).astype(int)
        last = np.clip(np.floor(high + 0.5), first, self.grid.shape).astype(int)
        window = self.walls[tuple(slice(a, b) for a, b in zip(first, last, strict=True))]
        covered = window.any(axis=axis)
        return bool(covered.size) and float(covered.mean()) >= AT_WALL_SHARE

    def _gap(self, frame: Frame, axis: int, side: int) -> float:
        """Return the signed distance in blocks from a side to the blocks in front; 0 for none."""
        low, high = self._bounds(frame)
        face = high[axis] if side > 0 else low[axis]
        for step in (0, 1):
            layer = (
                int(np.ceil(face - _EDGE)) + step
                if side > 0
                else int(np.floor(face + _EDGE)) - 1 - step
            )
            gap = layer - face if side > 0 else layer + 1 - face
            if not 0 <= layer < self.solid.shape[axis] or abs(gap) > MAX_BLOCKS:
                return 0.0
            window = [slice(*_whole(low[n], high[n], self.solid.shape[n])) for n in range(3)]
            window[axis] = slice(layer, layer + 1)
            if self.solid[tuple(window)].mean() >= AT_WALL_SHARE:
                return gap
        return 0.0

    def _out_of_walls(self, frame: Frame) -> np.ndarray:
        """Return the shortest horizontal shift out of blocks, float64 [3] in metres."""
        low, high = self._bounds(frame)
        # Floor and ceiling are not met sideways.
        low[2], high[2] = low[2] + _EDGE, max(high[2] - _EDGE, low[2] + 2 * _EDGE)
        if self._sunk(low, high, np.zeros(2)) <= _EDGE:
            return np.zeros(3)
        ways = [_ways(low[axis], high[axis]) for axis in (0, 1)]
        costs = {
            (x, y): round(SUNK_COST * self._sunk(low, high, np.array([x, y])) + abs(x) + abs(y), 6)
            for x in ways[0]
            for y in ways[1]
        }
        x, y = min(costs, key=lambda way: (costs[way], abs(way[0]) + abs(way[1]), way))
        return np.array([x, y, 0.0]) / self.lattice.blocks_per_metre

    def _bounds(self, frame: Frame) -> tuple[np.ndarray, np.ndarray]:
        low, high = self.lattice.coordinates_of(frame.bounds_m)
        return low.copy(), high.copy()

    def _sunk(self, low: np.ndarray, high: np.ndarray, shift: np.ndarray) -> float:
        """Return the share of a shifted box that is inside blocks."""
        volume = 1.0
        spans, weights = [], []
        for axis in range(3):
            a, b = low[axis], high[axis]
            if axis < 2:
                a, b = a + shift[axis] + _EDGE, b + shift[axis] - _EDGE
            first, last = int(np.floor(a)), max(int(np.ceil(b)), int(np.floor(a)) + 1)
            cells = np.arange(first, last)
            weights.append(np.clip(np.minimum(b, cells + 1) - np.maximum(a, cells), 0, None))
            spans.append(np.clip(cells, 0, self.solid.shape[axis] - 1))
            volume *= max(b - a, _EDGE)
        sums = self.solid[np.ix_(*spans)].astype(np.float64)
        for weight in weights:
            sums = np.tensordot(weight, sums, axes=(0, 0))
        return float(sums) / volume


def _ways(low: float, high: float) -> list[float]:
    """Return the shifts along an axis that bring a side to a block boundary, and 0."""
    up, down = np.ceil(low - _EDGE) - low, np.floor(high + _EDGE) - high
    ways = [0.0, float(up), float(up) + 1, float(down), float(down) - 1]
    return sorted({round(way, 9) for way in ways if abs(way) <= MAX_BLOCKS})


def _whole(low: float, high: float, count: int) -> tuple[int, int]:
    """Return the blocks [first, last) that a span meets, one at least."""
    first = int(np.clip(np.floor(low + _EDGE), 0, count - 1))
    return first, int(np.clip(np.ceil(high - _EDGE), first + 1, count))

"""Evidence in, one view after the other; at any time the map is there.

In: PointEvidence or GridEvidence in the scan's frame. Out: FusedEvidence in the room frame. The
map grows with what is seen, so that a capture is read once and nothing must be known of its size.
A cell holds log-odds of being occupied: a view that sees a surface in it adds ``hit_log_odds``, a
ray that crosses it adds ``free_log_odds``; what no ray reached stays 0, unknown.
"""

from collections.abc import Iterable

import numpy as np

from world2minecraft.classes import CLASS_COUNT
from world2minecraft.coordinates import apply
from world2minecraft.errors import CaptureError
from world2minecraft.fuse.grids import grid_gains
from world2minecraft.fuse.kernels import add_points, to_cells
from world2minecraft.fuse.parameters import FuseParameters
from world2minecraft.progress import Progress, silent
from world2minecraft.types import FusedEvidence, GridEvidence, PointEvidence, Scan

REACH_CELLS = 2  # A nudged point may leave its cell by one.
GROW_CELLS = 16  # Arrays grow in steps, so that few frames copy them.
MAX_CELLS = 40_000_000  # 4 GB of working arrays: a house of 40 x 40 x 12 m at 0.08 m.


class EvidenceMap:
    """The growing map. ``add`` takes evidence, ``fused`` gives the value of the moment."""

    def __init__(self, scan_to_room: np.ndarray, parameters: FuseParameters | None = None):
        self.parameters = parameters or FuseParameters()
        self.scan_to_room = np.asarray(scan_to_room, np.float64)
        self._low = np.zeros(3, np.int64)  # The room cell that stands at array index (0, 0, 0).
        self._allocate(np.zeros(3, np.int64))

    def add(self, evidence: PointEvidence | GridEvidence) -> None:
        """Add what one view says.

        Raises:
            CaptureError: the capture spans more than the map may hold.
        """
        if isinstance(evidence, PointEvidence):
            self._add_points(evidence)
        else:
            self._add_grid(evidence)

    def fused(self) -> FusedEvidence:
        """Return the map, cut to the cells that were seen."""
        seen = np.argwhere(self._log_odds != 0)
        if not len(seen):
            raise CaptureError("capture", "no view gave any evidence; is there depth in it?")
        low, high = seen.min(axis=0), seen.max(axis=0) + 1
        box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
        limit = np.maximum(self._hits[box] / 65535, 1)[..., None]
        return FusedEvidence(
            log_odds=self._log_odds[box].astype(np.float16),
            votes=np.minimum(self._votes[box], 60_000).astype(np.float16),
            colour_sum=(self._colour_sum[box] / limit).astype(np.float32),
            offset_sum=(self._offset_sum[box] / limit).astype(np.float32),
            hits=np.minimum(self._hits[box], 65535).astype(np.uint16),
            voxel_m=self.parameters.voxel_m,
            origin_m=(self._low + low) * self.parameters.voxel_m,
            scan_to_room=self.scan_to_room,
        )

    def _allocate(self, shape: np.ndarray) -> None:
        x, y, z = (int(size) for size in shape)
        self._log_odds = np.zeros((x, y, z), np.float32)
        self._votes = np.zeros((x, y, z, CLASS_COUNT), np.float32)
        self._colour_sum = np.zeros((x, y, z, 3), np.float32)
        self._offset_sum = np.zeros((x, y, z, 3), np.float32)
        self._hits = np.zeros((x, y, z), np.uint32)
        self._slots = np.full((x, y, z), -1, np.int32)

    def _reserve(self, low: np.ndarray, high: np.ndarray) -> None:
        """Grow the arrays so that room cells ``low`` to ``high`` (past the end) fit."""
        size = np.array(self._log_odds.shape)
        if (low >= self._low).all() and (high <= self._low + size).all() and size.all():
            return
        new_low = np.minimum(low, self._low) if size.all() else low
        new_low = new_low // GROW_CELLS * GROW_CELLS
        end = np.maximum(high, self._low + size) if size.all() else high
        new_size = -(-(end - new_low) // GROW_CELLS) * GROW_CELLS
        if new_size.astype(np.float64).prod() > MAX_CELLS:
            extent = " x ".join(f"{side:.0f}" for side in new_size * self.parameters.voxel_m)
            raise CaptureError("capture", f"spans {extent} m; a larger --voxel makes it fit")
        shift = np.maximum(self._low - new_low, 0)
        box = tuple(slice(a, a + b) for a, b in zip(shift, size, strict=True))
        old = (self._log_odds, self._votes, self._colour_sum, self._offset_sum, self._hits)
        self._allocate(new_size)
        new = (self._log_odds, self._votes, self._colour_sum, self._offset_sum, self._hits)
        for source, target in zip(old, new, strict=True):
            target[box] = source
        self._low = new_low

    def _add_points(self, evidence: PointEvidence) -> None:
        if not len(evidence.points_m):
            return
        voxel_m = self.parameters.voxel_m
        cells, low, high = to_cells(evidence.points_m, self.scan_to_room[:3] / voxel_m)
        camera = apply(self.scan_to_room, evidence.camera_m) / voxel_m
        self._reserve(
            np.floor(np.minimum(low, camera)).astype(np.int64) - REACH_CELLS,
            np.floor(np.maximum(high, camera)).astype(np.int64) + 1 + REACH_CELLS,
        )
        add_points(
            cells,
            evidence.weight,
            _NO_COLOUR if evidence.colour is None else evidence.colour,
            _NO_VOTES if evidence.votes is None else evidence.votes.astype(np.float32),
            camera,
            self._low,
            self._kernel_parameters,
            self._log_odds,
            self._votes,
            self._colour_sum,
            self._offset_sum,
            self._hits,
            self._slots,
        )

    def _add_grid(self, evidence: GridEvidence) -> None:
        cells, gains, votes = grid_gains(evidence, self.scan_to_room, self.parameters)
        if not len(cells):
            return
        self._reserve(cells.min(axis=0), cells.max(axis=0) + 1)
        at = tuple((cells - self._low).T)
        limit = self.parameters.limit_log_odds
        self._log_odds[at] = np.clip(self._log_odds[at] + gains, -limit, limit)
        self._votes[at] += votes

    @property
    def _kernel_parameters(self) -> np.ndarray:
        values = self.parameters
        return np.array(
            [
                values.hit_log_odds,
                values.free_log_odds,
                values.limit_log_odds,
                values.nudge_m / values.voxel_m,
                values.min_share * values.voxel_m**2,
                values.min_points,
                values.clear_m / values.voxel_m,
                values.voxel_m,
            ]
        )


def fuse_views(
    evidence: Iterable[PointEvidence | GridEvidence],
    scan: Scan,
    parameters: FuseParameters | None = None,
    progress: Progress = silent,
) -> FusedEvidence:
    """Fuse the evidence of all views, streamed: the paper's F_embodied, equation 2.

    Raises:
        CaptureError: no view gave evidence, or the capture is larger than the map may be.
    """
    map_ = EvidenceMap(scan.scan_to_room, parameters)
    total, done = len(scan.views), 0
    for item in evidence:
        map_.add(item)
        done = min(done + 1, total)
        progress("fuse", done, total, item.view)
    if done < total:  # Some views gave nothing.
        progress("fuse", total, total)
    return map_.fused()


_NO_COLOUR = np.zeros((0, 3), np.uint8)
_NO_VOTES = np.zeros((0, CLASS_COUNT), np.float32)

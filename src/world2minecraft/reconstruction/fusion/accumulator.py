"""Accumulate the evidence of views in a map that can be read at any time.

The input is PointEvidence or GridEvidence in the scan's frame, the output FusedEvidence in the room
frame. The map grows with the observed space, so a capture is read only once and its extent need not
be known. Each cell has log-odds of being occupied: a view that sees a surface in the cell adds
``hit_log_odds``, a ray that crosses it adds ``free_log_odds``, and cells without observations stay
0 (unknown). The planes of observed surfaces are also stored; ``decide_surface`` uses them to decide
which cells are solid.
"""

import math
from collections.abc import Iterable

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.parallel import read_ahead
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import FusedEvidence, GridEvidence, PointEvidence, Scan
from world2minecraft.reconstruction.fusion.integration import (
    ViewPlace,
    ViewPoints,
    ViewRules,
    add_hits,
    add_labels,
    add_votes,
    carve_free_space,
    places_of,
    sum_cells,
    to_cells,
)
from world2minecraft.reconstruction.fusion.network_grids import grid_gains
from world2minecraft.reconstruction.fusion.parameters import FusionParameters
from world2minecraft.reconstruction.fusion.surface_decision import (
    SurfaceRules,
    decide_surface,
    move_sums,
)
from world2minecraft.reconstruction.fusion.voxel_blocks import BLOCK_CELLS, MAX_DENSE, SIDE, Blocks

REACH_CELLS = 2  # A nudged point may leave its cell by one.
ALL_SUB_CELLS = 64


class EvidenceMap:
    """A growing map of evidence. ``add`` adds the evidence of a view, ``fused`` returns the map."""

    def __init__(self, scan_to_room: np.ndarray, parameters: FusionParameters | None = None):
        self.parameters = parameters or FusionParameters()
        self.scan_to_room = np.asarray(scan_to_room, np.float64)
        self.blocks = Blocks()
        self._base = 1  # The next view's number in the cells' marks.

    def add(self, evidence: PointEvidence | GridEvidence) -> None:
        """Add the evidence of one view.

        Raises:
            CaptureError: If the capture is larger than the map may be.
        """
        if isinstance(evidence, PointEvidence):
            self._add_points(evidence)
        else:
            self._add_grid(evidence)

    def fused(self) -> FusedEvidence:
        """Return the map with decided surfaces, cropped to the observed cells.

        Raises:
            CaptureError: If no cell was observed, or if the observed cells are too far apart for
                one grid.
        """
        values, blocks = self.parameters, self.blocks
        log_odds, record, low = self._dense()
        log_odds = np.clip(log_odds, -values.limit_log_odds, values.limit_log_odds)
        sums = [
            array[: int(blocks.used[1]) + 1].copy()
            for array in (blocks.votes, blocks.colour_sum, blocks.offset_sum, blocks.hits)
        ]
        log_odds, heir = decide_surface(
            log_odds, record, blocks.faces, values.voxel_m, self._surface_rules
        )
        move_sums(record, heir, values.voxel_m, *sums)
        seen = np.argwhere(log_odds != 0)
        if not len(seen):
            raise CaptureError(
                "capture", "no view contains usable depth; check the capture with w2m scan"
            )
        first, last = seen.min(axis=0), seen.max(axis=0) + 1
        box = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
        # A floor that was seen a few centimetres too high is moved into the layer below z = 0.
        below = [(0, 0), (0, 0), (int((low + first)[2] == 0), 0)]
        log_odds, record = (np.pad(array[box], below) for array in (log_odds, record))
        return self._as_evidence(log_odds, record, low + first - np.array(below)[:, 0], *sums)

    @property
    def memory_mb(self) -> float:
        """The memory of the map's arrays in megabytes."""
        arrays = (value for value in vars(self.blocks).values() if isinstance(value, np.ndarray))
        return sum(array.nbytes for array in arrays) / (1 << 20)

    def _as_evidence(self, log_odds, record, low, votes, colour_sum, offset_sum, hits):
        """Create evidence from dense cells and the sums of their records."""
        scale = np.maximum(hits / 65535, 1)[:, None]
        votes[0], colour_sum[0], offset_sum[0], hits[0] = 0, 0, 0, 0
        return FusedEvidence(
            log_odds=log_odds.astype(np.float16),
            votes=np.minimum(votes, 60_000).astype(np.float16)[record],
            colour_sum=(colour_sum / scale).astype(np.float32)[record],
            offset_sum=(offset_sum / scale).astype(np.float32)[record],
            hits=np.minimum(hits, 65535).astype(np.uint16)[record],
            voxel_m=self.parameters.voxel_m,
            origin_m=low * self.parameters.voxel_m,
            scan_to_room=self.scan_to_room,
        )

    def _dense(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return dense log-odds and record numbers over all blocks, and the lowest cell."""
        numbers, first = self.blocks.cells_of_blocks()
        if not len(numbers):
            return np.zeros((1, 1, 1), np.float32), np.zeros((1, 1, 1), np.int32), np.zeros(3)
        low = first.min(axis=0)
        shape = tuple((first.max(axis=0) + SIDE - low).tolist())
        if math.prod(shape) > MAX_DENSE:
            extent = " x ".join(f"{side * self.parameters.voxel_m:.0f}" for side in shape)
            raise CaptureError(
                "capture",
                f"spans {extent} m but most of that is empty: a frame may have a wrong pose; "
                "check the poses with w2m scan, or use larger cells (--voxel)",
            )
        log_odds, record = np.zeros(shape, np.float32), np.zeros(shape, np.int32)
        for number, start in zip(numbers, first - low, strict=True):
            box = tuple(slice(a, a + SIDE) for a in start)
            cells = slice(number * BLOCK_CELLS, (number + 1) * BLOCK_CELLS)
            log_odds[box] = self.blocks.log_odds[cells].reshape(SIDE, SIDE, SIDE)
            record[box] = self.blocks.record[cells].reshape(SIDE, SIDE, SIDE)
        return log_odds, record, low

    def _add_points(self, evidence: PointEvidence) -> None:
        if not len(evidence.points_m):
            return
        voxel_m, blocks, rules = self.parameters.voxel_m, self.blocks, self._rules
        points_m = _read_only(evidence.points_m, _NO_VECTORS)
        points, low, high = to_cells(points_m, self.scan_to_room[:3] / voxel_m)
        camera = apply(self.scan_to_room, evidence.camera_m) / voxel_m
        blocks.reserve_box(
            np.floor(np.minimum(low, camera)).astype(np.int64) - REACH_CELLS,
            np.floor(np.maximum(high, camera)).astype(np.int64) + 1 + REACH_CELLS,
            voxel_m,
        )
        view = ViewPoints(
            points,
            _read_only(evidence.normals, _NO_VECTORS),
            _read_only(evidence.weight, _NO_NUMBERS),
            _read_only(evidence.trust, _NO_NUMBERS),
            _read_only(evidence.colour, _NO_COLOURS),
        )
        turn = np.ascontiguousarray(self.scan_to_room[:3, :3])
        place = ViewPlace(camera, turn, self.parameters.nudge_m / voxel_m, voxel_m)
        owner, places, sums = sum_cells(view, place, blocks.by_cell, blocks.mark, self._base)
        blocks.reserve_records(len(places))
        taken = add_hits(places, sums, rules, blocks.used, blocks.cells, blocks.records)
        if evidence.labels is not None or evidence.votes is not None:
            self._add_votes(evidence, np.where(taken, blocks.record[places], 0)[owner])
        carve_free_space(camera, sums, rules, blocks.by_cell, blocks.cells, self._base)
        self._base += len(places) + 1

    def _add_votes(self, evidence: PointEvidence, rows: np.ndarray) -> None:
        """Add the votes of points to their records, int32 [N], 0 for none."""
        blocks = self.blocks
        if evidence.labels is not None:
            add_labels(evidence.labels, rows, blocks.votes)
        if evidence.votes is not None:
            of_point = evidence.vote_rows
            if of_point is None:
                of_point = np.arange(len(rows), dtype=np.int32)
            add_votes(evidence.votes.astype(np.float32), of_point, rows, blocks.votes)

    def _add_grid(self, evidence: GridEvidence) -> None:
        found = grid_gains(evidence, self.scan_to_room, self.parameters)
        if not len(found.cells):
            return
        blocks = self.blocks
        low, high = found.cells.min(axis=0), found.cells.max(axis=0) + 1
        blocks.reserve_box(low, high, self.parameters.voxel_m)
        at = places_of(found.cells, blocks.by_cell)
        blocks.log_odds[at] += found.gains
        voted = found.votes.any(axis=1)
        at = at[voted]
        blocks.reserve_records(len(at))
        fresh = at[blocks.record[at] == 0]
        blocks.record[fresh] = blocks.used[1] + 1 + np.arange(len(fresh), dtype=np.int32)
        blocks.used[1] += len(fresh)
        record = blocks.record[at]
        blocks.votes[record] += found.votes[voted]
        blocks.colour_sum[record] += found.colour[voted]
        blocks.hits[record] += found.coloured[voted]

    @property
    def _rules(self) -> ViewRules:
        """The rules of integrating a view; lengths along rays are in cells, others in metres."""
        values = self.parameters
        face_m2 = values.voxel_m**2
        return ViewRules(
            hit_log_odds=float(values.hit_log_odds),
            free_log_odds=float(values.free_log_odds),
            limit_log_odds=float(values.limit_log_odds),
            min_area_m2=values.min_share * face_m2,
            min_points=int(values.min_points),
            face_m2=face_m2,
            sigma_m=float(values.sigma_m),
            sigma_growth=float(values.sigma_growth),
            pose_m=float(values.pose_m),
            pose_growth=float(values.pose_growth),
            clear_cells=values.clear_m / values.voxel_m,
            clear_growth=float(values.clear_growth),
        )

    @property
    def _surface_rules(self) -> SurfaceRules:
        """The rules that decide which cells are solid."""
        values = self.parameters
        least = min(max(math.ceil(values.solid_share * ALL_SUB_CELLS - 1e-9), 1), ALL_SUB_CELLS)
        return SurfaceRules(
            least, float(values.merge_m), float(values.merge_sigmas), float(values.sure_m)
        )


def fuse_views(
    evidence: Iterable[PointEvidence | GridEvidence],
    scan: Scan,
    parameters: FusionParameters | None = None,
    progress: Progress = no_progress,
) -> FusedEvidence:
    """Fuse the evidence of all views one by one (F_embodied of the paper, equation 2).

    Raises:
        CaptureError: If no view has evidence, or if the capture is larger than the map may be.
    """
    map_ = EvidenceMap(scan.scan_to_room, parameters)
    total, done = len(scan.views), 0
    for item in read_ahead(evidence):
        map_.add(item)
        done = min(done + 1, total)
        progress("fuse", done, total, item.view)
    if done < total:  # Some views gave nothing.
        progress("fuse", total, total)
    return map_.fused()


def _read_only(values: np.ndarray | None, empty: np.ndarray) -> np.ndarray:
    """Return a read-only view of the values, or of ``empty`` if they are None.

    numba compiles a kernel again for each mixture of writable and read-only arrays, which takes
    seconds.
    """
    view = np.ascontiguousarray(empty if values is None else values).view()
    view.flags.writeable = False
    return view


_NO_VECTORS = np.zeros((0, 3), np.float32)
_NO_NUMBERS = np.zeros(0, np.float32)
_NO_COLOURS = np.zeros((0, 3), np.uint8)

"""Detect wrong axes, classes and poses of saved predictions.

A grid that is read correctly has a level floor below everything else, empty cells in front of what
a view's depth shows, and agrees with the grids of other views. Where this fails, the other
conventions that the files' shape allows are tried, and the error names the one that fits.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import apply, cell_centers_m, invert_rigid
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Scan, View
from world2minecraft.formats.predicted_grids import (
    ORDERS,
    GridRules,
    PredictedGrid,
    StoredGrid,
    axes_of,
    interpret_grid,
    read_as,
    read_stored_grid,
)
from world2minecraft.geometry.unprojection import unproject_depth
from world2minecraft.reconstruction.occupancy.parameters import PredictionParameters
from world2minecraft.reconstruction.occupancy.saved_grids import (
    GridFiles,
    place_frame,
    place_scene,
    view_camera,
)

MAX_VIEWS = 6  # Evenly spaced; the measures are means over them.
MIN_FLOOR_CELLS = 40
LEVEL_CELLS = 1.5  # Cells of one floor are within this height of its fullest layer.
MAX_RAYS = 4000  # Of a view's depth.
ALONG = (0.3, 0.45, 0.6, 0.75, 0.85)  # Of the way to the surface, where cells must be empty.
MIN_SAMPLES = 200  # Rays or cells, for a share of them to count.
NAMED = {"xyz": "embodiedocc", "xzy": "monoscene", "yxz": "iso"}
# True grids have a level floor (1.00), nothing below it (0.00), 0.7 empty cells and 0.01 blocked
# rays. A poor network on two real scans blocks 0.33 and 0.52 of the rays, and with the first two
# axes exchanged 0.57 and 0.73.
MIN_LEVEL, MAX_BELOW, MIN_EMPTY, MAX_BEFORE, MAX_LEAN_DEG = 0.5, 0.35, 0.02, 0.6, 15.0
CLEARLY_BETTER = 0.75  # An alternative fits if its badness is below this times the given one,
MIN_GAIN = 0.1  # and lower by this.
MAX_BADNESS = 0.12  # Below it nothing else is tried; true grids are at 0.03.


@dataclass(frozen=True)
class Plausibility:
    """How well grids fit the capture. A measure is None if nothing shows it.

    Attributes:
        level: Share of the floor's cells at one height.
        below: Share of the other occupied cells that lie below the floor.
        empty: Share of empty cells among the known.
        before: Share of the measured rays that cross an occupied cell in front of their surface.
        lean_deg: Angle between the grid's z axis and the room's.
        agree: Share of a view's occupied cells that the next view has occupied too.
    """

    level: float | None = None
    below: float | None = None
    empty: float | None = None
    before: float | None = None
    lean_deg: float | None = None
    agree: float | None = None

    def faults(self) -> list[str]:
        """Return what contradicts the capture, in words."""
        found = []
        if self.empty is not None and self.empty < MIN_EMPTY:
            found.append(f"only {self.empty:.0%} of the cells are empty")
        if self.lean_deg is not None and self.lean_deg > MAX_LEAN_DEG:
            found.append(f"the z axis is tilted by {self.lean_deg:.0f} degrees")
        if self.level is not None and self.level < MIN_LEVEL:
            found.append(f"the floor is not level: {self.level:.0%} of its cells are at one height")
        elif self.below is not None and self.below > MAX_BELOW:
            found.append(f"{self.below:.0%} of the other occupied cells are below the floor")
        if self.before is not None and self.before > MAX_BEFORE:
            found.append(f"occupied cells block {self.before:.0%} of the rays of the depth")
        return found

    @property
    def badness(self) -> float:
        """The sum of the measures' distances from their ideals, to compare conventions."""
        terms = (
            None if self.level is None else 1 - self.level,
            self.below,
            self.before,
            None if self.agree is None else 1 - self.agree,
            None if self.lean_deg is None else min(self.lean_deg / 45, 1.0),
        )
        return sum(term for term in terms if term is not None)


@dataclass(frozen=True, eq=False)
class Sample:
    """A stored grid with the view it belongs to, which is None for the grid of a scene."""

    stored: StoredGrid
    view: View | None


def check_predictions(
    files: GridFiles, scan: Scan, parameters: PredictionParameters
) -> tuple[str, ...]:
    """Check predictions against the capture, and return notes on what is doubtful.

    Raises:
        InputError: If another convention fits far better, or if hardly any cell is empty. The
            message names the fault and the convention.
    """
    samples = list(_samples(files, scan))
    grids = [_interpret(sample, parameters.rules) for sample in samples]
    if not parameters.check:
        return ()
    given = measure(samples, grids, scan)
    faults = given.faults()
    fitting = best_alternative(samples, grids, scan, parameters.rules, given)
    if fitting is None and not faults:
        return ()
    read_as_ = f"read as {grids[0].convention} (axes {', '.join(grids[0].axes)})"
    if fitting is not None:
        words, better = fitting
        reason = "; ".join(faults) or "the predictions contradict the capture"
        raise InputError(files.path, f"{read_as_}, {reason}; {words} fits: {_told(better, given)}")
    if given.empty is not None and given.empty < MIN_EMPTY:
        raise InputError(
            files.path,
            f"{read_as_}, {faults[0]}; check the classes (--classes), or skip this check with "
            "--set predictions.check=false",
        )
    return (f"the predictions, {read_as_}, are implausible: {'; '.join(faults)}",)


def best_alternative(
    samples: Sequence[Sample],
    grids: Sequence[PredictedGrid],
    scan: Scan,
    rules: GridRules,
    given: Plausibility,
) -> tuple[str, Plausibility] | None:
    """Return the option that makes the grids fit far better, and how well they fit then.

    Classes and poses are tried only if the grids as given have faults.
    """
    if not given.faults() and given.badness < MAX_BADNESS:
        return None
    tried: list[tuple[str, Plausibility]] = []
    for words, changed in _alternatives(samples, grids, rules, bool(given.faults())):
        tried.append((words, measure(samples, changed, scan)))
    fits = [
        (words, found)
        for words, found in tried
        if not found.faults()
        and found.badness < min(CLEARLY_BETTER * given.badness, given.badness - MIN_GAIN)
    ]
    return min(fits, key=lambda pair: pair[1].badness, default=None)


def _alternatives(
    samples: Sequence[Sample],
    grids: Sequence[PredictedGrid],
    rules: GridRules,
    has_faults: bool,
) -> Iterator[tuple[str, list[PredictedGrid]]]:
    """Yield each other way to read the samples with the option that selects it."""
    is_frame = samples[0].view is not None
    for axes in ORDERS:
        stored = samples[0].stored
        if axes == grids[0].axes or stored.axes or stored.path.suffix == ".bin":
            continue
        name = NAMED[axes]
        if axes_of(name, stored.cells, stored.name) != axes:
            name = "w2m" if axes == "xyz" else name
        yield from _read_all(samples, rules, name, axes, is_frame, f"--convention {name}")
    if not has_faults:
        return
    axes, convention = grids[0].axes, grids[0].convention
    for classes in ("nyu12", "embodied"):
        other = replace(rules, classes=classes)
        yield from _read_all(samples, other, convention, axes, is_frame, f"--classes {classes}")
    if grids[0].camera_to_world is not None:
        inverted = [
            replace(grid, camera_to_world=invert_rigid(grid.camera_to_world))
            for grid in grids
            if grid.camera_to_world is not None
        ]
        if len(inverted) == len(grids):
            yield "the inverse of cam_pose (camera to world)", inverted
    yield "a z axis that points up", [_upside_down(grid) for grid in grids]


def _upside_down(grid: PredictedGrid) -> PredictedGrid:
    """Return a grid with its z axis reversed."""
    shares = None if grid.shares is None else grid.shares[:, :, ::-1]
    return replace(grid, labels=grid.labels[:, :, ::-1], shares=shares)


def _read_all(
    samples: Sequence[Sample],
    rules: GridRules,
    convention: str,
    axes: str,
    is_frame: bool,
    words: str,
) -> Iterator[tuple[str, list[PredictedGrid]]]:
    try:
        yield (
            words,
            [
                read_as(sample.stored, rules, convention, axes, is_frame=is_frame)
                for sample in samples
            ],
        )
    except DamagedFileError:  # The shape or the ids do not allow it.
        return


def _samples(files: GridFiles, scan: Scan) -> Iterator[Sample]:
    if files.scene is not None:
        yield Sample(read_stored_grid(files.scene), None)
        return
    names = [name for name in scan.frames_used if name in files.of_view]
    step = max(1, -(-len(names) // MAX_VIEWS))
    wanted = set(names[::step])
    for view in scan.views:
        if view.name in wanted:
            yield Sample(read_stored_grid(files.of_view[view.name]), view)


def _interpret(sample: Sample, rules: GridRules) -> PredictedGrid:
    return interpret_grid(sample.stored, rules, is_frame=sample.view is not None)


def measure(samples: Sequence[Sample], grids: Sequence[PredictedGrid], scan: Scan) -> Plausibility:
    """Measure how well grids fit the capture."""
    places = [_place(sample, grid, scan) for sample, grid in zip(samples, grids, strict=True)]
    up = _up(samples, places, scan)
    levels, shares_below, empties, leans = [], [], [], []
    for grid, place in zip(grids, places, strict=True):
        known = grid.labels != UNKNOWN
        empties.append(float((grid.labels == 0).sum() / max(known.sum(), 1)))
        leans.append(float(np.degrees(np.arccos(np.clip(place[:3, 2] @ up, -1, 1)))))
        found = floor_measures(grid, place, up)
        if found is not None:
            levels.append(found[0])
            shares_below.append(found[1])
    return Plausibility(
        _mean(levels),
        _mean(shares_below),
        _mean(empties),
        blocked_rays(samples, grids, places, scan),
        _mean(leans),
        agreement(grids, places),
    )


def _up(samples: Sequence[Sample], places: Sequence[np.ndarray], scan: Scan) -> np.ndarray:
    """Return the up direction in the scan: stated, measured by depth, or else the grids' mean."""
    if scan.world_up is not None:
        return scan.world_up
    view = samples[0].view or next(iter(scan.views), None)
    if view is not None and view.depth_m is not None:
        return scan.scan_to_room[2, :3]
    mean = np.mean([place[:3, 2] for place in places], axis=0)
    return mean / max(float(np.linalg.norm(mean)), 1e-9)


def _mean(values: list[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _place(sample: Sample, grid: PredictedGrid, scan: Scan) -> np.ndarray:
    if sample.view is None:
        return place_scene(grid, scan.source_to_scan)
    pose = view_camera(sample.view)[1]
    return place_frame(grid, pose, scan.scan_to_room, scan.source_to_scan)


def floor_measures(
    grid: PredictedGrid, grid_to_scan: np.ndarray, up: np.ndarray
) -> tuple[float, float] | None:
    """Return how level the floor is and the share of the rest below it, or None without floor."""
    occupied = (grid.labels > 0) & (grid.labels != UNKNOWN)
    is_floor = np.equal(grid.labels, SemanticClass.FLOOR)
    if is_floor.sum() < MIN_FLOOR_CELLS:
        return None

    def heights(mask: np.ndarray) -> np.ndarray:
        centers_m = cell_centers_m(np.argwhere(mask), np.zeros(3), grid.voxel_m)
        return apply(grid_to_scan, centers_m) @ up

    floor_m, others_m = heights(is_floor), heights(occupied & ~is_floor)
    low, near_m = float(np.median(floor_m)), LEVEL_CELLS * grid.voxel_m
    level = float(np.mean(np.abs(floor_m - low) < near_m))
    return level, float(np.mean(others_m < low - near_m)) if len(others_m) else 0.0


def blocked_rays(
    samples: Sequence[Sample],
    grids: Sequence[PredictedGrid],
    places: Sequence[np.ndarray],
    scan: Scan,
) -> float | None:
    """Return the share of measured rays that cross an occupied cell in front of their surface.

    It is None if no view has depth.
    """
    pairs = [
        (sample.view, grid, place)
        for sample, grid, place in zip(samples, grids, places, strict=True)
        if sample.view is not None
    ]
    if samples[0].view is None:
        step = max(1, -(-len(scan.views) // MAX_VIEWS))
        chosen = [view for number, view in enumerate(scan.views) if number % step == 0]
        pairs = [(view, grids[0], places[0]) for view in chosen]
    blocked = total = 0
    for view, grid, place in pairs:
        if view.depth_m is None or view.depth_camera is None:
            continue
        camera_to_grid = invert_rigid(place) @ view.depth_camera_to_scan
        points_m, _ = unproject_depth(view.depth_m, view.depth_camera, camera_to_grid)
        rays_m = points_m[:: max(1, len(points_m) // MAX_RAYS)] - camera_to_grid[:3, 3]
        crossed, inside = np.zeros(len(rays_m), bool), np.zeros(len(rays_m), bool)
        for share in ALONG:
            labels = labels_at(grid, camera_to_grid[:3, 3] + share * rays_m)
            inside |= labels != UNKNOWN
            crossed |= (labels > 0) & (labels != UNKNOWN)
        total += int(inside.sum())
        blocked += int(crossed.sum())
    return blocked / total if total >= MIN_SAMPLES else None


def labels_at(grid: PredictedGrid, points_m: np.ndarray) -> np.ndarray:
    """Return the labels of the cells that contain points, uint8 [N]; 255 outside the grid.

    Args:
        grid: Grid of labels.
        points_m: Points relative to its minimum corner in metres, float [N, 3].
    """
    cells = np.floor(points_m / grid.voxel_m).astype(np.int64)
    held = ((cells >= 0) & (cells < grid.labels.shape)).all(axis=1)
    labels = np.full(len(points_m), UNKNOWN, np.uint8)
    labels[held] = grid.labels[tuple(cells[held].T)]
    return labels


def agreement(grids: Sequence[PredictedGrid], places: Sequence[np.ndarray]) -> float | None:
    """Return the share of occupied cells that the grid of another view has occupied too.

    The cells are those that both grids contain; it is None if they hardly overlap.
    """
    same = total = 0
    placed = list(zip(grids, places, strict=True))
    for (grid, place), (other, at) in pairwise(placed):
        cells = np.argwhere((grid.labels > 0) & (grid.labels != UNKNOWN))
        centers_m = apply(place, cell_centers_m(cells, np.zeros(3), grid.voxel_m))
        labels = labels_at(other, apply(invert_rigid(at), centers_m))
        total += int((labels != UNKNOWN).sum())
        same += int(((labels > 0) & (labels != UNKNOWN)).sum())
    return same / total if total >= MIN_SAMPLES else None


def _told(better: Plausibility, given: Plausibility) -> str:
    """Return the measures that another convention improves, in words."""
    pairs = (
        ("level floor", better.level, given.level),
        ("below the floor", better.below, given.below),
        ("blocked rays", better.before, given.before),
        ("agreement of views", better.agree, given.agree),
    )
    told = [
        f"{name} {new:.0%} instead of {old:.0%}"
        for name, new, old in pairs
        if new is not None and old is not None and abs(new - old) > 0.05
    ]
    return ", ".join(told) or "all measures"

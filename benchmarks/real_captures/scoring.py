"""Scores of a reconstruction against what is known about a real room.

All functions take arrays in the room frame of the reconstruction (z up, metres), so that they can
be tested without a capture.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, SemanticClass
from world2minecraft.core.coordinates import apply, cell_centers_m
from world2minecraft.core.types import OBSERVED, OccupancyGrid

NOT_FOUND = CLASS_COUNT  # The column of surface that the reconstruction does not have.
NEIGHBOURS = np.array([step for step in np.ndindex(3, 3, 3) if step != (1, 1, 1)]) - 1
RINGS = np.abs(NEIGHBOURS).sum(axis=1)  # 1 across a face, 2 across an edge, 3 across a corner.

MIN_FLOOR_POINTS = 10_000  # Pixels of 640x480.
MIN_FLOOR_SPREAD_M = 0.25  # Standard deviation along the shorter side: about 0.9 m of floor.


class LabelledCells(NamedTuple):
    """Cells of a grid with their true classes.

    Attributes:
        cells: Cell indices, int64 [N, 3]. They may lie outside the grid.
        classes: True classes, 1 to 11, uint8 [N].
    """

    cells: np.ndarray
    classes: np.ndarray


def labelled_cells(
    points_m: np.ndarray,
    classes: np.ndarray,
    area_m2: np.ndarray,
    origin_m: np.ndarray,
    voxel_m: float,
) -> LabelledCells:
    """Return the cells that contain labelled surface points, with the class of most of the surface.

    Args:
        points_m: Surface points, float [N, 3].
        classes: Class of each point, uint8 [N]; 0 and values above 11 are ignored.
        area_m2: Surface area of each point, float [N].
        origin_m: Minimum corner of cell (0, 0, 0), float64 [3].
        voxel_m: Cell size in metres.
    """
    known = (classes > 0) & (classes < CLASS_COUNT)
    index = np.floor((points_m[known] - origin_m) / voxel_m).astype(np.int64)
    cells, cell_of_point = np.unique(index, axis=0, return_inverse=True)
    areas = np.bincount(
        cell_of_point.reshape(-1) * CLASS_COUNT + classes[known],
        area_m2[known],
        minlength=len(cells) * CLASS_COUNT,
    ).reshape(-1, CLASS_COUNT)
    return LabelledCells(cells.reshape(-1, 3), areas.argmax(axis=1).astype(np.uint8))


def found_classes(labels: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return the class that a reconstruction has at each cell of a surface, or NOT_FOUND.

    Where a cell is empty or unknown, the occupied cells that share a face, else an edge, else a
    corner with it are used, and the most frequent class among them is returned. Surface within one
    voxel of its true position is therefore found.

    Args:
        labels: Labels of the reconstruction, uint8 [X, Y, Z].
        cells: Cell indices, int64 [N, 3]. They may lie outside the grid.

    Returns:
        Classes, uint8 [N].
    """
    padded = np.pad(np.where(labels < CLASS_COUNT, labels, 0), 3)
    inside = np.clip(cells + 3, 1, np.array(padded.shape) - 2)  # Far cells: an empty rim.
    found = padded[tuple(inside.T)].astype(np.int64)
    for ring in (1, 2, 3):
        missing = np.flatnonzero(found == 0)
        at = inside[missing, None] + NEIGHBOURS[ring == RINGS]
        near = padded[at[..., 0], at[..., 1], at[..., 2]]
        counts = np.stack([(near == number).sum(axis=1) for number in range(CLASS_COUNT)], axis=1)
        counts[:, 0] = 0
        found[missing] = np.where(counts.any(axis=1), counts.argmax(axis=1), 0)
    return np.where(found > 0, found, NOT_FOUND).astype(np.uint8)


def confusion(true: np.ndarray, found: np.ndarray) -> np.ndarray:
    """Return the number of cells of each true class (rows) and found class (columns).

    Args:
        true: True classes, 1 to 11, uint8 [N].
        found: Result of ``found_classes``, uint8 [N].

    Returns:
        Counts, int64 [12, 13]. The last column counts surface that was not found.
    """
    width = CLASS_COUNT + 1
    flat = np.bincount(true.astype(np.int64) * width + found, minlength=CLASS_COUNT * width)
    return flat.reshape(CLASS_COUNT, width)


def class_accuracy(counts: np.ndarray) -> float | None:
    """Return the share of labelled surface with its true class, or None without any surface."""
    total = counts.sum()
    return None if total == 0 else float(np.trace(counts[:, :CLASS_COUNT]) / total)


def accuracy_by_class(counts: np.ndarray) -> dict[str, float]:
    """Return the share of surface with its true class, for each class that occurs in the truth."""
    totals = counts.sum(axis=1)
    return {
        CLASS_NAMES[number]: float(counts[number, number] / totals[number])
        for number in range(1, CLASS_COUNT)
        if totals[number]
    }


def wall_share(counts: np.ndarray) -> float | None:
    """Return the share of true wall surface that is labelled wall, or None without any."""
    return accuracy_by_class(counts).get(CLASS_NAMES[SemanticClass.WALL])


def share_not_found(counts: np.ndarray) -> float | None:
    """Return the share of labelled surface that the reconstruction does not have."""
    total = counts.sum()
    return None if total == 0 else float(counts[:, NOT_FOUND].sum() / total)


def tilt_deg(scan_to_room: np.ndarray, up: np.ndarray) -> float:
    """Return the angle in degrees between the room's up direction and a reference.

    Args:
        scan_to_room: 4x4 transform.
        up: Reference up direction in the scan frame, of any length, float64 [3].
    """
    cosine = scan_to_room[2, :3] @ up / np.linalg.norm(up)
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def floor_error_m(
    scan_to_room: np.ndarray, room_size_m: np.ndarray, up: np.ndarray, floor_m: float
) -> float:
    """Return how far the floor is above its reference, at the middle of the room.

    Args:
        scan_to_room: 4x4 transform.
        room_size_m: Inner size of the room in metres, float64 [3].
        up: Reference up direction in the scan frame, of any length, float64 [3].
        floor_m: Height of the true floor above the scan's origin, along ``up``, in metres.
    """
    middle = np.array([room_size_m[0] / 2, room_size_m[1] / 2, 0.0])
    in_scan = apply(np.linalg.inv(scan_to_room), middle[None])[0]
    return float(in_scan @ up / np.linalg.norm(up) - floor_m)


def fit_floor(points_m: np.ndarray, camera_m: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the plane of labelled floor, as a reference for frames that state no gravity.

    Args:
        points_m: Points labelled floor, float [N, 3].
        camera_m: Position of the camera, which is above the floor, float64 [3].

    Returns:
        The unit up direction and a point of the plane, float64 [3] each, or None if too little
        floor is visible for a direction good to about a degree.
    """
    if len(points_m) < MIN_FLOOR_POINTS:
        return None
    kept = np.ones(len(points_m), bool)
    for _ in range(5):
        middle = points_m[kept].mean(axis=0, dtype=np.float64)
        spread, axes = np.linalg.eigh(np.cov((points_m[kept] - middle).T))
        residual = np.abs((points_m - middle) @ axes[:, 0])
        kept = residual < max(0.03, 2 * float(np.median(residual)))
    if np.sqrt(spread[1]) < MIN_FLOOR_SPREAD_M:
        return None
    up = axes[:, 0] * np.sign(axes[:, 0] @ (camera_m - middle))
    return up, middle


def surface_of(grid: OccupancyGrid, grid_to_other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the observed surface of a grid in another frame.

    Args:
        grid: Grid of a reconstruction.
        grid_to_other: 4x4 transform from its room frame to the other frame.

    Returns:
        The centres of the cells, float64 [N, 3], and their classes, uint8 [N].
    """
    cells = np.argwhere(grid.occupied & (grid.source == OBSERVED))
    centers_m = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
    return apply(grid_to_other, centers_m), grid.labels[tuple(cells.T)]


def agreement(
    truth: tuple[np.ndarray, np.ndarray], grid: OccupancyGrid, below_m: float = np.inf
) -> np.ndarray:
    """Return the confusion of a grid with the surface of a better reconstruction of the room.

    Args:
        truth: Points in the room frame of ``grid`` and their classes, from ``surface_of``.
        grid: The grid to score.
        below_m: Height above which the truth is ignored, in metres.
    """
    points_m, classes = truth
    low = points_m[:, 2] < below_m
    cells = np.floor((points_m[low] - grid.origin_m) / grid.voxel_m).astype(np.int64)
    return confusion(classes[low], found_classes(grid.labels, cells))


def has_class(labels: np.ndarray, cells: np.ndarray, classes: np.ndarray) -> np.ndarray:
    """Return whether a class occurs at each cell or in one of the 26 cells that touch it, bool [N].

    Args:
        labels: Labels of the reconstruction, uint8 [X, Y, Z].
        cells: Cell indices, int64 [N, 3]. They may lie outside the grid.
        classes: Class to look for at each cell, uint8 [N].
    """
    padded = np.pad(labels, 3, constant_values=255)
    inside = np.clip(cells + 3, 1, np.array(padded.shape) - 2)
    found = padded[tuple(inside.T)] == classes
    for step in NEIGHBOURS:
        found |= padded[tuple((inside + step).T)] == classes
    return found


class Stability(NamedTuple):
    """Shares of the cells of things on whose class several runs agree.

    Attributes:
        exact: The matching cell has the same class in all runs. Voxelizing one and the same
            labelling in turned grids already loses 0.1 to 0.2, at the borders of small things.
        near: The class occurs in the matching cell, or in a cell that touches it, in all runs.
    """

    exact: float
    near: float


def thing_stability(runs: Sequence[tuple[OccupancyGrid, np.ndarray]]) -> Stability | None:
    """Return how far several runs agree on the classes of things.

    A cell of the first run's observed surface is a cell of a thing if most runs give it a class
    from chair to object. Surface that a run does not have counts as another class.

    Args:
        runs: Grids of the same capture, each with its 4x4 ``scan_to_room`` transform.

    Returns:
        The shares, or None if there are no things.
    """
    first, scan_to_first = runs[0]
    in_scan, own = surface_of(first, np.linalg.inv(scan_to_first))
    found, near = [own], np.ones(len(own), bool)
    for grid, scan_to_room in runs[1:]:
        at = apply(scan_to_room, in_scan)
        cells = np.floor((at - grid.origin_m) / grid.voxel_m).astype(np.int64)
        found.append(found_classes(grid.labels, cells))
        near &= has_class(grid.labels, cells, own)
    classes = np.array(found)
    is_thing = (classes >= SemanticClass.CHAIR) & (classes < CLASS_COUNT)
    things = 2 * is_thing.sum(axis=0) > len(runs)
    if not things.any():
        return None
    exact = (classes == classes[0]).all(axis=0)
    return Stability(float(exact[things].mean()), float(near[things].mean()))

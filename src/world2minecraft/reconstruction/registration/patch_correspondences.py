"""Correspondences: which patches of different frames show the same piece of surface.

Patches are sorted into columns by the axis they face and by cells across that axis. Along the axis,
the patches of a column are separated at gaps wider than the possible pose error. This way no cell
border coincides with a wall, which would separate views from both sides of the border.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Surfels:
    """Groups of patches that show the same piece of surface.

    Attributes:
        owner: Surfel of each patch, int64 [N].
        centers_m: Centres in metres, float64 [K, 3].
        normals: Normals, float64 [K, 3].
        frames: Number of frames that see each surfel, int64 [K].
    """

    owner: np.ndarray
    centers_m: np.ndarray
    normals: np.ndarray
    frames: np.ndarray


def find_surfels(
    points_m: np.ndarray,
    normals: np.ndarray,
    weight: np.ndarray,
    frame: np.ndarray,
    *,
    cell_m: float,
    gap_m: float,
) -> Surfels:
    """Group patches into surfels.

    Args:
        points_m: Points in metres, float64 [N, 3], in a frame aligned with most walls.
        normals: Unit normals, float64 [N, 3].
        weight: Positive weights, float64 [N].
        frame: Frame that saw each patch, int [N].
        cell_m: Width of a column in metres.
        gap_m: Gap in metres that separates two surfaces of a column.
    """
    axis = np.abs(normals).argmax(axis=1)
    index = np.arange(len(points_m))
    sign = normals[index, axis] > 0
    along = points_m[index, axis]
    cells = np.floor(points_m / cell_m).astype(np.int64)
    cells -= cells.min(axis=0, initial=0)
    cells[index, axis] = 0
    sizes = cells.max(axis=0, initial=0) + 1
    column = (cells[:, 0] * sizes[1] + cells[:, 1]) * sizes[2] + cells[:, 2]
    column = column * 6 + axis * 2 + sign
    order = np.lexsort((along, column))
    new = np.ones(len(order), bool)
    new[1:] = np.diff(column[order]) != 0
    new[1:] |= np.diff(along[order]) > gap_m
    owner = np.empty(len(order), np.int64)
    owner[order] = np.cumsum(new) - 1
    count = int(new.sum())
    return Surfels(
        owner,
        _sums(points_m, weight, owner, count) / np.bincount(owner, weight, count)[:, None],
        _unit(_sums(normals, weight, owner, count)),
        _frames_of(owner, frame, count),
    )


def _sums(values: np.ndarray, weight: np.ndarray, owner: np.ndarray, count: int) -> np.ndarray:
    columns = [np.bincount(owner, weight * values[:, axis], count) for axis in range(3)]
    return np.stack(columns, axis=1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-12)[:, None]


def _frames_of(owner: np.ndarray, frame: np.ndarray, count: int) -> np.ndarray:
    width = int(frame.max(initial=0)) + 1
    pairs = np.unique(owner * width + frame)
    return np.bincount(pairs // width, minlength=count)

"""Rooms as grids: a plain box with a door and a window, and generated ones without noise."""

from functools import cache

import numpy as np
from voxel_scenes import VOXEL_M, grid_of

from world2minecraft.editing.scene import SceneDraft
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.procgen import generate_room

DOOR = (slice(20, 30), slice(0, 1), slice(1, 27))  # x, y, z
WINDOW = (slice(0, 1), slice(15, 30), slice(12, 25))


def box_room(shape=(50, 45, 34)) -> np.ndarray:
    """Labels of a box room in a sheet of one cell, unseen outside, with an open door."""
    labels = np.full(np.array(shape), 255, np.uint8)
    labels[1:-1, 1:-1, 1:-1] = 0
    labels[:, :, 1:-1][[0, -1]] = 3
    labels[:, [0, -1], 1:-1] = 3
    labels[1:-1, 1:-1, 0], labels[1:-1, 1:-1, -1] = 2, 1
    labels[DOOR] = 0
    labels[WINDOW] = 4
    return labels


def box_draft(labels: np.ndarray) -> SceneDraft:
    return SceneDraft(grid_of(labels))


@cache
def generated_labels(seed: int, shape: str | None) -> np.ndarray:
    """The truth of a generated room in cells of 8 cm; what was never air or solid is unknown."""
    room = generate_room(seed, shape=shape)
    first = np.floor(room.origin_m / VOXEL_M + 1e-6) - 1
    cells = np.ceil((room.size_m + 0.12) / VOXEL_M - 1e-6) - first + 1
    sides = tuple(int(side) for side in cells)
    fine = (room.labels, room.voxel_m, room.origin_m)
    labels = carry_truth(*fine, np.eye(4), sides, first * VOXEL_M, VOXEL_M)  # type: ignore[arg-type]
    labels.flags.writeable = False
    return labels

"""Evaluation of complete scenes with single-frame predictions, by voting.

EmbodiedOcc keeps a memory of a scene and is evaluated at the end. For networks without a memory,
each frame votes with its predicted class for each cell in its view. The most frequent class wins,
or the lowest id in case of a tie. The boxes of the frames must be aligned with a common lattice of
cells.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import apply, turn_grid
from world2minecraft.evaluation.metrics.protocols import KnownCells, ProtocolCounts, count_scene
from world2minecraft.evaluation.metrics.score_aggregation import FrameScore

TOLERANCE_CELLS = 0.02  # Maximum distance of a box's corner from the lattice.
TOLERANCE_DEG = 0.01
MAX_CELLS = 40_000_000  # Of a scene; the votes of a cell take 12 bytes.


class SceneFrame(NamedTuple):
    """The prediction and the ground truth of a frame, with its position in the room.

    Attributes:
        scene_id: Name of the scene.
        predicted: Predicted class of each cell, uint8 [X, Y, Z].
        truth: True class of each cell, uint8 [X, Y, Z].
        in_view: Whether each cell is in view, bool, packed into eight cells per byte.
        grid_to_room: Matrix from grid coordinates to room coordinates in metres [4, 4].
    """

    scene_id: str
    predicted: np.ndarray
    truth: np.ndarray
    in_view: np.ndarray
    grid_to_room: np.ndarray

    @classmethod
    def pack(
        cls, scene_id: str, predicted: np.ndarray, known: KnownCells, grid_to_room: np.ndarray
    ) -> "SceneFrame":
        """Create a frame from a prediction and its ground truth."""
        inside = np.ones(predicted.shape, bool) if known.in_frustum is None else known.in_frustum
        return cls(scene_id, predicted, known.labels, np.packbits(inside), grid_to_room)

    @property
    def mask(self) -> np.ndarray:
        """Whether each cell is in view, bool [X, Y, Z]."""
        return (
            np.unpackbits(self.in_view, count=self.predicted.size).reshape(self.predicted.shape) > 0
        )


def scene_scores(frames: Sequence[SceneFrame], voxel_m: float) -> tuple[list[FrameScore], str]:
    """Evaluate the scenes of the given frames by voting.

    Returns:
        The counts for each scene and an empty string, or an empty list and the reason why the
        scenes cannot be evaluated.
    """
    by_scene: dict[str, list[SceneFrame]] = {}
    for frame in frames:
        by_scene.setdefault(frame.scene_id, []).append(frame)
    found = []
    for scene_id in sorted(by_scene):
        lattice, reason = align_frames(by_scene[scene_id], voxel_m)
        if lattice is None:
            return [], reason
        found.append(FrameScore(scene_id, _count_votes(lattice)))
    return found, ""


class Lattice(NamedTuple):
    """The boxes of a scene's frames along the room axes, on a common lattice of cells.

    Attributes:
        grids: Predictions, ground truth and mask of each box.
        cells: First cell of each box, int [N, 3].
        shape: Shape of the scene in cells.
        origin_m: Minimum corner in room coordinates in metres, float64 [3].
    """

    grids: list[tuple[np.ndarray, np.ndarray, np.ndarray]]
    cells: np.ndarray
    shape: tuple[int, ...]
    origin_m: np.ndarray


def align_frames(frames: Sequence[SceneFrame], voxel_m: float) -> tuple[Lattice | None, str]:
    """Align the boxes of a scene's frames with a common lattice.

    Returns:
        The lattice and an empty string, or None and the reason why the boxes cannot be aligned.
    """
    scene_id = frames[0].scene_id
    places = [_align_to_axes(frame, voxel_m) for frame in frames]
    if any(place is None for place in places):
        return None, f"a box of {scene_id} is not aligned with the room axes"
    corners = np.array([place[1] for place in places if place is not None])
    steps = (corners - corners[0]) / voxel_m
    if np.abs(steps - np.round(steps)).max() > TOLERANCE_CELLS:
        return None, (
            f"the boxes of {scene_id} are not on a common lattice of {voxel_m:g} m; use "
            "cells of 0.08 m"
        )
    low = steps.min(axis=0)
    cells = np.round(steps - low).astype(int)
    grids = [place[0] for place in places if place is not None]
    shape = tuple((cells + [grid[0].shape for grid in grids]).max(axis=0).tolist())
    if np.prod(shape, dtype=float) > MAX_CELLS:
        return (
            None,
            f"{scene_id} spans {'x'.join(map(str, shape))} cells, which exceeds the limit "
            f"of {MAX_CELLS:,}",
        )
    return Lattice(grids, cells, shape, corners[0] + low * voxel_m), ""


def _align_to_axes(
    frame: SceneFrame, voxel_m: float
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], np.ndarray] | None:
    """Return the predictions, ground truth and mask along the room axes, and their corner."""
    turn_deg = np.degrees(np.arctan2(frame.grid_to_room[1, 0], frame.grid_to_room[0, 0]))
    quarters = round(turn_deg / 90)
    if abs(turn_deg - 90 * quarters) > TOLERANCE_DEG:
        return None
    ends = np.array([[0.0, 0, 0], frame.predicted.shape]) * voxel_m
    corner_m = apply(frame.grid_to_room, ends).min(axis=0)
    predicted, truth, mask = (
        turn_grid(values, quarters) for values in (frame.predicted, frame.truth, frame.mask)
    )
    return (predicted, truth, mask), corner_m


def merge_truth(lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """Merge the ground truth of all frames in a scene.

    Returns:
        The class of each cell, uint8 [X, Y, Z] with 255 for unknown, and whether it is in the view
        of any frame, bool [X, Y, Z].
    """
    labels = np.full(lattice.shape, UNKNOWN, np.uint8)
    seen = np.zeros(lattice.shape, bool)
    for (_, true, mask), first in zip(lattice.grids, lattice.cells, strict=True):
        box = tuple(slice(at, at + side) for at, side in zip(first, true.shape, strict=True))
        labels[box] = np.where(true == UNKNOWN, labels[box], true)
        seen[box] |= mask
    return labels, seen


def _count_votes(lattice: Lattice) -> ProtocolCounts:
    votes = np.zeros((*lattice.shape, CLASS_COUNT), np.uint8)
    for (predicted, _, mask), first in zip(lattice.grids, lattice.cells, strict=True):
        box = tuple(slice(at, at + side) for at, side in zip(first, predicted.shape, strict=True))
        at = np.nonzero(mask & (predicted < CLASS_COUNT))
        box_votes = votes[box]
        box_votes[(*at, predicted[at])] = np.minimum(box_votes[(*at, predicted[at])], 254) + 1
    labels = np.where(votes.any(axis=-1), votes.argmax(axis=-1), UNKNOWN).astype(np.uint8)
    truth, seen = merge_truth(lattice)
    return count_scene(labels, truth, [seen])

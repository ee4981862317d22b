"""Score whole scenes by single-frame predictions: each frame votes on the cells in its view.

EmbodiedOcc keeps a memory of a scene and scores it at the end. A network that knows single frames
has none: here each frame votes for the class that it predicts of the cells in its view, and the
most frequent counts, the lower id where two are even. The boxes must lie on one lattice of cells.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import apply, turn_grid
from world2minecraft.evaluation.metrics.protocols import KnownCells, ProtocolCounts, count_scene
from world2minecraft.evaluation.metrics.score_aggregation import FrameScore

TOLERANCE_CELLS = 0.02  # So far a box's corner may be off the lattice.
TOLERANCE_DEG = 0.01
MAX_CELLS = 40_000_000  # Of a scene; its votes take 12 bytes each.


class SceneFrame(NamedTuple):
    """The prediction and the truth of a frame, where it looks."""

    scene_id: str
    predicted: np.ndarray  # uint8 [X, Y, Z]
    truth: np.ndarray  # uint8 [X, Y, Z]
    in_view: np.ndarray  # bool, packed eight cells a byte
    grid_to_room: np.ndarray

    @classmethod
    def pack(
        cls, scene_id: str, predicted: np.ndarray, known: KnownCells, grid_to_room: np.ndarray
    ) -> "SceneFrame":
        """Keep what scenes are made of."""
        inside = np.ones(predicted.shape, bool) if known.in_frustum is None else known.in_frustum
        return cls(scene_id, predicted, known.labels, np.packbits(inside), grid_to_room)

    @property
    def mask(self) -> np.ndarray:
        """Bool [X, Y, Z]: what it has in view."""
        return (
            np.unpackbits(self.in_view, count=self.predicted.size).reshape(self.predicted.shape) > 0
        )


def scene_scores(frames: Sequence[SceneFrame], voxel_m: float) -> tuple[list[FrameScore], str]:
    """Return the counts of each scene, or none and the reason why there are none."""
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
    """The boxes of a scene's frames, along the room's axes, on the cells that they share."""

    grids: list[tuple[np.ndarray, np.ndarray, np.ndarray]]  # predicted, truth and mask of each box
    cells: np.ndarray  # int [N, 3], where each box begins
    shape: tuple[int, ...]
    origin_m: np.ndarray  # float64 [3], minimum corner in the room


def align_frames(frames: Sequence[SceneFrame], voxel_m: float) -> tuple[Lattice | None, str]:
    """Return the boxes of one scene's frames on their lattice, or None and why there is none."""
    scene_id = frames[0].scene_id
    places = [_align_to_axes(frame, voxel_m) for frame in frames]
    if any(place is None for place in places):
        return None, f"a box of {scene_id} is not along the room's axes"
    corners = np.array([place[1] for place in places if place is not None])
    steps = (corners - corners[0]) / voxel_m
    if np.abs(steps - np.round(steps)).max() > TOLERANCE_CELLS:
        return None, (
            f"the boxes of {scene_id} share no lattice of {voxel_m:g} m cells; score at 0.08 m"
        )
    low = steps.min(axis=0)
    cells = np.round(steps - low).astype(int)
    grids = [place[0] for place in places if place is not None]
    shape = tuple((cells + [grid[0].shape for grid in grids]).max(axis=0).tolist())
    if np.prod(shape, dtype=float) > MAX_CELLS:
        return None, f"{scene_id} spans {'x'.join(map(str, shape))} cells, which is no home"
    return Lattice(grids, cells, shape, corners[0] + low * voxel_m), ""


def _align_to_axes(
    frame: SceneFrame, voxel_m: float
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], np.ndarray] | None:
    """Return predictions, truth and mask along the room's axes, and their corner in the room."""
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
    """Return a scene's true labels uint8 [X, Y, Z], 255 where no frame knows, and what was seen."""
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

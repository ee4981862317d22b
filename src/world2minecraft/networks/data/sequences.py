"""Sequences: several frames of a scene as one sample, in the grid of the first frame.

The poses of the other frames are transformed to the grid of the first frame; labels are not
resampled. Frames that look into the grid are preferred. The number of frames depends on the step,
so a network learns from one frame as well as from several.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import Frame

LOOK_AHEAD_M = 2.0  # Typical distance of what a camera looks at: from a wall to the room's centre.
TRIES_PER_FRAME = 4  # Candidates per requested frame.


class SequenceSampler:
    """A sampler that finds further frames of a frame's scene.

    Args:
        frames: Frames of a data set.
        rows: Indices of the frames that may be used.
        voxel_m: Cell size in metres.
    """

    def __init__(self, frames: Frames, rows: Sequence[int], voxel_m: float):
        self._frames, self._voxel_m = frames, voxel_m
        self._rows: dict[str, list[int]] = {}
        for row in rows:
            self._rows.setdefault(frames.scenes[row], []).append(row)

    def sample(self, row: int, frame: Frame, count: int, rng: np.random.Generator) -> list[Frame]:
        """Choose random frames of the same scene and transform them to the grid of ``frame``.

        Frames that look into the grid are preferred. Frames are repeated if the scene has too few.

        Args:
            row: Index of ``frame``.
            frame: Frame that defines the grid.
            count: Number of frames to choose.
            rng: Random generator.
        """
        others = [one for one in self._rows[frame.scene_id] if one != row] or [row]
        order = [others[n] for n in rng.permutation(len(others))]
        found: list[Frame] = []
        spare: list[Frame] = []
        for other in order[: TRIES_PER_FRAME * count]:
            if len(found) == count:
                break
            moved = move_to_grid(frame, self._frames[other])
            (found if views_grid(moved, self._voxel_m) else spare).append(moved)
        chosen = (found + spare)[:count]
        return [chosen[n % len(chosen)] for n in range(count)]


def move_to_grid(anchor: Frame, other: Frame) -> Frame:
    """Transform another frame of the scene to the grid of ``anchor``.

    The result has the labels and masks of ``anchor``, because it has the same cells.
    """
    grid_to_anchor = invert_rigid(anchor.grid_to_room) @ other.grid_to_room
    return replace(
        other,
        camera_to_grid=(grid_to_anchor @ other.camera_to_grid).astype(np.float32),
        grid_to_room=anchor.grid_to_room,
        labels=anchor.labels,
        in_frustum=anchor.in_frustum,
        seen=anchor.seen,
        free=anchor.free,
    )


def views_grid(frame: Frame, voxel_m: float) -> bool:
    """Return whether the point ``LOOK_AHEAD_M`` in front of a frame's camera is above its grid."""
    sides_m = np.array(frame.labels.shape[:2]) * voxel_m
    at_m = frame.camera_to_grid[:2, 3] + LOOK_AHEAD_M * frame.camera_to_grid[:2, 2]
    return bool(((at_m >= 0) & (at_m <= sides_m)).all())


def sequence_length(seed: int, step: int, max_frames: int) -> int:
    """Return the random number of frames for the samples of a step, from 1 to ``max_frames``."""
    return 1 + int(np.random.default_rng([seed, 2**21, step]).integers(max_frames))

"""Sequences: several frames of one scene as one sample, in the grid of the first.

The others are used in the cells of the first one's grid: their poses are carried into it, and
nothing is resampled. Chosen are frames of the same scene that look into the box, where there are
any; how many follows from the step, so that a network learns from one frame as from many.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import Frame

LOOK_AHEAD_M = 2.0  # Distance of what a camera looks at: a room's middle from its wall.
TRIES_PER_FRAME = 4  # Frames that are tried for each that is wanted.


class SequenceSampler:
    """Finds further frames of the scene of a frame.

    Args:
        frames: of a set.
        rows: those that may be taken.
        voxel_m: of their cells.
    """

    def __init__(self, frames: Frames, rows: Sequence[int], voxel_m: float):
        self._frames, self._voxel_m = frames, voxel_m
        self._rows: dict[str, list[int]] = {}
        for row in rows:
            self._rows.setdefault(frames.scenes[row], []).append(row)

    def sample(self, row: int, frame: Frame, count: int, rng: np.random.Generator) -> list[Frame]:
        """Return ``count`` frames in the box of ``frame``, which is that of ``row``.

        Those that look into the box come first. A scene of fewer frames gives some of them again.
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
    """Return another frame of the scene with its camera in the grid of ``anchor``.

    Its labels and masks are those of ``anchor``: they are of the same cells.
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
    """Whether what a camera looks at lies over the box: ``LOOK_AHEAD_M`` before it, or itself."""
    sides_m = np.array(frame.labels.shape[:2]) * voxel_m
    at_m = frame.camera_to_grid[:2, 3] + LOOK_AHEAD_M * frame.camera_to_grid[:2, 2]
    return bool(((at_m >= 0) & (at_m <= sides_m)).all())


def sequence_length(seed: int, step: int, max_frames: int) -> int:
    """Return how many frames the samples of a step have, 1 to ``max_frames``, each as likely."""
    return 1 + int(np.random.default_rng([seed, 2**21, step]).integers(max_frames))

"""Votes of the built-in segmentation network, which sees colour, depth, gravity and height.

A vote is divided among the classes by the network's probabilities. Pixels at which no class is
likely do not vote: on real frames their votes are wrong as often as right, and geometry knows
better. Of many views that show the same from almost the same place, only the first votes.
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.types import View
from world2minecraft.core.vocabulary import NYU40_COUNT, nyu40_classes
from world2minecraft.reconstruction.naming.name_votes import NameVoteMap
from world2minecraft.reconstruction.occupancy.depth_evidence import PointVotes
from world2minecraft.reconstruction.recognition.segmentation import SegmentationModel, splat_depth
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    geometry_size,
    network_size,
)

MIN_PROBABILITY = 0.4
MIN_MOVE_M, MIN_TURN_DEG = 0.25, 12.0


def class_matrix() -> np.ndarray:
    """Return the matrix that converts the 40 NYU classes to the program's, float32 [40, 12]."""
    matrix = np.zeros((NYU40_COUNT, CLASS_COUNT), np.float32)
    for number in range(NYU40_COUNT):
        found = nyu40_classes()[number + 1]
        if found != UNKNOWN:
            matrix[number, found] = 1
    matrix[:, 0] = 0
    return matrix


class RgbdVoter:
    """Votes by the built-in segmentation network at the pixel that shows a point.

    Attributes:
        names: Votes for the NYU40 classes so far, for the fine names of objects.
    """

    notes: tuple[str, ...] = ()

    def __init__(
        self,
        weights: Path | None = None,
        *,
        min_probability: float = MIN_PROBABILITY,
        photos_only: bool = False,
    ):
        self.photos_only = photos_only
        self.model = SegmentationModel(weights)
        self.min_probability = min_probability
        self.matrix = class_matrix()
        self.names = NameVoteMap()
        self._poses: list[np.ndarray] = []

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> PointVotes | None:
        """Return the votes of N points, or None; see ``Voter``."""
        camera = view.colour_camera
        if view.colour is None or camera is None or view.labels is not None:
            return None
        pose = scan_to_room @ view.camera_to_scan
        if not self._is_new(pose):
            return None
        width, height = network_size(camera.width_px, camera.height_px)
        rows, columns = np.divmod(colour_px.astype(np.int64), camera.width_px)
        depth_m = splat_depth(
            apply(invert_rigid(view.camera_to_scan), points_m.astype(np.float64))[:, 2],
            (rows + 0.5) / camera.height_px,
            (columns + 0.5) / camera.width_px,
            geometry_size(width, height),
        )
        found = self.model.predict(view.colour, depth_m, camera, pose[2, :3], float(pose[2, 3]))
        shares = found @ self.matrix
        shares[shares.max(axis=2) < self.min_probability] = 0
        at = (
            rows * shares.shape[0] // camera.height_px,
            columns * shares.shape[1] // camera.width_px,
        )
        pixels = at[0] * shares.shape[1] + at[1]
        in_room_m = apply(scan_to_room, points_m.astype(np.float64))
        self.names.add(in_room_m, pixels, found.reshape(-1, NYU40_COUNT))
        return PointVotes(shares.reshape(-1, CLASS_COUNT), pixels.astype(np.int32))

    def _is_new(self, pose: np.ndarray) -> bool:
        """Return whether no earlier view was close to a camera-to-room pose, and remember it."""
        for other in self._poses:
            moved_m = np.linalg.norm(pose[:3, 3] - other[:3, 3])
            cosine = np.clip(pose[:3, 2] @ other[:3, 2], -1, 1)
            if moved_m < MIN_MOVE_M and np.degrees(np.arccos(cosine)) < MIN_TURN_DEG:
                return False
        self._poses.append(pose)
        return True

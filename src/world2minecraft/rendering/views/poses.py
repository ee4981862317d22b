"""Where a camera is: the game's pose, and the shot that a renderer takes from it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from world2minecraft.core.coordinates import (
    PLAYER_EYE_BLOCKS,
    camera_to_block_of_game_pose,
    carry_camera,
    game_pose_of_camera_to_block,
    invert,
)
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera

MOST_BLOCKS = 30_000_000  # The game's world ends there.


@dataclass(frozen=True)
class GamePose:
    """A pose as the game's F3 screen tells it: world block coordinates, degrees.

    Yaw 0 looks to +z (south) and grows clockwise seen from above; pitch grows downward. ``at``
    says whether x, y, z is where the feet stand, as the game shows it, or the eye.
    """

    x: float
    y: float
    z: float
    yaw_deg: float
    pitch_deg: float
    at: Literal["feet", "eye"] = "feet"

    def __post_init__(self):
        values = (self.x, self.y, self.z, self.yaw_deg, self.pitch_deg)
        if not np.isfinite(values).all() or max(map(abs, values[:3])) > MOST_BLOCKS:
            raise UsageError(f"a pose must be five numbers of the game's world, not {values}")
        if abs(self.pitch_deg) > 90:
            raise UsageError(f"pitch is -90 (up) to 90 (down) degrees, not {self.pitch_deg:g}")
        if self.at not in ("feet", "eye"):
            raise UsageError(f"a pose is at feet or eye, not {self.at!r}")

    def camera_to_block(self, eye_blocks: float = PLAYER_EYE_BLOCKS) -> np.ndarray:
        """Return the camera's 4x4 pose in world block coordinates.

        Args:
            eye_blocks: how high the eye is over the feet; where blocks are smaller than a metre
                a player is larger, see ``coordinates.eye_height_blocks``.
        """
        up = eye_blocks if self.at == "feet" else 0.0
        eye = np.array([self.x, self.y + up, self.z])
        return camera_to_block_of_game_pose(eye, self.yaw_deg, self.pitch_deg)

    def camera_to_room(
        self, block_to_room: np.ndarray, eye_blocks: float = PLAYER_EYE_BLOCKS
    ) -> np.ndarray:
        """Return the camera's 4x4 pose in room metres; see ``camera_to_block``."""
        return carry_camera(self.camera_to_block(eye_blocks), block_to_room)


def game_pose_of(camera_to_room: np.ndarray, block_to_room: np.ndarray) -> GamePose:
    """Return the pose, at the eye, of an upright camera in the room."""
    camera_to_block = carry_camera(camera_to_room, invert(block_to_room))
    eye, yaw_deg, pitch_deg = game_pose_of_camera_to_block(camera_to_block)
    x, y, z = (float(value) for value in eye)
    return GamePose(x, y, z, yaw_deg, min(max(pitch_deg, -90.0), 90.0), "eye")


@dataclass(frozen=True, eq=False)
class Shot:
    """One picture to take: through which camera, from where, and when in its tour."""

    camera: Camera
    camera_to_room: np.ndarray  # float64 [4, 4], OpenCV axes, metres
    t_s: float = 0.0

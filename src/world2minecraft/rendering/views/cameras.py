"""Cameras from a field of view or intrinsics, poses in Minecraft's convention, and shots."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from world2minecraft.core.coordinates import (
    PLAYER_EYE_BLOCKS,
    camera_to_block_of_game_pose,
    carry_camera,
    focal_px_of_fov,
    fov_deg_of_focal_px,
    game_pose_of_camera_to_block,
    invert,
)
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera

GAME_FOV_DEG = 70.0  # The game's usual field of view; the game's is vertical.
MAX_FOV_DEG = 170.0  # Wider, and a flat picture shows little but its edges.
MAX_COORDINATE = 30_000_000  # The game's world ends there.


def camera_of(
    width_px: int,
    height_px: int,
    *,
    vertical_fov_deg: float | None = None,
    horizontal_fov_deg: float | None = None,
    intrinsics: np.ndarray | Sequence[float] | None = None,
) -> Camera:
    """Return a camera from a field of view or from intrinsics.

    A camera from a field of view has square pixels and a centred principal point.

    Args:
        width_px: Image width in pixels.
        height_px: Image height in pixels.
        vertical_fov_deg: Vertical field of view in degrees, as in the game's options.
        horizontal_fov_deg: Horizontal field of view in degrees.
        intrinsics: fx, fy, cx, cy in pixels, or the 3x3 intrinsics matrix. Pixel centres are at
            +0.5.

    Raises:
        UsageError: If not exactly one of the last three arguments is given, or if a number is out
            of range.

    Example:
        >>> round(camera_of(640, 480, vertical_fov_deg=90).fx_px, 6)
        240.0
    """
    given = [vertical_fov_deg, horizontal_fov_deg, intrinsics]
    if sum(one is not None for one in given) != 1:
        raise UsageError(
            "give exactly one of vertical_fov_deg, horizontal_fov_deg and intrinsics, "
            f"got {sum(one is not None for one in given)}"
        )
    try:
        if intrinsics is not None:
            fx_px, fy_px, cx_px, cy_px = _intrinsics_values(intrinsics)
            return Camera(width_px, height_px, fx_px, fy_px, cx_px, cy_px)
        across = horizontal_fov_deg is not None
        fov_deg = horizontal_fov_deg if horizontal_fov_deg is not None else vertical_fov_deg
        focal_px = _focal_px(width_px if across else height_px, float(fov_deg or 0.0))
        return Camera(width_px, height_px, focal_px, focal_px, width_px / 2, height_px / 2)
    except ValueError as error:
        raise UsageError(f"invalid camera: {error}") from error


def vertical_fov_deg_of(camera: Camera) -> float:
    """Return a camera's vertical field of view in degrees, assuming a centred principal point."""
    return fov_deg_of_focal_px(camera.height_px, camera.fy_px)


def _focal_px(side_px: int, fov_deg: float) -> float:
    if not 0 < fov_deg <= MAX_FOV_DEG:
        raise UsageError(
            f"the field of view must be above 0 and at most {MAX_FOV_DEG:g} degrees, "
            f"got {fov_deg:g}"
        )
    return float(focal_px_of_fov(side_px, fov_deg))


def _intrinsics_values(intrinsics: np.ndarray | Sequence[float]) -> list[float]:
    """Return fx, fy, cx, cy of either form."""
    values = np.asarray(intrinsics, np.float64)
    if values.shape == (4,):
        return values.tolist()
    if values.shape != (3, 3):
        raise ValueError(
            f"intrinsics must be fx, fy, cx, cy or a 3x3 matrix, got shape {list(values.shape)}"
        )
    flat = (values[0, 1], values[1, 0], values[2, 0], values[2, 1], values[2, 2] - 1)
    if np.abs(flat).max() > 1e-9:
        raise ValueError("the intrinsics matrix must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]")
    return [values[0, 0], values[1, 1], values[0, 2], values[1, 2]]


@dataclass(frozen=True)
class GamePose:
    """A pose as shown on Minecraft's F3 screen: world block coordinates and angles in degrees.

    Yaw 0 faces +z (south) and increases clockwise seen from above. Pitch increases downward. ``at``
    states whether x, y, z is the position of the feet, as shown in the game, or of the eye.
    """

    x: float
    y: float
    z: float
    yaw_deg: float
    pitch_deg: float
    at: Literal["feet", "eye"] = "feet"

    def __post_init__(self):
        values = (self.x, self.y, self.z, self.yaw_deg, self.pitch_deg)
        if not np.isfinite(values).all() or max(map(abs, values[:3])) > MAX_COORDINATE:
            raise UsageError(
                f"a pose must be five finite numbers x, y, z, yaw, pitch within the world, "
                f"got {values}"
            )
        if abs(self.pitch_deg) > 90:
            raise UsageError(f"pitch must be -90 (up) to 90 (down) degrees, got {self.pitch_deg:g}")
        if self.at not in ("feet", "eye"):
            raise UsageError(f"at must be 'feet' or 'eye', got {self.at!r}")

    def camera_to_block(self, eye_blocks: float = PLAYER_EYE_BLOCKS) -> np.ndarray:
        """Return the camera pose in world block coordinates as a 4x4 matrix.

        Args:
            eye_blocks: Height of the eye above the feet, in blocks. If blocks are smaller than a
                metre, a player is taller in blocks; see ``coordinates.eye_height_blocks``.
        """
        up = eye_blocks if self.at == "feet" else 0.0
        eye = np.array([self.x, self.y + up, self.z])
        return camera_to_block_of_game_pose(eye, self.yaw_deg, self.pitch_deg)

    def camera_to_room(
        self, block_to_room: np.ndarray, eye_blocks: float = PLAYER_EYE_BLOCKS
    ) -> np.ndarray:
        """Return the camera pose in room metres as a 4x4 matrix. See ``camera_to_block``."""
        return carry_camera(self.camera_to_block(eye_blocks), block_to_room)


def game_pose_of(camera_to_room: np.ndarray, block_to_room: np.ndarray) -> GamePose:
    """Return the pose, at the eye, of an upright camera in the room."""
    camera_to_block = carry_camera(camera_to_room, invert(block_to_room))
    eye, yaw_deg, pitch_deg = game_pose_of_camera_to_block(camera_to_block)
    x, y, z = (float(value) for value in eye)
    return GamePose(x, y, z, yaw_deg, min(max(pitch_deg, -90.0), 90.0), "eye")


@dataclass(frozen=True, eq=False)
class Shot:
    """An image to render: its camera, its pose and its time in the tour."""

    camera: Camera
    camera_to_room: np.ndarray  # float64 [4, 4], OpenCV axes, metres
    t_s: float = 0.0

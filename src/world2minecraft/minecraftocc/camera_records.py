"""Camera records: K, E and descriptions of their conventions, ours or those printed in the paper.

A standard record is correct: K is computed from the vertical field of view, and E transforms camera
coordinates to room coordinates. With ``paper_compat``, the record contains the two matrices exactly
as printed in the paper's equations, including their two errors: K uses the game's vertical field of
view as the horizontal one, and the rotation in E is world-to-camera instead of camera-to-world.
These matrices do not match the image.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import (
    carry_camera,
    fov_deg_of_focal_px,
    game_pose_of_camera_to_block,
    invert,
    paper_focal_px,
    paper_rotation,
)
from world2minecraft.core.errors import MALFORMED, UsageError
from world2minecraft.core.types import Camera

CONVENTIONS = {
    "K": "[[fx, 0, cx], [0, fy, cy], [0, 0, 1]] in pixels; pixel centres at +0.5",
    "E": "camera to room, 4x4: camera axes x right, y down, z forward; room in metres, "
    "right-handed, z up, floor surface at z = 0",
    "camera_to_block": "camera to world block coordinates, 4x4: x east, y up, z south; "
    "a block spans n to n + 1; the rotation contains no scale",
    "depth": "along the camera's z, not along the ray",
    "fov": "vertical, as in the game's options",
    "game_pose": "eye position in world block coordinates, angles in degrees; yaw 0 faces +z "
    "(south) and increases clockwise seen from above; pitch increases downward",
    "distortion": "none (k1, k2, p1, p2 and k3 are 0)",
}
PAPER_CONVENTIONS = {
    "K": "as printed in the paper: fx = fy = W / (2 tan(fov / 2)), which uses the game's vertical "
    "field of view as the horizontal one; fx and fy are too large by the factor W / H",
    "E": "as printed in the paper: [R p; 0 1] with R = R_X(pitch + pi) R_Y(yaw + pi) and the eye p "
    "in block coordinates; R is world-to-camera although E is called camera-to-world",
    "game_pose": CONVENTIONS["game_pose"],
    "fov": CONVENTIONS["fov"],
    "distortion": CONVENTIONS["distortion"],
}


def camera_record(
    camera: Camera,
    camera_to_room: np.ndarray,
    block_to_room: np.ndarray,
    *,
    paper_compat: bool = False,
) -> dict[str, Any]:
    """Return the camera record of an image, ready for JSON.

    Args:
        camera: Camera without lens distortion.
        camera_to_room: Camera pose in the room, float64 [4, 4].
        block_to_room: Matrix from block coordinates to room coordinates, float64 [4, 4].
        paper_compat: Whether to return the matrices as printed in the paper instead of the correct
            ones.

    Raises:
        UsageError: If the camera has lens distortion.

    Example:
        >>> camera = Camera(640, 480, 500.0, 500.0, 320.0, 240.0)
        >>> record = camera_record(camera, np.eye(4), np.eye(4))
        >>> record["K"][0], record["distortion"]
        ([500.0, 0.0, 320.0], [0.0, 0.0, 0.0, 0.0, 0.0])
    """
    if any(camera.distortion):
        raise UsageError("camera records do not support lens distortion; undistort the image first")
    camera_to_block = carry_camera(camera_to_room, invert(block_to_room))
    eye, yaw_deg, pitch_deg = game_pose_of_camera_to_block(camera_to_block)
    fov_deg = fov_deg_of_focal_px(camera.height_px, camera.fy_px)
    record: dict[str, Any] = {
        "width": camera.width_px,
        "height": camera.height_px,
        "vertical_fov_deg": fov_deg,
        "distortion": [0.0] * 5,
        "game_pose": {**dict(zip("xyz", eye.tolist(), strict=True)), "yaw": yaw_deg,
                      "pitch": pitch_deg, "at": "eye"},
        "paper_compat": paper_compat,
    }  # fmt: skip
    if paper_compat:
        k, e = paper_matrices(camera.width_px, camera.height_px, fov_deg, eye, yaw_deg, pitch_deg)
        return {**record, "K": k.tolist(), "E": e.tolist(), "conventions": PAPER_CONVENTIONS}
    return {
        **record,
        "K": np.asarray(camera.matrix, np.float64).tolist(),
        "E": np.asarray(camera_to_room, np.float64).tolist(),
        "camera_to_block": camera_to_block.tolist(),
        "conventions": CONVENTIONS,
    }


def paper_matrices(
    width_px: int,
    height_px: int,
    fov_deg: float,
    eye_block: np.ndarray,
    game_yaw_deg: float,
    game_pitch_deg: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the matrices K (3x3) and E (4x4), float64, as printed in the paper's appendix.

    Args:
        width_px: Image width in pixels (W), from which the focal length is computed.
        height_px: Image height in pixels (H).
        fov_deg: Field of view in the game in degrees (alpha).
        eye_block: Eye position p in world block coordinates, float64 [3].
        game_yaw_deg: Yaw in the game in degrees (theta).
        game_pitch_deg: Pitch in the game in degrees (phi).
    """
    focal_px = paper_focal_px(width_px, fov_deg)
    k = np.array([[focal_px, 0, width_px / 2], [0, focal_px, height_px / 2], [0, 0, 1]])
    e = np.eye(4)
    e[:3, :3] = paper_rotation(game_yaw_deg, game_pitch_deg)
    e[:3, 3] = eye_block
    return k, e


def camera_from_record(record: Mapping[str, Any]) -> tuple[Camera, np.ndarray]:
    """Return the camera and the ``camera_to_room`` matrix, float64 [4, 4], from a camera record.

    Raises:
        UsageError: If the record is invalid, or contains the paper's matrices, which do not match
            the image.
    """
    if record.get("paper_compat"):
        raise UsageError(
            "K and E of a paper_compat record do not match its image; use a record "
            "without paper_compat"
        )
    try:
        k, e = (np.array(record[name], np.float64) for name in ("K", "E"))
        if (
            k.shape != (3, 3)
            or e.shape != (4, 4)
            or not (np.isfinite(k).all() & np.isfinite(e).all())
        ):
            raise ValueError("K must be a 3x3 and E a 4x4 matrix of finite numbers")
        size = int(record["width"]), int(record["height"])
        return Camera(*size, k[0, 0], k[1, 1], k[0, 2], k[1, 2]), e
    except MALFORMED as error:
        raise UsageError(f"not a valid camera record ({error})") from error

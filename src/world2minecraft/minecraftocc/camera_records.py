"""Camera records: K, E and the conventions in words, ours or as the paper prints them.

By itself the record is right: K from the vertical field of view, E carries the camera's axes to the
room. ``paper_compat`` gives the paper's two matrices exactly as its equations are printed, with
their two slips: K takes the game's vertical field of view for the horizontal one, and E's rotation
is world to camera where a camera-to-world one is due. Such matrices do not meet the image.
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
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera

CONVENTIONS = {
    "K": "[[fx, 0, cx], [0, fy, cy], [0, 0, 1]] in pixels; pixel centres at +0.5",
    "E": "camera to room, 4x4: camera axes x right, y down, z forward; room in metres, "
    "right-handed, z up, the floor's top at z = 0",
    "camera_to_block": "the same camera in world block coordinates: x east, y up, z south; "
    "a block spans n to n + 1; no scale in its rotation",
    "depth": "along the camera's z, not along the ray",
    "fov": "vertical, as in the game's options",
    "game_pose": "the eye in world block coordinates; yaw 0 looks to +z (south) and grows "
    "clockwise from above, pitch grows downward; degrees",
    "distortion": "none (k1 k2 p1 p2 k3 are 0)",
}
PAPER_CONVENTIONS = {
    "K": "as the paper prints it: fx = fy = W / (2 tan(fov / 2)), which takes the game's vertical "
    "field of view for the horizontal one; too long by W / H",
    "E": "as the paper prints it: [R p; 0 1] with R = R_X(pitch + pi) R_Y(yaw + pi) and p the eye "
    "in block coordinates; R is world to camera though E is called camera to world",
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
    """Return what a data set says of an image's camera, as plain values.

    Args:
        camera: without distortion, as all rendered pictures.
        camera_to_room: float64 [4, 4].
        block_to_room: of the world, float64 [4, 4].
        paper_compat: the paper's printed matrices in place of the right ones.

    Raises:
        UsageError: the camera has distortion.

    Example:
        >>> camera = Camera(640, 480, 500.0, 500.0, 320.0, 240.0)
        >>> record = camera_record(camera, np.eye(4), np.eye(4))
        >>> record["K"][0], record["distortion"]
        ([500.0, 0.0, 320.0], [0.0, 0.0, 0.0, 0.0, 0.0])
    """
    if any(camera.distortion):
        raise UsageError("a record's camera has no distortion; undistort the picture first")
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
    """Return the paper's K, float64 [3, 3], and E, float64 [4, 4], as its appendix prints them.

    Args:
        width_px: W, of which its focal length is made.
        height_px: H.
        fov_deg: the game's field of view, the paper's alpha.
        eye_block: p, float64 [3], in world block coordinates.
        game_yaw_deg: theta.
        game_pitch_deg: phi.
    """
    focal_px = paper_focal_px(width_px, fov_deg)
    k = np.array([[focal_px, 0, width_px / 2], [0, focal_px, height_px / 2], [0, 0, 1]])
    e = np.eye(4)
    e[:3, :3] = paper_rotation(game_yaw_deg, game_pitch_deg)
    e[:3, 3] = eye_block
    return k, e


def camera_from_record(record: Mapping[str, Any]) -> tuple[Camera, np.ndarray]:
    """Return the camera and ``camera_to_room``, float64 [4, 4], of a record.

    Raises:
        UsageError: it is no record, or one with the paper's matrices, which do not meet the image.
    """
    if record.get("paper_compat"):
        raise UsageError(
            "K and E of a paper_compat record do not meet its image; make it without paper_compat"
        )
    try:
        k, e = (np.array(record[name], np.float64) for name in ("K", "E"))
        if (
            k.shape != (3, 3)
            or e.shape != (4, 4)
            or not (np.isfinite(k).all() & np.isfinite(e).all())
        ):
            raise ValueError("K must be 3x3 and E 4x4, of finite numbers")
        size = int(record["width"]), int(record["height"])
        return Camera(*size, k[0, 0], k[1, 1], k[0, 2], k[1, 2]), e
    except (KeyError, TypeError, ValueError) as error:
        raise UsageError(f"this is no camera's record ({error})") from error

"""Rotations as phones and data sets state them: quaternions x, y, z, w."""

import numpy as np


def rotation_of(quaternion: np.ndarray) -> np.ndarray:
    """Return the 3x3 rotation of a quaternion x, y, z, w of any length; NaN where it is 0."""
    with np.errstate(all="ignore"):
        x, y, z, w = np.asarray(quaternion, np.float64) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def pose_of(translation: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
    """Return the 4x4 transform of a translation and a quaternion x, y, z, w."""
    pose = np.eye(4)
    pose[:3, :3] = rotation_of(quaternion)
    pose[:3, 3] = translation
    return pose

"""Rotations as phones and data sets state them: quaternions x, y, z, w."""

import numpy as np
from scipy.spatial.transform import Rotation


def rotation_of(quaternion: np.ndarray) -> np.ndarray:
    """Return the 3x3 rotation of a quaternion x, y, z, w of any length; NaN where it is 0."""
    length = np.linalg.norm(quaternion)
    if not 0 < length < np.inf:  # scipy raises; captures leave out a frame whose pose is NaN.
        return np.full((3, 3), np.nan)
    return Rotation.from_quat(np.asarray(quaternion, np.float64) / length).as_matrix()


def pose_of(translation: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
    """Return the 4x4 transform of a translation and a quaternion x, y, z, w."""
    pose = np.eye(4)
    pose[:3, :3] = rotation_of(quaternion)
    pose[:3, 3] = translation
    return pose

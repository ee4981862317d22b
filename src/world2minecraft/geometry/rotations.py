"""Rotation matrices from vectors, from quaternions in x, y, z, w order, and from any matrix.

Rotation vectors are not converted with SciPy, whose last bits vary between versions: generated
captures must have the same bytes for the same seed in every version.
"""

import numpy as np
from scipy.spatial.transform import Rotation

MIN_ANGLE_RAD = 1e-15  # Under it an axis has no direction.


def rotation_from_vector(vector: np.ndarray) -> np.ndarray:
    """Convert a rotation vector, whose length is the angle in radians, to a matrix float64 [3, 3].

    Example:
        >>> rotation_from_vector(np.array([0, 0, np.pi / 2])).round(9)[0].tolist()
        [0.0, -1.0, 0.0]
    """
    angle = float(np.linalg.norm(vector))
    if angle < MIN_ANGLE_RAD:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def nearest_rotation(matrix: np.ndarray) -> np.ndarray:
    """Return the rotation that is nearest to a 3x3 matrix."""
    left, _, right = np.linalg.svd(matrix)
    return left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right


def rotation_from_quaternion(quaternion: np.ndarray) -> np.ndarray:
    """Convert a quaternion x, y, z, w of any length to a 3x3 rotation; a zero one gives NaN."""
    length = np.linalg.norm(quaternion)
    if not 0 < length < np.inf:  # scipy raises; captures leave out a frame whose pose is NaN.
        return np.full((3, 3), np.nan)
    return Rotation.from_quat(np.asarray(quaternion, np.float64) / length).as_matrix()


def nearest_rigid(pose: np.ndarray) -> np.ndarray:
    """Return the rigid transform, float64 [4, 4], whose rotation is nearest to that of a pose."""
    left, _, right = np.linalg.svd(np.asarray(pose[:3, :3], np.float64))
    rigid = np.eye(4)
    rigid[:3, :3], rigid[:3, 3] = left @ right, pose[:3, 3]
    return rigid


def pose_from_quaternion(translation: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
    """Return the 4x4 transform of a translation and a quaternion x, y, z, w."""
    pose = np.eye(4)
    pose[:3, :3] = rotation_from_quaternion(quaternion)
    pose[:3, 3] = translation
    return pose

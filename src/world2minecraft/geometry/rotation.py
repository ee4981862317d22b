"""Rotations by their vector: about it, by its length in radians."""

# Not by scipy's Rotation: its last bits differ, and with them the poses that generated captures
# state, which are the same bytes for the same seed from one version to the next.

import numpy as np

LEAST_RAD = 1e-15  # Under it an axis has no direction.


def rotation_of_vector(vector: np.ndarray) -> np.ndarray:
    """Return the rotation, float64 [3, 3], about a vector by its length in radians (Rodrigues).

    Example:
        >>> rotation_of_vector(np.array([0, 0, np.pi / 2])).round(9)[0].tolist()
        [0.0, -1.0, 0.0]
    """
    angle = float(np.linalg.norm(vector))
    if angle < LEAST_RAD:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross

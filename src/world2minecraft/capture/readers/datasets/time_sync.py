"""Synchronisation of data streams by time: colour with depth, and images with poses."""

import numpy as np

from world2minecraft.geometry.rotations import pose_from_quaternion


def pair_times(first_s: np.ndarray, second_s: np.ndarray, within_s: float) -> list[tuple[int, int]]:
    """Pair each time of one stream with the nearest of another. Each time is used at most once.

    Args:
        first_s: Times of the first stream in seconds, float64 [N], in any order.
        second_s: Times of the second stream in seconds, float64 [M].
        within_s: Largest allowed time difference in seconds.

    Returns:
        Pairs of indices into both streams, in the order of the first. If several pairs compete for
        the same index, the closest pair is kept.
    """
    if not len(first_s) or not len(second_s):
        return []
    order = np.argsort(second_s, kind="stable")
    after = np.clip(np.searchsorted(second_s[order], first_s), 1, max(len(order) - 1, 1))
    rivals = []
    for index, place in enumerate(after.tolist()):
        for candidate in {place - 1, min(place, len(order) - 1)}:
            other = int(order[candidate])
            gap = abs(float(first_s[index] - second_s[other]))
            if gap <= within_s:
                rivals.append((gap, index, other))
    taken: dict[int, int] = {}
    used: set[int] = set()
    for _, index, other in sorted(rivals):
        if index not in taken and other not in used:
            taken[index] = other
            used.add(other)
    return sorted(taken.items())


def interpolate_pose(before: np.ndarray, after: np.ndarray, share: float) -> np.ndarray:
    """Interpolate between two poses, linearly in position and by slerp in rotation.

    Args:
        before: First pose, float64 [7]: x y z in metres and a quaternion x y z w.
        after: Second pose, float64 [7].
        share: Position between the poses, from 0 for the first to 1 for the second.

    Returns:
        The interpolated pose as float64 [4, 4].
    """
    start = before[3:] / np.linalg.norm(before[3:])
    end = after[3:] / np.linalg.norm(after[3:])
    cosine = float(start @ end)
    if cosine < 0:  # Both signs are one rotation; the shorter way is meant.
        end, cosine = -end, -cosine
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-6:
        turned = (1 - share) * start + share * end
    else:
        turned = np.sin((1 - share) * angle) * start + np.sin(share * angle) * end
    return pose_from_quaternion((1 - share) * before[:3] + share * after[:3], turned)

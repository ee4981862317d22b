"""Synchronisation of streams with their own clocks: images with images, images with poses."""

import numpy as np

from world2minecraft.geometry.rotations import pose_from_quaternion


def pair_times(first_s: np.ndarray, second_s: np.ndarray, within_s: float) -> list[tuple[int, int]]:
    """Pair each moment of one stream with the nearest of another, each used once at most.

    Args:
        first_s: float64 [N], seconds, in any order.
        second_s: float64 [M], seconds.
        within_s: pairs further apart are none.

    Returns:
        Indices into both, in the order of the first stream. Of rivals the nearer pair wins.
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
    """Return the pose part of the way from one to another, the turn at an even rate (slerp).

    Args:
        before: float64 [7]: x y z in metres and a quaternion x y z w.
        after: the same, a moment later.
        share: 0 is the first, 1 the second.
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

"""Rows with lists of their own lengths, as the faces of PLY files are."""

import numpy as np

from world2minecraft.core.jit import njit

MOST_CORNERS = 1 << 16  # Of one polygon.


@njit
def walk_lists(raw, rows, steps, big):
    """Find where the values of each property of each row lie among bytes.

    Args:
        raw: uint8 [B].
        rows: how many.
        steps: int64 [P, 2]: bytes of a list's count (0 where it is a single value) and of a value.
        big: whether counts have their high byte first.

    Returns:
        Starts and counts int64 [rows, P], and how many bytes were used, -1 where they end early.
    """
    starts = np.zeros((rows, len(steps)), np.int64)
    counts = np.ones((rows, len(steps)), np.int64)
    place = 0
    for row in range(rows):
        for p in range(len(steps)):
            head = steps[p, 0]
            if place + head > len(raw):
                return starts, counts, -1
            if head > 0:
                count = 0
                for b in range(head):
                    byte = raw[place + b] if big else raw[place + head - 1 - b]
                    count = count * 256 + byte
                if count > MOST_CORNERS:
                    return starts, counts, -1
                counts[row, p] = count
                place += head
            starts[row, p] = place
            place += counts[row, p] * steps[p, 1]
            if place > len(raw):
                return starts, counts, -1
    return starts, counts, place


@njit
def walk_numbers(numbers, rows, listed):
    """Do what ``walk_lists`` does among numbers, float64 [N]; ``listed`` bool [P]."""
    starts = np.zeros((rows, len(listed)), np.int64)
    counts = np.ones((rows, len(listed)), np.int64)
    place = 0
    for row in range(rows):
        for p in range(len(listed)):
            if place >= len(numbers):
                return starts, counts, -1
            if listed[p]:
                if not 0 <= numbers[place] <= MOST_CORNERS:
                    return starts, counts, -1
                counts[row, p] = int(numbers[place])
                place += 1
            starts[row, p] = place
            place += counts[row, p]
            if place > len(numbers):
                return starts, counts, -1
    return starts, counts, place


@njit
def gathered(raw, starts, counts, width):
    """Return the bytes of values that lie in runs: ``counts[i]`` of them from ``starts[i]``."""
    result = np.empty(counts.sum() * width, np.uint8)
    place = 0
    for row in range(len(starts)):
        for b in range(counts[row] * width):
            result[place] = raw[starts[row] + b]
            place += 1
    return result


def fans(counts: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cut polygons into triangles around their first corners.

    Args:
        counts: int64 [N], corners of each.
        values: int64 [sum of counts], their vertices.

    Returns:
        int64 [T, 3], and the polygon of each triangle, int64 [T].
    """
    if len(counts) and (counts == 3).all():
        return values.reshape(-1, 3), np.arange(len(counts))
    return _fans(counts, values, int(np.maximum(counts - 2, 0).sum()))


@njit
def _fans(counts, values, total):
    triangles, owner = np.empty((total, 3), np.int64), np.empty(total, np.int64)
    place, made = 0, 0
    for n in range(len(counts)):
        for k in range(counts[n] - 2):
            triangles[made, 0] = values[place]
            triangles[made, 1] = values[place + k + 1]
            triangles[made, 2] = values[place + k + 2]
            owner[made] = n
            made += 1
        place += counts[n]
    return triangles, owner

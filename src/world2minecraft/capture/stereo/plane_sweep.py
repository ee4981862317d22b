"""Plane-sweep stereo of a photo: matching costs, semi-global matching and selection of depth.

A plane at depth z maps the pixel (u, v) of the photo to ``turn @ (u, v, 1) + shift / z`` in a
neighbour, up to scale. Windows around both pixels are compared by zero-mean normalised
cross-correlation, which is invariant to brightness and contrast. In Hirschmueller's semi-global
matching, a path from each of eight directions accumulates, for each plane, the least cost of the
pixels before it. The plane with the least sum over all directions is selected.
"""

import numpy as np

from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.capture.stereo.photo_preparation import StereoPhoto
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.jit import lean, njit

NEAR_SHARE, FAR_SHARE = 0.8, 1.25  # Room around the nearest and farthest sparse points.


@njit
def sweep_costs(grey, sources, sizes, turns, shifts, inverse, best_of, radius, noise):
    """Return the matching cost of each pixel at each plane, from 0 (equal) to 254 (opposite).

    Args:
        grey: Grey levels of the photo, uint8 [h, w].
        sources: Grey levels of the neighbours, uint32 [N, H, W]; see ``pack_corners``.
        sizes: Height and width of each neighbour in its array, int64 [N, 2].
        turns: Matrices ``K_n R K^-1``, float32 [N, 3, 3].
        shifts: Vectors ``K_n t``, float32 [N, 3].
        inverse: Inverse depths of the planes, float32 [D].
        best_of: Number of best neighbours whose mean score is used.
        radius: Radius of the window in pixels, at most 7 so that sums are exact.
        noise: Variance added to that of both windows.

    Returns:
        The costs as uint8 [h, w, D]; 127 (neutral) if fewer than two neighbours show the pixel.
    """
    height, width = grey.shape
    count, stride = len(sources), sources.shape[2]
    pixels = sources.reshape(count, sources.shape[1] * stride)
    side = 2 * radius + 1
    planes = np.empty((len(inverse), height, width), np.uint8)
    padded = _padded(grey, radius)
    mean, spread = _window_statistics(padded, radius, noise)
    ring = np.zeros((count, side, width + 2 * radius), np.float32)
    seen = np.zeros((count, side, width), np.float32)
    sums = np.zeros((count, 3, width + 2 * radius), np.float32)
    scores = np.empty((count, width), np.float32)
    best = np.empty((best_of, width), np.float32)
    box = np.empty((3, width), np.float32)
    corner, at = np.empty(width, np.uint32), np.empty((2, width), np.float32)
    for d in range(len(inverse)):
        sums[:] = 0
        for row in range(-radius, height + radius):
            slot = (row + radius) % side
            inside = min(max(row, 0), height - 1)
            y = row - radius
            for n in range(count):
                if row >= radius + 1:
                    _add_row(sums[n], ring[n, slot], padded[row + radius - side], -1.0)
                _warp_row(
                    pixels[n], stride, sizes[n], turns[n], shifts[n], inverse[d], inside, radius,
                    corner, at, ring[n, slot], seen[n, slot],
                )  # fmt: skip
                _add_row(sums[n], ring[n, slot], padded[row + radius], 1.0)
                if y >= 0:
                    _score_row(
                        sums[n], mean[y], spread[y], seen[n, (y + radius) % side], side, noise,
                        box, scores[n],
                    )  # fmt: skip
            if y >= 0:
                _mean_best_scores(scores, best, box[0], box[1], planes[d, y])
    return _planes_last(planes)


@njit
def _planes_last(planes):
    """Return costs [D, h, w] as [h, w, D]."""
    count, height, width = planes.shape
    result = np.empty((height, width, count), np.uint8)
    for y in range(height):
        for x in range(width):
            for d in range(count):
                result[y, x, d] = planes[d, y, x]
    return result


@njit
def _padded(grey, radius):
    """Return grey levels minus 128 as float32, with the edge repeated ``radius`` times."""
    height, width = grey.shape
    result = np.empty((height + 2 * radius, width + 2 * radius), np.float32)
    for y in range(height + 2 * radius):
        for x in range(width + 2 * radius):
            v, u = min(max(y - radius, 0), height - 1), min(max(x - radius, 0), width - 1)
            result[y, x] = np.float32(grey[v, u]) - np.float32(128)
    return result


@njit
def _window_statistics(padded, radius, noise):
    """Return the mean of each window, and 1 / sqrt(area * variance)."""
    side = 2 * radius + 1
    height, width = padded.shape[0] - 2 * radius, padded.shape[1] - 2 * radius
    area = np.float32(side * side)
    mean, spread = np.empty((height, width), np.float32), np.empty((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            total, square = np.float32(0), np.float32(0)
            for j in range(side):
                for i in range(side):
                    value = padded[y + j, x + i]
                    total += value
                    square += value * value
            mean[y, x] = total / area
            variance = square - total * total / area + area * np.float32(noise)
            spread[y, x] = np.float32(1) / np.sqrt(variance)
    return mean, spread


@lean
def _warp_row(
    pixels, stride, size, turn, shift, inverse, v, radius, corner, at, values, seen
):  # fmt: skip
    """Sample a row of the photo from a neighbour through a plane, and repeat its ends.

    Values are grey levels minus 128, rounded to halves. The loops are separate because only the
    one that reads ``pixels`` at random places cannot be vectorised.
    """
    height, width = size
    y0, half = np.float32(v) + np.float32(0.5), np.float32(0.5)
    ax = turn[0, 1] * y0 + turn[0, 2] + shift[0] * inverse
    ay = turn[1, 1] * y0 + turn[1, 2] + shift[1] * inverse
    az = turn[2, 1] * y0 + turn[2, 2] + shift[2] * inverse
    last_x, last_y = np.float32(width - 1.001), np.float32(height - 1.001)
    none, one = np.float32(0), np.float32(1)
    row_width = len(seen)
    for u in range(row_width):
        x0 = np.float32(u) + half
        z = az + turn[2, 0] * x0
        by = one / max(z, np.float32(1e-6))
        x = (ax + turn[0, 0] * x0) * by - half
        y = (ay + turn[1, 0] * x0) * by - half
        inside = (z > none) & (x >= none) & (y >= none) & (x <= last_x) & (y <= last_y)
        seen[u] = one if inside else none
        x, y = min(max(x, none), last_x), min(max(y, none), last_y)
        i, j = np.int32(x), np.int32(y)
        corner[u] = np.uint32(j * stride + i)
        at[0, u], at[1, u] = x - np.float32(i), y - np.float32(j)
    for u in range(row_width):
        corner[u] = pixels[corner[u]]
    middle = values[radius : radius + row_width]
    for u in range(row_width):
        four, a, b = corner[u], at[0, u], at[1, u]
        top_left = np.float32(np.int32(four & 255) - 128)
        low_left = np.float32(np.int32((four >> 16) & 255) - 128)
        top = top_left + a * (np.float32(np.int32((four >> 8) & 255) - 128) - top_left)
        low = low_left + a * (np.float32(np.int32((four >> 24) & 255) - 128) - low_left)
        value = top + b * (low - top)
        middle[u] = np.floor(value * np.float32(2) + half) * half
    for k in range(radius):
        values[k] = values[radius]
        values[row_width + radius + k] = values[row_width + radius - 1]


@lean
def _add_row(sums, values, own, sign):
    """Add a row to the column sums, or subtract it."""
    for x in range(len(values)):
        value = values[x]
        signed = value * np.float32(sign)
        sums[0, x] += signed
        sums[1, x] += signed * value
        sums[2, x] += signed * own[x]


@lean
def _score_row(sums, mean, spread, seen, side, noise, box, scores):
    """Compute the correlation of each window of a row; -2 outside the neighbour.

    Loops over slices are vectorised; with ``row[x + k]``, numba checks each index for its sign.
    """
    area = np.float32(side * side)
    extra = area * np.float32(noise)
    width = len(scores)
    radius = side // 2
    for c in range(3):
        row, total = sums[c], box[c]
        middle = row[radius : radius + width]
        for x in range(width):
            total[x] = middle[x]
        for k in range(1, radius + 1):
            left, right = row[radius - k : radius - k + width], row[radius + k : radius + k + width]
            for x in range(width):
                total[x] += left[x] + right[x]
    for x in range(width):
        value = box[0, x]
        variance = box[1, x] - value * value / area + extra
        score = (box[2, x] - mean[x] * value) * spread[x]
        score /= np.sqrt(max(variance, np.float32(1e-6)))
        scores[x] = score if seen[x] > 0 else np.float32(-2)


@lean
def _mean_best_scores(scores, best, total, found, costs):
    """Convert the mean of the best scores of each pixel in a row to a cost.

    ``scores`` [N, w] is overwritten; ``best`` [B, w], ``total`` and ``found`` [w] are work space.
    """
    # Adding 0 makes both stores unconditional: masked stores take four times as long.
    zero, one = np.float32(0), np.float32(1)
    best[:] = -2
    for n in range(len(scores)):
        for k in range(len(best)):
            for x in range(len(costs)):
                value, current = scores[n, x], best[k, x]
                best[k, x] = max(current, value) + zero
                scores[n, x] = min(current, value) + zero
    total[:] = 0
    found[:] = 0
    for k in range(len(best)):
        for x in range(len(costs)):
            valid = one if best[k, x] > np.float32(-1.5) else zero
            total[x] += valid * best[k, x]
            found[x] += valid
    for x in range(len(costs)):
        mean = total[x] / max(found[x], one) if found[x] > np.float32(1.5) else zero
        cost = np.float32(127) * (one - mean) + np.float32(0.5)
        costs[x] = np.uint8(np.int32(min(max(cost, zero), np.float32(254))))


@njit
def aggregate_costs(costs, small_step, large_step):
    """Aggregate matching costs along eight directions (semi-global matching).

    Args:
        costs: Matching costs, uint8 [h, w, D].
        small_step: Cost of a change by one plane between neighbouring pixels.
        large_step: Cost of a larger change.

    Returns:
        The sum of the path costs as float32 [h, w, D].
    """
    height, width, planes = costs.shape
    total = np.zeros((height, width, planes), np.float32)
    # [direction, row before or here, pixel with a margin, plane with a margin]
    paths = np.empty((3, 2, width + 2, planes + 2), np.float32)
    min_costs = np.empty((3, 2, width + 2), np.float32)
    along = np.empty((2, planes + 2), np.float32)
    for way in range(2):
        paths[:] = 0
        min_costs[:] = 0
        for row in range(height):
            y = row if way == 0 else height - 1 - row
            now, before = row % 2, 1 - row % 2
            _reset_paths(paths, min_costs, now)
            along[:] = 0
            along[:, 0] = along[:, planes + 1] = np.inf
            along_min = np.float32(0)
            for column in range(width):
                x = column if way == 0 else width - 1 - column
                here = column % 2
                along_min = _advance_path(
                    costs[y, x], along[1 - here], along_min, along[here], total[y, x],
                    small_step, large_step,
                )  # fmt: skip
                for k in range(3):
                    min_costs[k, now, x + 1] = _advance_path(
                        costs[y, x], paths[k, before, x + k], min_costs[k, before, x + k],
                        paths[k, now, x + 1], total[y, x], small_step, large_step,
                    )  # fmt: skip
    return total


@njit
def _reset_paths(paths, min_costs, now):
    """Set the paths that enter from the sides to zero."""
    width, planes = paths.shape[2] - 2, paths.shape[3] - 2
    for k in range(3):
        for side in (0, width + 1):
            min_costs[k, now, side] = 0
            paths[k, now, side, :] = 0
        for x in range(width + 2):
            for row in range(2):
                paths[k, row, x, 0] = paths[k, row, x, planes + 1] = np.inf


@njit
def _advance_path(costs, before, previous_min, here, total, small_step, large_step):
    """Advance a path by one pixel, add it to the sum, and return its least cost."""
    small, jump = np.float32(small_step), previous_min + np.float32(large_step)
    smallest = np.float32(np.inf)
    for d in range(len(costs)):
        way = min(before[d + 1], min(before[d], before[d + 2]) + small)
        value = np.float32(costs[d]) + (min(way, jump) - previous_min)
        here[d + 1] = value
        total[d] += value
        smallest = min(smallest, value)
    return smallest


@njit
def select_planes(total):
    """Return the plane with the least cost as float32 [h, w], interpolated by a parabola."""
    height, width, planes = total.shape
    found = np.empty((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            best = 0
            for d in range(1, planes):
                if total[y, x, d] < total[y, x, best]:
                    best = d
            found[y, x] = best
            if 0 < best < planes - 1:
                low, mid, up = total[y, x, best - 1], total[y, x, best], total[y, x, best + 1]
                bend = low + up - 2 * mid
                if bend > 0:
                    found[y, x] = best + (low - up) / (2 * bend)
    return found


def depth_range(photo: StereoPhoto, all_m: np.ndarray) -> tuple[float, float]:
    """Return the smallest and largest z-depth of the sweep for a photo."""
    known = photo.guide_m if len(photo.guide_m) >= 20 else all_m
    near, far = np.percentile(known, [1, 99])
    return float(near * NEAR_SHARE), float(far * FAR_SHARE)


def sweep_depth(
    photo: StereoPhoto,
    others: list[StereoPhoto],
    depths_m: tuple[float, float],
    values: StereoParameters,
) -> np.ndarray:
    """Compute the z-depth of a photo by plane sweep, float32 [h, w].

    Args:
        photo: The photo.
        others: Its neighbours.
        depths_m: Smallest and largest depth.
        values: Stereo parameters.
    """
    near_m, far_m = depths_m
    inverse = np.linspace(1 / far_m, 1 / near_m, values.planes)
    turns, shifts = _homographies(photo, others)
    costs = sweep_costs(
        photo.grey, *pack_corners([other.grey for other in others]), turns, shifts,
        inverse.astype(np.float32), min(values.best_of, len(others)), values.window_px // 2,
        values.noise**2,
    )  # fmt: skip
    if values.guide_cost:
        _add_sparse_point_costs(costs, photo, inverse, values.guide_cost)
    plane = select_planes(aggregate_costs(costs, values.small_step, values.large_step))
    step = (inverse[-1] - inverse[0]) / (values.planes - 1)
    return (1 / (inverse[0] + plane * step)).astype(np.float32)


def pack_corners(greys: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return images of any sizes in one padded array, with all that a sample needs in one place.

    Args:
        greys: Grey levels, uint8 [H_n, W_n] each.

    Returns:
        An array uint32 [N, H, W] with four grey levels each: of the pixel in the lowest byte, then
        of its right, lower and lower right neighbours; and the sizes as int64 [N, 2].
    """
    sizes = np.array([grey.shape for grey in greys], np.int64)
    stack = np.zeros((len(greys), *(sizes.max(axis=0) + 1)), np.uint32)
    for number, grey in enumerate(greys):
        stack[number, : grey.shape[0], : grey.shape[1]] = grey
    right = stack[:, :-1, :-1] | stack[:, :-1, 1:] << 8
    below = stack[:, 1:, :-1] | stack[:, 1:, 1:] << 8
    return right | below << 16, sizes


def _add_sparse_point_costs(costs, photo, inverse, guide_cost):
    """Increase the costs of planes far from a sparse point in the pixels around it."""
    height, width, planes = costs.shape
    at = (1 / photo.guide_m - inverse[0]) / (inverse[1] - inverse[0])
    away = np.minimum(np.abs(np.arange(planes)[None] - at[:, None]) / 2, 1) * guide_cost
    u, v = np.floor(photo.guide_px).astype(int).T
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            y, x = np.clip(v + dy, 0, height - 1), np.clip(u + dx, 0, width - 1)
            costs[y, x] = np.minimum(costs[y, x] + away, 254).astype(np.uint8)


def _homographies(photo: StereoPhoto, others: list[StereoPhoto]):
    """Return turns float32 [N, 3, 3] and shifts float32 [N, 3]; see the module."""
    back = np.linalg.inv(photo.camera.matrix)
    turns, shifts = [], []
    for other in others:
        here_to_there = invert_rigid(other.camera_to_scan) @ photo.camera_to_scan
        turns.append(other.camera.matrix @ here_to_there[:3, :3] @ back)
        shifts.append(other.camera.matrix @ here_to_there[:3, 3])
    return np.array(turns, np.float32), np.array(shifts, np.float32)

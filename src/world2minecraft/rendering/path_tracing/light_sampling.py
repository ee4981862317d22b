"""Sample emitters: which one, where on it, and with what probability density.

The choice depends only on the lit point and its outward normal, so that for a ray that hits an
emitter by chance the density of sampling it is known: both ways are weighted by multiple importance
sampling, and no light is counted twice.
"""

import numpy as np

from world2minecraft.core.jit import inlined
from world2minecraft.rendering.path_tracing.emitters import BRICK

UNSEEN_SOFT = 2.5  # Cells: nearer to a lamp that is not seen, its light hardly grows.


@inlined
def brick_of(lamps, at):
    """Return the brick of a point, the nearest one where it lies outside."""
    i = min(max(int(at[0]) // BRICK, 0), lamps.bricks[0] - 1)
    j = min(max(int(at[1]) // BRICK, 0), lamps.bricks[1] - 1)
    k = min(max(int(at[2]) // BRICK, 0), lamps.bricks[2] - 1)
    return (i * lamps.bricks[1] + j) * lamps.bricks[2] + k


@inlined
def emitter_weight(lamps, row, at, out):
    """Return how much a lamp may give to a point, roughly; 0 where it lies all behind it."""
    x = lamps.centre[row, 0] - at[0]
    y = lamps.centre[row, 1] - at[1]
    z = lamps.centre[row, 2] - at[2]
    radius = lamps.radius[row]
    height = x * out[0] + y * out[1] + z * out[2] + radius
    if height <= 0:
        return 0.0
    square = max(x * x + y * y + z * z, radius * radius)
    return lamps.power[row] * min(height / np.sqrt(square), 1.0) / square


@inlined
def choose_emitter(lamps, at, out, number):
    """Return ``(row, odds, number, total)``: a lamp near a point, -1 for none.

    ``number`` of [0, 1) decides; the rest of it is returned, uniform again. ``total`` is the sum of
    the weights, from which ``odds`` of any lamp follow.
    """
    brick = brick_of(lamps, at)
    total, row, weight = 0.0, -1, 0.0
    for place in range(lamps.near_start[brick], lamps.near_start[brick + 1]):
        other = lamps.near[place]
        gives = emitter_weight(lamps, other, at, out)
        if gives <= 0:
            continue
        total += gives
        share = gives / total
        if number < share:
            row, weight, number = other, gives, number / share
        else:
            number = (number - share) / (1.0 - share)
    return row, weight / total if row >= 0 else 0.0, min(max(number, 0.0), 0.99999999), total


@inlined
def is_near(lamps, row, at):
    """Tell whether a lamp is in the list of a point's brick."""
    brick = brick_of(lamps, at)
    for place in range(lamps.near_start[brick], lamps.near_start[brick + 1]):
        if lamps.near[place] == row:
            return True
    return False


@inlined
def face_before(lamps, row, pair, at):
    """Return ``(distance, side)``: how far a point lies before a face of a pair; 0 for none."""
    height = (
        (at[0] - lamps.corner[row, 0]) * lamps.out[row, pair, 0]
        + (at[1] - lamps.corner[row, 1]) * lamps.out[row, pair, 1]
        + (at[2] - lamps.corner[row, 2]) * lamps.out[row, pair, 2]
    )
    side = 0
    if height > 0:
        height, side = lamps.thick[row, pair] - height, 1
    if height >= 0 or not lamps.shown[row] >> (2 * pair + side) & 1:
        return 0.0, side
    return -height, side


@inlined
def choose_face(lamps, row, at, number):
    """Return ``(pair, side, odds, distance)``: a face of a lamp before a point; odds 0 for none."""
    total, pair, side, weight, before = 0.0, 0, 0, 0.0, 0.0
    for other in range(3):
        distance, which = face_before(lamps, row, other, at)
        gives = distance * lamps.area[row, other]
        if gives <= 0:
            continue
        total += gives
        share = gives / total
        if number < share:
            pair, side, weight, before, number = other, which, gives, distance, number / share
        else:
            number = (number - share) / (1.0 - share)
    return pair, side, weight / total if total > 0 else 0.0, before


@inlined
def face_odds(lamps, row, pair, at):
    """Return ``(odds, distance)`` with which ``choose_face`` takes a pair's face."""
    total, weight, before = 0.0, 0.0, 0.0
    for other in range(3):
        distance, _ = face_before(lamps, row, other, at)
        gives = distance * lamps.area[row, other]
        total += gives
        if other == pair:
            weight, before = gives, distance
    return weight / total if total > 0 else 0.0, before


@inlined
def sample_emitter(lamps, s, pick, first, second):
    """Set direction, distance, light and density of a lamp; tell whether there is one."""
    row, odds, pick, s.weights = choose_emitter(lamps, s.at, s.out, pick)
    if row < 0:
        return False
    pair, side, face, before = choose_face(lamps, row, s.at, pick)
    if face <= 0:
        return False
    a, b = (pair + 1) % 3, (pair + 2) % 3
    square = 0.0
    for n in range(3):
        place = lamps.corner[row, n] + first * lamps.edges[row, a, n]
        place += second * lamps.edges[row, b, n] + side * lamps.edges[row, pair, n]
        s.to[n] = place - s.at[n]
        square += s.to[n] * s.to[n]
    s.far = np.sqrt(square)
    for n in range(3):
        s.to[n] /= s.far
    # cosine = before / far, so the density over directions is odds * far ** 3 / (area * before).
    s.unseen = 1 if lamps.element[row] < 0 else 0
    s.density = odds * face * square * s.far / (lamps.area[row, pair] * before)
    near = square / (square + UNSEEN_SOFT * UNSEEN_SOFT) if s.unseen else 1.0
    for n in range(3):
        s.aimed[n] = near * lamps.light[row, n] / s.density
    return True


@inlined
def emitter_row(lamps, shape, s, element):
    """Return the row of the lamp that a path has met, -1 for none."""
    row = lamps.row_of_element[element]
    if row >= 0 or len(lamps.cell) == 0:
        return row
    i, j, k = s.cell[0], s.cell[1], s.cell[2]
    row = lamps.row_of_cell[i, j, k]
    if row < 0:
        return -1
    cell = (i * shape[1] + j) * shape[2] + k
    while row < len(lamps.cell) and lamps.cell[row] == cell:
        if lamps.element[row] == element:
            return row
        row += 1
    return -1


@inlined
def sampling_density(lamps, row, s):
    """Return the density with which aiming, at the last bounce, takes the direction of a lamp."""
    if s.weights <= 0 or not is_near(lamps, row, s.from_at):
        return 0.0
    weight = emitter_weight(lamps, row, s.from_at, s.from_out)
    pair = s.face // 2
    odds, before = face_odds(lamps, row, pair, s.from_at)
    if odds <= 0:
        return 0.0
    square = 0.0
    for n in range(3):
        step = s.at[n] - s.from_at[n]
        square += step * step
    far = np.sqrt(square)
    chosen = s.aim_odds * weight / s.weights * odds
    return chosen * square * far / (lamps.area[row, pair] * before)

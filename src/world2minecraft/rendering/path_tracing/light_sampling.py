"""Sampling of emitters: the choice of a lamp, a point on it, and the probability density.

The choice depends only on the lit point and its outward normal. The sampling density is therefore
also known for an emitter that a ray hits by chance, so that multiple importance sampling can weight
both ways without counting light twice.
"""

import numpy as np

from world2minecraft.core.jit import inlined
from world2minecraft.rendering.path_tracing.emitters import BRICK

UNSEEN_SOFT = 2.5  # Cells: nearer to a lamp that is not seen, its light hardly grows.


@inlined
def brick_of(emitters, at):
    """Return the brick that contains a point, or the nearest brick for a point outside."""
    i = min(max(int(at[0]) // BRICK, 0), emitters.bricks[0] - 1)
    j = min(max(int(at[1]) // BRICK, 0), emitters.bricks[1] - 1)
    k = min(max(int(at[2]) // BRICK, 0), emitters.bricks[2] - 1)
    return (i * emitters.bricks[1] + j) * emitters.bricks[2] + k


@inlined
def emitter_weight(emitters, row, at, out):
    """Return the approximate contribution of a lamp to a point, 0 for a lamp behind the surface."""
    x = emitters.centre[row, 0] - at[0]
    y = emitters.centre[row, 1] - at[1]
    z = emitters.centre[row, 2] - at[2]
    radius = emitters.radius[row]
    height = x * out[0] + y * out[1] + z * out[2] + radius
    if height <= 0:
        return 0.0
    square = max(x * x + y * y + z * z, radius * radius)
    return emitters.power[row] * min(height / np.sqrt(square), 1.0) / square


@inlined
def choose_emitter(emitters, at, out, number):
    """Return ``(row, odds, number, total)`` of a lamp chosen near a point; row is -1 for none.

    ``number`` in [0, 1) determines the choice and is returned rescaled to a uniform number.
    ``total`` is the sum of the weights, from which the ``odds`` of any lamp follow.
    """
    brick = brick_of(emitters, at)
    total, row, weight = 0.0, -1, 0.0
    for place in range(emitters.near_start[brick], emitters.near_start[brick + 1]):
        other = emitters.near[place]
        gives = emitter_weight(emitters, other, at, out)
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
def is_near(emitters, row, at):
    """Return whether a lamp is in the list of a point's brick."""
    brick = brick_of(emitters, at)
    for place in range(emitters.near_start[brick], emitters.near_start[brick + 1]):
        if emitters.near[place] == row:
            return True
    return False


@inlined
def face_before(emitters, row, pair, at):
    """Return ``(distance, side)`` of a point in front of a face of a pair; distance 0 for none."""
    height = (
        (at[0] - emitters.corner[row, 0]) * emitters.out[row, pair, 0]
        + (at[1] - emitters.corner[row, 1]) * emitters.out[row, pair, 1]
        + (at[2] - emitters.corner[row, 2]) * emitters.out[row, pair, 2]
    )
    side = 0
    if height > 0:
        height, side = emitters.thick[row, pair] - height, 1
    if height >= 0 or not emitters.shown[row] >> (2 * pair + side) & 1:
        return 0.0, side
    return -height, side


@inlined
def choose_face(emitters, row, at, number):
    """Return ``(pair, side, odds, distance)`` of a lamp face towards a point; odds 0 for none."""
    total, pair, side, weight, before = 0.0, 0, 0, 0.0, 0.0
    for other in range(3):
        distance, which = face_before(emitters, row, other, at)
        gives = distance * emitters.area[row, other]
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
def face_odds(emitters, row, pair, at):
    """Return ``(odds, distance)`` with which ``choose_face`` chooses the face of a pair."""
    total, weight, before = 0.0, 0.0, 0.0
    for other in range(3):
        distance, _ = face_before(emitters, row, other, at)
        gives = distance * emitters.area[row, other]
        total += gives
        if other == pair:
            weight, before = gives, distance
    return weight / total if total > 0 else 0.0, before


@inlined
def sample_emitter(emitters, s, pick, first, second):
    """Sample a direction, distance, radiance and density of a lamp; return False for none."""
    row, odds, pick, s.weights = choose_emitter(emitters, s.at, s.out, pick)
    if row < 0:
        return False
    pair, side, face, before = choose_face(emitters, row, s.at, pick)
    if face <= 0:
        return False
    a, b = (pair + 1) % 3, (pair + 2) % 3
    square = 0.0
    for n in range(3):
        place = emitters.corner[row, n] + first * emitters.edges[row, a, n]
        place += second * emitters.edges[row, b, n] + side * emitters.edges[row, pair, n]
        s.to[n] = place - s.at[n]
        square += s.to[n] * s.to[n]
    s.far = np.sqrt(square)
    for n in range(3):
        s.to[n] /= s.far
    # cosine = before / far, so the density over directions is odds * far ** 3 / (area * before).
    s.unseen = 1 if emitters.element[row] < 0 else 0
    s.density = odds * face * square * s.far / (emitters.area[row, pair] * before)
    near = square / (square + UNSEEN_SOFT * UNSEEN_SOFT) if s.unseen else 1.0
    for n in range(3):
        s.aimed[n] = near * emitters.light[row, n] / s.density
    return True


@inlined
def emitter_row(emitters, shape, s, element):
    """Return the row of the lamp that a path has hit, or -1."""
    row = emitters.row_of_element[element]
    if row >= 0 or len(emitters.cell) == 0:
        return row
    i, j, k = s.cell[0], s.cell[1], s.cell[2]
    row = emitters.row_of_cell[i, j, k]
    if row < 0:
        return -1
    cell = (i * shape[1] + j) * shape[2] + k
    while row < len(emitters.cell) and emitters.cell[row] == cell:
        if emitters.element[row] == element:
            return row
        row += 1
    return -1


@inlined
def sampling_density(emitters, row, s):
    """Return the density with which light sampling at the last bounce chooses a lamp."""
    if s.weights <= 0 or not is_near(emitters, row, s.from_at):
        return 0.0
    weight = emitter_weight(emitters, row, s.from_at, s.from_out)
    pair = s.face // 2
    odds, before = face_odds(emitters, row, pair, s.from_at)
    if odds <= 0:
        return 0.0
    square = 0.0
    for n in range(3):
        step = s.at[n] - s.from_at[n]
        square += step * step
    far = np.sqrt(square)
    chosen = s.aim_odds * weight / s.weights * odds
    return chosen * square * far / (emitters.area[row, pair] * before)

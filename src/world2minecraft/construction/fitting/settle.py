"""Shapes that stay as they are: what the game would change at the next update is changed here.

Stairs beside stairs become corners; carpets lie on something; a single post stays single.
"""

import numpy as np

from world2minecraft.construction.fitting.selection import Gains, choose
from world2minecraft.construction.fitting.shapes import ShapeSet

STEPS = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)])  # East, north, west, south.
ROUNDS = 6
JOINING = ("full", "stairs", "post")  # What a fence would reach out to.


def with_corners(numbers: np.ndarray, shapes: ShapeSet) -> np.ndarray:
    """Return shapes, int [X, Y, Z], with the stair corners that the game makes of neighbours.

    Stairs whose front neighbour is turned by a quarter become outer corners, those whose back
    neighbour is, inner ones; unless they carry on a row of their like on that side.
    """
    code = np.pad(shapes.stairs[numbers], 1, constant_values=-1)
    at = np.argwhere(code >= 0)
    if not len(at):
        return numbers
    own = code[tuple(at.T)]
    facing, half = own // 2, own % 2

    def beside(side: np.ndarray) -> np.ndarray:
        return code[tuple((at + STEPS[side % 4]).T)]

    corner = np.zeros(len(at), np.intp)
    for inner, way in ((1, facing + 2), (0, facing)):  # What is in front wins: it comes last.
        other = beside(way)
        side = other // 2
        crosses = (other >= 0) & (other % 2 == half) & ((side + facing) % 2 == 1)
        crosses &= beside(side + 2 * (not inner)) != own
        left = side == (facing + 1) % 4
        corner = np.where(crosses, np.where(left, 1, 2) + 2 * (not inner), corner)
    result = numbers.copy()
    result[tuple((at - 1).T)] = shapes.corners[own, corner]
    return result


def settled(
    gains: Gains,
    cells: np.ndarray,
    shape: tuple[int, ...],
    shapes: ShapeSet,
    lam: float | None = None,
    barred: np.ndarray | None = None,
    ground: int | None = 0,
) -> tuple[np.ndarray, float]:
    """Return the best stable shape of each block, intp [X, Y, Z], and the lam that chose it.

    Args:
        gains: of N blocks.
        cells: int [N, 3], where they are; every other block stays empty.
        shape: of the whole box.
        shapes: what may be chosen.
        lam: see ``choose``.
        barred: bool [N, S], what may not stand where.
        ground: the layer whose blocks stand on something already; None for no such layer.
    """
    shut = np.zeros((len(cells), len(shapes)), bool) if barred is None else barred.copy()
    guarded = np.isin(shapes.kinds, ("carpet", "post"))
    chosen, lam = choose(gains, shapes, lam, shut | guarded)
    scores = gains.scores(lam)
    rows, is_stairs = np.arange(len(cells)), shapes.stairs >= 0
    grid = np.zeros(shape, np.intp)
    at = tuple(cells.T)
    for _ in range(ROUNDS):
        grid[at] = chosen
        grid = with_corners(grid, shapes)
        made = grid[at]
        bent = (made != chosen) & is_stairs[chosen]
        plain = np.where(shut | guarded | is_stairs, -np.inf, scores)
        plain[:, shapes.free :] = -np.inf
        worse = bent & (scores[rows, made] < plain.max(1))
        if not worse.any():
            break
        shut[worse] |= is_stairs
        chosen = np.where(worse, plain.argmax(1), chosen)
    if guarded.any():
        _add_posts(grid, at, scores, shapes, shut)
        _add_carpets(grid, cells, scores, shapes, shut, ground)
    return grid, lam


def _add_posts(grid, at, scores, shapes, shut) -> None:
    """Set single posts, in place, where they gain and nothing beside them would join them."""
    for number in np.flatnonzero(shapes.kinds == "post"):
        joins = np.isin(shapes.kinds, JOINING)
        gain = np.where(shut[:, number], -np.inf, scores[:, number])
        order = np.argsort(-gain, kind="stable")
        for row in order[gain[order] > 0].tolist():
            place = tuple(axis[row] for axis in at)
            if gain[row] <= scores[row, grid[place]]:
                continue
            x, y, z = place
            around = [
                grid[x + dx, y + dy, z]
                for dx, dy, _ in STEPS.tolist()
                if 0 <= x + dx < grid.shape[0] and 0 <= y + dy < grid.shape[1]
            ]
            if not joins[around].any() and not shapes.stairs[grid[place]] >= 0:
                grid[place] = number


def _add_carpets(grid, cells, scores, shapes, shut, ground) -> None:
    """Set carpets, in place, where they gain and lie on something; lower layers first."""
    for number in np.flatnonzero(shapes.kinds == "carpet"):
        for row in np.argsort(cells[:, 2], kind="stable").tolist():
            x, y, z = cells[row].tolist()
            held = z == ground or (z > 0 and grid[x, y, z - 1] > 0)
            now = grid[x, y, z]
            if shut[row, number] or not held or shapes.stairs[now] >= 0:
                continue
            if scores[row, number] > max(scores[row, now], 0):
                grid[x, y, z] = number

"""What stands on nothing, but should, gets posts under it: a table top whose legs were too thin."""

import numpy as np

from world2minecraft.fit.joins import parts_of_shapes
from world2minecraft.fit.masks import SUB
from world2minecraft.fit.problem import Problem
from world2minecraft.fit.shapes import ShapeSet

LEAST_VOLUME = 90.0  # Sub-cells, about a panel: what is smaller is a crumb.
LEAST_SPAN = 2  # Blocks from which a part stands on its corners; a narrower one has one post.
MOST_POSTS = 4


def grounded(
    grid: np.ndarray,
    parts: np.ndarray,
    shapes: ShapeSet,
    stands: bool,
    held: np.ndarray | None = None,
    floor: int = 0,
) -> np.ndarray:
    """Return which parts touch the floor or something that holds them, bool [parts + 1].

    Args:
        grid: int [X, Y, Z], the shapes.
        parts: int32 [X, Y, Z], as of ``parts_of_shapes``.
        shapes: the set.
        stands: whether a floor lies under the lowest layer.
        held: bool [X, Y, Z], the blocks with a wall or a ceiling beside them.
        floor: the sub-cell of the lowest layer at which that floor lies.
    """
    found = np.zeros(int(parts.max(initial=0)) + 1, bool)
    if held is not None:
        found[parts[held]] = True
    if stands:
        lowest = grid[:, :, 0]
        stood = shapes.faces[lowest, 2, 0].any((2, 3)) if floor == 0 else lowest > 0
        found[parts[:, :, 0][stood]] = True
    found[0] = False
    return found


def on_stilts(
    grid: np.ndarray,
    problem: Problem,
    scores: np.ndarray,
    shapes: ShapeSet,
    held: np.ndarray | None = None,
) -> np.ndarray:
    """Return shapes, int [X, Y, Z], with posts under the parts that nothing carries.

    A post stands where the wanted has a leg, else under the corners of the part; the block over
    it takes the best shape that touches it. Where the way down is not free, nothing is done.

    Args:
        grid: the shapes.
        problem: what is wanted.
        scores: float32 [N, S], what each shape gains in each block of the problem.
        shapes: the set; without posts nothing is done.
        held: bool [X, Y, Z], the blocks with a wall or a ceiling beside them.
    """
    posts = np.flatnonzero(shapes.kinds == "post")
    if not len(posts):
        return grid
    result = grid.copy()
    parts = parts_of_shapes(grid, shapes)
    volumes = np.bincount(parts.ravel(), shapes.volumes[grid].ravel())
    carried = grounded(grid, parts, shapes, True, held, problem.floor)
    filled = np.zeros(problem.shape, bool)
    filled[problem.at] = True
    hovering = ~carried & (volumes >= LEAST_VOLUME)
    hovering[0] = False
    for number in np.flatnonzero(hovering):
        for x, y, top in _ways(result, parts == number, filled):
            shape = _standing_shape(
                result[x, y, top], problem.rows[x + 1, y + 1, top + 1], scores, shapes
            )
            if shape:
                result[x, y, top] = shape
                result[x, y, :top] = posts[0]
    return result


def _ways(grid: np.ndarray, part: np.ndarray, filled: np.ndarray) -> list[tuple[int, int, int]]:
    """Return the columns in which a part gets posts, and the layer of its lowest block there."""
    first = np.where(part.any(2), part.argmax(2), 0)
    ways = [
        (int(x), int(y), int(first[x, y]))
        for x, y in np.argwhere(first > 0)
        if not grid[x, y, : first[x, y]].any()
    ]
    if not ways:
        return []
    spots = np.array(ways)
    legs = [n for n, (x, y, top) in enumerate(ways) if filled[x, y, :top].all()]
    if 0 < len(legs) <= MOST_POSTS:
        return [ways[n] for n in legs]
    among = np.array(legs or range(len(ways)))
    span = np.ptp(spots[among, :2], axis=0).max() + 1
    if span < LEAST_SPAN:
        apart = np.abs(spots[among, :2] - spots[:, :2].mean(0)).sum(1)
        return [ways[int(among[apart.argmin()])]]
    corners = {
        int(among[(spots[among, 0] * a + spots[among, 1] * b).argmax()])
        for a in (1, -1)
        for b in (1, -1)
    }
    return [ways[n] for n in sorted(corners)]


def _standing_shape(now: int, row: int, scores: np.ndarray, shapes: ShapeSet) -> int:
    """Return the best shape for a block over a post; 0 where there is none."""
    touches = shapes.faces[:, 2, 0, SUB // 2 - 1 : SUB // 2 + 1, SUB // 2 - 1 : SUB // 2 + 1]
    able = np.asarray(touches.any((1, 2)))
    if able[now]:
        return int(now)
    if row < 0:
        return 0
    able[shapes.free :] = False
    gains = np.where(able, scores[row], -np.inf)
    best = int(gains.argmax())
    return best if np.isfinite(gains[best]) else 0

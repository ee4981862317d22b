"""What stands on nothing, but should, gets posts under it: a table top whose legs were too thin."""

import numpy as np

from world2minecraft.construction.fitting.joins import parts_of_shapes, touching
from world2minecraft.construction.fitting.masks import SUB
from world2minecraft.construction.fitting.problem import WAYS, Problem
from world2minecraft.construction.fitting.shapes import ShapeSet

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
    it takes the best shape that touches it. Where no way down is free, but the wanted runs up to
    what holds it, as the cord of a lamp does, the posts go up. Else nothing is done.

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
        part = parts == number
        ways, side = _ways(result, part, filled), 0
        if not ways and held is not None:
            ways, side = _cords(result, part, filled, held), 1
        for x, y, level in ways:
            shape = _touching_shape(result, (x, y, level), side, problem, scores, shapes)
            if shape:
                result[x, y, level] = shape
                result[x, y, slice(0, level) if side == 0 else slice(level + 1, None)] = posts[0]
    return result


def _cords(
    grid: np.ndarray, part: np.ndarray, filled: np.ndarray, held: np.ndarray
) -> list[tuple[int, int, int]]:
    """Return the column in which a part hangs from the ceiling, and its highest block there."""
    last = np.where(part.any(2), part.shape[2] - 1 - part[:, :, ::-1].argmax(2), -1)
    ways = [
        (int(x), int(y), int(last[x, y]))
        for x, y in np.argwhere(last >= 0)
        if held[x, y, -1]
        and filled[x, y, last[x, y] + 1 :].all()
        and not grid[x, y, last[x, y] + 1 :].any()
    ]
    middle = np.argwhere(part)[:, :2].mean(0)
    return sorted(ways, key=lambda way: float(np.abs(np.array(way[:2]) - middle).sum()))[:1]


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


def _touching_shape(
    grid: np.ndarray,
    place: tuple[int, int, int],
    side: int,
    problem: Problem,
    scores: np.ndarray,
    shapes: ShapeSet,
) -> int:
    """Return the best shape for a block over (side 0) or under (1) a post; 0 where there is none.

    It touches the post, and every neighbour that the shape touched that stands there now.
    """
    core = slice(SUB // 2 - 1, SUB // 2 + 1)
    able = np.asarray(shapes.faces[:, 2, side, core, core].any((1, 2)))
    padded, (x, y, z) = np.pad(grid, 1), (axis + 1 for axis in place)
    now = int(grid[place])
    contact = touching(shapes)
    for way, (i, j, k) in enumerate(WAYS.tolist()):
        other = int(padded[x + i, y + j, z + k])
        if contact[way][now, other]:
            able &= contact[way][:, other]
    if able[now]:
        return now
    row = int(problem.rows[x, y, z])
    able[shapes.free :] = False
    gains = np.where(able, scores[row], -np.inf)
    best = int(gains.argmax())
    return best if row >= 0 and np.isfinite(gains[best]) else 0

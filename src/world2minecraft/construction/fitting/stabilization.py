"""Passes that make chosen shapes stable: connected, supported, symmetric and without loose pieces.

Chosen block by block, the best shapes of a chair are a plate at the top of one block and a leg at
the bottom of another: a floating seat. Shapes that touch therefore score higher if the object
continues through the face between them. Unsupported parts get posts, such as a table top with legs
too thin to be seen. Changes that the game would make at the next block update are made here: stairs
next to stairs become corners, carpets lie on a support, single posts stay unconnected.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.construction.fitting.problem import UP, WAYS, Problem, Rules
from world2minecraft.construction.fitting.selection import Gains, choose
from world2minecraft.construction.fitting.shapes import SUB, ShapeSet
from world2minecraft.geometry.connected_components import label_components

BROKEN = 60.0  # Sub-cells given up for a joint: a plate half a block lower, not a whole block.
LEG_BROKEN = 160.0  # The same for a leg: a corner of a table may become a stair for it.
STACKED = 30.0  # Stairs over stairs: an upright wall of them looks like a washboard.
ROUNDS = 6
MIN_VOLUME = 90.0  # Sub-cells, about a panel: what is smaller is a crumb.
MIN_SPAN = 2  # Blocks from which a part stands on its corners; a narrower one has one post.
MAX_POSTS = 4
STEPS = np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)])  # East, north, west, south.
JOINING = ("full", "stairs", "post")  # Shapes that a fence connects to.
LEG_SHARE = 0.5  # Of what a column of blocks holds, so much is thin: then it is a leg.
POLE_FILL, POLE_SPAN = 0.2, 4  # A pole is half a block thick at most, both ways.
CRUMB_SHARE = 0.12  # A loose part of less than this share of an object is left out.


@lru_cache(maxsize=16)
def contact_table(shapes: ShapeSet) -> np.ndarray:
    """Return whether two shapes touch through each face, bool [6, S, S], faces as in WAYS."""
    flat = shapes.faces.reshape(len(shapes), 3, 2, -1).astype(np.float32)
    rows = []
    for axis in range(3):
        high, low = flat[:, axis, 1], flat[:, axis, 0]
        rows += [high @ low.T > 0, low @ high.T > 0]
    return np.stack(rows)


def join_shapes(
    grid: np.ndarray, rows: np.ndarray, scores: np.ndarray, problem: Problem, shapes: ShapeSet
) -> np.ndarray:
    """Change shapes, int [X, Y, Z], so that neighbours touch where the target is continuous.

    Blocks of even and odd positions are updated alternately. Empty blocks are never filled.

    Args:
        grid: Initial shapes, int [X, Y, Z].
        rows: Blocks of the problem that may change, int [M].
        scores: Gain of each shape in each block, float32 [N, S]; -inf if not allowed.
        problem: The fitting problem.
        shapes: The shape set.
    """
    contact = contact_table(shapes)[:, : shapes.free]
    posts, stairs = shapes.kinds == "post", shapes.kinds == "stairs"
    padded = np.pad(grid, 1)
    places = tuple((problem.cells + 1).T)
    rows = rows[padded[places][rows] > 0]
    odd = problem.cells[rows].sum(1) % 2
    moved = [True, True]
    for turn in range(2 * ROUNDS):
        mine = rows[odd == turn % 2]
        energy = scores[mine, : shapes.free].copy()
        for way, step in enumerate(WAYS):
            other = padded[tuple((problem.cells[mine] + 1 + step).T)]
            required = problem.flows[way, mine] & (other > 0)
            cost = np.where(posts[other], LEG_BROKEN, BROKEN).astype(np.float32)
            energy -= cost[:, None] * (~contact[way][:, other].T & required[:, None])
            if step[2]:
                energy -= np.float32(STACKED) * (stairs[other][:, None] & stairs[: shapes.free])
        best = energy.argmax(1)
        here = tuple(axis[mine] for axis in places)
        moved[turn % 2] = bool((padded[here] != best).any())
        padded[here] = best
        if not any(moved):
            break
    return padded[1:-1, 1:-1, 1:-1].copy()


def broken_share(grid: np.ndarray, problem: Problem, shapes: ShapeSet) -> float:
    """Return the share of the target's joints at which shapes [X, Y, Z] do not touch."""
    contact, padded = contact_table(shapes), np.pad(grid, 1)
    held = broken = 0
    for way in (0, 2, 4):
        mine = problem.flows[way]
        here = problem.cells[mine] + 1
        own, other = padded[tuple(here.T)], padded[tuple((here + WAYS[way]).T)]
        held += len(own)
        broken += int((~contact[way][own, other]).sum())
    return broken / max(held, 1)


def label_parts(grid: np.ndarray, shapes: ShapeSet) -> np.ndarray:
    """Label the face-connected parts of shapes, int32 [X, Y, Z]."""
    contact = contact_table(shapes)
    # A board of blocks and, between them, the joints: labelled at twice the size.
    board = np.zeros([2 * side - 1 for side in grid.shape], bool)
    board[::2, ::2, ::2] = grid > 0
    for axis in range(3):
        inner, outer, between = ([slice(None)] * 3 for _ in range(3))
        inner[axis], outer[axis] = slice(None, -1), slice(1, None)
        between = [slice(None, None, 2)] * 3
        between[axis] = slice(1, None, 2)
        meet = contact[2 * axis][grid[tuple(inner)], grid[tuple(outer)]]
        board[tuple(between)] = meet
    return label_components(board, corners=False)[0][::2, ::2, ::2]


def find_supported_parts(
    grid: np.ndarray,
    parts: np.ndarray,
    shapes: ShapeSet,
    stands: bool,
    held: np.ndarray | None = None,
    floor: int = 0,
) -> np.ndarray:
    """Return which parts touch the floor or a holding block, bool [parts + 1].

    Args:
        grid: Shapes, int [X, Y, Z].
        parts: Part labels from ``label_parts``, int32 [X, Y, Z].
        shapes: The shape set.
        stands: Whether there is a floor under the lowest layer.
        held: Bool [X, Y, Z] mask of blocks next to a wall or ceiling.
        floor: Sub-cell of the lowest layer at which the floor is.
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


def add_supports(
    grid: np.ndarray,
    problem: Problem,
    scores: np.ndarray,
    shapes: ShapeSet,
    held: np.ndarray | None = None,
) -> np.ndarray:
    """Add posts under the unsupported parts of shapes, int [X, Y, Z].

    A post is placed below a leg of the target, otherwise below the corners of the part, and the
    block above takes the best shape that touches it. If no path down is free but the target
    continues up to a holding block, like the cord of a lamp, the posts go up. Otherwise nothing is
    changed.

    Args:
        grid: Shapes, int [X, Y, Z].
        problem: The fitting problem.
        scores: Gain of each shape in each block of the problem, float32 [N, S].
        shapes: The shape set; without posts nothing is changed.
        held: Bool [X, Y, Z] mask of blocks next to a wall or ceiling.
    """
    posts = np.flatnonzero(shapes.kinds == "post")
    if not len(posts):
        return grid
    result = grid.copy()
    parts = label_parts(grid, shapes)
    volumes = np.bincount(parts.ravel(), shapes.volumes[grid].ravel())
    carried = find_supported_parts(grid, parts, shapes, True, held, problem.floor)
    filled = np.zeros(problem.shape, bool)
    filled[problem.at] = True
    hovering = ~carried & (volumes >= MIN_VOLUME)
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
    if 0 < len(legs) <= MAX_POSTS:
        return [ways[n] for n in legs]
    among = np.array(legs or range(len(ways)))
    span = np.ptp(spots[among, :2], axis=0).max() + 1
    if span < MIN_SPAN:
        distances = np.abs(spots[among, :2] - spots[:, :2].mean(0)).sum(1)
        return [ways[int(among[distances.argmin()])]]
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
    """Return the best shape for a block above (0) or below (1) a post, or 0 if there is none.

    It touches the post, and every existing neighbour that the previous shape touched.
    """
    core = slice(SUB // 2 - 1, SUB // 2 + 1)
    able = np.asarray(shapes.faces[:, 2, side, core, core].any((1, 2)))
    padded, (x, y, z) = np.pad(grid, 1), (axis + 1 for axis in place)
    now = int(grid[place])
    contact = contact_table(shapes)
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


def make_stair_corners(numbers: np.ndarray, shapes: ShapeSet) -> np.ndarray:
    """Convert stairs to the corners that the game would make of neighbouring stairs, int [X, Y, Z].

    Stairs become outer corners if the stairs in front are rotated by a quarter turn, and inner
    corners if those behind are, unless they continue a straight row on that side.
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


def choose_stable(
    gains: Gains,
    cells: np.ndarray,
    shape: tuple[int, ...],
    shapes: ShapeSet,
    lam: float | None = None,
    barred: np.ndarray | None = None,
    ground: int | None = 0,
) -> tuple[np.ndarray, float]:
    """Choose the best stable shape of each block, intp [X, Y, Z], and return the ``lam`` used.

    Args:
        gains: Gains of N blocks.
        cells: Positions of these blocks, int [N, 3]; all other blocks stay empty.
        shape: Shape of the whole box in blocks.
        shapes: Shapes that may be used.
        lam: IoU that the whole object reaches; see ``choose``.
        barred: Bool [N, S] mask of shapes that are not allowed in a block.
        ground: Layer whose blocks are already supported, or None.
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
        grid = make_stair_corners(grid, shapes)
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
    """Set single posts, in place, where they gain and no neighbour would connect to them."""
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
    """Set carpets, in place, where they gain and lie on a support; lower layers first."""
    for number in np.flatnonzero(shapes.kinds == "carpet"):
        for row in np.argsort(cells[:, 2], kind="stable").tolist():
            x, y, z = cells[row].tolist()
            held = z == ground or (z > 0 and grid[x, y, z - 1] > 0)
            now = grid[x, y, z]
            if shut[row, number] or not held or shapes.stairs[now] >= 0:
                continue
            if scores[row, number] > max(scores[row, now], 0):
                grid[x, y, z] = number


def stabilize(
    problem: Problem, shapes: ShapeSet, rules: Rules, held: np.ndarray | None = None
) -> tuple[np.ndarray, float]:
    """Solve a fitting problem and return the shapes, intp [X, Y, Z], with the ``lam`` used.

    Args:
        problem: The fitting problem.
        shapes: Shapes that may be used.
        rules: Rules of the fit.
        held: Bool [X, Y, Z] mask of blocks next to a wall or ceiling; None means no blocks.
    """
    barred = _find_barred(problem, shapes, rules)
    ground = 0 if rules.stands else None
    grid, lam = choose_stable(
        problem.gains, problem.cells, problem.shape, shapes, rules.lam, barred, ground
    )
    grid = mirror_shapes(grid, shapes, rules.even)
    scores = problem.gains.scores(lam)
    scores[barred] = -np.inf
    placed_later = np.isin(shapes.kinds, ("carpet", "post"))
    scores[:, placed_later] = -np.inf
    if rules.stands and rules.legs:
        _add_legs(grid, problem, shapes)
    movable = np.flatnonzero(~placed_later[grid[problem.at]])
    grid = join_shapes(grid, movable, scores, problem, shapes)
    grid = make_stair_corners(mirror_shapes(grid, shapes, rules.even), shapes)
    if rules.stands:
        grid = add_supports(grid, problem, scores, shapes, held)
    grid = remove_crumbs(grid, shapes, rules.stands, held, problem.floor)
    return make_stair_corners(_without_bare_carpets(grid, shapes, ground), shapes), lam


def _find_barred(problem: Problem, shapes: ShapeSet, rules: Rules) -> np.ndarray:
    """Return which shapes are not allowed in each block, bool [N, S]."""
    barred = np.zeros((len(problem.cells), len(shapes)), bool)
    for axis in (0, 1):  # On a mirror plane, only what is its own mirror image.
        if rules.even[axis] and problem.shape[axis] % 2:
            on = problem.cells[:, axis] == problem.shape[axis] // 2
            barred |= on[:, None] & (shapes.mirrors[axis] != np.arange(len(shapes)))
    poles = _poles(problem)
    if (shapes.kinds == "post").any():
        barred |= ~poles[:, None] & (shapes.kinds == "post")
        barred |= (poles & rules.legs)[:, None] & shapes.is_upright
    if rules.flush:
        barred |= shapes.is_low
    return barred


def mirror_shapes(grid: np.ndarray, shapes: ShapeSet, even: tuple[bool, bool]) -> np.ndarray:
    """Replace the upper half of shapes, int [X, Y, Z], by the mirror image of the lower half."""
    result = grid.copy()
    for axis in (0, 1):
        if even[axis]:
            half = result.shape[axis] // 2
            low, high = [slice(None)] * 3, [slice(None)] * 3
            low[axis], high[axis] = slice(0, half), slice(result.shape[axis] - half, None)
            result[tuple(high)] = shapes.mirrors[axis][np.flip(result[tuple(low)], axis)]
    return result


def _poles(problem: Problem) -> np.ndarray:
    """Return which blocks contain a leg, a pole or its foot, bool [N]: upright and thin."""
    filled = problem.wanted.reshape(-1, SUB, SUB, SUB) > POLE_FILL
    upright = filled.any((1, 2)).sum(1) >= SUB - 1
    along, across = (np.asarray(filled.any(axes)) for axes in ((2, 3), (1, 3)))
    slim = np.maximum(_span(along), _span(across)) <= POLE_SPAN
    foot = np.median(filled.sum((1, 2)), axis=1) <= POLE_SPAN**2
    foot &= problem.cells[:, 2] == 0
    thin = problem.thin.sum(1) > LEG_SHARE * problem.wanted.sum(1)
    return upright & (slim | foot) & thin


def _span(rows: np.ndarray) -> np.ndarray:
    """Return the distance between the first and last set cell of rows bool [N, 8], int [N]."""
    first, last = rows.argmax(1), SUB - 1 - rows[:, ::-1].argmax(1)
    return np.where(rows.any(1), last - first + 1, 0)


def _add_legs(grid: np.ndarray, problem: Problem, shapes: ShapeSet) -> None:
    """Set posts, in place, where legs or a pole connect the floor to the chosen shapes."""
    numbers = np.flatnonzero(shapes.kinds == "post")
    if not len(numbers):
        return
    poles, runs = (np.zeros(problem.shape, bool) for _ in range(2))
    poles[problem.at] = _poles(problem)
    runs[problem.at] = problem.flows[UP]
    tall = np.logical_and.accumulate(poles & runs, axis=2).sum(2)
    for x, y in np.argwhere(tall):
        top = int(tall[x, y])
        if top < grid.shape[2] and grid[x, y, top]:
            grid[x, y, :top] = numbers[0]


def remove_crumbs(
    grid: np.ndarray,
    shapes: ShapeSet,
    stands: bool,
    held: np.ndarray | None = None,
    floor: int = 0,
) -> np.ndarray:
    """Remove the parts of shapes, int [X, Y, Z], that touch neither floor, wall nor the main part.

    If no part is supported, the larger parts are kept, so the result is never empty. ``floor`` is
    the sub-cell of the lowest layer at which the floor is.
    """
    parts = label_parts(grid, shapes)
    volumes = np.bincount(parts.ravel(), shapes.volumes[grid].ravel())
    volumes[0] = 0
    if not volumes.any():
        return grid
    keep = find_supported_parts(grid, parts, shapes, stands, held, floor)
    if not stands:
        keep |= volumes >= CRUMB_SHARE * volumes.sum()
    keep[0] = False
    if not keep.any():
        keep[int(volumes.argmax())] = True
    return np.where(keep[parts], grid, 0)


def _without_bare_carpets(grid: np.ndarray, shapes: ShapeSet, ground: int | None) -> np.ndarray:
    """Return shapes, int [X, Y, Z], without carpets that have no support."""
    bare = np.zeros(grid.shape, bool)
    bare[:, :, 1:] = grid[:, :, :-1] == 0
    bare[:, :, 0] = ground is None
    return np.where(bare & (shapes.kinds[grid] == "carpet"), 0, grid)


def remove_loose_blocks(grid: np.ndarray, shapes: ShapeSet, held: np.ndarray) -> np.ndarray:
    """Remove single blocks of shapes, int [X, Y, Z], that touch no other block and are not held."""
    parts = label_parts(grid, shapes)
    sizes = np.bincount(parts.ravel())
    keep = (sizes > 1) | np.isin(np.arange(len(sizes)), parts[held])
    return np.where(keep[parts] & (parts > 0), grid, 0)

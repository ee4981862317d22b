"""Clean-up of floating blocks, which are joined, lowered, suspended or removed.

Blocks are connected if their shapes touch, not just their cells: there is half a block of air
between a lantern and a lower slab below it. Blocks connected to the floor, or to a large enough
piece of structure, are supported. All other blocks float.
"""

from functools import lru_cache
from itertools import product

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import AIR
from world2minecraft.editing.cleanup.draft_blocks import (
    free_cells,
    max_crumb_blocks,
    metres_to_blocks,
    move_blocks,
    remove_blocks,
    structure_blocks,
    visible_blocks,
)
from world2minecraft.editing.cleanup.gaps import close_gap, full_block_of
from world2minecraft.editing.volume_draft import Draft
from world2minecraft.minecraft.visual_shapes import visual_boxes

GAP = 1 / 8  # In blocks: shapes nearer than this count as touching. A fence bar is as thick.
# Half of the 26 neighbours. The others are the same pairs in reverse.
SIDES = (-1, 0, 1)
STEPS = tuple(step for step in product(SIDES, SIDES, SIDES) if step > (0, 0, 0))
CARRIER_M2 = 0.5  # A piece of structure of this area is supported, even if it is unconnected.
JOIN_M = 0.5  # The widest gap over which a part is joined to its own object.
STEP_M = 0.5  # The longest move of a part down or sideways to a support.
CORD_M = 1.25  # The longest chain.
ROUNDS = 8  # A repair may leave other blocks floating, which the next round repairs.
GENTLE_ROUNDS = 4  # The rounds after these only remove.
CORD = "minecraft:chain[axis=y,waterlogged=false]"
STANDING = (SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA, SemanticClass.TABLE)
DOWN, UP = np.array([0, -1, 0]), np.array([0, 1, 0])
ASIDE = tuple(np.array(step) for step in ((1, 0, 0), (-1, 0, 0), (0, 0, 1), (0, 0, -1)))


def touching_parts(states: np.ndarray, palette: tuple[str, ...], mask: np.ndarray) -> np.ndarray:
    """Number the connected parts of a mask of blocks.

    Args:
        states: Palette indices, uint16 [X, Y, Z] in block axes.
        palette: Block states.
        mask: Cells to include, bool [X, Y, Z].

    Returns:
        Part numbers, int32 [X, Y, Z]: 0 outside the mask, 1 to n in the order of the first cells.
    """
    number = np.full(states.shape, -1, np.int64)
    cells = np.flatnonzero(mask)
    number.ravel()[cells] = np.arange(len(cells))
    pairs = [_touching_pairs(states, palette, number, step) for step in STEPS]
    first, second = (np.concatenate([pair[side] for pair in pairs]) for side in (0, 1))
    graph = coo_array((np.ones(len(first), bool), (first, second)), (len(cells), len(cells)))
    _, labels = connected_components(graph, directed=False)
    _, starts = np.unique(labels, return_index=True)
    order = np.empty(len(starts), np.int32)
    order[np.argsort(starts)] = np.arange(1, len(starts) + 1)
    parts = np.zeros(states.shape, np.int32)
    parts.ravel()[cells] = order[labels] if len(cells) else 0
    return parts


def _touching_pairs(
    states: np.ndarray, palette: tuple[str, ...], number: np.ndarray, step: tuple[int, int, int]
) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of cell numbers that touch across a step."""
    here = tuple(slice(max(0, -s), min(n, n - s)) for s, n in zip(step, states.shape, strict=True))
    there = tuple(slice(max(0, s), min(n, n + s)) for s, n in zip(step, states.shape, strict=True))
    both = (number[here] >= 0) & (number[there] >= 0)
    first, second = states[here][both].astype(np.int64), states[there][both].astype(np.int64)
    keys, places = np.unique(first * len(palette) + second, return_inverse=True)
    touch = np.array(
        [touches(palette[key // len(palette)], palette[key % len(palette)], step) for key in keys],
        bool,
    )
    chosen = touch[places] if len(keys) else np.zeros(0, bool)
    return number[here][both][chosen], number[there][both][chosen]


@lru_cache(maxsize=1 << 16)
def touches(state: str, other: str, step: tuple[int, int, int]) -> bool:
    """Return whether the shapes of two block states touch if they are ``step`` blocks apart.

    Example:
        >>> touches("minecraft:stone", "minecraft:stone", (0, 1, 0))
        True
        >>> touches("minecraft:oak_slab[type=bottom]", "minecraft:stone", (0, 1, 0))
        False
    """
    mine, its = visual_boxes(state), visual_boxes(other)
    if not len(mine) or not len(its):
        return False
    away = np.array(step, np.float64)
    low = np.maximum(mine[:, None, :3], its[None, :, :3] + away)
    high = np.minimum(mine[:, None, 3:], its[None, :, 3:] + away)
    return bool((high - low > -GAP + 1e-6).all(axis=2).any())


def repair_floating(draft: Draft) -> None:
    """Repair all floating parts of a draft, largest first. Each repair is an edit."""
    for tried in range(ROUNDS):
        parts, carried = _parts(draft)
        sizes = np.bincount(parts.ravel(), minlength=len(carried))
        floating = [number for number in range(1, len(carried)) if not carried[number]]
        if not floating:
            return
        for number in sorted(floating, key=lambda part: -sizes[part]):
            cells = np.argwhere(parts == number)
            if tried < GENTLE_ROUNDS:
                _mend(draft, cells, carried[parts])
            else:
                remove_blocks(draft, cells, "drop", "floating block that cannot be supported")
            parts, carried = _again(draft, parts, carried, number)


def floating_cells(draft: Draft) -> np.ndarray:
    """Return a mask of unsupported blocks, bool [X, Y, Z]."""
    parts, carried = _parts(draft)
    return np.asarray((parts > 0) & ~carried[parts])


def _parts(draft: Draft) -> tuple[np.ndarray, np.ndarray]:
    """Return the connected parts, int32 [X, Y, Z], and whether each is supported, bool [N]."""
    seen = visible_blocks(draft)
    parts = touching_parts(draft.states, draft.palette, seen)
    count = int(parts.max(initial=0)) + 1
    carried = np.zeros(count, bool)
    floor = draft.semantic == SemanticClass.FLOOR
    if floor.any():
        carried[np.unique(parts[floor])] = True
        area = np.bincount(parts[structure_blocks(draft)], minlength=count)
        carried |= area >= CARRIER_M2 * draft.start.blocks_per_metre**2
    elif count > 1:  # Blocks of others, without labels: what stands on the lowest layer.
        filled = np.flatnonzero(seen.any(axis=(0, 2)))
        carried[np.unique(parts[:, filled[0]])] = True
        carried[np.bincount(parts[seen]).argmax()] = True
    carried[0] = False
    return parts, carried


def _again(
    draft: Draft, parts: np.ndarray, carried: np.ndarray, number: int
) -> tuple[np.ndarray, np.ndarray]:
    """Update the parts after one was repaired, whose new blocks and neighbours are supported."""
    parts[parts == number] = 0
    for cell in (draft.edits[-1].cells - draft.corner).tolist():
        at = tuple(cell)
        if draft.states[at] and parts[at] == 0:
            parts[at] = number
    carried[number] = True
    return parts, carried


def _mend(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> None:
    """Repair a floating part, int [N, 3]. ``carriers`` is the mask of supported blocks."""
    classes = draft.semantic[tuple(cells.T)]
    counted = _count(len(cells))
    if np.isin(classes, (1, 2, 3, 4)).all():
        remove_blocks(draft, cells, "drop", f"unconnected piece of structure, {counted}")
    elif _is_crumb(draft, cells, carriers):
        remove_blocks(draft, cells, "drop", f"small floating piece, {counted}")
    elif not (
        _join(draft, cells, carriers)
        or close_gap(draft, cells, carriers)
        or _put(draft, cells, carriers)
        or (not np.isin(classes, STANDING).any() and _hang(draft, cells, carriers))
        or _lower(draft, cells, carriers)
    ):
        remove_blocks(draft, cells, "drop", f"floating piece with nothing below, {counted}")


def _is_crumb(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> bool:
    """Return whether a part is small and belongs to no object, or to one that exists elsewhere."""
    if len(cells) > max_crumb_blocks(draft):
        return False
    numbers = np.unique(draft.instance[tuple(cells.T)])
    return bool((numbers == 0).all() or np.isin(numbers, draft.instance[carriers]).all())


def _join(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> bool:
    """Fill the shortest straight gap to the supported rest of the same object."""
    numbers = np.setdiff1d(draft.instance[tuple(cells.T)], [0])
    rest = carriers & np.isin(draft.instance, numbers)
    if not rest.any():
        return False
    free = free_cells(draft)
    for gap in range(1, metres_to_blocks(draft, JOIN_M) + 1):
        for step in (DOWN, *ASIDE, UP):
            for start in cells:
                way = start + np.arange(1, gap + 2)[:, None] * step
                if not _inside(draft, way[-1]) or not rest[tuple(way[-1])]:
                    continue
                at = tuple(start)
                state = full_block_of(draft.palette[draft.states[at]])
                ends = draft.palette[draft.states[at]], draft.palette[draft.states[tuple(way[-1])]]
                if free[tuple(way[:-1].T)].all() and _bridges(state, ends, step):
                    number = int(draft.instance[at])
                    draft.fill(
                        "join",
                        way[:-1],
                        state,
                        as_class=int(draft.semantic[at]),
                        as_instance=number,
                        reason="part detached from the rest of its object",
                        class_id=int(draft.semantic[at]),
                        instance=number,
                    )
                    return True
    return False


def _bridges(state: str, ends: tuple[str, str], step: np.ndarray) -> bool:
    """Return whether a row of a state along a step is connected, including at its ends."""
    x, y, z = step.tolist()
    pairs = ((ends[0], state), (state, state), (state, ends[1]))
    return all(touches(one, other, (x, y, z)) for one, other in pairs)


def _put(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> bool:
    """Move a part down or sideways by at most half a metre to supported blocks."""
    ways = []
    for order, step in enumerate((DOWN, *ASIDE)):
        for length in range(1, metres_to_blocks(draft, STEP_M) + 1):
            if not _fits(draft, cells, step * length):
                break
            if _touches(draft, cells, step * length, carriers):
                ways.append((length, order, step * length))
                break
    if not ways:
        return False
    length, _, step = min(ways, key=lambda way: way[:2])
    move_blocks(draft, cells, step, f"floating piece, {_count(length)} from a support")
    return True


def _count(length: int) -> str:
    return f"{length} block{'s' * (length > 1)}"


def _hang(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> bool:
    """Suspend a part on a chain from supported blocks above."""
    top = cells[cells[:, 1] == cells[:, 1].max()]
    middle = top[np.abs(top - top.mean(axis=0)).sum(axis=1).argmin()]
    free = free_cells(draft)
    for length in range(1, metres_to_blocks(draft, CORD_M) + 1):
        cell = middle + UP * (length + 1)
        if not _inside(draft, cell) or not free[tuple(cell - UP)]:
            return False
        if carriers[tuple(cell)]:
            cord = middle + np.arange(1, length + 1)[:, None] * UP
            number = int(draft.instance[tuple(middle)])
            class_id = int(draft.semantic[tuple(middle)])
            draft.fill(
                "hang",
                cord,
                CORD,
                as_class=class_id,
                as_instance=number,
                reason="floating piece below a ceiling, suspended on a chain",
                class_id=class_id,
                instance=number,
            )
            return True
    return False


def _lower(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> bool:
    """Lower a part to the surface below."""
    length = 0
    while _fits(draft, cells, DOWN * (length + 1)):
        length += 1
        if _touches(draft, cells, DOWN * length, carriers):
            move_blocks(draft, cells, DOWN * length, f"floating piece, {_count(length)} too high")
            return True
    return False


def _fits(draft: Draft, cells: np.ndarray, step: np.ndarray) -> bool:
    """Return whether a part fits at an offset: inside the volume, in air or its own cells."""
    there = cells + step
    if not ((there >= 0) & (there < draft.states.shape)).all():
        return False
    taken = ~free_cells(draft)
    taken[tuple(cells.T)] = False
    return not taken[tuple(there.T)].any()


def _touches(draft: Draft, cells: np.ndarray, step: np.ndarray, carriers: np.ndarray) -> bool:
    """Return whether a part moved by a step would touch supported blocks."""
    there = cells + step
    low = np.maximum(there.min(axis=0) - 1, 0)
    high = there.max(axis=0) + 2
    box = tuple(slice(start, end) for start, end in zip(low, high, strict=True))
    states = np.where(carriers[box], draft.states[box], draft.id_of(AIR))
    mask = carriers[box].copy()
    at = tuple((there - low).T)
    states[at], mask[at] = draft.states[tuple(cells.T)], True
    parts = touching_parts(states, draft.palette, mask)
    return bool(np.isin(parts[at], parts[carriers[box]]).any())


def _inside(draft: Draft, cell: np.ndarray) -> bool:
    return bool(((cell >= 0) & (cell < draft.states.shape)).all())

"""Floating blocks of a build: connected to their support, or removed if they are small.

A scan misses thin structures, such as the cord of a lamp, the bracket of a shelf or the foot of a
screen. Without them, the objects would float in the game.
"""

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.core.classes import OBJECT_CLASSES, STRUCTURE_CLASSES, SemanticClass
from world2minecraft.geometry.connected_components import label_components

REACH_M = 1.25  # A cord is no longer than this,
SIDE_M = 0.5  # nor a bracket than this.
STANDING = (SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA, SemanticClass.TABLE)
CRUMB_BLOCKS = 2  # A smaller piece beside an object that stands is noise.
LOWER, UPPER, WHOLE = "type=bottom", "type=top", "type=double"
CORD = "minecraft:chain[axis=y,waterlogged=false]"
# Down first: what stands on something seldom hangs; of equal gaps the first wins.
WAYS = ((0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1))


def support_floaters(canvas: Canvas) -> None:
    """Connect the floating parts of objects to a support, in place, or remove them.

    Blocks that touch by faces, edges or corners are one part. A part is connected to the nearest
    supported block in a straight line: upward by a chain, otherwise by more of its own block. If
    nothing is within reach, the part is lowered onto whatever is below it.
    """
    solid = np.isin(canvas.semantic, (*OBJECT_CLASSES, *STRUCTURE_CLASSES))
    parts, count = label_components(solid)
    structure = np.isin(canvas.semantic, STRUCTURE_CLASSES)
    carried = np.zeros(count + 1, bool)
    carried[np.unique(parts[structure])] = True
    carried[0] = False
    for number in np.flatnonzero(~carried[1:]) + 1:
        blocks = np.argwhere(parts == number)
        stands = carried[parts]
        if _is_crumb(canvas, blocks, stands) or not _join(canvas, blocks, stands, parts):
            canvas.put(tuple(blocks.T), 0, 0)
            continue
        carried[number] = True


def close_gaps(canvas: Canvas) -> None:
    """Close, in place, gaps of half a block between objects and their support.

    An object cannot begin in the upper half of a block whose lower half is a table top. A lower
    slab below the object is made a full block, and an upper slab of the object is lowered.
    """
    things = np.isin(canvas.semantic, (SemanticClass.OBJS, SemanticClass.TVS))
    on = things[:, :, 1:] & (canvas.semantic[:, :, :-1] > 0)
    on &= canvas.instance[:, :, :-1] != canvas.instance[:, :, 1:]
    _change(canvas.states[:, :, :-1], on, canvas, (LOWER, WHOLE))
    _change(canvas.states[:, :, 1:], on, canvas, (UPPER, LOWER))


def _change(states: np.ndarray, mask: np.ndarray, canvas: Canvas, kinds: tuple[str, str]) -> None:
    """Replace the slabs of a mask by another kind of slab, in place."""
    names = canvas.palette
    for number in np.unique(states[mask]).tolist():
        if kinds[0] in names[number]:
            states[mask & (states == number)] = canvas.id_of(names[number].replace(*kinds))


def _is_crumb(canvas: Canvas, blocks: np.ndarray, stands: np.ndarray) -> bool:
    """Return whether a part is small and belongs to no object, or to one supported elsewhere."""
    if len(blocks) > CRUMB_BLOCKS:
        return False
    numbers = np.unique(canvas.instance[tuple(blocks.T)])
    return bool((numbers == 0).all() or np.isin(numbers, canvas.instance[stands]).all())


def _join(canvas: Canvas, blocks: np.ndarray, stands: np.ndarray, parts: np.ndarray) -> bool:
    """Fill the shortest path from a part to a supported block; return False if there is none.

    A part that belongs on the floor gets a leg, never a bracket.
    """
    scale = canvas.lattice.blocks_per_metre
    up, aside = (max(1, round(length * scale)) for length in (REACH_M, SIDE_M))
    reach = {way: up if way[2] else aside for way in WAYS}
    down = {WAYS[0]: stands.shape[2]}
    stood = np.isin(canvas.semantic[tuple(blocks.T)], STANDING).all()
    found = None if stood else _shortest(blocks, stands, parts, reach)
    found = found or _shortest(blocks, stands, parts, down)
    if found is None:
        return False
    start, way, gap = found
    at = tuple(start.tolist())
    state = canvas.id_of(CORD) if way == WAYS[-1] else int(canvas.states[at])
    for step in range(1, gap + 1):
        place = tuple((start + np.array(way) * step).tolist())
        canvas.put(place, state, int(canvas.semantic[at]), int(canvas.instance[at]))
        parts[place] = parts[at]
    return True


def _shortest(
    blocks: np.ndarray,
    stands: np.ndarray,
    parts: np.ndarray,
    reach: dict[tuple[int, int, int], int],
) -> tuple[np.ndarray, tuple[int, int, int], int] | None:
    """Return the start block, the direction and the number of blocks of the gap, or None.

    ``reach`` contains the maximum gap in each direction; earlier directions win ties.
    """
    shape = np.array(stands.shape)
    middle = blocks.mean(axis=0)
    best: tuple[tuple[float, ...], np.ndarray, tuple[int, int, int], int] | None = None
    for order, (way, most) in enumerate(reach.items()):
        for start in blocks:
            for gap in range(1, most + 1):
                place = start + np.array(way) * (gap + 1)
                between = start + np.array(way) * gap
                if (place < 0).any() or (place >= shape).any() or parts[tuple(between)]:
                    break
                if stands[tuple(place)]:
                    off = float(np.abs(start - middle).sum())
                    key = (float(gap), float(order), off)
                    if best is None or key < best[0]:
                        best = key, start, way, gap
                    break
    return None if best is None else best[1:]

"""Which blocks inside rooms are one piece: a cupboard, a sofa, a curtain over it.

Furniture stands side by side, so blocks beside each other are of one piece only where they are the
same; blocks on one another always are, but for what hangs: curtains and pictures over a sofa.
Without the hanging ones that gave, in eight generated houses at 2 to 4 blocks a metre, 1 to 1.4
times as many pieces as there are, 85 to 96 of 100 blocks of a piece's own class; all that touches
gave half as many.
"""

import numpy as np
from scipy import ndimage, sparse
from scipy.sparse import csgraph

SHEET_M, RAISED_M = 1.2, 1.0  # Of a curtain; of one that hangs over a sofa's back.
PLATE_M = 0.66  # Pictures hang higher than seats are; two blocks of a third of a metre.
TALL_M = 1.4  # What is higher and of one height is one: wardrobes of two woods.


def pieces_of(
    held: np.ndarray,
    blocks: np.ndarray,
    sheets: np.ndarray,
    plates: np.ndarray,
    ground: np.ndarray,
    scale: float,
) -> tuple[np.ndarray, int]:
    """Number the pieces of a volume: int32 [X, Y, Z], 0 for none, and how many there are.

    Args:
        held: bool [X, Y, Z], the blocks inside that are part of some piece.
        blocks: int [X, Y, Z], which block each is, whatever its properties.
        sheets: bool [X, Y, Z], those that curtains are of.
        plates: bool [X, Y, Z], those that pictures are of.
        ground: int16 [X, Y, Z], the layer of the floor under each.
        scale: blocks per metre.
    """
    height, first = columns(blocks)
    least = np.where(first > ground + 1, RAISED_M, SHEET_M) * scale
    hangs = sheets & (height >= least - 1e-6)
    hangs |= plates & (first - ground - 1 >= PLATE_M * scale - 1e-6)
    parts, count = joined_parts(held, 2 * blocks.astype(np.int64) + hangs, hangs)
    return _abreast(parts, count, max(2, round(TALL_M * scale)))


def _abreast(parts: np.ndarray, count: int, tall: int) -> tuple[np.ndarray, int]:
    """Join tall things that touch and are of one height: the doors of a wardrobe of two woods."""
    low, high = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    for number, box in enumerate(ndimage.find_objects(parts), 1):
        if box is not None:
            low[number], high[number] = box[1].start, box[1].stop
    pairs = []
    for axis in (0, 2):
        first, second = (
            np.take(parts, np.arange(a, parts.shape[axis] - 1 + a), axis) for a in (0, 1)
        )
        met = (first > 0) & (second > 0) & (first != second)
        pairs.append(np.stack([first[met], second[met]]))
    one, other = np.unique(np.concatenate(pairs, axis=1), axis=1)
    alike = (low[one] == low[other]) & (high[one] == high[other]) & (high[one] - low[one] >= tall)
    edges = (one[alike], other[alike])
    graph = sparse.coo_matrix((np.ones(len(edges[0]), bool), edges), (count + 1, count + 1))
    found, own = csgraph.connected_components(graph, directed=False)
    order = np.zeros(found, np.int32)  # Nothing, 0, is joined to none; it keeps its number.
    order[own[0]] = 0
    rest = np.setdiff1d(np.arange(found), own[:1])
    order[rest] = np.arange(1, found)
    return order[own][parts], found - 1


def joined_parts(held: np.ndarray, blocks: np.ndarray, alone: np.ndarray) -> tuple[np.ndarray, int]:
    """Number blocks that belong together: on one another, or beside each other and the same.

    Args:
        held: bool [X, Y, Z], the blocks.
        blocks: int [X, Y, Z], which each is.
        alone: bool [X, Y, Z], those that belong to nothing else that is under or over them.

    Returns:
        int32 of the shape of ``held``, 0 outside and 1 to n inside, and n.
    """
    number = np.full(held.shape, -1, np.int64)
    number[held] = np.arange(int(held.sum()))
    pairs = []
    for axis in range(3):
        first = tuple(slice(0, -1) if a == axis else slice(None) for a in range(3))
        second = tuple(slice(1, None) if a == axis else slice(None) for a in range(3))
        joined = held[first] & held[second]
        same = blocks[first] == blocks[second]
        joined &= same | ~(alone[first] | alone[second]) if axis == 1 else same
        pairs.append(np.stack([number[first][joined], number[second][joined]]))
    edges = np.concatenate(pairs, axis=1)
    count = int(held.sum())
    graph = sparse.coo_matrix((np.ones(edges.shape[1], bool), tuple(edges)), (count, count))
    found, own = csgraph.connected_components(graph, directed=False)
    parts = np.zeros(held.shape, np.int32)
    parts[held] = own + 1
    return parts, int(found) if count else 0


def columns(blocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how many of the same block stand on one another where each is, and the lowest's layer.

    Both int [X, Y, Z].
    """
    layers = np.arange(blocks.shape[1])[None, :, None]
    begins, ends = np.ones(blocks.shape, bool), np.ones(blocks.shape, bool)
    begins[:, 1:] = blocks[:, 1:] != blocks[:, :-1]
    ends[:, :-1] = begins[:, 1:]
    first = np.maximum.accumulate(np.where(begins, layers, 0), axis=1)
    last = np.where(ends, layers, blocks.shape[1])[:, ::-1]
    return np.minimum.accumulate(last, axis=1)[:, ::-1] - first + 1, first

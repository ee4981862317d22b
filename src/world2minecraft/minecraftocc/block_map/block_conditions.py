"""Position-dependent conditions and measures for the rules of a block map.

``Context`` computes each condition in ``CONDITIONS`` when a rule first uses it. Blocks inside rooms
are segmented into pieces of furniture, which have the measures in ``MEASURES``. Furniture often
touches other furniture, so horizontally adjacent blocks belong to the same piece only if they are
the same block. Vertically adjacent blocks always belong to the same piece, except for hanging
blocks such as curtains and pictures above a sofa. In eight generated houses at 2 to 4 blocks per
metre, this found 1 to 1.4 times the true number of pieces (hanging blocks not counted), and 85 to
96 percent of the blocks of a piece had the piece's class. Joining all touching blocks found only
half of the pieces.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import ndimage, sparse
from scipy.sparse import csgraph

from world2minecraft.minecraftocc.block_map.room_detection import (
    CEILING,
    FLOOR,
    INSIDE,
    OUTSIDE,
    WALL,
    detect_zones,
    next_above,
)
from world2minecraft.minecraftocc.block_map.rules import BlockMap, Rule, Span

# A condition holds or not at a block. Zones first: a block is in one of them.
CONDITIONS = {
    "floor": "in the walkable layer of a room",
    "ceiling": "in the first layer above a room, or in a flat roof",
    "wall": "in a column between floor and ceiling that closes a room, or in a lintel",
    "inside": "between the floor and the ceiling of a room, and not a wall",
    "outside": "in none of the four zones above",
    "under_floor": "at most half a metre below a floor, with no room in between",
    "wall_line": "outside, and at most half a metre directly above or below a wall",
    "over_ceiling": "at most three metres above a ceiling, as roofs and attics are",
    "open_floor": "outside, on a walkable flat surface at least one and a half metres wide",
    "air_above": "with no block directly above",
    "air_below": "with no block directly below",
    "on_floor": "directly above a floor",
    "at_wall": "next to a wall",
    "under_ceiling": "directly below a ceiling, or below blocks that hang from one",
    "turned": "upside down, such as a stair that supports a table top",
    "coarse": "at fewer than two blocks per metre, where one block is a piece of furniture",
    "in_row": "next to a block of the same kind at the same height",
    "climbs": "next to a block of the same kind that is one block higher or lower",
}
# A condition of two words asks for the kind or class of a neighbour: "over fence".
NEIGHBOURS = {"over": (0, -1, 0), "under": (0, 1, 0)}
# Measures of the piece of furniture that a block is part of, in metres.
MEASURES = {
    "at_m": "height of the block's underside above the floor",
    "height_m": "height of the piece from its lowest to its highest block",
    "bottom_m": "height of the piece's underside above the floor",
    "top_m": "height of the piece's top above the floor",
    "long_m": "longer side of the piece's bounding box, seen from above",
    "wide_m": "shorter side of the piece's bounding box, seen from above",
    "area_m2": "area that the piece covers, seen from above",
    "filled": "fraction of the piece's bounding box that is filled, from 0 to 1",
    "open": "fraction of the piece's columns that are empty at the floor, as under a table top",
}
SHEET_M, RAISED_M = 1.2, 1.0  # Minimum height of a curtain, and of one above furniture.
PLATE_M = 0.66  # Minimum height of a picture above the floor, which is higher than seats.
TALL_M = 1.4  # Adjacent pieces of this and of equal height are one, such as a wardrobe.
UNDER_M = 0.5  # Maximum thickness of a floor, and maximum height of a wall beside it.
ROOF_M, SKY_M, WIDE_M = 3.0, 1.8, 1.5
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))
COARSE_BLOCKS_PER_METRE = 2.0  # Blocks per metre under which a chair is one block.
ZONES = {"outside": OUTSIDE, "floor": FLOOR, "ceiling": CEILING, "wall": WALL, "inside": INSIDE}


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces of furniture in a volume, with their measures.

    Attributes:
        parts: Number of the piece that each block belongs to, int32 [X, Y, Z]; 0 for none.
        measures: For each name in ``MEASURES``, its value for each piece, float64 [pieces + 1].
    """

    parts: np.ndarray
    measures: dict[str, np.ndarray]


def measure_pieces(parts: np.ndarray, count: int, ground: np.ndarray, scale: float) -> Pieces:
    """Compute the measures of pieces of furniture.

    Args:
        parts: Number of the piece that each block belongs to, int32 [X, Y, Z]; 0 for none.
        count: Number of pieces.
        ground: Layer of the floor below each block, int16 [X, Y, Z].
        scale: Blocks per metre.
    """
    found = {name: np.zeros(count + 1) for name in MEASURES if name != "at_m"}
    for number, box in enumerate(ndimage.find_objects(parts), 1):
        if box is None:
            continue
        own = parts[box] == number
        floor = int(ground[box][own].min()) + 1
        low, high = box[1].start, box[1].stop
        sides = sorted(s.stop - s.start for s in (box[0], box[2]))
        held_columns = own.any(axis=1)
        at_floor = own[:, max(0, floor - low) :][:, :1].any(axis=1) & (low <= floor)
        found["height_m"][number] = (high - low) / scale
        found["bottom_m"][number] = (low - floor) / scale
        found["top_m"][number] = (high - floor) / scale
        found["wide_m"][number], found["long_m"][number] = sides[0] / scale, sides[1] / scale
        found["area_m2"][number] = held_columns.sum() / scale**2
        found["filled"][number] = own.mean()
        found["open"][number] = (held_columns & ~at_floor).sum() / held_columns.sum()
    return Pieces(parts, found)


def kind_shares(parts: np.ndarray, kinds: np.ndarray, count: int) -> np.ndarray:
    """Return the fraction of each piece's blocks that each kind has, as [pieces + 1, count]."""
    pieces = int(parts.max(initial=0)) + 1
    inside = parts > 0
    pairs = parts[inside].astype(np.int64) * count + kinds[inside]
    counts = np.bincount(pairs, minlength=pieces * count).reshape(pieces, count)
    return counts / np.maximum(counts.sum(1, keepdims=True), 1)


def segment_pieces(
    inside: np.ndarray,
    blocks: np.ndarray,
    sheets: np.ndarray,
    plates: np.ndarray,
    ground: np.ndarray,
    scale: float,
) -> tuple[np.ndarray, int]:
    """Segment the blocks inside rooms into pieces of furniture.

    Args:
        inside: Whether each block is inside a room and part of a piece, bool [X, Y, Z].
        blocks: Number of each block's id without its properties, int [X, Y, Z].
        sheets: Whether each block can be part of a curtain, bool [X, Y, Z].
        plates: Whether each block can be part of a picture, bool [X, Y, Z].
        ground: Layer of the floor below each block, int16 [X, Y, Z].
        scale: Blocks per metre.

    Returns:
        The number of the piece that each block belongs to, int32 [X, Y, Z] with 0 for none, and the
        number of pieces.
    """
    height, first = block_columns(blocks)
    min_height = np.where(first > ground + 1, RAISED_M, SHEET_M) * scale
    hangs = sheets & (height >= min_height - 1e-6)
    hangs |= plates & (first - ground - 1 >= PLATE_M * scale - 1e-6)
    parts, count = connected_parts(inside, 2 * blocks.astype(np.int64) + hangs, hangs)
    return _merge_tall_neighbours(parts, count, max(2, round(TALL_M * scale)))


def _merge_tall_neighbours(parts: np.ndarray, count: int, tall: int) -> tuple[np.ndarray, int]:
    """Join tall adjacent pieces of the same height, such as the doors of a two-colour wardrobe."""
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
    order = np.zeros(found, np.int32)  # The number 0, for no piece, is never joined and is kept.
    order[own[0]] = 0
    rest = np.setdiff1d(np.arange(found), own[:1])
    order[rest] = np.arange(1, found)
    return order[own][parts], found - 1


def connected_parts(
    inside: np.ndarray, blocks: np.ndarray, separate: np.ndarray
) -> tuple[np.ndarray, int]:
    """Number connected groups of blocks.

    Vertically adjacent blocks are connected, and so are horizontally adjacent blocks that are the
    same.

    Args:
        inside: Blocks to number, bool [X, Y, Z].
        blocks: Number of each block's id, int [X, Y, Z].
        separate: Blocks that are not connected to different blocks above or below, bool [X, Y, Z].

    Returns:
        The group number of each block, int32 in the shape of ``inside`` (0 outside, 1 to n inside),
        and n.
    """
    number = np.full(inside.shape, -1, np.int64)
    number[inside] = np.arange(int(inside.sum()))
    pairs = []
    for axis in range(3):
        first = tuple(slice(0, -1) if a == axis else slice(None) for a in range(3))
        second = tuple(slice(1, None) if a == axis else slice(None) for a in range(3))
        joined = inside[first] & inside[second]
        same = blocks[first] == blocks[second]
        joined &= same | ~(separate[first] | separate[second]) if axis == 1 else same
        pairs.append(np.stack([number[first][joined], number[second][joined]]))
    edges = np.concatenate(pairs, axis=1)
    count = int(inside.sum())
    graph = sparse.coo_matrix((np.ones(edges.shape[1], bool), tuple(edges)), (count, count))
    found, own = csgraph.connected_components(graph, directed=False)
    parts = np.zeros(inside.shape, np.int32)
    parts[inside] = own + 1
    return parts, int(found) if count else 0


def block_columns(blocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Measure the vertical run of identical blocks that each block is part of.

    Returns:
        The height of the run in blocks and the layer of its lowest block, both int [X, Y, Z].
    """
    layers = np.arange(blocks.shape[1])[None, :, None]
    begins, ends = np.ones(blocks.shape, bool), np.ones(blocks.shape, bool)
    begins[:, 1:] = blocks[:, 1:] != blocks[:, :-1]
    ends[:, :-1] = begins[:, 1:]
    first = np.maximum.accumulate(np.where(begins, layers, 0), axis=1)
    last = np.where(ends, layers, blocks.shape[1])[:, ::-1]
    return np.minimum.accumulate(last, axis=1)[:, ::-1] - first + 1, first


def shift(values: np.ndarray, x: int, y: int, z: int) -> np.ndarray:
    """Return the neighbour of each block at the given offset, or 0 outside the volume."""
    result = np.zeros_like(values)
    cuts = [_overlap(*pair) for pair in zip((x, y, z), values.shape, strict=True)]
    result[tuple(ours for ours, _ in cuts)] = values[tuple(theirs for _, theirs in cuts)]
    return result


def _overlap(step: int, side: int) -> tuple[slice, slice]:
    low, high = min(max(0, -step), side), min(max(0, step), side)
    return slice(low, side - high), slice(high, side - low)


def _air_above(context: "Context") -> np.ndarray:
    return ~shift(context.filled, 0, 1, 0)


def _air_below(context: "Context") -> np.ndarray:
    below = ~shift(context.filled, 0, -1, 0)
    below[:, 0] = False
    return below


def _on_floor(context: "Context") -> np.ndarray:
    return shift(context.condition("floor"), 0, -1, 0)


def _at_wall(context: "Context") -> np.ndarray:
    wall = context.condition("wall")
    return np.any([shift(wall, x, 0, z) for x, z in SIDES], axis=0)


def _under_ceiling(context: "Context") -> np.ndarray:
    """Return the blocks that hang from a ceiling in a column without gaps."""
    above = context.condition("ceiling") & context.building
    hangs, layers = np.zeros_like(above), above.shape[1]
    for layer in range(layers - 2, -1, -1):
        supported = above[:, layer + 1] | hangs[:, layer + 1]
        hangs[:, layer] = supported & context.filled[:, layer] & ~above[:, layer]
    return hangs


def _same_kind_beside(context: "Context", rises: tuple[int, ...]) -> np.ndarray:
    """Return whether a horizontal neighbour, at one of the given rises, is of the same kind."""
    kinds = context.kinds
    steps = [(x, rise, z) for x, z in SIDES for rise in rises]
    near = [shift(kinds, *step) == kinds for step in steps]
    return context.filled & np.any(near, axis=0)


def _under_floor(context: "Context") -> np.ndarray:
    reach = max(1, round(UNDER_M * context.scale))
    floor, result = context.condition("floor"), np.zeros(context.filled.shape, bool)
    below = context.condition("outside") & context.building
    here = floor
    for _ in range(reach):
        here = shift(here, 0, 1, 0) & below
        result |= here
    return result


def _wall_line(context: "Context") -> np.ndarray:
    """Return the blocks that continue a wall above or below."""
    reach = max(1, round(UNDER_M * context.scale))
    wall, outside = context.condition("wall"), context.condition("outside") & context.building
    result = np.zeros_like(wall)
    for up in (1, -1):
        here = wall
        for _ in range(reach):
            here = shift(here, 0, up, 0) & outside
            result |= here
    return result


def _over_ceiling(context: "Context") -> np.ndarray:
    reach = max(2, round(ROOF_M * context.scale))
    ceiling = context.condition("ceiling")
    near = np.zeros_like(ceiling)
    for up in range(1, reach + 1):
        near |= shift(ceiling, 0, -up, 0)
    wide = ndimage.binary_dilation(
        near, np.ones((3, 1, 3)), iterations=max(1, round(context.scale))
    )
    return np.asarray(wide) & context.condition("outside")


def _open_floor(context: "Context") -> np.ndarray:
    layers = np.arange(context.filled.shape[1])[None, :, None]
    head = max(2, round(SKY_M * context.scale))
    stands = context.building & (next_above(context.building) - layers > head)
    side = max(2, round(WIDE_M * context.scale))
    wide = ndimage.binary_opening(stands, np.ones((side, 1, side)))
    return np.asarray(wide) & context.condition("outside")


CONDITION_MASKS: dict[str, Callable[["Context"], np.ndarray]] = {
    "under_floor": _under_floor,
    "wall_line": _wall_line,
    "over_ceiling": _over_ceiling,
    "open_floor": _open_floor,
    "air_above": _air_above,
    "air_below": _air_below,
    "on_floor": _on_floor,
    "at_wall": _at_wall,
    "under_ceiling": _under_ceiling,
    "in_row": lambda context: _same_kind_beside(context, (0,)),
    "climbs": lambda context: _same_kind_beside(context, (1, -1)),
}


class Context:
    """The surroundings of each block in a volume, used to check the rules of a block map.

    Args:
        kinds: Number of each block's class or kind, int [X, Y, Z]; 0 is air.
        names: Class or kind name for each number.
        rules: Block map that defines the kinds for structure, curtains and pictures.
        blocks: Number of each block's id, int [X, Y, Z].
        turned: Whether each block is upside down, bool [X, Y, Z].
        scale: Blocks per metre.
    """

    def __init__(
        self,
        kinds: np.ndarray,
        names: tuple[str, ...],
        rules: BlockMap,
        blocks: np.ndarray,
        turned: np.ndarray,
        scale: float,
    ):
        self.kinds, self.names, self.scale = kinds, names, scale
        self.filled = ~self._are(("empty",))[kinds]
        self.building = self._are(rules.structure)[kinds]
        self.zones = detect_zones(self.building, scale)
        ground = self.zones.ground
        inside = self.filled & (self.zones.zone == INSIDE) & ~self._are(rules.apart)[kinds]
        sheets, plates = self._are(rules.sheets)[kinds], self._are(rules.plates)[kinds]
        parts, count = segment_pieces(inside, blocks, sheets, plates, ground, scale)
        self.pieces = measure_pieces(parts, count, ground, scale)
        self.shares = kind_shares(self.pieces.parts, kinds, len(names))
        self._found: dict[str, np.ndarray] = {
            "turned": turned,
            "coarse": np.full(kinds.shape, scale < COARSE_BLOCKS_PER_METRE),
        }

    def holds(self, rule: Rule, at: np.ndarray) -> np.ndarray:
        """Return whether a rule applies to each block in a list of flat indices, bool [N]."""
        result = np.ones(len(at), bool)
        for name in rule.where:
            truth = self.condition(name.removeprefix("not ")).ravel()[at]
            result &= ~truth if name.startswith("not ") else truth
        if rule.spans or rule.shares:
            parts = self.pieces.parts.ravel()[at]
            result &= parts > 0
            for name, span in rule.spans.items():
                own = name == "at_m"
                values = self._at_m(at) if own else self.pieces.measures[name][parts]
                result &= _in_span(values, span)
            for name, span in rule.shares.items():
                share = self.shares[:, self._are((name,))].sum(1)
                result &= _in_span(share, span)[parts]
        return result

    def _at_m(self, at: np.ndarray) -> np.ndarray:
        """Return the height of blocks above their floor in metres."""
        layer = np.unravel_index(at, self.kinds.shape)[1]
        return (layer - self.zones.ground.ravel()[at] - 1) / self.scale

    def condition(self, name: str) -> np.ndarray:
        """Return whether the condition with this name is true for each block, bool [X, Y, Z]."""
        if name in ZONES:
            return self.zones.zone == ZONES[name]
        if name not in self._found:
            side, _, other = name.partition(" ")
            if other:
                own = self._are((other,))[self.kinds]
                self._found[name] = shift(own, *NEIGHBOURS[side])
            else:
                self._found[name] = CONDITION_MASKS[name](self)
        return self._found[name]

    def _are(self, names: frozenset[str] | tuple[str, ...]) -> np.ndarray:
        """Return whether the name of each kind is in ``names``, bool [kinds]."""
        return np.array([name in names for name in self.names])


def _in_span(values: np.ndarray, span: Span) -> np.ndarray:
    return (values >= span[0] - 1e-9) & (values <= span[1] + 1e-9)

"""The garden around a house: a lawn that ends at a hedge, a path to the front door, beds and trees.

Its blocks have the unknown class because they are not part of any room.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.procgen.worlds.block_house import BlockHouse
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.exterior import outer_walls, outward
from world2minecraft.procgen.worlds.wares_and_stands import WareDeck

DEEP_M = 2.75  # Distance from the inner face of the outer walls to the hedge, in metres.
HEDGE_M = 1.1
PLANTED = 0.5  # Share of the beds below windows, where most plants are,
HEDGE_SHARE = 0.3  # and how much less of the ground before the hedge.
TREES_A_HOUSE = 5


@dataclass(frozen=True)
class Garden:
    """A kind of garden: its ground, path, hedge and trees, and the share of beds with plants."""

    ground: str
    path: str
    hedge: str
    trunk: str
    crown: str
    planted: float = PLANTED


GARDENS: dict[str, Garden] = {
    "lawn": Garden(
        "grass_block", "gravel", "oak_leaves[persistent=true]", "oak_log[axis=y]",
        "oak_leaves[persistent=true]",
    ),
    "birch": Garden(
        "grass_block", "andesite", "flowering_azalea_leaves[persistent=true]",
        "birch_log[axis=y]", "birch_leaves[persistent=true]",
    ),
    "jungle": Garden(
        "moss_block", "packed_mud", "jungle_leaves[persistent=true]", "jungle_log[axis=y]",
        "jungle_leaves[persistent=true]", 0.8,
    ),
    "blossom": Garden(
        "grass_block", "smooth_stone", "azalea_leaves[persistent=true]", "cherry_log[axis=y]",
        "cherry_leaves[persistent=true]", 0.7,
    ),
    "taiga": Garden(
        "grass_block", "coarse_dirt", "spruce_leaves[persistent=true]", "spruce_log[axis=y]",
        "spruce_leaves[persistent=true]",
    ),
    "snow": Garden(
        "snow_block", "stone_bricks", "spruce_leaves[persistent=true]", "spruce_log[axis=y]",
        "spruce_leaves[persistent=true]", 0.1,
    ),
    "desert": Garden(
        "sand", "cut_sandstone", "sandstone_wall", "stripped_acacia_log[axis=y]",
        "acacia_leaves[persistent=true]", 0.2,
    ),
    "mesa": Garden(
        "red_sand", "cut_red_sandstone", "red_sandstone_wall", "acacia_log[axis=y]",
        "acacia_leaves[persistent=true]", 0.2,
    ),
    "swamp": Garden(
        "moss_block", "mud_bricks", "mangrove_leaves[persistent=true]", "mangrove_log[axis=y]",
        "mangrove_leaves[persistent=true]", 0.7,
    ),
    "dark wood": Garden(
        "podzol", "cobblestone", "dark_oak_leaves[persistent=true]", "dark_oak_log[axis=y]",
        "dark_oak_leaves[persistent=true]",
    ),
    "crimson": Garden(
        "crimson_nylium", "polished_blackstone", "nether_brick_fence", "crimson_stem[axis=y]",
        "nether_wart_block", 0.4,
    ),
    "warped": Garden(
        "warped_nylium", "polished_deepslate", "warped_fence", "warped_stem[axis=y]",
        "warped_wart_block", 0.4,
    ),
    "end": Garden(
        "end_stone", "purpur_block", "end_stone_brick_wall", "purpur_pillar[axis=y]",
        "purpur_block", 0.2,
    ),
    "yard": Garden(
        "grass_block", "stone_bricks", "cobblestone_wall", "oak_log[axis=y]",
        "oak_leaves[persistent=true]", 0.3,
    ),
}  # fmt: skip
SUITS: dict[str, tuple[str, ...]] = {
    "nether": ("crimson",), "warped": ("warped",), "end": ("end",), "polar": ("snow", "taiga"),
    "desert": ("desert", "mesa"), "savanna": ("mesa", "desert"), "tropical": ("jungle", "swamp"),
    "rose": ("blossom",), "japanese": ("blossom", "yard"), "castle": ("yard", "dark wood"),
    "autumn": ("mesa", "dark wood"), "forest": ("taiga", "dark wood", "lawn"),
    "night club": ("yard",), "loft": ("yard", "lawn"), "copper works": ("yard",),
    "mediterranean": ("desert", "lawn"), "ocean": ("desert", "lawn"),
}  # fmt: skip
ANYWHERE = ("lawn", "birch", "blossom", "taiga")


def garden_blocks(blocks_per_metre: float) -> int:
    """Return the depth of a garden in blocks, including the wall in front of it and the hedge."""
    return max(4, round(DEEP_M * blocks_per_metre))


def draw_garden(style: str, rng: np.random.Generator) -> Garden:
    """Choose a random garden that suits a style of houses."""
    names = SUITS.get(style, ANYWHERE)
    return GARDENS[names[int(rng.integers(len(names)))]]


def put_garden(
    canvas: WorldCanvas, house: BlockHouse, garden: Garden, deck: WareDeck, rng: np.random.Generator
) -> None:
    """Add a lawn, a path, a hedge and beds around a house whose outer walls exist."""
    level = canvas.at(0, 0, 0)[2]
    built, path = outer_walls(canvas, house, 0), _path(canvas, house)
    x, y = np.nonzero(~built)
    state = np.where(path[x, y], garden.path, garden.ground)
    for block in (garden.path, garden.ground):
        own = state == block
        at = (x[own], y[own], np.full(int(own.sum()), level - 1))
        canvas.set(at, f"minecraft:{block}", UNKNOWN)
    below = (x, y, np.full(len(x), level - 2))  # Sand and gravel would fall.
    canvas.set(below, "minecraft:stone", UNKNOWN)
    _put_hedge(canvas, garden, house, path)
    _plant_beds(canvas, house, garden, path, deck, rng)


def _path(canvas: WorldCanvas, house: BlockHouse) -> np.ndarray:
    """Return the columns from the front doors straight to the hedge, as bool [X, Y]."""
    columns = np.zeros(canvas.states.shape[:2], bool)
    for gap in house.gaps:
        if gap.kind == "window" or len(gap.rooms) != 1:
            continue
        x, y = (
            slice(a + canvas.margin, b + canvas.margin)
            for a, b in zip(gap.low, gap.high, strict=True)
        )
        sides = [x, y]
        across, out = gap.turn % 2, outward(gap)
        sides[across] = (
            slice(sides[across].stop, None) if out > 0 else slice(0, sides[across].start)
        )
        columns[tuple(sides)] = True
    return columns & ~outer_walls(canvas, house, 0)


def _put_hedge(canvas: WorldCanvas, garden: Garden, house: BlockHouse, path: np.ndarray) -> None:
    """Set a hedge around the garden, with a gap at the end of the path."""
    high = max(1, round(HEDGE_M * house.blocks_per_metre))
    level = canvas.at(0, 0, 0)[2]
    rim = np.zeros(canvas.states.shape[:2], bool)
    rim[[0, -1]] = rim[:, [0, -1]] = True
    for z in range(level, level + high):
        canvas.set((*np.nonzero(rim & ~path), z), f"minecraft:{garden.hedge}", UNKNOWN)


def _plant_beds(
    canvas: WorldCanvas,
    house: BlockHouse,
    garden: Garden,
    path: np.ndarray,
    deck: WareDeck,
    rng: np.random.Generator,
) -> None:
    """Place plants along the house and, fewer, along the hedge, each with its own soil."""
    level = canvas.at(0, 0, 0)[2]
    near = np.asarray(ndimage.distance_transform_cdt(~outer_walls(canvas, house, 0), "chessboard"))
    share = np.where(near == 1, garden.planted, 0.0)
    share[1:-1, [1, -2]] = share[[1, -2], 1:-1] = HEDGE_SHARE * garden.planted
    share[np.asarray(ndimage.binary_dilation(path, np.ones((3, 3))), bool)] = 0
    share[[0, -1]] = share[:, [0, -1]] = 0
    for x, y in np.argwhere(rng.random(share.shape) < share).tolist():
        ware = deck.deal("soil")
        cells = slice(level, level + max(1, len(ware.states) - 1))
        if canvas.states[x, y, cells].any():
            continue
        for n, state in enumerate(ware.turned("south")):
            canvas.set((x, y, level - 1 + n), state, UNKNOWN)


def plant_trees(
    canvas: WorldCanvas, house: BlockHouse, garden: Garden, rng: np.random.Generator
) -> None:
    """Place trees with round crowns on the lawn, clear of the path, the house and its roof."""
    scale, level = house.blocks_per_metre, canvas.at(0, 0, 0)[2]
    radius, trunk = max(1, round(0.7 * scale)), max(2, round(1.6 * scale))
    top = canvas.states.shape[2]
    if len(house.grounds) > 1:  # Views that set storeys apart would cut through taller trees.
        top = level + house.height
    taken = canvas.states[:, :, level:].any(axis=2) | _path(canvas, house)
    inner = np.zeros(taken.shape, bool)
    inner[1 + radius : -1 - radius, 1 + radius : -1 - radius] = True
    places = np.argwhere(inner & ~taken)
    left = TREES_A_HOUSE
    for x, y in places[rng.permutation(len(places))].tolist():
        high = min(trunk + int(rng.integers(2 * radius)), top - level - radius - 1)
        box = (slice(x - radius, x + radius + 1), slice(y - radius, y + radius + 1))
        if left == 0:
            return
        if high < 2 or canvas.states[(*box, slice(level, None))].any() or taken[x, y]:
            continue
        left -= 1
        canvas.set((x, y, slice(level, level + high)), f"minecraft:{garden.trunk}", UNKNOWN)
        dx, dy, dz = np.indices((2 * radius + 1,) * 3) - radius
        ball = np.argwhere(dx**2 + dy**2 + dz**2 <= (radius + 0.3) ** 2) - radius
        at = ball + np.array([x, y, level + high - 1])
        at = at[(at[:, 2] < top) & (at[:, 2] >= level)]
        free = canvas.states[tuple(at.T)] == 0
        canvas.set(tuple(at[free].T), f"minecraft:{garden.crown}", UNKNOWN)

"""The garden around a house, which is visible through the windows and ends at a hedge.

Its blocks have the unknown class because they are not part of any room.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.procgen.worlds.block_house import BlockHouse
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.wares_and_stands import WareDeck

DEEP_M = 2.5  # Distance from the outer wall to the hedge, in metres.
HEDGE_M = 1.3
PLANTED = 0.06  # Share of the ground.
TREES_A_HOUSE = 7


@dataclass(frozen=True)
class Garden:
    """A kind of garden, with its ground, hedge, trees and share of planted ground."""

    ground: tuple[str, ...]
    hedge: str
    trunk: str
    crown: str
    planted: float = PLANTED


GARDENS: dict[str, Garden] = {
    "lawn": Garden(
        ("grass_block", "grass_block", "moss_block"), "oak_leaves[persistent=true]",
        "oak_log[axis=y]", "oak_leaves[persistent=true]",
    ),
    "birch": Garden(
        ("grass_block", "podzol"), "flowering_azalea_leaves[persistent=true]",
        "birch_log[axis=y]", "birch_leaves[persistent=true]",
    ),
    "jungle": Garden(
        ("grass_block", "moss_block", "rooted_dirt"), "jungle_leaves[persistent=true]",
        "jungle_log[axis=y]", "jungle_leaves[persistent=true]", 0.12,
    ),
    "blossom": Garden(
        ("grass_block",), "azalea_leaves[persistent=true]", "cherry_log[axis=y]",
        "cherry_leaves[persistent=true]", 0.1,
    ),
    "taiga": Garden(
        ("podzol", "coarse_dirt", "grass_block"), "spruce_leaves[persistent=true]",
        "spruce_log[axis=y]", "spruce_leaves[persistent=true]",
    ),
    "snow": Garden(
        ("snow_block",), "spruce_leaves[persistent=true]", "spruce_log[axis=y]",
        "snow_block", 0.01,
    ),
    "desert": Garden(
        ("sand", "sand", "smooth_sandstone"), "sandstone_wall", "stripped_acacia_log[axis=y]",
        "acacia_leaves[persistent=true]", 0.02,
    ),
    "mesa": Garden(
        ("red_sand", "terracotta", "coarse_dirt"), "red_sandstone_wall", "acacia_log[axis=y]",
        "acacia_leaves[persistent=true]", 0.03,
    ),
    "swamp": Garden(
        ("mud", "grass_block", "muddy_mangrove_roots"), "mangrove_leaves[persistent=true]",
        "mangrove_log[axis=y]", "mangrove_leaves[persistent=true]", 0.1,
    ),
    "dark wood": Garden(
        ("podzol", "mycelium", "grass_block"), "dark_oak_leaves[persistent=true]",
        "dark_oak_log[axis=y]", "dark_oak_leaves[persistent=true]",
    ),
    "crimson": Garden(
        ("crimson_nylium", "netherrack"), "nether_brick_fence", "crimson_stem[axis=y]",
        "nether_wart_block", 0.05,
    ),
    "warped": Garden(
        ("warped_nylium", "soul_soil"), "warped_fence", "warped_stem[axis=y]",
        "warped_wart_block", 0.05,
    ),
    "end": Garden(
        ("end_stone",), "end_stone_brick_wall", "purpur_pillar[axis=y]", "purpur_block", 0.02,
    ),
    "yard": Garden(
        ("stone", "gravel", "andesite"), "cobblestone_wall", "oak_log[axis=y]",
        "oak_leaves[persistent=true]", 0.03,
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


def put_garden(
    canvas: WorldCanvas, house: BlockHouse, style: str, deck: WareDeck, rng: np.random.Generator
) -> str:
    """Add a garden around a house whose shell exists, and return the kind of garden."""
    names = SUITS.get(style, ANYWHERE)
    name = names[int(rng.integers(len(names)))]
    garden, level = GARDENS[name], canvas.at(0, 0, 0)[2]
    open_air = canvas.states[:, :, level - 1] == 0
    rooms = np.pad(np.any([room.floor(house.size) for room in house.rooms], axis=0), canvas.margin)
    built = ndimage.binary_dilation(rooms, np.ones((3, 3), bool)) | ~open_air
    x, y = np.nonzero(~built)
    kinds = rng.integers(len(garden.ground), size=len(x))
    for number, block in enumerate(garden.ground):
        own = kinds == number
        at = (x[own], y[own], np.full(int(own.sum()), level - 1))
        canvas.set(at, f"minecraft:{block}", UNKNOWN)
    below = (x, y, np.full(len(x), level - 2))  # Sand and gravel would fall.
    canvas.set(below, "minecraft:stone", UNKNOWN)
    _put_hedge(canvas, garden, house, level)
    away = np.asarray(ndimage.distance_transform_cdt(~built, "chessboard"))
    _plant_trees(canvas, garden, away, level, house, rng)
    _plant(canvas, garden, away, level, deck, rng)
    return name


def _put_hedge(canvas: WorldCanvas, garden: Garden, house: BlockHouse, level: int) -> None:
    high = max(1, round(HEDGE_M * house.blocks_per_metre))
    rim = np.zeros(canvas.states.shape[:2], bool)
    rim[[0, -1]] = rim[:, [0, -1]] = True
    for z in range(level, level + high):
        canvas.set((*np.nonzero(rim), z), f"minecraft:{garden.hedge}", UNKNOWN)


def _plant_trees(
    canvas: WorldCanvas,
    garden: Garden,
    away: np.ndarray,
    level: int,
    house: BlockHouse,
    rng: np.random.Generator,
) -> None:
    """Place trees with round crowns where they do not hide a whole window."""
    scale = house.blocks_per_metre
    radius, trunk = max(1, round(0.7 * scale)), max(2, round(1.6 * scale))
    inner = np.zeros_like(away, bool)
    inner[1 + radius : -1 - radius, 1 + radius : -1 - radius] = True
    places = np.argwhere((away > radius + 1) & inner)
    top = canvas.states.shape[2]
    for x, y in places[rng.permutation(len(places))[:TREES_A_HOUSE]].tolist():
        high = min(trunk + int(rng.integers(2 * radius)), top - level - radius - 1)
        box = (slice(x - radius, x + radius + 1), slice(y - radius, y + radius + 1))
        if high < 2 or canvas.states[(*box, slice(level, top))].any():
            continue
        canvas.set((x, y, slice(level, level + high)), f"minecraft:{garden.trunk}", UNKNOWN)
        dx, dy, dz = np.indices((2 * radius + 1,) * 3) - radius
        ball = np.argwhere(dx**2 + dy**2 + dz**2 <= (radius + 0.3) ** 2) - radius
        at = ball + np.array([x, y, level + high - 1])
        at = at[(at[:, 2] < top) & (at[:, 2] >= level)]
        free = canvas.states[tuple(at.T)] == 0
        canvas.set(tuple(at[free].T), f"minecraft:{garden.crown}", UNKNOWN)


def _plant(
    canvas: WorldCanvas,
    garden: Garden,
    away: np.ndarray,
    level: int,
    deck: WareDeck,
    rng: np.random.Generator,
) -> None:
    """Place plants, each with its own soil in the ground."""
    places = np.argwhere(away > 0)
    count = round(garden.planted * len(places))
    for x, y in places[rng.permutation(len(places))[:count]].tolist():
        ware = deck.deal("soil")
        cells = slice(level, level + max(1, len(ware.states) - 1))
        if canvas.states[x, y, cells].any():
            continue
        for n, state in enumerate(ware.turned("south")):
            canvas.set((x, y, level - 1 + n), state, UNKNOWN)

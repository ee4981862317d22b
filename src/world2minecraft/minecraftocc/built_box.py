"""Where in a world somebody has built: the box of blocks that no world grows by itself.

The chunks around the spawn are asked first, by the list of states that each section of theirs
begins with; then all others, up to a number.
"""

import re
from collections.abc import Iterable
from fnmatch import translate
from pathlib import Path

import numpy as np

from world2minecraft.formats.build_source import around_spawn, spawn_of
from world2minecraft.formats.volume_crop import Box
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraft.worlds.anvil import read_region
from world2minecraft.minecraft.worlds.chunks import read_chunk
from world2minecraft.minecraft.worlds.world_reader import read_level, region_files

SECTION = 16
NEAR = 6  # Chunks from the spawn within which a build counts as the one that is meant: 96 blocks.
MOST_CHUNKS = 6144  # About half a minute of reading; six regions.
MOST_SIDE = 320  # Blocks; what is larger is cut around the middle of what was built.
MARGIN = 2
# By parts of names: what players build of, and what no landscape, ore or plant is.
BUILT = (
    "*_planks", "*_stairs", "*_slab", "*_concrete", "*_wool", "*_carpet", "*_bed", "*_door",
    "*glass", "*glass_pane", "*_terracotta", "smooth_*", "quartz_*", "polished_*_slab", "bricks",
    "*_bricks", "*_trapdoor", "*_fence", "bookshelf", "*_banner", "*_sign", "stripped_*", "iron_*",
    "sea_lantern", "flower_pot", "potted_*", "polished_*",
)  # fmt: skip
# ... but these stand in mines and ruins too: they go on with a build, and alone are none.
WILD = ("oak_planks", "oak_fence", "rail", "mossy_stone_bricks", "stone_bricks")
_BUILT = re.compile("|".join(translate(pattern) for pattern in BUILT))
LEAST = 3  # Kinds of built blocks that some section of a build must have.


def built_box(world: Path) -> tuple[Box, str]:
    """Return the box of what was built in a world, and a sentence that says so.

    Where nothing looks built, the blocks around the spawn are returned.

    Raises:
        InputError: it is no world. DamagedFileError: a file of it is broken.
    """
    spawn = spawn_of(read_level(world))
    sections, was_cut = _built_sections(world, (spawn[0] >> 4, spawn[2] >> 4))
    if max(sections.values(), default=0) < LEAST:
        box, _ = around_spawn(world)
        return box, (
            "nothing in this world looks built, so the blocks around its spawn are taken; "
            "--box x0 y0 z0 x1 y1 z1 chooses others"
        )
    box = _box_of(_group(sections, spawn))
    told = " ".join(str(value) for value in box)
    more = (
        f"; only the {MOST_CHUNKS:,} chunks nearest to the spawn were searched" if was_cut else ""
    )
    return box, f"this world has no scene.json: taking what looks built, --box {told}{more}"


def is_built(state: str) -> bool:
    """Whether a block state is one that players build of, or a mod's.

    Example:
        >>> is_built("minecraft:white_concrete"), is_built("minecraft:stone")
        (True, False)
    """
    if state.partition(":")[0] != "minecraft":
        return True
    name = _name(state)
    return name not in WILD and bool(_BUILT.match(name))


def _name(state: str) -> str:
    return state.partition("[")[0].partition(":")[2]


def _built_sections(
    world: Path, spawn: tuple[int, int]
) -> tuple[dict[tuple[int, int, int], int], bool]:
    """Return the built kinds of each section that has some, nearest regions first."""
    found: dict[tuple[int, int, int], int] = {}
    known: dict[bytes, str] = {}
    built: dict[str, bool] = {}
    searched = 0
    for path in sorted(region_files(world), key=lambda one: _distance(one, spawn)):
        for place, data in read_region(path):
            searched += 1
            if searched > MOST_CHUNKS:
                return found, True
            _, sections = read_chunk(data, place, path, known)
            for section in sections:
                count = sum(_asked(state, built) for state in section.palette)
                if count or any(_name(state) in WILD for state in section.palette):
                    found[section.place] = count
    return found, False


def _asked(state: str, built: dict[str, bool]) -> bool:
    if state not in built:
        built[state] = is_built(state)
    return built[state]


def _distance(region: Path, spawn: tuple[int, int]) -> tuple[float, str]:
    """Return how far a region's middle is from the spawn, in chunks."""
    numbers = re.fullmatch(r"r\.(-?\d+)\.(-?\d+)\.mca", region.name)
    x, z = (int(n) * 32 + 16 for n in numbers.groups()) if numbers else (1 << 20, 1 << 20)
    return float(np.hypot(x - spawn[0], z - spawn[1])), region.name


def _group(
    sections: dict[tuple[int, int, int], int], spawn: tuple[int, int, int]
) -> Iterable[tuple[int, int, int]]:
    """Return the sections of the build that is meant: near the spawn if any is, else the largest.

    Sections that touch, or have one between them, are one build.
    """
    places = np.array(sorted(sections))
    low = places.min(axis=0)
    size = np.minimum((places.max(axis=0) - low) // 2 + 1, 4096)
    halves = np.minimum((places - low) // 2, size - 1)
    grid = np.zeros(tuple(size.tolist()), bool)
    grid[tuple(halves.T)] = True
    parts, count = label_components(grid)
    own = parts[tuple(halves.T)]
    weight = np.array([sections[tuple(place)] for place in places.tolist()])
    sums = np.bincount(own, weight, minlength=count + 1)
    middle = np.array([spawn[0] >> 4, spawn[2] >> 4])
    is_meant = weight >= LEAST
    near = is_meant & (np.abs(places[:, [0, 2]] - middle).max(axis=1) <= NEAR)
    candidates = np.unique(own[near if near.any() else is_meant])
    best = int(candidates[np.argmax(sums[candidates])])
    return [tuple(place) for place in places[own == best].tolist()]


def _box_of(places: Iterable[tuple[int, int, int]]) -> Box:
    held = np.array(list(places))
    low, high = held.min(axis=0) * SECTION - MARGIN, (held.max(axis=0) + 1) * SECTION + MARGIN
    middle = (low + high) // 2
    low = np.maximum(low, middle - MOST_SIDE // 2)
    high = np.minimum(high, middle + MOST_SIDE // 2)
    x0, y0, z0 = (int(value) for value in low)
    x1, y1, z1 = (int(value) for value in high)
    return x0, y0, z0, x1, y1, z1

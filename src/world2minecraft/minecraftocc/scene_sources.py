"""Open any place that holds blocks as a scene of a data set: blocks, classes and designs.

In: a run's folder, a generated world, a world of anyone, a schematic. Files beside the blocks say
what they are (``scene.json``, ``scene.npz``); without them, a block map decides.

In a world of others the box that somebody has built is searched for: in the chunks around the spawn
first, by the palette of each of their sections, then in all others, up to a number.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import translate
from functools import cached_property
from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.build_reader import (
    BuildSource,
    box_around_spawn,
    level_spawn,
    read_build,
)
from world2minecraft.formats.volume_crop import Box
from world2minecraft.formats.volume_formats import overlapping_cells, read_run_templates
from world2minecraft.formats.world_labels import read_scene
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraft.worlds.anvil import read_region
from world2minecraft.minecraft.worlds.chunks import read_chunk
from world2minecraft.minecraft.worlds.world_reader import read_level, region_files
from world2minecraft.minecraftocc.block_map import BlockMap, classify, load_block_map, remap_labels
from world2minecraft.minecraftocc.block_map.parser import MAPS
from world2minecraft.minecraftocc.labels.fine_classes import map_fine_classes

SECTION = 16
# Chunks from the spawn within which a build counts as the one that is meant: 96 blocks.
NEAR_CHUNKS = 6
MAX_CHUNKS = 6144  # About half a minute of reading; six regions.
MAX_SIDE = 320  # Blocks; what is larger is cut around the middle of what was built.
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
MIN_BUILT_KINDS = 3  # Kinds of built blocks that some section of a build must have.
FOREIGN_SCALE = 1.0  # Blocks per metre of worlds that do not say theirs: players build so.
OWN_MAP = MAPS[0]  # The map that our own truth is by.
_FIRST = ("build", "world")  # Names of folders that say nothing of the scene.


def find_built_box(world: Path) -> tuple[Box, str]:
    """Return the box of what was built in a world, and a sentence that says so.

    Where nothing looks built, the blocks around the spawn are returned.

    Raises:
        InputError: it is no world. DamagedFileError: a file of it is broken.
    """
    spawn = level_spawn(read_level(world))
    sections, was_cut = _built_sections(world, (spawn[0] >> 4, spawn[2] >> 4))
    if max(sections.values(), default=0) < MIN_BUILT_KINDS:
        box, _ = box_around_spawn(world)
        return box, (
            "nothing in this world looks built, so the blocks around its spawn are taken; "
            "--box x0 y0 z0 x1 y1 z1 chooses others"
        )
    box = _box_of(_main_build(sections, spawn))
    corners = " ".join(str(value) for value in box)
    more = f"; only the {MAX_CHUNKS:,} chunks nearest to the spawn were searched" if was_cut else ""
    return box, f"this world has no scene.json: taking what looks built, --box {corners}{more}"


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
            if searched > MAX_CHUNKS:
                return found, True
            _, sections = read_chunk(data, place, path, known)
            for section in sections:
                count = sum(_is_built_cached(state, built) for state in section.palette)
                if count or any(_name(state) in WILD for state in section.palette):
                    found[section.place] = count
    return found, False


def _is_built_cached(state: str, built: dict[str, bool]) -> bool:
    if state not in built:
        built[state] = is_built(state)
    return built[state]


def _distance(region: Path, spawn: tuple[int, int]) -> tuple[float, str]:
    """Return how far a region's middle is from the spawn, in chunks."""
    numbers = re.fullmatch(r"r\.(-?\d+)\.(-?\d+)\.mca", region.name)
    x, z = (int(n) * 32 + 16 for n in numbers.groups()) if numbers else (1 << 20, 1 << 20)
    return float(np.hypot(x - spawn[0], z - spawn[1])), region.name


def _main_build(
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
    is_meant = weight >= MIN_BUILT_KINDS
    near = is_meant & (np.abs(places[:, [0, 2]] - middle).max(axis=1) <= NEAR_CHUNKS)
    candidates = np.unique(own[near if near.any() else is_meant])
    best = int(candidates[np.argmax(sums[candidates])])
    return [tuple(place) for place in places[own == best].tolist()]


def _box_of(places: Iterable[tuple[int, int, int]]) -> Box:
    sections = np.array(list(places))
    low, high = (
        sections.min(axis=0) * SECTION - MARGIN,
        (sections.max(axis=0) + 1) * SECTION + MARGIN,
    )
    middle = (low + high) // 2
    low = np.maximum(low, middle - MAX_SIDE // 2)
    high = np.minimum(high, middle + MAX_SIDE // 2)
    x0, y0, z0 = (int(value) for value in low)
    x1, y1, z1 = (int(value) for value in high)
    return x0, y0, z0, x1, y1, z1


def read_designs(folder: Path | None, volume: BlockVolume) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the design of each block of a volume, uint16 [X, Y, Z], and their names.

    Number 0 stands for none; its name is empty.

    Args:
        folder: that of the ``scene.json``, or None.
        volume: the blocks.

    Raises:
        DamagedFileError: designs are there and cannot be read.
    """
    none = np.zeros(volume.states.shape, np.uint16)
    if folder is None or not (folder / "scene.npz").is_file():
        return none, ("",)
    scene = read_scene(folder)
    if scene.design is not None:
        ours, theirs = overlapping_cells(volume, scene)
        none[ours] = np.where(volume.states[ours] > 0, scene.design[theirs], 0)
        return none, scene.designs
    return _designs_of_run(volume, read_run_templates(folder.parent))


def _designs_of_run(
    volume: BlockVolume, templates: Mapping[int, str]
) -> tuple[np.ndarray, tuple[str, ...]]:
    names = ("", *sorted(set(templates.values())))
    highest = max([int(volume.instance.max(initial=0)), *templates])
    table = np.zeros(highest + 1, np.uint16)
    for number, template in templates.items():
        table[number] = names.index(template)
    return np.where(volume.states > 0, table[volume.instance], 0).astype(np.uint16), names


@dataclass(frozen=True)
class SceneSource:
    """A scene that is read when it is asked for; it can be sent to another process.

    Labels are the truth where there is one, and by the block map where not. By another map than
    ``nyu`` the truth is mapped too, as far as blocks and designs tell.
    """

    path: Path
    scene_id: str
    block_map: str = OWN_MAP
    box: Box | None = None
    blocks_per_metre: float | None = None
    _cache: dict = field(default_factory=dict, repr=False, compare=False, hash=False)

    def __getstate__(self) -> dict:
        """Leave out what was read: each process reads for itself."""
        return {
            key: value for key, value in self.__dict__.items() if key[0] != "_" and key != "rules"
        }

    def __setstate__(self, state: dict) -> None:
        """Take what was sent."""
        self.__dict__.update(state, _cache={})

    @cached_property
    def rules(self) -> BlockMap:
        """The block map."""
        return load_block_map(self.block_map)

    def volume(self) -> BlockVolume:
        """Return the blocks with a class each; the same volume each time.

        Raises:
            InputError: it cannot be read, or holds air alone. UsageError: the box lies beside it.
        """
        if "volume" not in self._cache:
            self._cache["volume"] = self._labelled()
        return self._cache["volume"]

    def designs(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """Return which furniture design each block is part of: uint16 [X, Y, Z], and the names.

        Number 0 stands for none; its name is empty. Worlds of others have no designs.
        """
        if "designs" not in self._cache:
            source = self._read()
            self._cache["designs"] = read_designs(source.folder, source.volume)
        return self._cache["designs"]

    def start(self) -> tuple[float, float, float] | None:
        """Return where its player starts, the feet in world blocks; None where it does not say."""
        start = self._read().start
        return None if start is None else (start.x, start.y, start.z)

    def has_truth(self) -> bool:
        """Whether classes lie beside the blocks, rather than being told by the map alone."""
        return bool(self._read().volume.semantic.any())

    def notes(self) -> list[str]:
        """Return what was chosen for the user, in sentences."""
        return self._read().notes

    def _read(self) -> BuildSource:
        if "source" not in self._cache:
            source = read_build(self.path, self.box, choose=find_built_box)
            if source.folder is None or self.blocks_per_metre is not None:
                source.volume = _with_scale(source.volume, self.blocks_per_metre or FOREIGN_SCALE)
            self._cache["source"] = source
        return self._cache["source"]

    def _labelled(self) -> BlockVolume:
        volume = self._read().volume
        if not volume.semantic.any():
            return classify(volume, self.rules)
        volume = classify_unlabelled(volume, self.rules)
        if self.block_map == OWN_MAP:
            return volume
        names = map_fine_classes(volume, self.designs())
        fine = names.of_cells(np.arange(volume.states.size)).reshape(volume.states.shape)
        return replace(
            volume, semantic=remap_labels(volume.semantic, fine, names.classes, self.rules)
        )


def open_scene_source(
    path: str | Path,
    *,
    box: Sequence[int] | None = None,
    blocks_per_metre: float | None = None,
    block_map: str | Path = OWN_MAP,
    scene_id: str = "",
) -> SceneSource:
    """Return the scene of a place; its blocks are read when they are asked for.

    Args:
        path: a run's folder, its ``build``, a folder with ``world/`` and ``scene.json``, a folder
            with ``level.dat``, or a file such as ``house.schem``, ``.litematic``, ``.nbt``.
        box: x0 y0 z0 x1 y1 z1 in blocks, the last ones not included. Left out, a scene says its
            own, and in a world of others what was built is looked for.
        blocks_per_metre: the scale, where the place does not say it; 1 where nobody does.
        block_map: ``nyu``, ``paper`` or the path of a YAML file.
        scene_id: what it is called; made of the path where it is left out.

    Raises:
        InputError: nothing is there. UsageError: the box or the scale cannot be.
        UnknownNameError: there is no such block map.
    """
    place = Path(path)
    if not place.exists():
        raise InputError(place, "is not there")
    if blocks_per_metre is not None and not 0 < blocks_per_metre <= 64:
        raise UsageError(f"blocks per metre must be above 0 and up to 64, not {blocks_per_metre}")
    load_block_map(block_map)
    return SceneSource(
        place, scene_id or scene_id_of(place), str(block_map), _check_box(box), blocks_per_metre
    )


def source_of_blocks(source: BuildSource, scene_id: str) -> SceneSource:
    """Return the scene of blocks that are there already, such as those of a running server."""
    return SceneSource(source.path, scene_id, _cache={"source": source})


def scene_id_of(path: Path) -> str:
    """Return a name for the scene of a path: of letters, digits and _.

    Example:
        >>> scene_id_of(Path("worlds/house_0001/world"))
        'house_0001'
    """
    parts = [part for part in path.resolve().parts if part not in _FIRST]
    stem = Path(parts[-1]).stem if parts else "scene"
    return re.sub(r"[^A-Za-z0-9_]+", "_", stem).strip("_") or "scene"


def classify_unlabelled(volume: BlockVolume, rules: BlockMap) -> BlockVolume:
    """Return a volume with classes by a map where it has blocks that it says nothing of.

    A player who builds on in a world of ours leaves such blocks.
    """
    shown = np.array([rules.meaning(state) != "empty" for state in volume.palette])
    unlabelled = (volume.semantic == 0) & (volume.states != 0) & shown[volume.states]
    if not unlabelled.any():
        return volume
    classified = classify(volume, rules)
    semantic = np.where(unlabelled, classified.semantic, volume.semantic)
    highest = int(volume.instance.max(initial=0))
    new = (
        unlabelled
        & (classified.instance > 0)
        & (classified.instance.astype(np.int64) + highest <= 0xFFFF)
    )
    instance = np.where(new, classified.instance + np.uint16(highest), volume.instance)
    return replace(volume, semantic=semantic, instance=instance.astype(np.uint16))


def _check_box(box: Sequence[int] | None) -> Box | None:
    if box is None:
        return None
    numbers = [int(value) for value in box]
    if len(numbers) != 6 or any(a >= b for a, b in zip(numbers[:3], numbers[3:], strict=True)):
        raise UsageError(
            f"a box is x0 y0 z0 x1 y1 z1, each second corner beyond the first, not {list(box)}"
        )
    x0, y0, z0, x1, y1, z1 = numbers
    return x0, y0, z0, x1, y1, z1


def _with_scale(volume: BlockVolume, blocks_per_metre: float) -> BlockVolume:
    return replace(volume, block_to_room=block_to_room(np.zeros(2), blocks_per_metre))

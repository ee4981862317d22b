"""Scene sources: any world, run folder or schematic, opened with blocks, classes and designs.

If ``scene.json`` and ``scene.npz`` are next to the blocks, the classes are read from them;
otherwise a block map assigns the classes.

In worlds that were not created by this program, the built-up area is detected. The chunks around
the spawn point are searched first, using the palette of each chunk section, and then all other
chunks up to a limit.
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
from world2minecraft.formats.object_names import NamedObject, read_world_names
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
# Maximum distance in chunks of the main build from the spawn point, 96 blocks.
NEAR_CHUNKS = 6
MAX_CHUNKS = 6144  # About half a minute of reading; six regions.
MAX_SIDE = 320  # Blocks; larger builds are cut around their centre.
MARGIN = 2
# Names of blocks that players build with and that do not occur in landscapes, ores or plants.
BUILT = (
    "*_planks", "*_stairs", "*_slab", "*_concrete", "*_wool", "*_carpet", "*_bed", "*_door",
    "*glass", "*glass_pane", "*_terracotta", "smooth_*", "quartz_*", "polished_*_slab", "bricks",
    "*_bricks", "*_trapdoor", "*_fence", "bookshelf", "*_banner", "*_sign", "stripped_*", "iron_*",
    "sea_lantern", "flower_pot", "potted_*", "polished_*",
)  # fmt: skip
# Exceptions that also occur in mines and ruins. They extend a build, but do not form one alone.
WILD = ("oak_planks", "oak_fence", "rail", "mossy_stone_bricks", "stone_bricks")
_BUILT = re.compile("|".join(translate(pattern) for pattern in BUILT))
MIN_BUILT_KINDS = 3  # Kinds of built blocks that some section of a build must have.
FOREIGN_SCALE = 1.0  # Blocks per metre of worlds that do not record their scale.
OWN_MAP = MAPS[0]  # The block map of stored classes.
_FIRST = ("build", "world")  # Names of folders that do not identify a scene.


def find_built_box(world: Path) -> tuple[Box, str]:
    """Find the built-up area of a world.

    If nothing looks built, the blocks around the spawn point are used.

    Returns:
        The box of the built-up area, and a message for the user that describes the choice.

    Raises:
        InputError: If the folder is not a world.
        DamagedFileError: If a file of the world is damaged.
    """
    spawn = level_spawn(read_level(world))
    sections, was_cut = _built_sections(world, (spawn[0] >> 4, spawn[2] >> 4))
    if max(sections.values(), default=0) < MIN_BUILT_KINDS:
        box, _ = box_around_spawn(world)
        return box, (
            "no buildings found in this world; using the blocks around the spawn point "
            "(change with --box x0 y0 z0 x1 y1 z1)"
        )
    box = _box_of(_main_build(sections, spawn))
    corners = " ".join(str(value) for value in box)
    more = (
        f"; only the {MAX_CHUNKS:,} chunks nearest to the spawn point were searched"
        if was_cut
        else ""
    )
    return box, f"this world has no scene.json; using the detected buildings: --box {corners}{more}"


def is_built(state: str) -> bool:
    """Return whether a block state is typical of player-made builds, or belongs to a mod.

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
    """Return the number of built block kinds in each chunk section, nearest regions first."""
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
    """Return the distance between the centre of a region and the spawn point in chunks."""
    numbers = re.fullmatch(r"r\.(-?\d+)\.(-?\d+)\.mca", region.name)
    x, z = (int(n) * 32 + 16 for n in numbers.groups()) if numbers else (1 << 20, 1 << 20)
    return float(np.hypot(x - spawn[0], z - spawn[1])), region.name


def _main_build(
    sections: dict[tuple[int, int, int], int], spawn: tuple[int, int, int]
) -> Iterable[tuple[int, int, int]]:
    """Return the sections of the main build: one near the spawn point, else the largest one.

    Sections that touch, or that have only one section between them, belong to the same build.
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
    """Return the furniture design of each block in a volume.

    Args:
        folder: Folder with ``scene.json``, or None.
        volume: Volume of blocks.

    Returns:
        The design index of each block, uint16 [X, Y, Z], and the names of the designs. Index 0
        means no design and has an empty name.

    Raises:
        DamagedFileError: If the designs are stored but cannot be read.
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
    """A scene whose blocks are read on demand. It can be pickled and sent to another process.

    Stored classes are used if there are any; otherwise the block map assigns the classes. With a
    block map other than ``nyu``, stored classes are also converted, as far as the block and design
    of each cell determine the class.

    Attributes:
        path: World, run folder or schematic.
        scene_id: Name of the scene.
        block_map: Name or file of the block map.
        box: Part of the world to use, in blocks. None uses the recorded or detected part.
        blocks_per_metre: Scale for worlds that do not record their own.
    """

    path: Path
    scene_id: str
    block_map: str = OWN_MAP
    box: Box | None = None
    blocks_per_metre: float | None = None
    _cache: dict = field(default_factory=dict, repr=False, compare=False, hash=False)

    def __getstate__(self) -> dict:
        """Return the state without cached data, since each process reads the files itself."""
        return {
            key: value for key, value in self.__dict__.items() if key[0] != "_" and key != "rules"
        }

    def __setstate__(self, state: dict) -> None:
        """Restore the state with an empty cache."""
        self.__dict__.update(state, _cache={})

    @cached_property
    def rules(self) -> BlockMap:
        """Block map of the scene."""
        return load_block_map(self.block_map)

    def volume(self) -> BlockVolume:
        """Return the blocks with their classes. The volume is read once and cached.

        Raises:
            InputError: If the source cannot be read, or contains only air.
            UsageError: If the box is outside the source.
        """
        if "volume" not in self._cache:
            self._cache["volume"] = self._labelled()
        return self._cache["volume"]

    def designs(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """Return the furniture design of each block.

        Returns:
            The design index of each block, uint16 [X, Y, Z], and the names of the designs. Index 0
            means no design and has an empty name. Worlds that were not created by this program have
            no designs.
        """
        if "designs" not in self._cache:
            source = self._read()
            self._cache["designs"] = read_designs(source.folder, source.volume)
        return self._cache["designs"]

    def names(self) -> tuple[NamedObject, ...]:
        """Return the names of the objects, if the scene or its run states them.

        Raises:
            DamagedFileError: If the names are stored but cannot be read.
        """
        folder = self._read().folder
        return () if folder is None else read_world_names(folder)

    def start(self) -> tuple[float, float, float] | None:
        """Return the player's start position (feet, in block coordinates), or None if unknown."""
        start = self._read().start
        return None if start is None else (start.x, start.y, start.z)

    def has_truth(self) -> bool:
        """Return whether classes are stored with the blocks, not assigned by the block map."""
        return bool(self._read().volume.semantic.any())

    def notes(self) -> list[str]:
        """Return messages for the user about choices that were made automatically."""
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
    """Open a scene. Its blocks are read on demand.

    Args:
        path: Run folder or its ``build`` folder, folder with ``world/`` and ``scene.json``, folder
            with ``level.dat``, or a file such as ``house.schem``, ``.litematic`` or ``.nbt``.
        box: Part of the world to use, as x0 y0 z0 x1 y1 z1 in blocks, upper bounds excluded.
            Defaults to the recorded box or, for other worlds, to the detected buildings.
        blocks_per_metre: Scale for sources that do not record their own. Defaults to 1.
        block_map: ``nyu``, ``paper`` or the path of a YAML file.
        scene_id: Name of the scene. Derived from the path by default.

    Raises:
        InputError: If the path does not exist.
        UsageError: If the box or the scale is not valid.
        UnknownNameError: If there is no such block map.
    """
    place = Path(path)
    if not place.exists():
        raise InputError(place, "not found")
    if blocks_per_metre is not None and not 0 < blocks_per_metre <= 64:
        raise UsageError(f"blocks per metre must be above 0 and at most 64, got {blocks_per_metre}")
    load_block_map(block_map)
    return SceneSource(
        place, scene_id or scene_id_of(place), str(block_map), _check_box(box), blocks_per_metre
    )


def source_of_blocks(source: BuildSource, scene_id: str) -> SceneSource:
    """Return a scene source for blocks in memory, such as those of a running server."""
    return SceneSource(source.path, scene_id, _cache={"source": source})


def scene_id_of(path: Path) -> str:
    """Derive a scene name from a path, using only letters, digits and underscores.

    Example:
        >>> scene_id_of(Path("worlds/house_0001/world"))
        'house_0001'
    """
    parts = [part for part in path.resolve().parts if part not in _FIRST]
    stem = Path(parts[-1]).stem if parts else "scene"
    return re.sub(r"[^A-Za-z0-9_]+", "_", stem).strip("_") or "scene"


def classify_unlabelled(volume: BlockVolume, rules: BlockMap) -> BlockVolume:
    """Classify the unlabelled blocks of a volume with a block map.

    Such blocks occur if a player continues to build in a generated world.
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
            f"a box must be x0 y0 z0 x1 y1 z1 with x0 < x1, y0 < y1 and z0 < z1, got {list(box)}"
        )
    x0, y0, z0, x1, y1, z1 = numbers
    return x0, y0, z0, x1, y1, z1


def _with_scale(volume: BlockVolume, blocks_per_metre: float) -> BlockVolume:
    return replace(volume, block_to_room=block_to_room(np.zeros(2), blocks_per_metre))

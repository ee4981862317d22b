"""The blocks and entities in a box of an existing world, read so that some can be replaced.

This module writes no files: ``changed_files`` returns the new contents of the files. Entities of
earlier builds are replaced, and all others are kept.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, UsageError
from world2minecraft.core.types import BlockEntity, Entity
from world2minecraft.minecraft.entities import entity_nbt, entity_tags
from world2minecraft.minecraft.nbt import read_nbt, write_nbt
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.chunks import read_block_entities
from world2minecraft.minecraft.worlds.in_place_editing import (
    RegionFile,
    StateNumbers,
    clear_light,
    new_chunk,
    parse_chunk,
    read_region_file,
    read_sections,
    set_block_entities,
    set_section,
)
from world2minecraft.minecraft.worlds.world_reader import read_level

MAX_CELLS = 64 << 20
MODERN_FOLDER = Path("dimensions/minecraft/overworld")  # Since Minecraft 26.1.
Place = tuple[int, int]
Corner = tuple[int, int, int]
BUILT_TAG = "w2m_built"  # The tag of the entities that were built into a world.


@dataclass
class WorldBox:
    """The blocks in a box of a world, starting at ``low``.

    ``states`` [X, Y, Z] are indices into ``numbers``. ``data`` contains the block entities in the
    box. ``missing`` lists the chunks touched by the box that the game has not fully generated.
    """

    world: Path
    low: Corner
    states: np.ndarray
    numbers: StateNumbers
    data: tuple[BlockEntity, ...]
    data_version: int
    missing: list[Place] = field(default_factory=list)
    _regions: dict[Place, RegionFile] = field(default_factory=dict)
    _chunks: dict[Place, dict[str, Any]] = field(default_factory=dict)

    def version_at(self, block_pos: Sequence[int]) -> int:
        """Return the data version of the chunk that contains a block.

        The result for a new chunk is the data version of the world. The game upgrades a chunk when
        it loads it, so a chunk that has not been visited for long is older than its world.
        """
        chunk = self._chunks.get((int(block_pos[0]) >> 4, int(block_pos[2]) >> 4))
        return self.data_version if chunk is None else int(chunk["DataVersion"])

    def changed_files(
        self, states: np.ndarray, data: Sequence[BlockEntity]
    ) -> dict[str, bytes | None]:
        """Return the contents of the files, by path in the world, that change with new blocks.

        Args:
            states: Indices into ``numbers``, uint16 [X, Y, Z].
            data: All block entities in the box.
        """
        changed = self._changed_chunks(states, data)
        regions: dict[Place, dict[Place, bytes]] = defaultdict(dict)
        for place in changed:
            regions[region_of(place)][place] = self._rewrite_chunk(place, states, data)
        files = {}
        for region, chunks in sorted(regions.items()):
            found = self._regions[region]
            folder = found.path.parent.relative_to(self.world).as_posix()
            for name, content in found.with_chunks(chunks).items():
                files[f"{folder}/{name}"] = content
        return files

    def _changed_chunks(self, states: np.ndarray, data: Sequence[BlockEntity]) -> list[Place]:
        before, after = self._data_by_chunk(self.data), self._data_by_chunk(data)
        found = []
        for place in chunks_of(self.low, states.shape):
            part = self._part(place)
            if not np.array_equal(states[part], self.states[part]) or before.get(
                place
            ) != after.get(place):
                found.append(place)
        return found

    def _rewrite_chunk(
        self, place: Place, states: np.ndarray, data: Sequence[BlockEntity]
    ) -> bytes:
        root = self._chunks.get(place)
        if root is None:
            lowest = game_version().min_y >> 4
            root = new_chunk(place, self.data_version, lowest)
        path = self._regions[region_of(place)].path
        old = read_sections(root, path, self.numbers)
        first, last = self.low[1], self.low[1] + states.shape[1] - 1
        for section in range(first >> 4, (last >> 4) + 1):
            cells = old.get(section, np.zeros((16, 16, 16), np.uint16))
            new = cells.copy()
            here, there = _overlap((place[0] * 16, section * 16, place[1] * 16), self.low, states)
            new[here] = states[there]
            if not np.array_equal(new, cells):
                set_section(root, section, new, self.numbers)
        others = [e for e in read_block_entities(root, path) if not self._holds(e.block_pos)]
        mine = [e for e in data if (e.block_pos[0] >> 4, e.block_pos[2] >> 4) == place]
        set_block_entities(root, [*others, *sorted(mine, key=lambda entity: entity.block_pos)])
        clear_light(root)
        return write_nbt(root)

    def _part(self, place: Place) -> tuple[slice, ...]:
        """Return the slices of the box that are inside a chunk."""
        sides = [slice(None)] * 3
        for axis, chunk in ((0, place[0]), (2, place[1])):
            start = chunk * 16 - self.low[axis]
            sides[axis] = slice(max(start, 0), min(start + 16, self.states.shape[axis]))
        return tuple(sides)

    def _holds(self, position: Sequence[int]) -> bool:
        offset = np.array(position) - self.low
        return bool(((offset >= 0) & (offset < self.states.shape)).all())

    def _data_by_chunk(self, data: Sequence[BlockEntity]) -> Mapping[Place, set[bytes]]:
        found: dict[Place, set[bytes]] = defaultdict(set)
        for entity in data:
            x, y, z = (int(value) for value in entity.block_pos)
            key = write_nbt({"id": entity.id, "pos": [x, y, z], "nbt": entity.nbt})
            found[x >> 4, z >> 4].add(key)
        return found


def read_world_box(world: Path, low: Corner, size: Sequence[int]) -> WorldBox:
    """Read the blocks in a box of a world.

    Args:
        world: World folder.
        low: Minimum block position.
        size: Number of blocks along x, y and z.

    Raises:
        InputError: If the folder is not a world, or the world is from a version before 1.18.
        UsageError: If the box extends beyond the world limits.
        DamagedFileError: If a world file is damaged.
    """
    level = read_level(world)
    version = level.get("DataVersion")
    if not isinstance(version, int):
        raise DamagedFileError(world / "level.dat", "does not state a game version")
    _check_box(low, size)
    box = WorldBox(world, low, np.zeros(tuple(size), np.uint16), StateNumbers(), (), version)
    folder = overworld_folder(world)
    data: list[BlockEntity] = []
    for place in chunks_of(low, size):
        region = region_of(place)
        if region not in box._regions:
            path = folder / "region" / f"r.{region[0]}.{region[1]}.mca"
            box._regions[region] = read_region_file(path)
        data += _read_chunk(box, place, box._regions[region])
    box.data = tuple(entity for entity in data if box._holds(entity.block_pos))
    return box


def _read_chunk(box: WorldBox, place: Place, region: RegionFile) -> list[BlockEntity]:
    raw = region.chunk(place)
    root = None if raw is None else parse_chunk(raw, place, region.path)
    if root is None:
        box.missing.append(place)
        return []
    box._chunks[place] = root
    for section, cells in read_sections(root, region.path, box.numbers).items():
        corner = (place[0] * 16, section * 16, place[1] * 16)
        here, there = _overlap(corner, box.low, box.states)
        box.states[there] = cells[here]
    return read_block_entities(root, region.path)


def overworld_folder(world: Path) -> Path:
    """Return the folder of a world that contains ``region`` and ``entities`` of the overworld."""
    modern = world / MODERN_FOLDER
    return modern if (modern / "region").is_dir() else world


def chunks_of(low: Sequence[int], size: Sequence[int]) -> Iterator[Place]:
    """Yield the chunks that a box touches in sorted order."""
    for x in range(low[0] >> 4, ((low[0] + size[0] - 1) >> 4) + 1):
        for z in range(low[2] >> 4, ((low[2] + size[2] - 1) >> 4) + 1):
            yield x, z


def region_of(place: Place) -> Place:
    """Return the region that contains a chunk."""
    return place[0] >> 5, place[1] >> 5


def is_void(level: Mapping[str, Any]) -> bool:
    """Return whether the game generates only air in the overworld of a ``level.dat``."""
    try:
        overworld = level["WorldGenSettings"]["dimensions"]["minecraft:overworld"]
        settings = overworld["generator"]["settings"]
        layers = [layer["block"] for layer in settings["layers"]]
    except (KeyError, TypeError):
        return False
    flat = overworld["generator"].get("type") == "minecraft:flat"
    return flat and all(block == "minecraft:air" for block in layers)


def _check_box(low: Corner, size: Sequence[int]) -> None:
    version = game_version()
    high = low[1] + size[1] - 1
    if low[1] < version.min_y or high > version.max_y:
        raise UsageError(
            f"the build would span y {low[1]} to {high}, but the world spans y "
            f"{version.min_y} to {version.max_y}; choose another Y or fewer blocks per metre"
        )
    if max(abs(low[0]), abs(low[2])) > 29_000_000:
        raise UsageError(f"x {low[0]}, z {low[2]} is beyond the world border at 29,999,984")
    if float(np.prod(np.array(size, float))) > MAX_CELLS:
        shown = " x ".join(map(str, size))
        raise InputError("build", f"has {shown} blocks; the limit is {MAX_CELLS:,}")


def _overlap(
    corner: Sequence[int], low: Sequence[int], states: np.ndarray
) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Return the slices in which a section at ``corner`` and a box from ``low`` overlap."""
    here, there = [], []
    for start, first, size in zip(corner, low, states.shape, strict=True):
        begin, end = max(start, first), max(start, first, min(start + 16, first + size))
        here.append(slice(begin - start, end - start))
        there.append(slice(begin - first, end - first))
    return tuple(here), tuple(there)


class WorldEntities:
    """The entities of the chunks that a box touches."""

    def __init__(self, world: Path, low: Sequence[int], size: Sequence[int], data_version: int):
        """Read the entities.

        Raises:
            DamagedFileError: If an entity file is damaged.
        """
        self._world, self._low, self._size = world, np.array(low), np.array(size)
        self._data_version = data_version
        self._regions: dict[Place, RegionFile] = {}
        self._held: dict[Place, list[dict[str, Any]]] = {}
        self._roots: dict[Place, dict[str, Any]] = {}  # What lies there beside the entities.
        folder = overworld_folder(world) / "entities"
        for place in chunks_of(low, size):
            region = region_of(place)
            if region not in self._regions:
                path = folder / f"r.{region[0]}.{region[1]}.mca"
                self._regions[region] = read_region_file(path)
            self._held[place] = self._read(place, self._regions[region])

    def built(self) -> tuple[Entity, ...]:
        """Return the entities of an earlier build that are in the box."""
        found = [
            entity_from_nbt(nbt) for held in self._held.values() for nbt in held if _is_built(nbt)
        ]
        return tuple(entity for entity in found if self._is_inside(entity))

    def changed_files(
        self, gone: Iterable[Entity], come: Iterable[Entity]
    ) -> dict[str, bytes | None]:
        """Return the new contents of the files that change when entities are added and removed.

        Entities are identified by their UUID. An added entity replaces an entity with the same
        UUID.
        """
        wanted = {place: list(held) for place, held in self._held.items()}
        arriving = [dict(entity.nbt) for entity in map(with_uuid, come)]
        leaving = {_uuid(entity.nbt) for entity in gone} | {_uuid(nbt) for nbt in arriving}
        for place, held in wanted.items():
            wanted[place] = [nbt for nbt in held if _uuid(nbt) not in leaving]
        for nbt in arriving:
            wanted.setdefault(_chunk_of(nbt["Pos"]), []).append(nbt)
        regions: dict[Place, dict[Place, bytes]] = defaultdict(dict)
        for place, held in wanted.items():
            if _keys(held) != _keys(self._held.get(place, [])):
                regions[region_of(place)][place] = self._pack_chunk(place, held)
        files = {}
        for region, chunks in sorted(regions.items()):
            found = self._regions.get(region) or self._new_region(region)
            base = found.path.parent.relative_to(self._world).as_posix()
            files |= {f"{base}/{name}": c for name, c in found.with_chunks(chunks).items()}
        return files

    def _read(self, place: Place, region: RegionFile) -> list[dict[str, Any]]:
        raw = region.chunk(place)
        if raw is None:
            return []
        _, root = read_nbt(raw, region.path)
        held = root.pop("Entities", [])
        self._roots[place] = root
        try:
            for nbt in held:
                entity_from_nbt(nbt)
        except MALFORMED as error:
            raise DamagedFileError(
                region.path, "contains an entity without an id or a position"
            ) from error
        return held

    def _pack_chunk(self, place: Place, held: list[dict[str, Any]]) -> bytes:
        """Return a chunk of entities, keeping its data version if it contains other entities.

        The game upgrades entities from the data version of their chunk. With a version that is too
        new, it would not upgrade old data and would drop it.
        """
        root = {
            "DataVersion": self._data_version,
            "Position": np.array(place, np.int32),
            **self._roots.get(place, {}),
        }
        if all(map(_is_built, held)):
            root["DataVersion"] = self._data_version
        return write_nbt({**root, "Entities": held})

    def _new_region(self, region: Place) -> RegionFile:
        folder = overworld_folder(self._world) / "entities"
        return read_region_file(folder / f"r.{region[0]}.{region[1]}.mca")

    def _is_inside(self, entity: Entity) -> bool:
        offset = np.array(entity.position) - self._low
        return bool(((offset >= 0) & (offset <= self._size)).all())


def entity_from_nbt(nbt: dict[str, Any]) -> Entity:
    """Return an entity from its NBT, keeping all tags in ``nbt``."""
    x, y, z = (float(value) for value in nbt["Pos"])
    return Entity((x, y, z), str(nbt["id"]), dict(nbt))


def tag_entities(entities: Sequence[Entity]) -> tuple[Entity, ...]:
    """Return entities with a UUID and a tag that identifies them to later builds."""
    found = []
    for number, entity in enumerate(entities):
        nbt = entity_nbt(entity, number)
        tags = [tag for tag in entity_tags(nbt) if tag != BUILT_TAG]
        found.append(entity_from_nbt(nbt | {"Tags": [*tags, BUILT_TAG]}))
    return tuple(found)


def with_uuid(entity: Entity) -> Entity:
    """Return an entity with all NBT tags that a world requires, including a UUID."""
    return entity if "UUID" in entity.nbt and "Pos" in entity.nbt else tag_entities([entity])[0]


def _is_built(nbt: dict[str, Any]) -> bool:
    return BUILT_TAG in entity_tags(nbt)


def _uuid(nbt: Any) -> bytes:
    value = nbt.get("UUID")
    return value.tobytes() if isinstance(value, np.ndarray) else write_nbt({"nbt": dict(nbt)})


def _keys(held: list[dict[str, Any]]) -> list[bytes]:
    return sorted(write_nbt(nbt) for nbt in held)


def _chunk_of(position: Sequence[float]) -> Place:
    return int(position[0] // 16), int(position[2] // 16)

"""Entities of a world that exists: those of earlier builds go, new ones come, others stay."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Entity
from world2minecraft.editing.world_box import Place, chunks_of, overworld_folder, region_of
from world2minecraft.minecraft.entities import entity_nbt, entity_tags
from world2minecraft.minecraft.nbt import read_nbt, write_nbt
from world2minecraft.minecraft.worlds.in_place_editing import RegionFile, read_region_file

BUILT = "w2m_built"  # The tag of the entities that were built into a world.


class WorldEntities:
    """The entities of the chunks that a box touches."""

    def __init__(self, world: Path, low: Sequence[int], size: Sequence[int], data_version: int):
        """Read them.

        Raises:
            DamagedFileError: a file of them is broken.
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
        """Return the entities in the box that an earlier build left there."""
        found = [entity_of(nbt) for held in self._held.values() for nbt in held if _is_built(nbt)]
        return tuple(entity for entity in found if self._is_inside(entity))

    def changed_files(
        self, gone: Iterable[Entity], come: Iterable[Entity]
    ) -> dict[str, bytes | None]:
        """Return the files that differ when some entities go and others come; none is written.

        An entity is known by its UUID. Those that come replace those of the same UUID.
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
                regions[region_of(place)][place] = self._packed(place, held)
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
                entity_of(nbt)
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise DamagedFileError(region.path, "has an entity without id and place") from error
        return held

    def _packed(self, place: Place, held: list[dict[str, Any]]) -> bytes:
        """Return a chunk of entities; with those of others in it, it stays as old as it was.

        The game brings entities up to date by what their chunk says: one that said too much would
        leave what they carry in the form of an older game, which the newer one drops.
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


def entity_of(nbt: dict[str, Any]) -> Entity:
    """Return an entity of its NBT; all of its tags stay in ``nbt``."""
    x, y, z = (float(value) for value in nbt["Pos"])
    return Entity((x, y, z), str(nbt["id"]), dict(nbt))


def marked(entities: Sequence[Entity]) -> tuple[Entity, ...]:
    """Return entities with their UUID and the tag by which a later build knows them."""
    found = []
    for number, entity in enumerate(entities):
        nbt = entity_nbt(entity, number)
        tags = [tag for tag in entity_tags(nbt) if tag != BUILT]
        found.append(entity_of(nbt | {"Tags": [*tags, BUILT]}))
    return tuple(found)


def with_uuid(entity: Entity) -> Entity:
    """Return an entity whose NBT is whole, as a world holds it."""
    return entity if "UUID" in entity.nbt and "Pos" in entity.nbt else marked([entity])[0]


def _is_built(nbt: dict[str, Any]) -> bool:
    return BUILT in entity_tags(nbt)


def _uuid(nbt: Any) -> bytes:
    value = nbt.get("UUID")
    return value.tobytes() if isinstance(value, np.ndarray) else write_nbt({"nbt": dict(nbt)})


def _keys(held: list[dict[str, Any]]) -> list[bytes]:
    return sorted(write_nbt(nbt) for nbt in held)


def _chunk_of(position: Sequence[float]) -> Place:
    return int(position[0] // 16), int(position[2] // 16)

"""Any place that holds blocks as a scene to make a data set of: blocks, classes and designs.

In: a run's folder, a generated world, a world of anyone, a schematic. What lies beside the blocks
says what they are (``scene.json``, ``scene.npz``); where nothing does, a block map tells.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.build_source import Source, read_source
from world2minecraft.formats.volume_crop import Box
from world2minecraft.minecraftocc.block_map import BlockMap, classify, load_block_map, remapped
from world2minecraft.minecraftocc.block_map.parser import MAPS
from world2minecraft.minecraftocc.built_box import built_box
from world2minecraft.minecraftocc.designs import designs_beside
from world2minecraft.minecraftocc.labels.materials import fine_names

FOREIGN_SCALE = 1.0  # Blocks per metre of worlds that do not say theirs: players build so.
OWN_MAP = MAPS[0]  # The map that our own truth is by.
_FIRST = ("build", "world")  # Names of folders that say nothing of the scene.


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
            self._cache["designs"] = designs_beside(source.folder, source.volume)
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

    def _read(self) -> Source:
        if "source" not in self._cache:
            source = read_source(self.path, self.box, choose=built_box)
            if source.folder is None or self.blocks_per_metre is not None:
                source.volume = _scaled(source.volume, self.blocks_per_metre or FOREIGN_SCALE)
            self._cache["source"] = source
        return self._cache["source"]

    def _labelled(self) -> BlockVolume:
        volume = self._read().volume
        if not volume.semantic.any():
            return classify(volume, self.rules)
        volume = with_unlabelled(volume, self.rules)
        if self.block_map == OWN_MAP:
            return volume
        names = fine_names(volume, self.designs())
        fine = names.of_cells(np.arange(volume.states.size)).reshape(volume.states.shape)
        return replace(volume, semantic=remapped(volume.semantic, fine, names.classes, self.rules))


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
        place, scene_id or scene_id_of(place), str(block_map), _box(box), blocks_per_metre
    )


def source_of_blocks(source: Source, scene_id: str) -> SceneSource:
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


def with_unlabelled(volume: BlockVolume, rules: BlockMap) -> BlockVolume:
    """Return a volume with classes by a map where it has blocks that it says nothing of.

    A player who builds on in a world of ours leaves such blocks.
    """
    shown = np.array([rules.meaning(state) != "empty" for state in volume.palette])
    unsaid = (volume.semantic == 0) & (volume.states != 0) & shown[volume.states]
    if not unsaid.any():
        return volume
    told = classify(volume, rules)
    semantic = np.where(unsaid, told.semantic, volume.semantic)
    most = int(volume.instance.max(initial=0))
    new = unsaid & (told.instance > 0) & (told.instance.astype(np.int64) + most <= 0xFFFF)
    instance = np.where(new, told.instance + np.uint16(most), volume.instance)
    return replace(volume, semantic=semantic, instance=instance.astype(np.uint16))


def _box(box: Sequence[int] | None) -> Box | None:
    if box is None:
        return None
    numbers = [int(value) for value in box]
    if len(numbers) != 6 or any(a >= b for a, b in zip(numbers[:3], numbers[3:], strict=True)):
        raise UsageError(
            f"a box is x0 y0 z0 x1 y1 z1, each second corner beyond the first, not {list(box)}"
        )
    x0, y0, z0, x1, y1, z1 = numbers
    return x0, y0, z0, x1, y1, z1


def _scaled(volume: BlockVolume, blocks_per_metre: float) -> BlockVolume:
    return replace(volume, block_to_room=block_to_room(np.zeros(2), blocks_per_metre))

"""Blocks and, from the ``scene.json`` beside them, what they are and how large they are."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import InputError
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.scene import Scene, read_scene

SCENE_FILE = "scene.json"


def place_of_blocks(path: Path) -> Path:
    """Return where the blocks of a place lie: of a run or a build, its world or its schematic.

    A player may have changed the world, so it comes first. Other places are their own.

    Raises:
        InputError: the folder of a build holds neither.
    """
    build = next((p for p in (path, path / "build") if (p / SCENE_FILE).is_file()), None)
    if build is None:
        return path
    world, schematic = build / "world", build / "room.schem"
    if (world / "level.dat").is_file():
        return world
    if schematic.is_file():
        return schematic
    raise InputError(build, "holds a scene.json and neither world nor room.schem")


def labelled(volume: BlockVolume, path: Path) -> BlockVolume:
    """Return the volume with the labels and the scale of the scene that it belongs to.

    Args:
        volume: the blocks that were read.
        path: where they were asked for: a run, its ``build``, or a file or world in it. A scene
            counts only where all that it labels lies where the volume has its blocks.

    Raises:
        DamagedFileError: there is a scene, and it cannot be read.
    """
    places = (path, path / "build", path.parent)
    folder = next((place for place in places if (place / SCENE_FILE).is_file()), None)
    if folder is None:
        return volume
    scene = read_scene(folder)
    return with_scene(volume, scene) if _overlaps(volume, scene) else volume


def with_scene(volume: BlockVolume, scene: Scene) -> BlockVolume:
    """Return the volume with a scene's labels on all blocks that are there, and its scale."""
    ours, theirs = common_cells(volume, scene)
    semantic, instance = np.zeros_like(volume.semantic), np.zeros_like(volume.instance)
    is_block = volume.states[ours] > 0
    semantic[ours] = np.where(is_block, scene.semantic[theirs], 0)
    instance[ours] = np.where(is_block, scene.instance[theirs], 0)
    return replace(volume, semantic=semantic, instance=instance, block_to_room=scene.block_to_room)


def _overlaps(volume: BlockVolume, scene: Scene) -> bool:
    """Whether most of what the scene labels is still a block: else it is another's scene."""
    ours, theirs = common_cells(volume, scene)
    wanted = int((scene.semantic > 0).sum())
    met = int(((scene.semantic[theirs] > 0) & (volume.states[ours] > 0)).sum())
    return wanted > 0 and met >= wanted / 2


def common_cells(volume: BlockVolume, scene: Scene) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Return the cells that both hold, as slices of each."""
    low = np.maximum(volume.corner, scene.corner)
    high = np.minimum(
        np.add(volume.corner, volume.states.shape), np.add(scene.corner, scene.semantic.shape)
    )
    high = np.maximum(low, high)

    def window(corner: tuple[int, int, int]) -> tuple[slice, ...]:
        steps = zip(low - np.array(corner), high - np.array(corner), strict=True)
        return tuple(slice(max(int(a), 0), max(int(b), 0)) for a, b in steps)

    return window(volume.corner), window(scene.corner)

"""Read any build as a volume: a run folder, its build, a world, or a block file."""

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.whole_reads import unchanged
from world2minecraft.formats.volume_crop import Box, crop_volume, trim_air
from world2minecraft.formats.volume_formats import find_blocks, read_volume, with_scene_labels
from world2minecraft.minecraft.worlds.world_writer import read_level, read_world

# Blocks that are read around and above the spawn of a world without a scene.
SPAWN_REACH, SPAWN_REACH_UP = (64, 32, 64), 96
SCENE_MARGIN = 2  # Blocks around a scene: display entities may stand out of it.


class PlayerStart(NamedTuple):
    """The spawn point of a world written by this program, in world block coordinates."""

    x: float
    y: float
    z: float
    yaw_deg: float  # the game's


@dataclass(eq=False)
class BuildSource:
    """A volume with notes on choices that were made for the user.

    ``folder`` contains the ``scene.json`` with the labels or scale of the volume. It is None if
    there is no such file.
    """

    volume: BlockVolume
    name: str
    path: Path
    start: PlayerStart | None = None
    folder: Path | None = None
    notes: list[str] = field(default_factory=list)


def box_around_spawn(world: Path) -> tuple[Box, str]:
    """Return a box around the spawn point of a world, and a note for the user."""
    x, y, z = level_spawn(read_level(world))
    wide, low, deep = SPAWN_REACH
    place = " ".join(str(value) for value in (x, y, z))
    note = f"the world has no scene.json; using the blocks around the spawn point ({place}); "
    box = (x - wide, y - low, z - deep, x + wide, y + SPAWN_REACH_UP, z + deep)
    return box, note + "select others with --box x0,y0,z0,x1,y1,z1"


def read_build(
    path: Path,
    box: Box | None = None,
    *,
    choose: Callable[[Path], tuple[Box, str]] = box_around_spawn,
) -> BuildSource:
    """Read a block file, a world, a run folder or its build.

    Args:
        path: Path of the build.
        box: Box of blocks to read, with exclusive upper bounds. Worlds written by this program
            record their own box.
        choose: Function that selects the box of other worlds and returns it with a note.

    Raises:
        InputError: If the build cannot be read or contains only air.
        UsageError: If the box does not overlap the build.
    """
    if not path.exists():
        raise InputError(path, "not found")
    with unchanged(path) if path.is_dir() else nullcontext():
        return _read_build(path, box, choose)


def _read_build(
    path: Path, box: Box | None, choose: Callable[[Path], tuple[Box, str]]
) -> BuildSource:
    blocks = find_blocks(path)
    if (blocks / "level.dat").is_file():
        source = _read_world(blocks, path, box, choose)
    else:
        source = _read_file(path, box)
    source.volume = trim_air(source.volume)
    if not source.volume.states.any():
        where = "in this box" if box else "here"
        raise InputError(path, f"contains only air {where}; choose another box (--box)")
    return source


def level_spawn(level: dict[str, Any]) -> tuple[int, int, int]:
    """Return the spawn point of a level of any game version, or the world origin if it has none."""
    try:
        if "spawn" in level:  # Since 1.21.9.
            x, y, z = (int(value) for value in level["spawn"]["pos"])
        else:
            x, y, z = (int(level[key]) for key in ("SpawnX", "SpawnY", "SpawnZ"))
    except MALFORMED:
        return 0, 64, 0
    return x, y, z


def _read_file(path: Path, box: Box | None) -> BuildSource:
    volume = read_volume(path)
    _, folder = _find_scene(path)
    return BuildSource(crop_volume(volume, box) if box else volume, path.stem, path, folder=folder)


def _read_world(
    world: Path, given: Path, box: Box | None, choose: Callable[[Path], tuple[Box, str]]
) -> BuildSource:
    """Read the given box of a world, the box of its scene, or the selected box."""
    scene, folder = _find_scene(given)
    if scene is None or folder is None:
        chosen, note = (box, "") if box else choose(world)
        source = BuildSource(read_world(world, box=chosen), world.name, given)
        source.notes += [note] if note else []
        return source
    own = _box_of(scene, folder / "scene.json")
    volume = _with_labels(read_world(world, box=box or own), scene, folder)
    source = BuildSource(volume, given.resolve().stem, given, _start_of(scene), folder)
    if not (folder / "scene.npz").is_file():
        source.notes.append("scene.npz not found: classes and objects are empty")
    return source


def _find_scene(path: Path) -> tuple[dict[str, Any] | None, Path | None]:
    for folder in (path, path / "build", path.parent):
        if (folder / "scene.json").is_file():
            scene = read_json(folder / "scene.json")
            if not isinstance(scene, dict):
                raise DamagedFileError(
                    folder / "scene.json", "is not a valid scene (expected a JSON object)"
                )
            return scene, folder
    return None, None


def _box_of(scene: dict[str, Any], path: Path) -> Box:
    try:
        x, y, z = (int(value) for value in scene["corner"])
        east, up, south = (int(value) for value in scene["size"])
    except MALFORMED as error:
        raise DamagedFileError(path, f"is not a valid scene ({error})") from error
    return (
        x - SCENE_MARGIN,
        y - SCENE_MARGIN,
        z - SCENE_MARGIN,
        x + east + SCENE_MARGIN,
        y + up + SCENE_MARGIN,
        z + south + SCENE_MARGIN,
    )


def _with_labels(volume: BlockVolume, scene: dict[str, Any], folder: Path) -> BlockVolume:
    """Return the volume with the scene's labels, or only its scale if the labels are missing."""
    if (folder / "scene.npz").is_file():
        return with_scene_labels(volume, folder)
    try:
        return replace(volume, block_to_room=np.array(scene["block_to_room"], np.float64))
    except MALFORMED as error:
        raise DamagedFileError(folder / "scene.json", f"is not a valid scene ({error})") from error


def _start_of(scene: dict[str, Any]) -> PlayerStart | None:
    try:
        x, y, z = (float(value) for value in scene["spawn"]["position"])
        return PlayerStart(x, y, z, float(scene["spawn"]["yaw_deg"]))
    except MALFORMED:
        return None

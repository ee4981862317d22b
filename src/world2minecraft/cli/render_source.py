"""What ``w2m render`` draws: a volume of any form, at its scale, and where its player starts."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.errors import DamagedFileError, InputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.render.views import GamePose
    from world2minecraft.types import BlockVolume

Box = tuple[int, int, int, int, int, int]
AROUND = (64, 32, 64)  # Blocks to each side of the spawn, of a world that comes without a scene,
ABOVE = 96  # and so many over it.
EDGE = 2  # Blocks around a scene: display entities may stand out of it.


@dataclass(eq=False)
class Source:
    """A volume to draw; ``notes`` say what was chosen for the user."""

    volume: "BlockVolume"
    name: str
    path: Path
    spawn: "GamePose | None" = None
    notes: list[str] = field(default_factory=list)


def read_source(path: Path, box: Box | None) -> Source:
    """Read a file, a world, a run's folder or its build.

    Args:
        path: where it is.
        box: which blocks, the last ones not included; a world of this program says so itself,
            of another world those around the spawn are taken.

    Raises:
        InputError: it cannot be read. UsageError: nothing but air is there.
    """
    if not path.exists():
        raise InputError(path, "is not there")
    from world2minecraft.exchange.labelled import place_of_blocks

    blocks = place_of_blocks(path)
    if (blocks / "level.dat").is_file():
        source = _read_world(blocks, path, box)
    else:
        source = _read_file(path, box)
    source.volume = trimmed(source.volume)
    if not source.volume.states.any():
        where = "in the box" if box else "there"
        raise InputError(path, f"nothing but air is {where}; choose another --box")
    return source


def _read_file(path: Path, box: Box | None) -> Source:
    from world2minecraft.exchange.forms import read_form

    volume = read_form(path)
    return Source(cropped(volume, box) if box else volume, path.stem, path)


def _read_world(world: Path, asked: Path, box: Box | None) -> Source:
    """Read the box of a world that is asked for, or that of its scene, or around its spawn."""
    from world2minecraft.minecraft.worlds.world import read_level, read_world

    scene, folder = _scene_beside(asked)
    if scene is None:
        x, y, z = _spawn_of(read_level(world))
        wide, low, deep = AROUND
        around = (x - wide, y - low, z - deep, x + wide, y + ABOVE, z + deep)
        told = " ".join(str(value) for value in (x, y, z))
        note = f"this world has no scene.json: drawing the blocks around its spawn ({told}); "
        source = Source(read_world(world, box=box or around), world.name, asked)
        source.notes += [] if box else [note + "--box x0,y0,z0,x1,y1,z1 chooses others"]
        return source
    own = _box_of(scene, folder / "scene.json")
    volume = _with_labels(read_world(world, box=box or own), scene, folder)
    source = Source(volume, asked.resolve().stem, asked, _spawn_pose(scene))
    if not (folder / "scene.npz").is_file():
        source.notes.append("scene.npz is not there: classes and objects are empty")
    return source


def _scene_beside(path: Path) -> tuple[dict[str, Any] | None, Path]:
    from world2minecraft.files import read_json

    for folder in (path, path / "build", path.parent):
        if (folder / "scene.json").is_file():
            scene = read_json(folder / "scene.json")
            if not isinstance(scene, dict):
                raise DamagedFileError(folder / "scene.json", "is no scene (no JSON object)")
            return scene, folder
    return None, path


def _box_of(scene: dict[str, Any], path: Path) -> Box:
    try:
        x, y, z = (int(value) for value in scene["corner"])
        east, up, south = (int(value) for value in scene["size"])
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(path, f"is no scene ({error})") from error
    return (x - EDGE, y - EDGE, z - EDGE, x + east + EDGE, y + up + EDGE, z + south + EDGE)


def _with_labels(volume: "BlockVolume", scene: dict[str, Any], folder: Path) -> "BlockVolume":
    """Return the volume with the scene's labels, or with its scale alone where they are gone."""
    import numpy as np

    if (folder / "scene.npz").is_file():
        from world2minecraft.exchange.labelled import labelled

        return labelled(volume, folder)
    try:
        return replace(volume, block_to_room=np.array(scene["block_to_room"], np.float64))
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(folder / "scene.json", f"is no scene ({error})") from error


def _spawn_pose(scene: dict[str, Any]) -> "GamePose | None":
    from world2minecraft.render.views import GamePose

    try:
        x, y, z = (float(value) for value in scene["spawn"]["position"])
        return GamePose(x, y, z, float(scene["spawn"]["yaw_deg"]), 0.0)
    except (KeyError, TypeError, ValueError, UsageError):
        return None


def _spawn_of(level: dict[str, Any]) -> tuple[int, int, int]:
    """Return the spawn of a level, of old and new games; the world's middle where it has none."""
    try:
        if "spawn" in level:  # Since 1.21.9.
            x, y, z = (int(value) for value in level["spawn"]["pos"])
        else:
            x, y, z = (int(level[key]) for key in ("SpawnX", "SpawnY", "SpawnZ"))
    except (KeyError, TypeError, ValueError):
        return 0, 64, 0
    return x, y, z


def cropped(volume: "BlockVolume", box: Box) -> "BlockVolume":
    """Return the blocks and entities of a volume that lie in a box of world coordinates."""
    import numpy as np

    corner = np.array(volume.corner)
    low = np.clip(np.array(box[:3]) - corner, 0, volume.states.shape)
    high = np.maximum(np.clip(np.array(box[3:]) - corner, 0, volume.states.shape), low)
    if (high == low).any():
        size = " x ".join(str(side) for side in volume.states.shape)
        at = ",".join(str(value) for value in volume.corner)
        raise UsageError(f"--box lies beside the build, which is {size} blocks from {at}")
    cut = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    x, y, z = (int(value) for value in corner + low)
    first, last = corner + low, corner + high
    return replace(
        volume,
        states=volume.states[cut],
        semantic=volume.semantic[cut],
        instance=volume.instance[cut],
        corner=(x, y, z),
        block_entities=tuple(
            one
            for one in volume.block_entities
            if (first <= one.block_pos).all() and (one.block_pos < last).all()
        ),
        entities=tuple(
            one
            for one in volume.entities
            if (first <= one.position).all() and (one.position < last).all()
        ),
    )


def trimmed(volume: "BlockVolume") -> "BlockVolume":
    """Return the volume without the layers of air around its blocks; its entities all stay."""
    import numpy as np

    filled = volume.states != 0
    if not filled.any():
        return volume
    cuts = []
    for axis in range(3):
        used = np.flatnonzero(filled.any(axis=tuple({0, 1, 2} - {axis})))
        cuts.append(slice(int(used[0]), int(used[-1]) + 1))
    cut = tuple(cuts)
    x, y, z = (low + part.start for low, part in zip(volume.corner, cut, strict=True))
    return replace(
        volume,
        states=np.ascontiguousarray(volume.states[cut]),
        semantic=np.ascontiguousarray(volume.semantic[cut]),
        instance=np.ascontiguousarray(volume.instance[cut]),
        corner=(x, y, z),
    )

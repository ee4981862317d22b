"""``scene.json`` and ``scene.npz``: what lies beside every world that the program writes.

``scene.json``: ``block_to_room`` [4][4], ``metres_per_block``, ``corner`` [3], ``size`` [3],
``data_version``, ``mc_version``, ``spawn`` {position [3], yaw_deg}. ``scene.npz``: ``semantic``
uint8 and ``instance`` uint16, both [X, Y, Z] in block axes, cell (0, 0, 0) at ``corner``.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.errors import DamagedFileError
from world2minecraft.files import read_json, read_npz, write_json, write_npz
from world2minecraft.types import BlockVolume, checks


@dataclass(frozen=True, eq=False)
class Scene:
    """What a world's blocks mean, and where they stand in the room."""

    semantic: np.ndarray  # uint8 [X, Y, Z], block axes
    instance: np.ndarray  # uint16 [X, Y, Z]
    corner: tuple[int, int, int]  # the world position of cell (0, 0, 0)
    block_to_room: np.ndarray  # float64 [4, 4]
    mc_version: str
    data_version: int
    spawn: tuple[float, float, float]  # the feet, in world block coordinates
    spawn_yaw_deg: float  # the game's

    def __post_init__(self):
        put = object.__setattr__
        semantic = checks.labels("semantic", self.semantic, (None, None, None))
        put(self, "semantic", semantic)
        put(self, "instance", checks.array("instance", self.instance, np.uint16, semantic.shape))
        put(self, "block_to_room", checks.floats("block_to_room", self.block_to_room, (4, 4)))
        checks.floats("spawn", self.spawn, (3,))

    @property
    def metres_per_block(self) -> float:
        """The side of a block in metres of the room."""
        return float(np.linalg.norm(self.block_to_room[:3, 0]))


def scene_of(
    volume: BlockVolume,
    *,
    mc_version: str,
    data_version: int,
    spawn: tuple[float, float, float],
    spawn_yaw_deg: float,
) -> Scene:
    """Return the scene of a volume that is written for a version of the game."""
    return Scene(
        volume.semantic,
        volume.instance,
        volume.corner,
        volume.block_to_room,
        mc_version,
        data_version,
        spawn,
        spawn_yaw_deg,
    )


def write_scene(folder: str | Path, scene: Scene) -> None:
    """Write ``scene.json`` and ``scene.npz`` into a folder. Raises OutputError."""
    target = Path(folder)
    write_npz(target / "scene.npz", {"semantic": scene.semantic, "instance": scene.instance})
    write_json(
        target / "scene.json",
        {
            "block_to_room": scene.block_to_room.tolist(),
            "metres_per_block": scene.metres_per_block,
            "corner": list(scene.corner),
            "size": list(scene.semantic.shape),
            "mc_version": scene.mc_version,
            "data_version": scene.data_version,
            "spawn": {"position": list(scene.spawn), "yaw_deg": scene.spawn_yaw_deg},
        },
    )


def read_scene(folder: str | Path) -> Scene:
    """Read the scene that lies in a folder.

    Raises:
        InputError: a file is missing. DamagedFileError: the files hold no scene.
        LimitError: an array is too large.
    """
    source = Path(folder)
    raw = read_json(source / "scene.json")
    arrays = read_npz(source / "scene.npz", ("semantic", "instance"))
    try:
        x, y, z = (int(value) for value in raw["corner"])
        east, up, south = (float(value) for value in raw["spawn"]["position"])
        return Scene(
            arrays["semantic"],
            arrays["instance"],
            (x, y, z),
            np.array(raw["block_to_room"]),
            str(raw["mc_version"]),
            int(raw["data_version"]),
            (east, up, south),
            float(raw["spawn"]["yaw_deg"]),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(source / "scene.json", f"is no scene ({error})") from error

"""``scene.json`` and ``scene.npz``: labels and scale of every world written by this program.

``scene.json`` contains ``block_to_room`` [4][4], ``metres_per_block``, ``corner`` [3], ``size``
[3], ``data_version``, ``mc_version``, ``spawn`` {position [3], yaw_deg}, for generated houses
``light`` {hour 0 to 24, lamps}, and if known ``objects``, the names of the objects. ``scene.npz``
contains ``semantic`` uint8 and ``instance`` uint16, both [X, Y, Z] in block axes, with cell
(0, 0, 0) at ``corner``. If known, it also contains ``design`` uint16, an index into the names in
``designs.json``, whose first entry means none.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import npz_array_names, read_json, read_npz, write_json, write_npz
from world2minecraft.core.types import BlockVolume, checks
from world2minecraft.formats.object_names import NamedObject, names_of_rows, rows_of_names

DESIGNS = "designs.json"


@dataclass(frozen=True, eq=False)
class Scene:
    """The labels of a world's blocks, and their position in the room."""

    semantic: np.ndarray  # uint8 [X, Y, Z], block axes
    instance: np.ndarray  # uint16 [X, Y, Z]
    corner: tuple[int, int, int]  # the world position of cell (0, 0, 0)
    block_to_room: np.ndarray  # float64 [4, 4]
    mc_version: str
    data_version: int
    spawn: tuple[float, float, float]  # the feet, in world block coordinates
    spawn_yaw_deg: float  # the game's
    design: np.ndarray | None = None  # uint16 [X, Y, Z], into ``designs``; None where unknown
    designs: tuple[str, ...] = ("",)  # furniture of the library; the first is none
    light: Mapping[str, Any] = field(default_factory=dict)  # hour 0 to 24, lamps
    objects: tuple[NamedObject, ...] = ()

    def __post_init__(self):
        put = object.__setattr__
        semantic = checks.labels("semantic", self.semantic, (None, None, None))
        put(self, "semantic", semantic)
        put(self, "instance", checks.array("instance", self.instance, np.uint16, semantic.shape))
        put(self, "block_to_room", checks.similarity("block_to_room", self.block_to_room))
        checks.floats("spawn", self.spawn, (3,))
        if self.design is not None:
            put(self, "design", checks.array("design", self.design, np.uint16, semantic.shape))
            if self.design.size and int(self.design.max()) >= len(self.designs):
                raise ValueError(
                    f"design index {self.design.max()} exceeds the {len(self.designs)} names"
                )

    @property
    def metres_per_block(self) -> float:
        """The side length of a block in metres of the room."""
        return float(np.linalg.norm(self.block_to_room[:3, 0]))


def scene_from_volume(
    volume: BlockVolume,
    *,
    mc_version: str,
    data_version: int,
    spawn: tuple[float, float, float],
    spawn_yaw_deg: float,
    design: np.ndarray | None = None,
    designs: tuple[str, ...] = ("",),
    light: Mapping[str, Any] | None = None,
    objects: tuple[NamedObject, ...] = (),
) -> Scene:
    """Return the scene of a volume that is written for a game version."""
    return Scene(
        volume.semantic,
        volume.instance,
        volume.corner,
        volume.block_to_room,
        mc_version,
        data_version,
        spawn,
        spawn_yaw_deg,
        design,
        designs,
        dict(light or {}),
        objects,
    )


def write_scene(folder: str | Path, scene: Scene) -> None:
    """Write ``scene.json`` and ``scene.npz`` to a folder, and ``designs.json`` if known.

    Raises:
        OutputError: If a file cannot be written.
    """
    target = Path(folder)
    arrays = {"semantic": scene.semantic, "instance": scene.instance}
    if scene.design is not None:
        arrays["design"] = scene.design
        write_json(target / DESIGNS, list(scene.designs))
    write_npz(target / "scene.npz", arrays)
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
            **({"light": dict(scene.light)} if scene.light else {}),
            **({"objects": rows_of_names(scene.objects)} if scene.objects else {}),
        },
    )


def read_scene(folder: str | Path) -> Scene:
    """Read the scene in a folder.

    Raises:
        InputError: If a file does not exist.
        DamagedFileError: If the files do not contain a valid scene.
        LimitError: If an array is too large.
    """
    source = Path(folder)
    raw = read_json(source / "scene.json")
    names = ("semantic", "instance")
    if "design" in npz_array_names(source / "scene.npz"):
        names = (*names, "design")
    arrays = read_npz(source / "scene.npz", names)
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
            arrays.get("design"),
            tuple(map(str, read_json(source / DESIGNS))) if "design" in arrays else ("",),
            dict(raw.get("light", {})),
            names_of_rows(raw.get("objects", []), source / "scene.json"),
        )
    except MALFORMED as error:
        raise DamagedFileError(source / "scene.json", f"is not a valid scene ({error})") from error

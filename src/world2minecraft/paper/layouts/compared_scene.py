"""A scene for comparison between methods, and its file format ``compared.json``."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES, class_id
from world2minecraft.core.errors import MALFORMED, DamagedFileError, World2MinecraftError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Layout, LayoutObject, Placement
from world2minecraft.formats.layout import layout_from_json, layout_to_json

SCENE_FILE = "compared.json"
MAX_BYTES = 16 << 20
DECIMALS = 6  # Micrometres: finer than any margin, so that what is read again scores the same.


@dataclass(frozen=True, eq=False)
class ComparedScene:
    """Rooms and object boxes in one frame: metres, z up, floor at z = 0.

    Attributes:
        name: The name of the scene.
        method: The method that created the scene.
        rooms: The rooms, at least one.
        objects: The boxes as the method placed them, before any conversion to cells.
        unplaced: The names of objects for which the method found no position.
        skipped: Descriptions of entries that could not be read.
        is_height_stated: Whether the wall height is known. If False, no object counts as too high.
        collided: The number of object pairs of a run that collide, based on their cells. None for a
            layout.
    """

    name: str
    method: str
    rooms: tuple[Layout, ...]
    objects: tuple[LayoutObject | Placement, ...]
    unplaced: tuple[str, ...] = ()
    skipped: tuple[str, ...] = ()
    is_height_stated: bool = True
    collided: int | None = None

    def __post_init__(self):
        if not self.rooms:
            raise ValueError("a scene must have at least one room")
        for name in ("rooms", "objects", "unplaced", "skipped"):
            object.__setattr__(self, name, tuple(getattr(self, name)))


def write_scene(path: str | Path, scene: ComparedScene) -> None:
    """Write a scene to a file.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_json(
        path,
        {
            "name": scene.name,
            "method": scene.method,
            "rooms": [layout_to_json(room) for room in scene.rooms],
            "objects": [_row(item) for item in scene.objects],
            "unplaced": list(scene.unplaced),
            "skipped": list(scene.skipped),
            "is_height_stated": scene.is_height_stated,
            "collided": scene.collided,
        },
    )


def read_scene(path: str | Path) -> ComparedScene:
    """Read a scene from a file.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a valid scene.
    """
    data = read_json(path, MAX_BYTES)
    try:
        return ComparedScene(
            name=str(data["name"]),
            method=str(data["method"]),
            rooms=tuple(layout_from_json(row) for row in data["rooms"]),
            objects=tuple(_object(row) for row in data["objects"]),
            unplaced=tuple(str(name) for name in data["unplaced"]),
            skipped=tuple(str(name) for name in data["skipped"]),
            is_height_stated=bool(data["is_height_stated"]),
            collided=None if data["collided"] is None else int(data["collided"]),
        )
    except (*MALFORMED, World2MinecraftError) as error:
        raise DamagedFileError(path, f"not a valid scene of w2m compare ({error})") from error


def _row(item: LayoutObject | Placement) -> dict[str, Any]:
    placed = isinstance(item, Placement)
    return {
        "name": item.template if placed else item.name,
        "class": CLASS_NAMES[item.class_id],
        "center_m": [round(float(value), DECIMALS) for value in item.center_m],
        "size_m": [round(float(value), DECIMALS) for value in item.size_m],
        "yaw_deg": round(float(90 * item.quarter_turns if placed else item.yaw_deg), DECIMALS),
    }


def _object(row: dict[str, Any]) -> LayoutObject:
    return LayoutObject(
        class_id(row["class"]), row["center_m"], row["size_m"], float(row["yaw_deg"]),
        str(row["name"]),
    )  # fmt: skip

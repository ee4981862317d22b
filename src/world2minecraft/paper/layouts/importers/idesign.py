"""Importer of I-Design's ``scene_graph.json``, the scene graph after its solver.

The file is a list of ``{new_object_id, position {x, y, z}, rotation {z_angle}, size_in_meters
{length, width, height}, ...}`` in metres with x east, y north and z up. Positions are centres.
``z_angle`` is the compass bearing of the front: 0 faces north, 90 east. ``length`` is measured from
side to side and ``width`` from front to back. The four walls, the ceiling and the middle of the
room are entries as well and define the room size. An object without ``position`` is one for which
the solver found no position.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.core.errors import MALFORMED
from world2minecraft.core.types import LayoutObject
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import (
    MAX_OBJECTS,
    Box,
    checked_count,
    clean_name,
    number,
    object_of,
    rectangle,
    why,
)

if TYPE_CHECKING:
    from world2minecraft.paper.layouts.importers import How

METHOD = "I-Design"
FLOOR, CEILING = "middle of the room", "ceiling"
SHELL = ("south_wall", "north_wall", "east_wall", "west_wall", CEILING, FLOOR)


class Format:
    """The scene graph format of I-Design."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Return whether JSON data is a scene graph of I-Design."""
        first = data[0] if isinstance(data, list) and data else None
        return isinstance(first, dict) and "new_object_id" in first

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Read the only scene of a scene graph.

        Raises:
            ValueError: If a value is invalid.
            KeyError: If a field is missing.
            TypeError: If a field has the wrong type.
        """
        entries = checked_count(data, MAX_OBJECTS, "entries")
        shell = {one["new_object_id"]: one for one in entries if one["new_object_id"] in SHELL}
        objects, unplaced, skipped = [], [], []
        for one in entries:
            if one["new_object_id"] in SHELL:
                continue
            name = clean_name(one["new_object_id"])
            if not one.get("position"):
                unplaced.append(name)
                continue
            try:
                objects.append(_object(one, name))
            except MALFORMED as error:
                skipped.append(f"{name}: {why(error)}")
        name = path.parent.name if path.stem == "scene_graph" else path.stem
        room = rectangle(*_sides(shell))
        return [ComparedScene(name, METHOD, (room,), tuple(objects), tuple(unplaced),
                              tuple(skipped))]  # fmt: skip


FORMAT = Format()


def _sides(shell: dict[str, Any]) -> tuple[float, float, float]:
    """Return the room size from the positions of the far walls and the ceiling."""
    sides = []
    for name, axis in (("east_wall", "x"), ("north_wall", "y"), (CEILING, "z")):
        if name not in shell:
            raise ValueError(f"{name} is missing, so the room size is unknown")
        sides.append(number(shell[name]["position"][axis], f"{name} {axis}"))
    return sides[0], sides[1], sides[2]


def _object(one: dict[str, Any], name: str) -> LayoutObject:
    place, size = one["position"], one["size_in_meters"]
    x, y, z = (number(place[axis], axis) for axis in "xyz")
    length, width, height = (number(size[key], key) for key in ("length", "width", "height"))
    turn = one.get("rotation") or {}
    bearing = number(turn.get("z_angle", 0.0) if isinstance(turn, dict) else turn, "z_angle")
    return object_of(Box(name, (x, y, z), (width, length, height), 90 - bearing))

"""I-Design: ``scene_graph.json``, the graph after its solver.

A list of ``{new_object_id, position {x, y, z}, rotation {z_angle}, size_in_meters {length, width,
height}, ...}`` in metres, x east, y north, z up, positions of centres. ``z_angle`` is a compass
bearing of the front: 0 looks north, 90 east. ``length`` runs from side to side, ``width`` from
front to back. Four walls, the ceiling and the middle of the room are entries too; the room's sides
come from them. An object without ``position`` is one for which the solver found no place.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.core.types import LayoutObject
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import (
    MAX_OBJECTS,
    READ_ERRORS,
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
    """The format of this module."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Whether a JSON is a scene graph of I-Design."""
        first = data[0] if isinstance(data, list) and data else None
        return isinstance(first, dict) and "new_object_id" in first

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Return its one scene. Raises ValueError, KeyError, TypeError."""
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
            except READ_ERRORS as error:
                skipped.append(f"{name}: {why(error)}")
        name = path.parent.name if path.stem == "scene_graph" else path.stem
        room = rectangle(*_sides(shell))
        return [ComparedScene(name, METHOD, (room,), tuple(objects), tuple(unplaced),
                              tuple(skipped))]  # fmt: skip


FORMAT = Format()


def _sides(shell: dict[str, Any]) -> tuple[float, float, float]:
    """Return the room's sides: where the far walls and the ceiling are."""
    sides = []
    for name, axis in (("east_wall", "x"), ("north_wall", "y"), (CEILING, "z")):
        if name not in shell:
            raise ValueError(f"has no {name}, so the room's size is not known")
        sides.append(number(shell[name]["position"][axis], f"{name} {axis}"))
    return sides[0], sides[1], sides[2]


def _object(one: dict[str, Any], name: str) -> LayoutObject:
    place, size = one["position"], one["size_in_meters"]
    x, y, z = (number(place[axis], axis) for axis in "xyz")
    length, width, height = (number(size[key], key) for key in ("length", "width", "height"))
    turn = one.get("rotation") or {}
    bearing = number(turn.get("z_angle", 0.0) if isinstance(turn, dict) else turn, "z_angle")
    return object_of(Box(name, (x, y, z), (width, length, height), 90 - bearing))

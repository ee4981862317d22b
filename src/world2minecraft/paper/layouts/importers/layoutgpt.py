"""Importer of LayoutGPT's published results in ``llm_output/3D``.

The file is a list of records ``{query_id, iter, prompt, object_list}``. The prompt contains ``Room
Size: max length 270px, max width 252px``, and an object is ``[category, {length, width, height,
left, top, depth, orientation}]``. ``left``, ``top`` and ``depth`` are the centre, and sizes are
full extents. ``left`` is 3D-FRONT's x, and ``top`` its z, which points down the page when seen from
above. Therefore y is the room width minus ``top``, without mirroring. At an orientation of 0
degrees, the front faces along ``top``: with this convention, four fifths of the published beds and
nightstands have their back to the nearest wall.

**Pixels.** In the published files, the shorter side of a room has 256 pixels. The files do not
contain metres, so 256 pixels are assumed to be 3.5 m, which gives desks 0.75 m and chairs 0.89 m
high. Files in metres are used unchanged. Two options of the script give other units: with ``--unit
m --normalize`` the shorter side of every room is 1.00 m, which is interpreted as 256 pixels, and
with ``--unit px`` alone nothing is normalised, and some "pixels" are metres.
"""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.core.errors import MALFORMED
from world2minecraft.core.types import LayoutObject
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import (
    MAX_OBJECTS,
    MAX_SCENES,
    Box,
    checked_count,
    clean_name,
    height_over,
    number,
    object_of,
    rectangle,
    why,
)

if TYPE_CHECKING:
    from world2minecraft.paper.layouts.importers import How

METHOD = "LayoutGPT"
_SIDE = r"\s*([0-9]+(?:\.[0-9]+)?)\s*(px|m)?\b"
_SIZE = re.compile(rf"max\s+length{_SIDE}\s*,\s*max\s+width{_SIDE}", re.I)
SHORTER_PX = 256  # The shorter side of a normalised room;
SLACK = 0.005  # in metres it is 1, given with two decimals.
MAX_ROOM_M = 40.0  # A room with at most this many pixels was not normalised.


class Format:
    """The record format of LayoutGPT."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Return whether JSON data contains records of LayoutGPT."""
        first = data[0] if isinstance(data, list) and data else data
        return isinstance(first, dict) and "object_list" in first

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Read the scene of each record.

        Raises:
            ValueError: If a value is invalid.
            KeyError: If a field is missing.
            TypeError: If a field has the wrong type.
        """
        records = checked_count([data] if isinstance(data, dict) else data, MAX_SCENES, "records")
        return [_scene(record, number, how.px_m) for number, record in enumerate(records)]


FORMAT = Format()


def _scene(record: dict[str, Any], count: int, px_m: float) -> ComparedScene:
    found = _SIZE.search(str(record.get("prompt", "")))
    if found is None:
        raise ValueError(_no_room(record, count))
    unit_m = _unit_m(found, px_m)
    length_m, width_m = float(found[1]) * unit_m, float(found[3]) * unit_m
    objects, skipped = [], []
    for item in checked_count(record["object_list"], MAX_OBJECTS, "objects"):
        try:
            objects.append(_object(item, unit_m, width_m))
        except MALFORMED as error:
            skipped.append(f"{_name(item)}: {why(error)}")
    room = rectangle(length_m, width_m, height_over(objects))
    name = clean_name(record.get("query_id", record.get("id", f"record {count}")))
    return ComparedScene(
        name, METHOD, (room,), tuple(objects), skipped=tuple(skipped), is_height_stated=False
    )


def _unit_m(found: re.Match[str], px_m: float) -> float:
    """Return the length of a record's unit in metres, derived from the sides of its room."""
    shorter, longer = sorted(float(found[group]) for group in (1, 3))
    if "m" in (found[2], found[4]):
        return SHORTER_PX * px_m if abs(shorter - 1) <= SLACK else 1.0
    return px_m if longer > MAX_ROOM_M else 1.0


def _no_room(record: dict[str, Any], count: int) -> str:
    """Return why a record is not a room. LayoutGPT can also lay out images."""
    items = record.get("object_list")
    first = items[0] if isinstance(items, list) and items else None
    if isinstance(first, list) and len(first) == 2 and isinstance(first[1], list):
        return f"record {count} is an image layout; room layouts are in LayoutGPT's llm_output/3D"
    return f"record {count} has no room size, such as 'max length 270px, max width 252px'"


def _name(item: Any) -> str:
    return clean_name(item[0] if isinstance(item, (list, tuple)) and item else None)


def _object(item: Any, unit_m: float, width_m: float) -> LayoutObject:
    if not (isinstance(item, (list, tuple)) and len(item) == 2 and isinstance(item[1], dict)):
        raise ValueError("expected [category, {length, width, height, left, top, ...}]")
    data = item[1]
    length, width, height = (
        number(data[key], key) * unit_m for key in ("length", "width", "height")
    )
    left, top = (number(data[key], key) * unit_m for key in ("left", "top"))
    middle = number(data["depth"], "depth") * unit_m if "depth" in data else height / 2
    turned = number(data.get("orientation", 0.0), "orientation")
    return object_of(
        Box(_name(item), (left, width_m - top, middle), (width, length, height), turned - 90)
    )

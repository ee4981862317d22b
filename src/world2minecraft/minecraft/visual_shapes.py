"""Visible boxes of block states, and the blocks that are rendered at full brightness.

The hand-written data file ``data/visual_boxes.json`` defines the visible boxes of fences, walls,
signs, torches, plants and others. All other blocks look like their collision boxes.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache, lru_cache
from typing import Any

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.data_files import read_data

LUMINOUS = (
    "sea_lantern",
    "glowstone",
    "shroomlight",
    "froglight",
    "lantern",
    "torch",
    "end_rod",
    "redstone_lamp[lit=true",
    "beacon",
    "candle",
)
DARK = ("torchflower", "lit=false")  # A flower, and candles and torches that do not burn.
# Clockwise from above, from the side that the data file's boxes are written for.
QUARTERS = ("north", "east", "south", "west")


def is_luminous(state: str) -> bool:
    """Return whether a block state is rendered at full brightness."""
    return any(part in state for part in LUMINOUS) and not any(part in state for part in DARK)


@dataclass(frozen=True, eq=False)
class VisualFamily:
    """A family of blocks with the same look: their name patterns and their visible parts."""

    name: str
    patterns: tuple[str, ...]
    needs: tuple[str, ...]
    turn: str
    rotation: str
    point: str
    axis: str
    parts: tuple[Mapping[str, Any], ...]


@lru_cache(maxsize=1 << 16)
def visual_boxes(state: str) -> np.ndarray:
    """Return the visible boxes of a block state.

    Args:
        state: Text of the block state. Missing properties have their default values.

    Returns:
        The boxes as read-only float32 [N, 6] with x0, y0, z0, x1, y1, z1 in block units within the
        unit cube: x is east, y is up and z is south. The boxes do not overlap, except at the edges
        of vines. Air, barriers and light blocks have no box.

    Raises:
        UsageError: If the text is not a valid block state.

    Example:
        >>> visual_boxes("minecraft:red_carpet").tolist()
        [[0.0, 0.0, 0.0, 1.0, 0.0625, 1.0]]
    """
    whole = complete(parse_state(state))
    family = find_visual_family(whole)
    boxes = _table_boxes(whole) if family is None else _family_boxes(family, whole)
    boxes.flags.writeable = False
    return boxes


def find_visual_family(state: BlockState) -> VisualFamily | None:
    """Return the visual family of a complete block state, or None if it has none."""
    name = state.name.partition(":")[2]
    properties = dict(state.properties)
    for family in visual_families():
        if all(key in properties for key in family.needs) and any(
            fnmatchcase(name, pattern) for pattern in family.patterns
        ):
            return family
    return None


@cache
def visual_families() -> tuple[VisualFamily, ...]:
    """Load the visual families from the bundled file. The first match of a block applies."""
    raw = read_data("visual_boxes.json")
    return tuple(_family(entry) for entry in raw["families"])


def _family(entry: Mapping[str, Any]) -> VisualFamily:
    turn, rotation, point, axis = (
        entry.get(key, "") for key in ("turn", "rotation", "point", "axis")
    )
    turning = [key for key in (turn, rotation, point, axis) if key]
    sides = QUARTERS if any("sides" in part for part in entry["parts"]) else ()
    return VisualFamily(
        name=entry["name"],
        patterns=tuple(entry["blocks"]),
        needs=(*entry.get("needs", ()), *turning, *sides),
        turn=turn,
        rotation=rotation,
        point=point,
        axis=axis,
        parts=tuple(entry["parts"]),
    )


def _table_boxes(state: BlockState) -> np.ndarray:
    """Return the collision boxes clipped to the unit cube."""
    boxes = np.clip(boxes_of(str(state)), 0, 1)
    return boxes[(boxes[:, 3:] > boxes[:, :3]).all(axis=1)]


def _family_boxes(family: VisualFamily, state: BlockState) -> np.ndarray:
    values = dict(state.properties)
    drawn = [box for part in family.parts for box in _part_boxes(part, values)]
    boxes = np.array(drawn, np.float64).reshape(-1, 6)
    if family.turn:
        boxes = _rotate(boxes, _quarter(values[family.turn]))
    if family.rotation:
        boxes = _rotate(boxes, _quarter_of_rotation(values[family.rotation]))
    if family.point:
        boxes = _tip(boxes, values[family.point])
    if family.axis and values[family.axis] != "y":
        boxes = _rotate(_tip(boxes, "north"), values[family.axis] == "x")
    return (boxes / 16).astype(np.float32)


def _part_boxes(part: Mapping[str, Any], values: Mapping[str, str]) -> Iterator[list[float]]:
    """Yield the boxes of a part in sixteenths, if the state shows the part."""
    when = part.get("when", {})
    cases = when if isinstance(when, list) else [when]
    if not any(all(_holds(values, *pair) for pair in case.items()) for case in cases):
        return
    if "sides" not in part and "faces" not in part:
        yield from part["boxes"]
        return
    wanted = part.get("sides", part.get("faces"))
    boxes = np.array(part["boxes"], np.float64)
    for quarter, side in enumerate(QUARTERS):
        if _holds(values, side, wanted):
            yield from _rotate(boxes, quarter).tolist()
    if "faces" in part:
        for side in ("up", "down"):
            if _holds(values, side, wanted):
                upright = boxes[:, [0, 2, 1, 3, 5, 4]]  # The north face's plate, laid down.
                yield from _tip(upright, "down" if side == "up" else "up").tolist()


def _holds(values: Mapping[str, str], key: str, wanted: str) -> bool:
    return values.get(key, "") in wanted.split("|")


def _quarter(facing: str) -> int:
    """Return the number of clockwise quarter turns from north to a side."""
    return QUARTERS.index(facing) if facing in QUARTERS else 0


def _quarter_of_rotation(rotation: str) -> int:
    """Return the nearest quarter turn of a sign rotation, in which 0 is south, clockwise."""
    sixteenths = int(rotation) % 16 if rotation.isdecimal() and len(rotation) < 4 else 0
    return ((sixteenths + 2) // 4 + 2) % 4


def _rotate(boxes: np.ndarray, quarters: int) -> np.ndarray:
    """Rotate boxes, float64 [N, 6] in sixteenths, clockwise from above: x' = 16 - z, z' = x."""
    for _ in range(int(quarters) % 4):
        x0, y0, z0, x1, y1, z1 = boxes.T
        boxes = np.stack([16 - z1, y0, x0, 16 - z0, y1, x1], axis=1)
    return boxes


def _tip(boxes: np.ndarray, facing: str) -> np.ndarray:
    """Tilt boxes that are defined for up towards one of the six sides."""
    x0, y0, z0, x1, y1, z1 = boxes.T
    if facing == "down":
        return np.stack([x0, 16 - y1, z0, x1, 16 - y0, z1], axis=1)
    if facing in QUARTERS:
        north = np.stack([x0, z0, 16 - y1, x1, z1, 16 - y0], axis=1)
        return _rotate(north, _quarter(facing))
    return boxes

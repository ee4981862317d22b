"""The physical sense of what was placed: collisions, bounds, and the classes that got lost."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.coordinates import apply
from world2minecraft.evaluate.objects import TrueObjects, semantic_integrity
from world2minecraft.exchange.objects import read_placements
from world2minecraft.exchange.scan import read_room_size
from world2minecraft.metrics.layout import collisions, out_of_bounds
from world2minecraft.types import Layout


def layout_facts(
    out: Path, own: Sequence[Layout], true: Sequence[Layout], objects: TrueObjects
) -> dict[str, Any]:
    """Return the counts of the placements of a run; empty where it was not furnished.

    Args:
        out: the folder of the run.
        own: the rooms that the run found, in the room frame.
        true: the true rooms in the room frame.
        objects: the true objects.
    """
    if not (out / "placements.json").is_file():
        return {}
    placements = read_placements(out / "placements.json")
    return {
        "placements": len(placements),
        "collisions": len(collisions(placements)),
        "out_of_bounds": len(_outside(placements, own)),
        "out_of_true_rooms": len(_outside(placements, true)),
        "semantic_integrity": semantic_integrity(placements, objects),
    }


def own_rooms(out: Path) -> tuple[Layout, ...]:
    """Return the room that a run found, as its scan was aligned to it. Raises InputError."""
    width, depth, height = read_room_size(out / "scan.json").tolist()
    outline = np.array([[0, 0], [width, 0], [width, depth], [0, depth]], np.float64)
    return (Layout(outline, height),)


def in_room(layouts: Sequence[Layout], truth_to_room: np.ndarray) -> tuple[Layout, ...]:
    """Carry the outlines of true rooms into the estimated frame; their openings stay behind."""
    moved = []
    for layout in layouts:
        heights = np.full((len(layout.floor_polygon_m), 1), layout.floor_z_m)
        corners = apply(truth_to_room, np.hstack([layout.floor_polygon_m, heights]))
        floor = float(corners[:, 2].mean())
        moved.append(
            replace(
                layout, floor_polygon_m=corners[:, :2], floor_z_m=floor, openings=(), objects=()
            )
        )
    return tuple(moved)


def _outside(placements: Sequence[Any], rooms: Sequence[Layout]) -> set[int]:
    """Return the placements that lie wholly within none of the rooms."""
    outside = set(range(len(placements))) if rooms else set()
    for room in rooms:
        outside &= set(out_of_bounds(placements, room.floor_polygon_m))
    return outside

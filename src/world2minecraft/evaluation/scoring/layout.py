"""The physical sense of what was placed: collisions, bounds, and the classes that got lost."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import Layout, OccupancyGrid
from world2minecraft.evaluation.scoring.objects import TrueObjects
from world2minecraft.formats.objects import read_placements
from world2minecraft.formats.rooms import read_rooms
from world2minecraft.furniture.layout_checks import category_integrity, collisions, out_of_rooms


def layout_facts(
    out: Path, grid: OccupancyGrid, true_rooms: Sequence[Layout], objects: TrueObjects
) -> dict[str, Any]:
    """Return the counts of the placements of a run; empty where it was not furnished.

    ``out_of_bounds`` is judged by the rooms that the run itself found, ``out_of_true_rooms`` by
    the true ones; an object may stand in any of several rooms. ``semantic_integrity`` is the
    share of the object classes that were seen in the true room and were placed.

    Args:
        out: the folder of the run.
        grid: its ``room.npz``.
        true_rooms: the true rooms in the room frame.
        objects: the true objects.
    """
    if not (out / "placements.json").is_file():
        return {}
    placements = read_placements(out / "placements.json")
    pairs = zip(objects.objects, objects.seen, strict=True)
    judged = {"out_of_true_rooms": _outside(placements, true_rooms)} if true_rooms else {}
    return judged | {
        "placements": len(placements),
        "collisions": len(collisions(placements, grid=grid)),
        "out_of_bounds": _outside(placements, read_rooms(out, grid)),
        "semantic_integrity": category_integrity(
            {item.class_id for item in placements}, {item.class_id for item, seen in pairs if seen}
        ),
    }


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


def _outside(placements: Sequence[Any], rooms: Sequence[Layout]) -> int:
    """Return how many placements lie wholly within none of the rooms, where any are known."""
    return len(out_of_rooms(placements, rooms)) if rooms else 0

"""The figures of the layout: what collides, lies outside, hangs in the air or got lost."""

from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.types import UNSEEN, Layout
from world2minecraft.evaluation.report.scene import FinishedScene
from world2minecraft.furniture.layout_checks import (
    category_integrity,
    collisions,
    floaters,
    kept_objects,
    out_of_rooms,
    overlapping_boxes,
)


def layout_facts(scene: FinishedScene) -> dict[str, Any]:
    """Return the layout's figures; ``furniture.layout_checks`` says what each means.

    ``floaters`` are parts of the built blocks, ``floaters_seen`` of the room's cells.
    ``semantic_integrity`` compares the world with what was found: its ``categories``, and the
    share of ``objects`` whose blocks still show them.
    """
    placed = scene.placements
    outside = out_of_rooms(placed, scene.rooms)
    kept = kept_objects(scene.volume, scene.instances, scene.grid)
    lost = sorted(set(range(len(scene.instances))) - set(kept))
    found = {one.class_id for one in scene.instances}
    return {
        "collisions": len(collisions(placed, grid=scene.grid)),
        "overlapping_boxes": len(overlapping_boxes(placed)),
        "out_of_bounds": len(outside),
        "out_of_bounds_rate": round(len(outside) / max(len(placed), 1), 4),
        "floaters": floaters(scene.volume.semantic).parts,
        "floaters_seen": floaters(scene.grid.labels).parts,
        "semantic_integrity": {
            "categories": round(category_integrity(built_categories(scene), found), 4),
            "objects": round(len(kept) / max(len(scene.instances), 1), 4)
            if scene.instances
            else 1.0,
            "lost": [scene.instances[index].id for index in lost],
        },
    }


def built_categories(scene: FinishedScene) -> set[int]:
    """Return the object classes that stand in the world."""
    return set(np.unique(scene.volume.semantic).tolist()) & set(OBJECT_CLASSES)


def room_rows(scene: FinishedScene) -> list[dict[str, Any]]:
    """Return one row for each room: its floor, its height, what it holds and its openings."""
    rows = []
    for number, room in enumerate(scene.rooms, 1):
        inside = set(range(len(scene.placements))) - set(out_of_rooms(scene.placements, [room]))
        ids = {scene.placements[index].object_id for index in inside}
        kinds = [opening.kind for opening in room.openings]
        rows.append(
            {
                "name": room.name or f"room {number}",
                "area_m2": round(_area_m2(room), 2),
                "height_m": round(room.wall_height_m, 2),
                "floor_z_m": round(room.floor_z_m, 2),
                "objects": len(ids),
                "openings": {kind: kinds.count(kind) for kind in sorted(set(kinds))},
            }
        )
    return rows


def confidence_facts(scene: FinishedScene) -> dict[str, Any]:
    """Return how sure the labels are: of all reached cells, and by class."""
    reached = scene.grid.source != UNSEEN
    confidence = scene.grid.confidence.astype(np.float64)
    rows = {}
    for number, name in enumerate(CLASS_NAMES):
        cells = confidence[reached & (scene.grid.labels == number)]
        if len(cells):
            rows[name] = round(float(cells.mean()), 3)
    cells = confidence[reached & scene.grid.occupied]
    return {
        "mean": round(float(cells.mean()), 3) if len(cells) else 0.0,
        "below_half": round(float((cells < 0.5).mean()), 4) if len(cells) else 0.0,
        "by_class": rows,
    }


def _area_m2(room: Layout) -> float:
    x, y = room.floor_polygon_m.T
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)

"""Measures of the report that require no ground truth, as functions of a finished scene.

They count collisions, objects out of bounds, floating parts and lost objects, as well as observed,
completed and placed cells.
"""

from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.coordinates import apply, cell_centers_m, invert
from world2minecraft.core.types import COMPLETED, OBSERVED, OWN_CELLS, UNSEEN, BlockVolume
from world2minecraft.evaluation.report.finished_run import FinishedScene
from world2minecraft.furniture.footprints import area_m2
from world2minecraft.furniture.layout_checks import (
    category_integrity,
    collisions,
    floaters,
    kept_objects,
    out_of_rooms,
    overlapping_boxes,
)
from world2minecraft.geometry.level_planes import HorizontalPlane, find_horizontal_planes
from world2minecraft.reconstruction.verification.built_names import stands_for

NEIGHBOURS = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


def layout_facts(scene: FinishedScene) -> dict[str, Any]:
    """Return the layout measures that ``furniture.layout_checks`` defines.

    ``floaters`` counts parts of the built blocks, and ``floaters_seen`` parts of the room's cells.
    ``semantic_integrity`` compares the world with the detected objects: the share of ``objects``
    that are preserved, and of ``categories`` of which at least one object is preserved.
    """
    placed = scene.placements
    outside = out_of_rooms(placed, scene.rooms)
    surviving = preserved_objects(scene)
    lost = sorted(set(range(len(scene.instances))) - set(surviving))
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
            "objects": round(len(surviving) / max(len(scene.instances), 1), 4)
            if scene.instances
            else 1.0,
            "lost": [scene.instances[index].id for index in lost],
        },
    }


def preserved_objects(scene: FinishedScene) -> list[int]:
    """Return the indices of the objects whose place has blocks that can stand for them.

    Blocks of the object must be in its place (``kept_objects``), and the furniture must show the
    name of the object, or be of its class: a bathroom of armchairs preserves nothing.
    """
    kept = kept_objects(scene.volume, scene.instances, scene.grid)
    return [index for index in kept if stands_for(scene.instances[index], scene.placements)]


def built_categories(scene: FinishedScene) -> set[int]:
    """Return the classes of the objects that are preserved in the built world."""
    return {scene.instances[index].class_id for index in preserved_objects(scene)}


def room_rows(scene: FinishedScene) -> list[dict[str, Any]]:
    """Return a row for each room with its floor area, height, objects and openings."""
    rows = []
    for number, room in enumerate(scene.rooms, 1):
        inside = set(range(len(scene.placements))) - set(out_of_rooms(scene.placements, [room]))
        ids = {scene.placements[index].object_id for index in inside}
        kinds = [opening.kind for opening in room.openings]
        rows.append(
            {
                "name": room.name or f"room {number}",
                "area_m2": round(area_m2(room.floor_polygon_m), 2),
                "height_m": round(room.wall_height_m, 2),
                "floor_z_m": round(room.floor_z_m, 2),
                "objects": len(ids),
                "openings": {kind: kinds.count(kind) for kind in sorted(set(kinds))},
            }
        )
    return rows


def confidence_facts(scene: FinishedScene) -> dict[str, Any]:
    """Return the mean label confidence of occupied cells, in total and by class."""
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


def scene_facts(scene: FinishedScene) -> dict[str, Any]:
    """Return all values of ``report.json`` that require no ground truth."""
    planes = scene_planes(scene)
    floors = [plane for plane in planes if plane.class_id == 2]
    largest = max(floors, key=lambda plane: plane.area_m2, default=None)
    return {
        "room_size_m": [round(float(v), 3) for v in scene.room_size_m],
        "floor_m": None if largest is None else largest.height_m,
        "planes": [
            {"class": CLASS_NAMES[p.class_id], "height_m": p.height_m, "area_m2": p.area_m2}
            for p in planes
        ],
        "voxels": voxel_counts(scene),
        "surface_explained": surface_explained(scene),
        "objects": object_rows(scene),
        "built": built_shares(scene),
        "layout": layout_facts(scene),
        "rooms": room_rows(scene),
        "confidence": confidence_facts(scene),
        "object_cells_without_object": int(
            (np.isin(scene.grid.labels, OBJECT_CLASSES) & (scene.grid.instance == 0)).sum()
        ),
        "blocks": int((scene.volume.semantic > 0).sum()),
        "entities": len(scene.volume.entities),
        "blocks_per_metre": scene.volume.blocks_per_metre,
    }


def scene_planes(scene: FinishedScene) -> tuple[HorizontalPlane, ...]:
    """Return the horizontal surfaces of the fused room, with heights at sub-cell precision."""
    evidence = scene.evidence
    layers = np.arange(evidence.hits.shape[2])
    middle_m = evidence.origin_m[2] + (layers + 0.5) * evidence.voxel_m
    mean_m = middle_m + evidence.offset_sum[..., 2] / np.maximum(evidence.hits, 1)
    observed = np.where(scene.grid.source == COMPLETED, 255, scene.grid.labels)
    return find_horizontal_planes(observed, mean_m, evidence.hits, evidence.voxel_m)


def voxel_counts(scene: FinishedScene) -> dict[str, dict[str, int]]:
    """Return the number of observed and completed cells by class, including unknown."""
    labels, source = scene.grid.labels, scene.grid.source
    rows = {
        name: {
            "observed": int(((labels == n) & (source == OBSERVED)).sum()),
            "completed": int(((labels == n) & (source == COMPLETED)).sum()),
        }
        for n, name in enumerate(CLASS_NAMES)
    }
    return rows | {"unknown": {"observed": int((labels == 255).sum()), "completed": 0}}


def surface_explained(scene: FinishedScene) -> dict[str, float]:
    """Return the share of observed surface cells inside a block, exactly and within one cell."""
    grid = scene.grid
    cells = np.argwhere(grid.occupied & (grid.source == OBSERVED))
    if not len(cells):
        return {"exact": 0.0, "within_one_voxel": 0.0}
    centers_m = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
    exact = in_solid_block(scene.volume, centers_m)
    near = exact.copy()
    for step in NEIGHBOURS:
        near |= in_solid_block(scene.volume, centers_m + step * grid.voxel_m)
    return {"exact": round(float(exact.mean()), 4), "within_one_voxel": round(near.mean(), 4)}


def in_solid_block(volume: BlockVolume, points_m: np.ndarray) -> np.ndarray:
    """Return which room points [N, 3] are inside a block that has a class.

    Invisible lights and barriers have no class and do not count.
    """
    blocks = np.floor(apply(invert(volume.block_to_room), points_m) - volume.corner + 1e-9)
    shape = np.array(volume.states.shape)
    inside = np.asarray(((blocks >= 0) & (blocks < shape)).all(axis=1))
    at = np.where(inside[:, None], blocks, 0).astype(np.int64)
    return inside & (volume.semantic[tuple(at.T)] > 0)


def object_rows(scene: FinishedScene) -> list[dict[str, Any]]:
    """Return a row for each object, with the templates that were placed for it."""
    rows = []
    for instance in scene.instances:
        mine = [p for p in scene.placements if p.object_id == instance.id]
        named = {}
        if instance.name:
            confidence = round(float(instance.name_confidence), 3)
            named = {"name": instance.name, "name_confidence": confidence}
        placed = {p.template for p in mine}
        others = {a.template: a.iou for p in mine for a in p.alternatives}
        rows.append(
            named
            | {
                "id": instance.id,
                "class": CLASS_NAMES[instance.class_id],
                "center_m": [round(float(v), 2) for v in instance.center_m],
                "size_m": [round(float(v), 2) for v in instance.size_m],
                "yaw_deg": round(float(instance.yaw_deg), 1),
                "confidence": round(float(instance.confidence), 3),
                "templates": [{"name": p.template, "iou": round(float(p.iou), 3)} for p in mine],
                "alternatives": [
                    {"name": name, "iou": round(float(iou), 3)}
                    for name, iou in sorted(others.items(), key=lambda one: (-one[1], one[0]))
                    if name not in placed
                ],
            }
        )
    return rows


def built_shares(scene: FinishedScene) -> dict[str, float]:
    """Return the shares of placements built from a template and from their own cells."""
    own = sum(placement.template == OWN_CELLS for placement in scene.placements)
    total = max(len(scene.placements), 1)
    return {"own_cells": round(own / total, 4), "template": round((total - own) / total, 4)}

"""The figures of the report that need no truth: pure functions of a finished scene."""

from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.coordinates import apply, cell_centers_m, invert
from world2minecraft.core.types import COMPLETED, OBSERVED, BlockVolume
from world2minecraft.evaluation.report.layout import confidence_facts, layout_facts, room_rows
from world2minecraft.evaluation.report.scene import FinishedScene
from world2minecraft.geometry.planes import LevelPlane, level_planes

NEIGHBOURS = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


def scene_facts(scene: FinishedScene) -> dict[str, Any]:
    """Return every figure of ``report.json`` that needs no truth."""
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


def scene_planes(scene: FinishedScene) -> tuple[LevelPlane, ...]:
    """Return the level surfaces of the fused room, their heights finer than a cell."""
    evidence = scene.evidence
    layers = np.arange(evidence.hits.shape[2])
    middle_m = evidence.origin_m[2] + (layers + 0.5) * evidence.voxel_m
    mean_m = middle_m + evidence.offset_sum[..., 2] / np.maximum(evidence.hits, 1)
    observed = np.where(scene.grid.source == COMPLETED, 255, scene.grid.labels)
    return level_planes(observed, mean_m, evidence.hits, evidence.voxel_m)


def voxel_counts(scene: FinishedScene) -> dict[str, dict[str, int]]:
    """Return, for each class and for unknown, how many cells were observed and completed."""
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
    """Return the share of observed surface cells that stand in a block, and within one cell."""
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
    """Return which room points [N, 3] lie in a block that stands for something.

    Invisible lights and barriers have no class, and do not count.
    """
    blocks = np.floor(apply(invert(volume.block_to_room), points_m) - volume.corner + 1e-9)
    shape = np.array(volume.states.shape)
    inside = np.asarray(((blocks >= 0) & (blocks < shape)).all(axis=1))
    at = np.where(inside[:, None], blocks, 0).astype(np.int64)
    return inside & (volume.semantic[tuple(at.T)] > 0)


def object_rows(scene: FinishedScene) -> list[dict[str, Any]]:
    """Return one row for each object, with the templates put in its place."""
    rows = []
    for instance in scene.instances:
        mine = [p for p in scene.placements if p.object_id == instance.id]
        rows.append(
            {
                "id": instance.id,
                "class": CLASS_NAMES[instance.class_id],
                "center_m": [round(float(v), 2) for v in instance.center_m],
                "size_m": [round(float(v), 2) for v in instance.size_m],
                "yaw_deg": round(float(instance.yaw_deg), 1),
                "confidence": round(float(instance.confidence), 3),
                "templates": [{"name": p.template, "iou": round(float(p.iou), 3)} for p in mine],
            }
        )
    return rows


def built_shares(scene: FinishedScene) -> dict[str, float]:
    """Return the share of placements built by a template and from their own cells."""
    own = sum(placement.template == "cells" for placement in scene.placements)
    total = max(len(scene.placements), 1)
    return {"own_cells": round(own / total, 4), "template": round((total - own) / total, 4)}

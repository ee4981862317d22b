"""The report's figures against scenes whose figures are known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.construction import build_volume
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import (
    BlockVolume,
    FusedEvidence,
    Layout,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.evaluation.report.finished_run import FinishedScene, read_built
from world2minecraft.evaluation.report.measures import (
    in_solid_block,
    layout_facts,
    scene_facts,
    surface_explained,
)

VOXEL_M = 0.08


def floor_and_table() -> FinishedScene:
    """A floor of 2.0 x 1.6 m and a table top at 0.72 m; a world at one block a voxel."""
    labels = np.zeros((25, 20, 12), np.uint8)
    labels[:, :, 0] = 2
    labels[5:15, 5:12, 9] = 8
    labels[20:, 18:, 5:] = 255
    known = labels != 255
    hits = ((labels > 0) & known).astype(np.uint16) * 10
    offset = np.zeros((*labels.shape, 3), np.float32)
    offset[..., 2] = 0.04 * hits - 0.002 * hits
    origin_m = np.array([0, 0, -VOXEL_M])
    evidence = FusedEvidence(
        log_odds=np.where(hits > 0, 3, np.where(known, -1, 0)).astype(np.float16),
        votes=np.zeros((*labels.shape, 12), np.float16),
        colour_sum=np.zeros((*labels.shape, 3), np.float32),
        offset_sum=offset,
        hits=hits,
        voxel_m=VOXEL_M,
        origin_m=origin_m,
        scan_to_room=np.eye(4),
    )
    instance = np.where(labels == 8, 1, 0).astype(np.uint16)
    grid = OccupancyGrid(
        labels=labels,
        confidence=known.astype(np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=known.astype(np.uint8),
        instance=instance,
        voxel_m=VOXEL_M,
        origin_m=origin_m,
    )
    cells = np.argwhere(instance == 1).astype(np.int32)
    table = ObjectInstance(1, 8, [0.8, 0.68, 0.68], [0.8, 0.56, 0.08], 0.0, cells, 0.9)
    placed = Placement(1, 8, "dining_table", [0.8, 0.68, 0.36], [0.8, 0.56, 0.72], 0, 0.7)
    away = Placement(2, 11, "cells", [3.0, 0.8, 0.1], [0.2, 0.2, 0.2], 0, 0.1)
    semantic = np.ascontiguousarray(np.swapaxes(np.where(known, labels, 0)[:, ::-1], 1, 2))
    volume = BlockVolume(
        states=(semantic > 0).astype(np.uint16),
        palette=("minecraft:air", "minecraft:stone"),
        semantic=semantic.astype(np.uint8),
        instance=np.zeros(semantic.shape, np.uint16),
        corner=(0, 63, 0),
        block_to_room=block_to_room(np.array([0.0, 1.6]), 12.5),
    )
    room = np.array([2.0, 1.6, 0.88])
    outline = Layout(np.array([[0, 0], [2, 0], [2, 1.6], [0, 1.6]]), 0.88)
    return FinishedScene(Path(), grid, evidence, (table,), (placed, away), volume, room, (outline,))


def test_heights_are_finer_than_cells():
    facts = scene_facts(floor_and_table())
    assert facts["floor_m"] == pytest.approx(-0.002, abs=1e-3)
    (table,) = [plane for plane in facts["planes"] if plane["class"] == "table"]
    assert table["height_m"] == pytest.approx(0.718, abs=1e-3)
    assert table["area_m2"] == pytest.approx(10 * 7 * VOXEL_M**2, abs=1e-3)


def test_counts_objects_and_layout():
    facts = scene_facts(floor_and_table())
    assert facts["voxels"]["floor"] == {"observed": 500, "completed": 0}
    assert facts["voxels"]["unknown"]["observed"] == 5 * 2 * 7
    assert facts["objects"][0]["templates"] == [{"name": "dining_table", "iou": 0.7}]
    assert facts["built"] == {"own_cells": 0.5, "template": 0.5}
    assert facts["layout"]["out_of_bounds"] == 1 and facts["layout"]["collisions"] == 0
    assert facts["layout"]["floaters"] == 1, "a table top without legs hangs in the air"
    assert facts["object_cells_without_object"] == 0
    assert facts["blocks"] == 500 + 70


def test_true_world_is_explained_empty_world_is_not():
    scene = floor_and_table()
    assert surface_explained(scene) == {"exact": 1.0, "within_one_voxel": 1.0}
    blank = BlockVolume(
        states=np.zeros_like(scene.volume.states),
        palette=("minecraft:air",),
        semantic=np.zeros_like(scene.volume.semantic),
        instance=scene.volume.instance,
        corner=scene.volume.corner,
        block_to_room=scene.volume.block_to_room,
    )
    empty = FinishedScene(Path(), scene.grid, scene.evidence, (), (), blank, scene.room_size_m)
    assert surface_explained(empty) == {"exact": 0.0, "within_one_voxel": 0.0}


def test_points_beside_the_volume_are_in_no_block():
    volume = floor_and_table().volume
    points = np.array([[-0.5, 0.5, -0.04], [1.0, 0.8, -0.04], [1.0, 0.8, 0.3], [1, 1, 50]])
    assert in_solid_block(volume, points).tolist() == [False, True, False, False]


def test_a_build_whose_parts_do_not_belong_together_is_refused(tmp_path):
    from world2minecraft.construction import write_build

    volume = floor_and_table().volume
    write_build(tmp_path / "a", volume)
    again = read_built(tmp_path / "a")
    assert np.array_equal(again.semantic, volume.semantic)
    assert np.array_equal(again.states > 0, volume.states > 0) and again.corner == volume.corner
    np.savez(
        tmp_path / "a/scene.npz",
        semantic=np.zeros((2, 2, 2), np.uint8),
        instance=np.zeros((2, 2, 2), np.uint16),
    )
    with pytest.raises(
        DamagedFileError, match=(r"does not belong to the " r"room\.schem in the same folder")
    ):
        read_built(tmp_path / "a")


def test_rooms_confidence_and_integrity_are_told():
    scene = floor_and_table()
    facts = scene_facts(scene)
    (room,) = facts["rooms"]
    assert room["area_m2"] == pytest.approx(3.2) and room["objects"] == 1
    assert room["name"] == "room 1" and room["openings"] == {}
    assert facts["confidence"]["mean"] == 1.0 and facts["confidence"]["below_half"] == 0.0
    assert set(facts["confidence"]["by_class"]) == {"empty", "floor", "table"}
    integrity = facts["layout"]["semantic_integrity"]
    assert integrity == {"categories": 0.0, "objects": 0.0, "lost": [1]}, "no block has its number"
    named = replace(scene.volume, instance=(scene.volume.semantic == 8).astype(np.uint16))
    kept = scene_facts(replace(scene, volume=named))["layout"]["semantic_integrity"]
    assert kept == {"categories": 1.0, "objects": 1.0, "lost": []}


def bathroom(templates: dict[str, str]) -> FinishedScene:
    """A toilet and a washbasin that are built from the given templates."""
    scene = floor_and_table()
    labels, instance = scene.grid.labels.copy(), scene.grid.instance.copy()
    labels[labels == 8], instance[:] = 0, 0
    instances, placements = [], []
    for number, (name, class_id, low) in enumerate(
        [("toilet", 11, (3, 3)), ("washbasin", 10, (12, 3))], start=1
    ):
        box = (slice(low[0], low[0] + 6), slice(low[1], low[1] + 6), slice(1, 9))
        labels[box], instance[box] = class_id, number
        cells = np.argwhere(instance == number).astype(np.int32)
        center_m = (cells.mean(axis=0) + 0.5) * VOXEL_M + scene.grid.origin_m
        size_m = [6 * VOXEL_M, 6 * VOXEL_M, 8 * VOXEL_M]
        instances.append(
            ObjectInstance(number, class_id, center_m, size_m, 0.0, cells, 0.9, name, 0.9)
        )
        placements.append(Placement(number, class_id, templates[name], center_m, size_m, 0, 0.7))
    labels[labels == 255] = 0
    grid = replace(scene.grid, labels=labels, instance=instance, source=np.ones_like(labels))
    volume = build_volume(grid, placements, instances)
    return replace(
        scene, grid=grid, instances=tuple(instances), placements=tuple(placements), volume=volume
    )


def test_a_bathroom_of_armchairs_has_no_integrity():
    facts = layout_facts(bathroom({"toilet": "armchair", "washbasin": "armchair"}))
    assert facts["semantic_integrity"] == {"categories": 0.0, "objects": 0.0, "lost": [1, 2]}


def test_a_bathroom_of_bathroom_furniture_has_integrity():
    facts = layout_facts(bathroom({"toilet": "toilet", "washbasin": "vanity"}))
    assert facts["semantic_integrity"] == {"categories": 1.0, "objects": 1.0, "lost": []}

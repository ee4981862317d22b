"""How an occupancy made from pictures compares with one made from depth.

Two finished runs of one room are held against each other: cells of both are carried to the frame
of the reference's capture. Within one voxel means centres at most a voxel's diagonal apart.
"""

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from world2minecraft.posing.similarity import align_similarity
from world2minecraft.types import OBSERVED

REACH_VOXELS = 3**0.5 + 0.01


class Cells(NamedTuple):
    """What a run found, centres [N, 3] in metres of its capture's frame."""

    occupied_m: np.ndarray
    free_m: np.ndarray
    labels: np.ndarray
    source: np.ndarray
    origin_m: np.ndarray
    voxel_m: float
    scan_to_room: np.ndarray


def read_cells(room_file: Path) -> Cells:
    """Read the observed and the free cells of a ``room.npz``."""
    with np.load(room_file) as room:
        labels, source, origin = room["labels"], room["source"], room["origin_m"]
        voxel, scan_to_room = float(room["voxel_m"]), room["scan_to_room"]
    to_scan = np.linalg.inv(scan_to_room)

    def centers(mask):
        at = origin + (np.argwhere(mask) + 0.5) * voxel
        return at @ to_scan[:3, :3].T + to_scan[:3, 3]

    occupied = (labels > 0) & (labels != 255) & (source == 1)
    return Cells(
        centers(occupied), centers(labels == 0), labels, source, origin, voxel, scan_to_room
    )


def looked_up(cells: Cells, points_m: np.ndarray) -> np.ndarray:
    """Return the labels of the cells that hold points of the capture's frame.

    255 where they lie outside, and where nobody saw: what was completed is no observation.
    """
    at = points_m @ cells.scan_to_room[:3, :3].T + cells.scan_to_room[:3, 3]
    index = np.floor((at - cells.origin_m) / cells.voxel_m + 1e-9).astype(int)
    inside = ((index >= 0) & (index < cells.labels.shape)).all(axis=1)
    found = np.full(len(points_m), 255, np.uint8)
    at = tuple(index[inside].T)
    found[inside] = np.where(cells.source[at] == OBSERVED, cells.labels[at], 255)
    return found


def moved(points_m: np.ndarray, similarity: np.ndarray) -> np.ndarray:
    """Carry points by a 4x4 similarity."""
    return points_m @ similarity[:3, :3].T + similarity[:3, 3]


def compare(
    reference: Path, result: Path, result_to_reference: np.ndarray | None = None
) -> dict[str, float]:
    """Return the figures of ``result / room.npz`` against ``reference / room.npz``.

    ``result_to_reference`` is a similarity between the frames of their captures.
    """
    carry = np.eye(4) if result_to_reference is None else result_to_reference
    true, found = read_cells(reference / "room.npz"), read_cells(result / "room.npz")
    reach = REACH_VOXELS * true.voxel_m
    occupied = moved(found.occupied_m, carry)
    near_true, _ = cKDTree(true.occupied_m).query(occupied)
    near_found, _ = cKDTree(occupied).query(true.occupied_m)
    back = np.linalg.inv(carry)
    true_at = looked_up(found, moved(true.occupied_m, back))
    free_at = looked_up(found, moved(true.free_m, back))
    known = looked_up(true, occupied) != 255
    return {
        "precision": float((near_true <= reach).mean()),
        "precision where known": float((near_true[known] <= reach).mean()),
        "recall": float((near_found <= reach).mean()),
        "free found": float((free_at == 0).mean()),
        "wrong free": float((true_at == 0).mean()),
        "cells": len(occupied),
    }


def poses_of(capture_file: Path) -> dict[str, np.ndarray]:
    """Return camera_to_world by frame, of a plain capture's ``capture.json``."""
    frames = json.loads(capture_file.read_text())["frames"]
    return {f["name"]: np.array(f["camera_to_world"]) for f in frames if "camera_to_world" in f}


def best_similarity(found: dict[str, np.ndarray], true: dict[str, np.ndarray]) -> np.ndarray:
    """Return the 4x4 similarity that carries found poses to the true ones best.

    True poses may be those of a depth sensor beside the colour camera: where it sits and how it
    is turned is found with the similarity.
    """
    names = sorted(set(found) & set(true))
    poses = (np.array([given[name] for name in names]) for given in (found, true))
    best = align_similarity(*poses, mounted=len(names) >= 8)
    similarity = np.eye(4)
    similarity[:3, :3] = best.scale * best.rotation
    similarity[:3, 3] = best.shift_m
    return similarity

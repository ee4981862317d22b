"""How much of the true room stands in the blocks of the world that was built."""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, cell_centers_m, invert
from world2minecraft.evaluation.scoring.visibility import Reached
from world2minecraft.formats.scene import Scene, read_scene

NEAR = np.array(list(np.ndindex(3, 3, 3))) - 1


def world_facts(out: Path, true_labels: np.ndarray, reached: Reached) -> dict[str, Any]:
    """Return the shares of seen true surface that blocks stand for; empty where none were built.

    ``explained`` cells lie within one cell of a block of any class, ``right_class`` ones within
    one cell of a block of their own.

    Args:
        out: the folder of the run.
        true_labels: uint8 [X, Y, Z] in the box of ``reached``.
        reached: where rays came; only cells in which one met a surface are asked for.
    """
    if not (out / "build" / "scene.json").is_file():
        return {}
    scene = read_scene(out / "build")
    cells = np.argwhere(reached.met & (true_labels > 0) & (true_labels != UNKNOWN))
    if not len(cells):
        return {"explained": 1.0, "right_class": 1.0}
    wanted = true_labels[tuple(cells.T)]
    centers_m = cell_centers_m(cells, reached.low * reached.voxel_m, reached.voxel_m)
    explained, right = np.zeros(len(cells), bool), np.zeros(len(cells), bool)
    for step in NEAR:
        block = class_at(scene, centers_m + step * reached.voxel_m)
        explained |= block > 0
        right |= block == wanted
    return {"explained": float(explained.mean()), "right_class": float(right.mean())}


def class_at(scene: Scene, points_m: np.ndarray) -> np.ndarray:
    """Return the class of the block that holds each room point [N, 3]; 0 where there is none."""
    blocks = np.floor(apply(invert(scene.block_to_room), points_m) - scene.corner + 1e-9)
    inside = np.asarray(((blocks >= 0) & (blocks < scene.semantic.shape)).all(axis=1))
    at = np.where(inside[:, None], blocks, 0).astype(np.int64)
    return np.where(inside, scene.semantic[tuple(at.T)], 0)

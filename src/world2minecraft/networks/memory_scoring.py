"""Score whole scenes by a network with a memory: it fuses all frames, then is scored once.

What is true of a scene is put together from its frames' cells of 8 cm, which share a lattice, and
made coarser where the network's cells are. The network sees the frames one by one in those cells;
only what it sums up is read at the end.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import nn

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.evaluation.metrics.protocols import count_scene
from world2minecraft.evaluation.metrics.score_aggregation import FrameScore
from world2minecraft.minecraftocc.formats.sscnet import downsample_labels
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.networks.config import GRIDS, RunConfig
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import cells_with_masks
from world2minecraft.networks.models.embodied import Embodied, SceneStream
from world2minecraft.networks.scene_voting import SceneFrame, align_frames, merge_truth
from world2minecraft.networks.scoring import MEMORY, summarise_scenes

FINE = GRIDS["0.08"]


class SceneTruth(NamedTuple):
    """What is true of a scene, along the room's axes."""

    labels: np.ndarray  # uint8 [X, Y, Z], 0 to 11 or 255
    seen: np.ndarray  # bool [X, Y, Z], in view of any frame
    origin_m: np.ndarray  # float64 [3], minimum corner in the room


def memory_scores(
    network: Embodied,
    found: ImportedSet,
    frames: Frames,
    rows: Sequence[int],
    config: RunConfig,
    progress: Progress = no_progress,
) -> tuple[list[FrameScore], str]:
    """Return the counts of each scene of some rows, or none and the reason why there are none.

    Args:
        network: it is left in evaluation.
        found: the set, for the cells of 8 cm.
        frames: the same samples as the network sees them.
        rows: of ``frames``.
        config: of the network: its cells, and whether it is given depth.
        progress: called for ``scenes``.
    """
    by_scene: dict[str, list[int]] = {}
    for row in rows:
        by_scene.setdefault(frames.scenes[row], []).append(row)
    counts = []
    for done, (scene, scene_rows) in enumerate(sorted(by_scene.items()), 1):
        truth, reason = assemble_truth(found, [frames.keys[row] for row in scene_rows], config)
        if truth is None:
            return [], reason
        predicted = predict_scene(network, frames, scene_rows, truth, config)
        counts.append(FrameScore(scene, count_scene(predicted, truth.labels, [truth.seen])))
        progress("scenes", done, len(by_scene))
    return counts, ""


def assemble_truth(
    found: ImportedSet, keys: Sequence[str], config: RunConfig
) -> tuple[SceneTruth | None, str]:
    """Return what is true of the scene of some frames, in the cells of a run."""
    boxes = []
    for key in keys:
        sample = found[key]
        known = cells_with_masks(sample, FINE)
        boxes.append(
            SceneFrame.pack(sample.scene_id, known.labels, known, sample.occ.region.region_to_room)
        )
    lattice, reason = align_frames(boxes, FINE.voxel_m)
    if lattice is None:
        return None, reason
    factor = round(config.cells.voxel_m / FINE.voxel_m)
    labels, seen = merge_truth(lattice)
    if factor > 1:
        spare = [(0, -side % factor) for side in labels.shape]
        labels = downsample_labels(np.pad(labels, spare, constant_values=UNKNOWN), factor)
        blocks = [part for side in labels.shape for part in (side, factor)]
        seen = np.asarray(np.pad(seen, spare).reshape(blocks).any(axis=(1, 3, 5)))
    return SceneTruth(labels, seen, lattice.origin_m), ""


def predict_scene(
    network: Embodied, frames: Frames, rows: Sequence[int], truth: SceneTruth, config: RunConfig
) -> np.ndarray:
    """Return the labels of a scene after the network saw some frames, uint8 [X, Y, Z]."""
    x, y, z = truth.labels.shape
    stream = SceneStream(network, (x, y, z), config.cells.shape, config.cells.voxel_m)
    room_to_scene = np.eye(4)
    room_to_scene[:3, 3] = -truth.origin_m
    for row in rows:
        frame = frames[row]
        pose = room_to_scene @ frame.grid_to_room @ frame.camera_to_grid
        image = torch.from_numpy(np.array(frame.image)).permute(2, 0, 1).float() / 255
        stream.add(
            image,
            torch.from_numpy(frame.intrinsics),
            torch.from_numpy(pose),
            torch.from_numpy(frame.depth_m) if config.depth == "given" else None,
        )
    return stream.logits().argmax(dim=0).to(torch.uint8).cpu().numpy()


def add_memory_scores(
    scores: dict[str, Any],
    network: nn.Module,
    found: ImportedSet,
    frames: Frames,
    rows: Sequence[int],
    config: RunConfig,
    *,
    seed: int = 0,
    progress: Progress = no_progress,
) -> None:
    """Add ``embodied memory`` to scores, where the network is one that fuses frames by itself."""
    if not isinstance(network, Embodied):
        return
    counts, reason = memory_scores(network, found, frames, rows, config, progress)
    if reason:
        scores["left_out"][MEMORY] = reason
    else:
        scores["protocols"][MEMORY] = summarise_scenes(counts, "; the network fuses them", seed)

"""Evaluation of complete scenes for networks with a memory, which fuse all frames of a scene.

The ground truth of a scene is assembled from the 8 cm cells of its frames, which share a lattice,
and is downsampled if the cells of the network are larger. The network processes the frames one by
one, and its fused result is evaluated once at the end.
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
from world2minecraft.formats.sscnet import downsample_labels
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.networks.config import GRIDS, RunConfig
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import cells_with_masks
from world2minecraft.networks.models.embodied import Embodied, SceneStream
from world2minecraft.networks.scene_voting import SceneFrame, align_frames, merge_truth
from world2minecraft.networks.scoring import MEMORY, summarise_scenes

FINE = GRIDS["0.08"]


class SceneTruth(NamedTuple):
    """The ground truth of a scene along the room axes.

    Attributes:
        labels: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z].
        seen: Whether each cell is in the view of any frame, bool [X, Y, Z].
        origin_m: Minimum corner in room coordinates in metres, float64 [3].
    """

    labels: np.ndarray
    seen: np.ndarray
    origin_m: np.ndarray


def memory_scores(
    network: Embodied,
    found: ImportedSet,
    frames: Frames,
    rows: Sequence[int],
    config: RunConfig,
    progress: Progress = no_progress,
) -> tuple[list[FrameScore], str]:
    """Evaluate a network with a memory on the scenes of the given frames.

    Args:
        network: Network to evaluate. It is left in evaluation mode.
        found: Data set, from which the 8 cm cells are read.
        frames: The same samples as frames for the network.
        rows: Indices of the frames to use.
        config: Settings of the network, which define its cells and the use of depth.
        progress: Callback that reports progress on the stage ``scenes``.

    Returns:
        The counts for each scene and an empty string, or an empty list and the reason why the
        scenes cannot be evaluated.
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
    """Assemble the ground truth of a scene from its frames, in the cells of a run.

    Returns:
        The ground truth and an empty string, or None and the reason.
    """
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
    """Return the predicted labels of a scene after processing its frames, uint8 [X, Y, Z]."""
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
    """Add the protocol ``embodied memory`` to scores if the network has a memory."""
    if not isinstance(network, Embodied):
        return
    counts, reason = memory_scores(network, found, frames, rows, config, progress)
    if reason:
        scores["left_out"][MEMORY] = reason
    else:
        scores["protocols"][MEMORY] = summarise_scenes(counts, ", fused by the network", seed)

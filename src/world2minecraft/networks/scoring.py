"""Evaluation of networks, ONNX files and saved predictions with any of the protocols.

Predictions and ground truth of frames are converted to a dict of scores for JSON, and to rows of a
LaTeX table with the columns of the paper. Protocols that require missing data, such as ``ssc``
without depth, are left out with the reason.
"""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.evaluation.metrics.protocols import (
    PROTOCOLS,
    KnownCells,
    count_frame,
    count_scene,
    protocol_named,
)
from world2minecraft.evaluation.metrics.score_aggregation import FrameScore, summarise
from world2minecraft.minecraftocc.importers.embodied import SceneSet
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.minecraftocc.statistics.tables import escape_latex
from world2minecraft.networks.config import Grid
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import cells_with_masks
from world2minecraft.networks.saved_predictions import SavedPredictions, grid_of_labels
from world2minecraft.networks.scene_voting import SceneFrame, scene_scores

SCENES = "embodied scenes"  # The protocol ``embodied`` for complete scenes.
MEMORY = "embodied memory"  # The same for networks that fuse frames themselves.


def latex_rows(scores: dict[str, Any], name: str) -> str:
    """Format scores as LaTeX table rows in percent, one for each protocol.

    A comment in the first line names the columns.

    Example:
        >>> figures = {"iou": 0.5, "miou": 0.25, "precision": 1.0, "recall": 0.5}
        >>> figures["class_iou"] = dict.fromkeys(CLASS_NAMES, 0.1)
        >>> scores = {"protocols": {"iso": {"micro": figures}}}
        >>> latex_rows(scores, "net a").splitlines()[1][:30]
        'net a (iso) & 50.00 & 25.00 & '
    """
    lines = [f"% method & IoU & mIoU & precision & recall & {' & '.join(CLASS_NAMES)}"]
    for protocol, found in scores["protocols"].items():
        micro = found["micro"]
        values = [micro[key] for key in ("iou", "miou", "precision", "recall")]
        values += [micro["class_iou"][label] for label in CLASS_NAMES]
        cells = " & ".join(f"{100 * value:.2f}" for value in values)
        lines.append(f"{escape_latex(f'{name} ({protocol})')} & {cells} \\\\")
    return "\n".join(lines) + "\n"


class PredictedFrame(NamedTuple):
    """The prediction and the ground truth of a frame.

    Attributes:
        scene_id: Name of the scene.
        predicted: Predicted class of each cell, uint8 [X, Y, Z].
        known: Ground truth and masks.
        grid_to_room: Matrix from grid coordinates to room coordinates in metres, float64 [4, 4].
    """

    scene_id: str
    predicted: np.ndarray
    known: KnownCells
    grid_to_room: np.ndarray


def protocol_scores(
    frames: Iterable[PredictedFrame],
    voxel_m: float,
    protocols: Sequence[str] = (),
    *,
    seed: int = 0,
) -> dict[str, Any]:
    """Evaluate frames with the given protocols, or with all protocols that their masks allow.

    Args:
        frames: Frames in any order, read one at a time.
        voxel_m: Cell size in metres.
        protocols: Names of the protocols. Defaults to all.
        seed: Random seed for the confidence intervals.

    Returns:
        A dict with ``protocols``, which contains the result of ``summarise`` for each protocol with
        ``counts`` and ``reads`` as descriptions, and ``left_out``, which contains the reason for
        each omitted protocol.

    Raises:
        UsageError: If there are no frames, or if a requested protocol cannot be computed.
        UnknownNameError: If a protocol is unknown.
    """
    chosen = [protocol_named(name) for name in protocols or PROTOCOLS]
    counts: dict[str, list[FrameScore]] = {one.name: [] for one in chosen}
    left_out: dict[str, str] = {}
    scenes: list[SceneFrame] = []
    for frame in frames:
        for protocol in chosen:
            try:
                found = count_frame(protocol, frame.predicted, frame.known)
            except UsageError as error:
                if protocols:
                    raise
                left_out[protocol.name] = str(error)
                continue
            counts[protocol.name].append(FrameScore(frame.scene_id, found))
        if "embodied" in counts and frame.known.in_frustum is not None:
            scenes.append(SceneFrame.pack(*frame))
    if not any(counts.values()):
        raise UsageError("no frames to evaluate")
    result: dict[str, Any] = {}
    for protocol in chosen:
        if counts[protocol.name] and protocol.name not in left_out:
            words = {"counts": protocol.cells, "reads": protocol.unknown}
            result[protocol.name] = summarise(counts[protocol.name], seed=seed) | words
    if scenes:
        by_scene, reason = scene_scores(scenes, voxel_m)
        if reason:
            left_out[SCENES] = reason
        else:
            result[SCENES] = summarise_scenes(by_scene, ", by votes of the frames", seed)
    return {"protocols": result, "left_out": left_out}


def summarise_scenes(counts: list[FrameScore], how: str, seed: int) -> dict[str, Any]:
    """Summarise the counts of scenes, with a description of the counted cells."""
    words = {
        "counts": f"cells of each scene that are in the view of any frame{how}",
        "reads": PROTOCOLS["embodied"].unknown,
    }
    return summarise(counts, seed=seed) | words


def saved_scene_scores(
    saved: SavedPredictions,
    scenes: SceneSet,
    names: Sequence[str],
    *,
    seed: int = 0,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Evaluate saved grids of complete scenes, such as those from EmbodiedOcc's memory.

    Args:
        saved: A grid for each scene.
        scenes: Scenes with their ground truth.
        names: Names of the scenes to evaluate.
        seed: Random seed for the confidence intervals.
        progress: Callback that reports progress on the stage ``score``.

    Returns:
        A dict as returned by ``protocol_scores``, with only ``embodied scenes``.

    Raises:
        InputError: If a grid or a scene is missing, or if they differ in shape.
    """
    counts = []
    for done, name in enumerate(names, 1):
        truth = scenes.read(name)
        labels = saved.scene_labels(name, truth.labels.shape)
        counts.append(FrameScore(name, count_scene(labels, truth.labels, [truth.seen])))
        progress("score", done, len(names))
    return {"protocols": {SCENES: summarise_scenes(counts, "", seed)}, "left_out": {}}


def scenes_to_score(saved: SavedPredictions, scenes: SceneSet, split: str | None) -> list[str]:
    """Return the scenes of a split that have saved grids, or an empty list if frames were saved."""
    known = {saved.path.stem} if saved.is_single else set(saved.keys())
    return [name for name, of in scenes.splits.items() if name in known and split in (None, of)]


def network_predictions(
    frames: Frames, rows: Sequence[int], predicted: Iterator[np.ndarray]
) -> Iterator[PredictedFrame]:
    """Combine the predictions of a network with the ground truth of the frames."""
    for row, labels in zip(rows, predicted, strict=True):
        frame = frames[row]
        yield PredictedFrame(frame.scene_id, labels, frame.known, frame.grid_to_room)


def onnx_predictions(
    path: Path, frames: Frames, rows: Sequence[int], progress: Progress = no_progress
) -> Iterator[PredictedFrame]:
    """Run an ONNX file on the given frames.

    Raises the same exceptions as ``OccupancyNetwork``.
    """
    from world2minecraft.reconstruction.occupancy.onnx_network import OccupancyNetwork  # noqa: PLC0415

    network = OccupancyNetwork(path)
    for done, row in enumerate(rows, 1):
        frame = frames[row]
        image = np.moveaxis(frame.image, -1, 0).astype(np.float32) / 255
        depth_m = frame.depth_m if network.facts.wants_depth else None
        found = network.probabilities(image, frame.intrinsics, frame.camera_to_grid, depth_m)
        labels = found.argmax(axis=-1).astype(np.uint8)
        yield PredictedFrame(frame.scene_id, labels, frame.known, frame.grid_to_room)
        progress("score", done, len(rows))


def file_predictions(
    saved: SavedPredictions,
    truth: ImportedSet,
    keys: Sequence[str],
    progress: Progress = no_progress,
) -> Iterator[PredictedFrame]:
    """Combine saved predictions with the ground truth of the samples with the same keys.

    Raises:
        InputError: If a prediction is missing, or if its shape differs from the sample.
    """
    grid: Grid | None = None
    for done, key in enumerate(keys, 1):
        labels, sample = saved.labels(key), truth[key]
        grid = grid or grid_of_labels(labels, saved.path)
        if labels.shape != grid.shape:
            raise InputError(
                saved.path,
                f"{key} has shape {labels.shape}, but other predictions have {grid.shape}",
            )
        known = cells_with_masks(sample, grid)
        yield PredictedFrame(sample.scene_id, labels, known, sample.occ.region.region_to_room)
        progress("score", done, len(keys))


def keys_to_score(saved: SavedPredictions, truth: ImportedSet, split: str | None) -> list[str]:
    """Return the sample keys of a split that have saved predictions.

    Raises:
        InputError: If there are none, or if a single prediction is given for several samples.
    """
    keys = truth.keys(split)
    if saved.is_single:
        if len(keys) != 1:
            raise InputError(
                saved.path,
                f"contains a single frame, but the data set has {len(keys)}; use a folder "
                "of KEY.npz files",
            )
        return keys
    known = set(saved.keys())
    found = [key for key in keys if key in known]
    if not found:
        example = f", such as {keys[0]}.npz" if keys else ""
        raise InputError(saved.path, f"contains no predictions for {truth.path}{example}")
    return found

"""Score a network, an ONNX file or saved predictions, by any of the protocols.

In: predictions of frames and their truth. Out: a dictionary for JSON, also as rows of a LaTeX table
in the columns of the paper. What a set cannot answer, as ``ssc`` without depth, is left out, with
the reason.
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
from world2minecraft.networks.config import Grid
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import cells_with_masks
from world2minecraft.networks.saved_predictions import SavedPredictions, grid_of_labels
from world2minecraft.networks.scene_voting import SceneFrame, scene_scores

_SPECIAL = {"_": r"\_", "%": r"\%", "&": r"\&", "#": r"\#", "$": r"\$", "{": r"\{", "}": r"\}"}
SCENES = "embodied scenes"  # The scene level of ``embodied``, beside its frames.
MEMORY = "embodied memory"  # The same of a network that fuses frames by itself.


def latex_rows(scores: dict[str, Any], name: str) -> str:
    """Return a comment that names the columns, and a row a protocol, per cent.

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
        lines.append(f"{_escaped(f'{name} ({protocol})')} & {cells} \\\\")
    return "\n".join(lines) + "\n"


def _escaped(text: str) -> str:
    return "".join(_SPECIAL.get(sign, sign) for sign in text)


class PredictedFrame(NamedTuple):
    """One frame: the prediction and the truth of its cells."""

    scene_id: str
    predicted: np.ndarray  # uint8 [X, Y, Z]
    known: KnownCells
    grid_to_room: np.ndarray  # float64 [4, 4]


def protocol_scores(
    frames: Iterable[PredictedFrame],
    voxel_m: float,
    protocols: Sequence[str] = (),
    *,
    seed: int = 0,
) -> dict[str, Any]:
    """Score frames by some protocols, or by all that their masks allow.

    Args:
        frames: one at a time; those of a scene need not follow each other.
        voxel_m: the side of their cells.
        protocols: names; all where empty.
        seed: of the intervals.

    Returns:
        ``protocols``: name to what ``summarise`` returns, with ``counts`` and ``reads`` in words;
        ``left_out``: name to reason.

    Raises:
        UsageError: there is no frame, or a protocol that was requested by name cannot be.
        UnknownNameError: there is no such protocol.
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
        raise UsageError("there is no frame to score")
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
            result[SCENES] = summarise_scenes(by_scene, "; frames vote", seed)
    return {"protocols": result, "left_out": left_out}


def summarise_scenes(counts: list[FrameScore], how: str, seed: int) -> dict[str, Any]:
    """Return what ``summarise`` does of scenes, with what was counted in words."""
    words = {
        "counts": f"of each scene those that any of its frames has in view{how}",
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
    """Score saved grids of whole scenes, as EmbodiedOcc's memory leaves them.

    Args:
        saved: a grid for each scene.
        scenes: the truth.
        names: of the scenes to score.
        seed: of the intervals.
        progress: called for ``score``.

    Returns:
        What ``protocol_scores`` returns, of ``embodied scenes`` alone.

    Raises:
        InputError: a grid or a scene is missing, or they have other cells.
    """
    counts = []
    for done, name in enumerate(names, 1):
        truth = scenes.read(name)
        labels = saved.scene_labels(name, truth.labels.shape)
        counts.append(FrameScore(name, count_scene(labels, truth.labels, [truth.seen])))
        progress("score", done, len(names))
    return {"protocols": {SCENES: summarise_scenes(counts, "", seed)}, "left_out": {}}


def scenes_to_score(saved: SavedPredictions, scenes: SceneSet, split: str | None) -> list[str]:
    """Return the scenes of a split that grids were saved of; none where frames were saved."""
    known = {saved.path.stem} if saved.is_single else set(saved.keys())
    return [name for name, of in scenes.splits.items() if name in known and split in (None, of)]


def network_predictions(
    frames: Frames, rows: Sequence[int], predicted: Iterator[np.ndarray]
) -> Iterator[PredictedFrame]:
    """Pair what a network says of rows with what is true of them."""
    for row, labels in zip(rows, predicted, strict=True):
        frame = frames[row]
        yield PredictedFrame(frame.scene_id, labels, frame.known, frame.grid_to_room)


def onnx_predictions(
    path: Path, frames: Frames, rows: Sequence[int], progress: Progress = no_progress
) -> Iterator[PredictedFrame]:
    """Run an ONNX file over rows. Raises what ``OccupancyNetwork`` raises."""
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
    """Pair saved predictions with the samples of the same keys.

    Raises:
        InputError: a prediction is missing, or a sample has other cells.
    """
    grid: Grid | None = None
    for done, key in enumerate(keys, 1):
        labels, sample = saved.labels(key), truth[key]
        grid = grid or grid_of_labels(labels, saved.path)
        if labels.shape != grid.shape:
            raise InputError(saved.path, f"{key} has {labels.shape} cells, others {grid.shape}")
        known = cells_with_masks(sample, grid)
        yield PredictedFrame(sample.scene_id, labels, known, sample.occ.region.region_to_room)
        progress("score", done, len(keys))


def keys_to_score(saved: SavedPredictions, truth: ImportedSet, split: str | None) -> list[str]:
    """Return the keys of a split that there are predictions of.

    Raises:
        InputError: there are none, or the predictions are of one frame and the truth of many.
    """
    keys = truth.keys(split)
    if saved.is_single:
        if len(keys) != 1:
            raise InputError(
                saved.path,
                f"is one frame's, and the truth has {len(keys)}; give a folder of KEY.npz",
            )
        return keys
    known = set(saved.keys())
    found = [key for key in keys if key in known]
    if not found:
        example = f", such as {keys[0]}.npz" if keys else ""
        raise InputError(saved.path, f"holds no prediction of {truth.path}{example}")
    return found

"""Evaluation of a run, weights, an ONNX file or saved predictions on an occupancy data set."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.networks.config import Grid
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.frames import FrameRule
from world2minecraft.networks.data.splits import take_evenly
from world2minecraft.networks.saved_predictions import SavedPredictions, grid_of_labels
from world2minecraft.networks.scoring import (
    PredictedFrame,
    file_predictions,
    keys_to_score,
    network_predictions,
    onnx_predictions,
    protocol_scores,
    saved_scene_scores,
    scenes_to_score,
)


@dataclass(frozen=True)
class Evaluation:
    """The settings of an evaluation.

    Attributes:
        predicted: Run folder, weights, ``.onnx`` file, or file or folder with saved predictions.
        truth: Data set with the ground truth.
        split: Split to evaluate. None evaluates all frames.
        limit: Maximum number of frames, evenly spaced.
        protocols: Names of the protocols. Defaults to all.
        order: Axis order of saved predictions.
        classes: Class numbering of saved predictions.
        device: ``auto``, ``cpu`` or ``cuda``.
        cache: Cache for decoded frames, as accepted by ``--cache``.
        seed: Random seed for the confidence intervals.
    """

    predicted: Path
    truth: ImportedSet
    split: str | None = None
    limit: int | None = None
    protocols: tuple[str, ...] = ()
    order: str = ""
    classes: str = ""
    device: str = "auto"
    cache: str = ""
    seed: int = 0

    def scores(self, progress: Progress = no_progress) -> dict[str, Any]:
        """Return the scores of each protocol, in the form of ``protocol_scores``."""
        if self.predicted.suffix == ".onnx":
            return self._of_onnx(progress)
        if is_weights(self.predicted):
            return self._of_weights(progress)
        return self._of_files(progress)

    def _scored(self, frames: Iterator[PredictedFrame], voxel_m: float) -> dict[str, Any]:
        return protocol_scores(frames, voxel_m, self.protocols, seed=self.seed)

    def _rows(self, frames: Frames) -> list[int]:
        of = self.truth.splits
        rows = [n for n, key in enumerate(frames.keys) if self.split in (None, of[key])]
        return take_evenly(rows, self.limit or len(rows))

    def _frames(self, grid: Grid, size_px: tuple[int, int], progress: Progress) -> Frames:
        from world2minecraft.networks.data.training_data import (  # noqa: PLC0415
            CacheLocation,
            open_frames,
        )

        place = CacheLocation.parse(self.cache)
        return open_frames(self.truth, FrameRule(grid, *size_px), place, progress)

    def _of_onnx(self, progress: Progress) -> dict[str, Any]:
        from world2minecraft.reconstruction.occupancy.onnx_network import (  # noqa: PLC0415
            OccupancyNetwork,
        )

        facts = OccupancyNetwork(self.predicted).facts
        grid = Grid(facts.grid_shape, facts.voxel_m)
        frames = self._frames(grid, facts.image_size_px, progress)
        predicted = onnx_predictions(self.predicted, frames, self._rows(frames), progress)
        return self._scored(predicted, grid.voxel_m)

    def _of_weights(self, progress: Progress) -> dict[str, Any]:
        # Only here: saved predictions are scored without torch, which is an extra.
        from world2minecraft.networks.memory_scoring import add_memory_scores  # noqa: PLC0415
        from world2minecraft.networks.training import load_weights_file  # noqa: PLC0415
        from world2minecraft.networks.validation import (  # noqa: PLC0415
            predict_labels,
            resolve_device,
        )

        network, config = load_weights_file(self.predicted)
        network.to(resolve_device(self.device))
        frames = self._frames(config.cells, config.image, progress)
        rows = self._rows(frames)
        labels = predict_labels(network, frames, rows, config, progress=progress)
        scores = self._scored(network_predictions(frames, rows, labels), config.cells.voxel_m)
        if not self.protocols or "embodied" in self.protocols:
            add_memory_scores(
                scores, network, self.truth, frames, rows, config, seed=self.seed, progress=progress
            )
        return scores

    def _of_files(self, progress: Progress) -> dict[str, Any]:
        saved = SavedPredictions(self.predicted, self.order, self.classes)
        if (of_scenes := self._of_scenes(saved, progress)) is not None:
            return of_scenes
        keys = keys_to_score(saved, self.truth, self.split)
        keys = [keys[n] for n in take_evenly(list(range(len(keys))), self.limit or len(keys))]
        grid = grid_of_labels(saved.labels(keys[0]), self.predicted)
        return self._scored(file_predictions(saved, self.truth, keys, progress), grid.voxel_m)

    def _of_scenes(self, saved: SavedPredictions, progress: Progress) -> dict[str, Any] | None:
        """Return the scores of saved scene grids, or None if there are no scene files."""
        if self.truth.format != "embodied":
            return None
        from world2minecraft.minecraftocc.importers.embodied import open_scenes  # noqa: PLC0415

        scenes = open_scenes(self.truth.path)
        if not (names := scenes_to_score(saved, scenes, self.split)):
            return None
        if self.protocols not in ((), ("embodied",)):
            raise UsageError(
                f"{self.predicted} contains predictions for complete scenes; use the protocol "
                "embodied (--protocol embodied)"
            )
        return saved_scene_scores(saved, scenes, names, seed=self.seed, progress=progress)


def is_weights(path: Path) -> bool:
    """Return whether a path is a run folder or a file of weights."""
    return path.suffix == ".safetensors" or (path / "run.yaml").is_file()


def needs_torch(path: Path) -> bool:
    """Return whether evaluating a path requires PyTorch; only saved predictions do not."""
    return path.suffix == ".onnx" or is_weights(path)


def choose_split(requested: str, available: Iterable[str]) -> str | None:
    """Return the split to evaluate, or None for all frames.

    Args:
        requested: Requested split, ``all``, or an empty string for ``test`` if available, else all.
        available: Splits of the data set.

    Raises:
        UsageError: If the requested split has no frames.
    """
    there = set(available)
    if not requested:
        return "test" if "test" in there else None
    if requested == "all":
        return None
    if requested not in there:
        known = ", ".join(sorted(one for one in there if one)) or "none"
        raise UsageError(
            f"no frames in split {requested!r}; use all or one of the available splits: {known}"
        )
    return requested

"""The data sets of a run, opened for training, validation and the final score.

The first data set is the target: its validation frames determine the best weights, and its test
frames the score. The other data sets are used only for training.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.networks.config import RunConfig
from world2minecraft.networks.data.batches import TrainingSet
from world2minecraft.networks.data.cache import Frames, StreamedFrames, open_cached_frames
from world2minecraft.networks.data.class_weights import class_counts
from world2minecraft.networks.data.frames import FrameRule
from world2minecraft.networks.data.splits import Split, describe_counts, split_rows, take_evenly

MAX_COUNTED_FRAMES = 1000  # Evenly spaced frames of each data set for the class frequencies.


@dataclass(frozen=True)
class CacheLocation:
    """Where decoded frames are cached, if caching is enabled.

    Attributes:
        keep: Whether to cache frames.
        root: Cache folder. None uses the user's cache folder.
    """

    keep: bool = True
    root: Path | None = None

    @classmethod
    def parse(cls, text: str) -> "CacheLocation":
        """Parse the value of ``--cache``.

        Args:
            text: Cache folder, ``off``, or an empty string for the default folder.
        """
        return cls(False) if text == "off" else cls(True, Path(text) if text else None)


@dataclass(frozen=True, eq=False)
class RunData:
    """The data sets of a run.

    Attributes:
        parts: Training frames of each data set.
        weights: Relative weight of each data set.
        target: Frames of the first data set.
        split: Split of the first data set.
        counts: Weighted number of training cells of each class, int64 [12].
        descriptions: Description of each data set for the user.
    """

    parts: tuple[TrainingSet, ...]
    weights: tuple[float, ...]
    target: Frames
    split: Split
    counts: np.ndarray
    descriptions: tuple[str, ...]


def frame_rule(config: RunConfig) -> FrameRule:
    """Return the frame format for a run."""
    return FrameRule(config.cells, *config.image)


def open_run_data(
    config: RunConfig, cache: CacheLocation | None = None, progress: Progress = no_progress
) -> RunData:
    """Open and split the data sets of a run.

    Raises:
        InputError: If a data set is not valid, or if its cells cannot be converted to the grid.
        UsageError: If a data set cannot be split as required.
    """
    rule, place = frame_rule(config), cache or CacheLocation()
    parts, splits, descriptions = [], [], []
    total = np.zeros(12)
    for source in config.data:
        found = open_occupancy(source.path)
        frames = open_frames(found, rule, place, progress)
        held_out = config.val_share if not parts else 0.0
        split = _split(found, frames, held_out, is_target=not parts)
        splits.append(split)
        parts.append(TrainingSet(frames, split.train))
        counts = class_counts(frames.labels(take_evenly(split.train, MAX_COUNTED_FRAMES)))
        total += counts * (source.weight / max(counts.sum(), 1))
        descriptions.append(f"{source.path}: {found.format}, {describe_counts(split._asdict())}")
    return RunData(
        parts=tuple(parts),
        weights=tuple(source.weight for source in config.data),
        target=parts[0].frames,
        split=splits[0],
        counts=np.round(total * 1e9).astype(np.int64),
        descriptions=tuple(descriptions),
    )


def open_frames(
    found: ImportedSet, rule: FrameRule, place: CacheLocation, progress: Progress = no_progress
) -> Frames:
    """Open the frames of a data set, from the cache if it is enabled."""
    if not place.keep:
        return StreamedFrames(found, rule)
    return open_cached_frames(found, rule, place.root, progress)


def _split(found: ImportedSet, frames: Frames, val_share: float, *, is_target: bool) -> Split:
    splits = [found.splits[key] for key in frames.keys]
    if is_target:
        return split_rows(frames.scenes, splits, val_share, str(found.path))
    rows = [row for row, split in enumerate(splits) if split != "test"]
    return Split(rows, [], []) if rows else split_rows(frames.scenes, splits, 0, str(found.path))

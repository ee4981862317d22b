"""Statistics of a data set on disk, computed one image at a time.

A data set in our own format is counted by several processes without reading its images.
"""

import json
import re
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import MALFORMED, InputError, WorkerError
from world2minecraft.core.files import read_bytes, read_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.importers.format_detection import IMPORTED, open_occupancy
from world2minecraft.minecraftocc.statistics.counting import (
    StatisticsCounter,
    add_sample,
    count_samples,
)
from world2minecraft.minecraftocc.statistics.types import DatasetStatistics
from world2minecraft.minecraftocc.store import OccStore, open_store
from world2minecraft.minecraftocc.store.folder import META, SCENES

SCENE_ID = re.compile(r"[A-Za-z0-9_-]{1,90}")
HOUSE = "house.json"
MAX_VIEWS_BYTES = 256 << 20
PART = 200  # Images that a process counts at a time, about two seconds of work.


def statistics_of(
    path: str | Path,
    split: str | None = None,
    *,
    format: str | None = None,
    jobs: int = 1,
    progress: Progress = no_progress,
) -> DatasetStatistics:
    """Compute the statistics of a data set in our own format or in a published format.

    Args:
        path: Data set, or a folder that ``w2m dataset import`` accepts.
        split: Split to count. None counts all splits.
        format: Format of the folder. Detected automatically by default.
        jobs: Number of processes, used only for our own format.
        progress: Callback that reports the number of images counted so far.

    Raises:
        InputError: If the path is not a data set, or has no images in the split.
        DamagedFileError: If a sample cannot be read.
        UsageError: If the split or the format is unknown.
        WorkerError: If a worker process has exited.
    """
    place = Path(path)
    if format is None and ((place / META).is_file() or not _is_imported(place)):
        return store_statistics(place, split, jobs=jobs, progress=progress)
    found = open_occupancy(place, format)
    keys = found.keys(split)
    if not keys:
        raise InputError(place, f"contains no images in split {split!r}")
    counter = StatisticsCounter()
    for done, sample in enumerate(found.samples(split)):
        progress("count", done, len(keys))
        add_sample(counter, sample)
    progress("count", len(keys), len(keys))
    return counter.result(_named(place, split))


def store_statistics(
    path: str | Path,
    split: str | None = None,
    *,
    jobs: int = 1,
    progress: Progress = no_progress,
) -> DatasetStatistics:
    """Compute the statistics of a data set in our own format, or of one of its splits.

    Memory use does not depend on the number of images.

    Args:
        path: Folder of the data set.
        split: Split to count. None counts all splits.
        jobs: Number of processes.
        progress: Callback that reports the number of images counted so far.

    Raises:
        InputError: If the folder is not a data set.
        DamagedFileError: If a sample cannot be read.
        UsageError: If the split is unknown.
        WorkerError: If a worker process has exited.
    """
    store = open_store(path)
    keys = store.keys(split)
    counter = StatisticsCounter()
    progress("count", 0, len(keys))
    for part, pictures in _parts(store, keys, jobs):
        counter.merge(part)
        progress("count", counter.pictures, len(keys), f"{pictures:,} images")
    for scene_id, rooms in rooms_of(store.folder, store.meta).items():
        counter.set_rooms(scene_id, rooms)
    return counter.result(_named(store.folder, split))


def rooms_of(folder: Path, meta: dict[str, Any]) -> dict[str, int]:
    """Return the number of rooms of each scene, for the scenes in which it is known.

    The number is read from ``dataset.json``, from the ``house.json`` of a generated house, or from
    the scene's planned views, which state their rooms.
    """
    found = {}
    for scene in meta.get("scenes", ()):
        name = str(scene.get("scene_id")) if isinstance(scene, dict) else ""
        if not SCENE_ID.fullmatch(name):
            continue
        rooms = (
            scene.get("rooms")
            or _rooms_of_house(folder / str(scene.get("source", name)) / HOUSE)
            or _rooms_of_views(folder / SCENES / f"{name}.poses.jsonl")
        )
        if isinstance(rooms, int) and rooms > 0:
            found[name] = rooms
    return found


def _rooms_of_house(path: Path) -> int | None:
    """Return the number of rooms in a generated house, or None if there is no house file."""
    try:
        return len(read_json(path, MAX_VIEWS_BYTES)["rooms"])
    except (InputError, KeyError, TypeError):
        return None


def _rooms_of_views(path: Path) -> int | None:
    """Return the number of rooms in the views of a tour file, or None if a view has no room."""
    try:
        lines = read_bytes(path, MAX_VIEWS_BYTES).splitlines()
        rooms = [json.loads(line)["room"] for line in lines if line.strip()]
    except (*MALFORMED, InputError):  # Many scenes have no such file.
        return None
    return len(set(rooms)) if all(isinstance(room, int) for room in rooms) else None


def _named(folder: Path, split: str | None) -> str:
    name = folder.resolve().name
    return f"{name}, {split}" if split else name


def _is_imported(place: Path) -> bool:
    return place.exists() and any(kind.is_at(place) for kind in IMPORTED.values())


def _parts(
    store: OccStore, keys: Sequence[str], jobs: int
) -> Iterator[tuple[StatisticsCounter, int]]:
    """Yield the counters for parts of the data set, in order."""
    parts = [keys[start : start + PART] for start in range(0, len(keys), PART)]
    if jobs <= 1 or len(parts) <= 1:
        for part in parts:
            yield count_samples(store.sample(key, pictures=False) for key in part), len(part)
        return
    with ProcessPoolExecutor(min(jobs, len(parts)), get_context("spawn")) as pool:
        tasks = deque((pool.submit(_count, str(store.folder), part), len(part)) for part in parts)
        try:
            while tasks:  # In order, so that the first part defines the grid of cells of a scene.
                task, pictures = tasks.popleft()  # Otherwise all results would stay in memory.
                yield task.result(), pictures
        except RuntimeError as error:  # BrokenProcessPool is a RuntimeError.
            raise WorkerError(
                f"a worker process has exited ({error}); try a single job (--jobs 1)"
            ) from error
        finally:
            pool.shutdown(cancel_futures=True)


def _count(folder: str, keys: Sequence[str]) -> StatisticsCounter:
    """Count samples in a worker process."""
    store = open_store(folder)
    return count_samples(store.sample(key, pictures=False) for key in keys)

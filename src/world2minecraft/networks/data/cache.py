"""A cache of decoded frames: resized images and coarse labels, as plain arrays on disk.

Decoding a JPEG of 640x480 pixels and downsampling labels takes longer than a training step of a
small network, so it is done once for each data set, image size and grid. The arrays are
memory-mapped, so only the frames that are used occupy memory. They are stored in the user's cache
folder and created again if the data set changes.
"""

import hashlib
import json
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np

from world2minecraft.core.errors import OutputError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.jit import user_cache_dir
from world2minecraft.core.locks import Lock
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.networks.data.frames import Frame, FrameRule, make_frame

VERSION = 1  # Of the contents of the folder.
ARRAYS = ("image", "depth", "intrinsics", "camera_to_grid", "grid_to_room", "labels", "masks")
READY = "frames.json"  # Written last.
MASKS = {"in_frustum": 1, "seen": 2, "free": 4}  # Bits of ``masks``.
DEPTH_UNIT_M = 0.001
MAX_DEPTH = 65_535


class Frames(Protocol):
    """Interface of a list of frames.

    Attributes:
        keys: Sample key of each frame.
        scenes: Scene name of each frame.
    """

    keys: list[str]
    scenes: list[str]

    def __len__(self) -> int: ...

    def __getitem__(self, row: int) -> Frame: ...

    def labels(self, rows: Sequence[int]) -> Iterator[np.ndarray]:
        """Yield the labels of the given frames, uint8 [X, Y, Z] each."""
        ...


class StreamedFrames:
    """Frames that are decoded from their samples on each access, without a cache."""

    def __init__(self, source: ImportedSet, rule: FrameRule):
        """Read the scene name of each sample."""
        self._source, self._rule = source, rule
        self.keys = source.keys()
        self.scenes = [source[key].scene_id for key in self.keys]

    def __len__(self) -> int:
        return len(self.keys)

    def __getitem__(self, row: int) -> Frame:
        return make_frame(self._source[self.keys[row]], self._rule)

    def labels(self, rows: Sequence[int]) -> Iterator[np.ndarray]:
        """Yield the labels of the given frames, uint8 [X, Y, Z] each."""
        return (self[row].labels for row in rows)


class CachedFrames:
    """Frames from a cache folder created by ``open_cached_frames``."""

    def __init__(self, folder: Path):
        self._folder = folder
        facts = read_json(folder / READY)
        self.keys: list[str] = facts["keys"]
        self.scenes: list[str] = facts["scenes"]
        self._has_depth: list[bool] = facts["has_depth"]
        self._arrays = {
            name: np.load(folder / f"{name}.npy", mmap_mode="r", allow_pickle=False)
            for name in ARRAYS
        }

    def __reduce__(self) -> tuple[type["CachedFrames"], tuple[Path]]:
        """Pickle only the folder, so that other processes open the files themselves."""
        return CachedFrames, (self._folder,)

    def __len__(self) -> int:
        return len(self.keys)

    def __getitem__(self, row: int) -> Frame:
        arrays = {name: values[row] for name, values in self._arrays.items()}
        return Frame(
            key=self.keys[row],
            scene_id=self.scenes[row],
            image=np.array(arrays["image"]),
            depth_m=arrays["depth"].astype(np.float32) * np.float32(DEPTH_UNIT_M),
            intrinsics=np.array(arrays["intrinsics"]),
            camera_to_grid=np.array(arrays["camera_to_grid"]),
            grid_to_room=np.array(arrays["grid_to_room"]),
            labels=np.array(arrays["labels"]),
            has_depth=self._has_depth[row],
            **{name: (arrays["masks"] & bit) > 0 for name, bit in MASKS.items()},
        )

    def labels(self, rows: Sequence[int]) -> Iterator[np.ndarray]:
        """Yield the labels of the given frames, uint8 [X, Y, Z] each."""
        return (self._arrays["labels"][row] for row in rows)


def open_cached_frames(
    source: ImportedSet,
    rule: FrameRule,
    root: Path | None = None,
    progress: Progress = no_progress,
) -> CachedFrames:
    """Open the frames of a data set from the cache, and create the cache if necessary.

    Args:
        source: Data set.
        rule: Size of the images and cells.
        root: Folder for all caches. Defaults to the user's cache folder.
        progress: Callback that reports progress on the stage ``frames``.

    Raises:
        OutputError: If the disk is full.
        ConflictError: If another process is creating the cache.
    """
    root = user_cache_dir() / "frames" if root is None else root
    folder = root / _identity(source, rule)
    if not (folder / READY).is_file():
        root.mkdir(parents=True, exist_ok=True)
        lock = Lock(root / f"{folder.name}.lock", "filled")
        lock.acquire()
        try:
            _fill(source, rule, folder, progress)
        finally:
            lock.remove()
    return CachedFrames(folder)


def cache_bytes(count: int, rule: FrameRule) -> int:
    """Return the size in bytes of a cache with ``count`` frames."""
    return sum(
        int(np.prod(shape)) * np.dtype(kind).itemsize
        for shape, kind in _layout(count, rule).values()
    )


def _layout(count: int, rule: FrameRule) -> dict[str, tuple[tuple[int, ...], type]]:
    """Return the shape and dtype of each array."""
    size, cells = (rule.height_px, rule.width_px), rule.grid.shape
    return {
        "image": ((count, *size, 3), np.uint8),
        "depth": ((count, *size), np.uint16),
        "intrinsics": ((count, 3, 3), np.float32),
        "camera_to_grid": ((count, 4, 4), np.float32),
        "grid_to_room": ((count, 4, 4), np.float64),
        "labels": ((count, *cells), np.uint8),
        "masks": ((count, *cells), np.uint8),
    }


def _fill(source: ImportedSet, rule: FrameRule, folder: Path, progress: Progress) -> None:
    keys = source.keys()
    need = cache_bytes(len(keys), rule)
    if need > shutil.disk_usage(folder.parent).free:
        raise OutputError(
            folder,
            f"not enough free disk space for {need / 1e9:.1f} GB; choose another cache folder "
            "(--cache DIR) or no cache (--cache off)",
        )
    folder.mkdir(exist_ok=True)
    arrays = {
        name: np.lib.format.open_memmap(folder / f"{name}.npy", "w+", kind, shape)
        for name, (shape, kind) in _layout(len(keys), rule).items()
    }
    scenes, has_depth = [], []
    for row, key in enumerate(keys):
        frame = make_frame(source[key], rule)
        for name, values in _stored(frame).items():
            arrays[name][row] = values
        scenes.append(frame.scene_id)
        has_depth.append(frame.has_depth)
        progress("frames", row + 1, len(keys), source.path.name)
    for values in arrays.values():
        values.flush()
    write_json(folder / READY, {"keys": keys, "scenes": scenes, "has_depth": has_depth})


def _stored(frame: Frame) -> dict[str, np.ndarray]:
    masks = np.zeros(frame.labels.shape, np.uint8)
    for name, bit in MASKS.items():
        masks |= getattr(frame, name).astype(np.uint8) * np.uint8(bit)
    return {
        "image": frame.image,
        "depth": np.clip(np.rint(frame.depth_m / DEPTH_UNIT_M), 0, MAX_DEPTH).astype(np.uint16),
        "intrinsics": frame.intrinsics,
        "camera_to_grid": frame.camera_to_grid,
        "grid_to_room": frame.grid_to_room,
        "labels": frame.labels,
        "masks": masks,
    }


def _identity(source: ImportedSet, rule: FrameRule) -> str:
    """Return a cache name that depends on the data set, its state, the image size and the grid."""
    facts = [
        VERSION, str(source.path.resolve()), source.format, _state(source.path),
        hashlib.sha256("\n".join(source.keys()).encode()).hexdigest(),
        list(rule.grid.shape), rule.grid.voxel_m, rule.width_px, rule.height_px,
    ]  # fmt: skip
    return hashlib.sha256(json.dumps(facts).encode()).hexdigest()[:24]


def _state(path: Path) -> str:
    """Return a value that changes with the data set: its checksum or its newest file time."""
    meta = path / "dataset.json"
    if meta.is_file():
        return hashlib.sha256(meta.read_bytes()).hexdigest()
    places = [path, *(one for one in path.iterdir())] if path.is_dir() else [path]
    return str(max(one.stat().st_mtime_ns for one in places))

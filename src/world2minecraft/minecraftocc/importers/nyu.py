"""Importer for NYUv2 in the layout of MonoScene and later methods.

The labels are read from ``NAME.pkl`` if MonoScene's preprocessing has been run; this file is in
``base/``, in the same folder or in another one. Otherwise ``NAME.bin`` is read and downsampled in
the same way.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.formats.safe_pickle import read_pickle
from world2minecraft.formats.sscnet import downsample_labels, read_bin
from world2minecraft.minecraftocc.formats.image_conventions import HEIGHT_PX, NYU_CAMERA, WIDTH_PX
from world2minecraft.minecraftocc.importers.imported_samples import (
    ImportedFrame,
    ImportedSet,
    checked_labels,
    make_sample,
    read_colour_if_present,
    read_depth_if_present,
    resize_colour,
    resize_depth,
)
from world2minecraft.minecraftocc.types import OccSample

FOLDERS = {"NYUtrain": "train", "NYUtest": "test"}
AXES = (0, 2, 1)  # From x, z (up), y to x, y, z.
STORED_SHAPE = (60, 36, 60)
SAME_SHAPE = 0.01  # Tolerance of the aspect ratio 4:3 of a resized image.


@dataclass(frozen=True)
class _Place:
    """The location of a frame's files."""

    name: str
    folder: Path  # of its pictures and its .bin
    labels: Path | None  # its .pkl
    split: str


def is_nyu(path: Path) -> bool:
    """Return whether a path is a ``.bin`` file, or a folder in the layout of NYUv2."""
    if path.suffix == ".bin":
        return path.is_file()
    if path.name in FOLDERS or any((path / name).is_dir() for name in FOLDERS):
        return True
    return path.is_dir() and any(path.glob("*.bin"))


def open_nyu(path: Path, labels: Path | None = None) -> ImportedSet:
    """Open a folder or file and list its frames.

    Args:
        path: Folder with NYUtrain and NYUtest, any folder with ``.bin`` files, or a ``.bin`` file.
        labels: Folder with the ``base/`` folder of the preprocessing, if it is stored elsewhere.

    Raises:
        InputError: If there are no frames.
    """
    places: dict[str, _Place] = {}
    for folder in _folders(path):
        split = _split_of(folder)
        names = [path.stem] if path.suffix == ".bin" else _names(folder, path, labels)
        for name in names:
            key = name if name not in places else f"{split or folder.name}-{name}"
            places[key] = _Place(name, folder, _pickle_of(folder, name, path, labels), split)
    if not places:
        raise InputError(path, "no files found that match NAME.bin or base/NYUtrain/NAME.pkl")
    splits = {key: place.split for key, place in places.items()}
    return ImportedSet(path, "nyu", splits, lambda key: _read(key, places[key]))


def _split_of(folder: Path) -> str:
    """Return the split in a folder name, such as NYUCADtest or SUNCGtrain_1 of SSCNet."""
    if folder.name in FOLDERS:
        return FOLDERS[folder.name]
    return next((split for split in ("train", "test") if split in folder.name.lower()), "")


def _folders(path: Path) -> list[Path]:
    if path.suffix == ".bin":
        return [path.parent]
    known = [path / name for name in FOLDERS if (path / name).is_dir()]
    return known if known and path.name not in FOLDERS else [path]


def _names(folder: Path, path: Path, labels: Path | None) -> list[str]:
    """Return the frame names of a folder, given by its ``.bin`` files or else by pickles."""
    names = {file.stem for file in folder.glob("*.bin")}
    if not names:
        for base in _bases(folder, path, labels):
            names |= {file.stem for file in base.glob("*.pkl")}
    return sorted(names)


def _bases(folder: Path, path: Path, labels: Path | None) -> list[Path]:
    """Return the possible folders of pickles, the most likely first."""
    roots = [labels / "base", labels] if labels is not None else []
    roots += [folder.parent / "base", path / "base", folder.parent / "preprocess" / "base"]
    return [root / folder.name for root in roots if (root / folder.name).is_dir()]


def _pickle_of(folder: Path, name: str, path: Path, labels: Path | None) -> Path | None:
    for base in _bases(folder, path, labels):
        if (base / f"{name}.pkl").is_file():
            return base / f"{name}.pkl"
    return None


def _read(key: str, place: _Place) -> OccSample:
    stored, origin_m, pose, source = _labels(place)
    picture = place.folder / f"{place.name}_color.jpg"
    colour = read_colour_if_present(picture)
    if colour is not None:
        height, width = colour.shape[:2]
        if abs(width * HEIGHT_PX / (height * WIDTH_PX) - 1) > SAME_SHAPE:
            raise DamagedFileError(
                picture,
                f"image must have the aspect ratio of NYUv2 (640x480), got {width}x{height}",
            )
        colour = resize_colour(colour, WIDTH_PX, HEIGHT_PX)
    depth_m = read_depth_if_present(place.folder / f"{place.name}.png", "nyu")
    if depth_m is not None:
        depth_m = resize_depth(depth_m, NYU_CAMERA)
    labels = np.ascontiguousarray(checked_labels(stored, STORED_SHAPE, source).transpose(AXES))
    found = ImportedFrame(source, labels, origin_m, pose, NYU_CAMERA, colour, depth_m)
    return make_sample(
        found, key, scene_id=place.name, tour_id="", frame=0, split=place.split, format="nyu"
    )


def _labels(place: _Place) -> tuple[np.ndarray, np.ndarray, np.ndarray, Path]:
    """Return the 8 cm labels, the origin, the camera pose and the file with the labels."""
    if place.labels is None:
        path = place.folder / f"{place.name}.bin"
        frame = read_bin(path)
        return downsample_labels(frame.labels, 4), frame.origin_m, frame.camera_to_world, path
    found = read_pickle(place.labels)
    missing = [name for name in ("target_1_4", "voxel_origin", "cam_pose") if name not in found]
    if missing:
        raise DamagedFileError(place.labels, f"does not contain {', '.join(missing)}")
    return found["target_1_4"], found["voxel_origin"], found["cam_pose"], place.labels

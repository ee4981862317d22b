"""Importer for EmbodiedOcc-ScanNet: the frames of complete scenes, and the scenes themselves.

``scene_occ`` contains the packages. The poses and images of the frames are read from ``occscannet``
in the same folder, as in the loaders of this format.
"""

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.formats.safe_pickle import read_pickle
from world2minecraft.minecraftocc.importers.imported_samples import (
    ImportedSet,
    checked_labels,
    checked_numbers,
    checked_place,
    make_sample,
)
from world2minecraft.minecraftocc.importers.occscannet import read_frame
from world2minecraft.minecraftocc.types import DEFAULT_VOXEL_M, OccSample

_FRAME = re.compile(r"([\w-]{1,100})_(\d{1,9})_new", re.ASCII)
MAX_SCENE_BYTES = 2 << 30


@dataclass(frozen=True, eq=False)
class ScenePackage:
    """A complete scene in the coordinate system that its frames share.

    Attributes:
        labels: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z], with z up.
        seen: Whether each cell is seen by any frame, bool [X, Y, Z].
        origin_m: Minimum corner of cell (0, 0, 0) in metres, float64 [3].
        voxel_m: Cell size in metres.
        images: Image paths as stored in the package. They contain the scene name and frame number.
    """

    labels: np.ndarray
    seen: np.ndarray
    origin_m: np.ndarray
    voxel_m: float
    images: tuple[str, ...]


def is_embodied(path: Path) -> bool:
    """Return whether a folder, or its ``scene_occ`` subfolder, contains scene packages."""
    return _packages(path).joinpath("global_occ_package").is_dir()


def open_embodied(path: Path) -> ImportedSet:
    """Open a folder and list the frames of all its scenes.

    Raises:
        InputError: If the frames or their poses are missing.
    """
    packages = _packages(path)
    frames = packages.parent / "occscannet"
    if not (frames / "gathered_data").is_dir():
        raise InputError(
            frames, "contains no gathered_data folder, which is required for the camera poses"
        )
    files: dict[str, tuple[Path, str]] = {}
    for split in ("train", "test"):
        folder = packages / "streme_occ_new_package" / split
        for file in sorted(folder.glob("*_new.pkl")):
            if match := _FRAME.fullmatch(file.stem):
                files[f"{match[1]}-{match[2]}"] = file, split
    if not files:
        raise InputError(
            packages, "no files found that match streme_occ_new_package/train/SCENE_NNNNN_new.pkl"
        )
    splits = {key: split for key, (_, split) in files.items()}
    return ImportedSet(
        path, "embodied", splits, lambda key: _read(frames, key, files[key][0], splits[key])
    )


def read_scene(path: Path) -> ScenePackage:
    """Read a scene package ``global_occ_package/SCENE.pkl``.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid scene package.
    """
    stored = read_pickle(path, MAX_SCENE_BYTES)
    wanted = ("scene_dim", "global_labels", "global_pts", "global_mask", "valid_img_paths")
    if missing := [name for name in wanted if name not in stored]:
        raise DamagedFileError(path, f"does not contain {', '.join(missing)}")
    sides = checked_numbers(stored["scene_dim"], (3,), "scene_dim", path).astype(int)
    shape = (int(sides[0]), int(sides[1]), int(sides[2]))
    labels = checked_labels(stored["global_labels"], shape, path)
    centres = np.asarray(stored["global_pts"])
    seen = np.asarray(stored["global_mask"])
    if centres.shape != (*shape, 3) or centres.dtype.kind != "f" or seen.shape != shape:
        raise DamagedFileError(
            path, "global_pts or global_mask does not have the shape of global_labels"
        )
    first = checked_place(centres.reshape(-1, 3).min(axis=0), "global_pts", path)
    origin_m = first - DEFAULT_VOXEL_M / 2  # The stored points are cell centres.
    images = stored["valid_img_paths"]
    names = tuple(str(name) for name in images) if isinstance(images, list) else ()
    return ScenePackage(labels, seen.astype(bool), origin_m, DEFAULT_VOXEL_M, names)


@dataclass(frozen=True)
class SceneSet:
    """The scenes of a folder.

    Attributes:
        path: Folder with the scene packages.
        splits: Split of each scene, ``train`` or ``test``.
        frames: Frame files of each scene.
    """

    path: Path
    splits: dict[str, str]
    frames: dict[str, tuple[Path, ...]]

    def read(self, scene: str) -> ScenePackage:
        """Read a scene.

        ``seen`` is the union of the masks of its frames, as in the published evaluations.

        Raises:
            InputError: If the scene package does not exist.
            DamagedFileError: If the scene package or the mask of a frame is not valid.
        """
        package = read_scene(self.path / "global_occ_package" / f"{scene}.pkl")
        seen = np.zeros(package.labels.shape, bool)
        for file in self.frames[scene]:
            mask = np.asarray(read_pickle(file, MAX_SCENE_BYTES).get("mask_in_global"))
            if mask.shape != seen.shape or mask.dtype.kind not in ("b", "u"):
                raise DamagedFileError(
                    file, f"mask_in_global has shape {mask.shape}, but its scene has {seen.shape}"
                )
            seen |= mask.astype(bool)
        return replace(package, seen=seen)


def open_scenes(path: Path) -> SceneSet:
    """Open a folder and list the scenes that have both a package and frames.

    Raises:
        InputError: If there are no such scenes.
    """
    packages = _packages(path)
    frames: dict[str, list[Path]] = {}
    splits: dict[str, str] = {}
    for split in ("train", "test"):
        for file in sorted((packages / "streme_occ_new_package" / split).glob("*_new.pkl")):
            if match := _FRAME.fullmatch(file.stem):
                splits.setdefault(match[1], split)
                frames.setdefault(match[1], []).append(file)
    there = {one.stem for one in (packages / "global_occ_package").glob("*.pkl")}
    names = sorted(there & set(splits))
    if not names:
        raise InputError(
            packages, "no scene found that has both a global_occ_package file and frames"
        )
    return SceneSet(
        packages, {name: splits[name] for name in names}, {n: tuple(frames[n]) for n in names}
    )


def _packages(path: Path) -> Path:
    return path / "scene_occ" if (path / "scene_occ").is_dir() else path


def _read(frames: Path, key: str, file: Path, split: str) -> OccSample:
    scene, _, number = key.rpartition("-")
    stored: dict[str, Any] = read_pickle(file)
    if "local_label" not in stored:
        raise DamagedFileError(file, "does not contain local_label")
    found = read_frame(frames, f"{scene}/{number}", stored["local_label"])
    return make_sample(
        found, key, scene_id=scene, tour_id="", frame=int(number), split=split, format="embodied"
    )

"""Importer for OccScanNet: ``gathered_data/SCENE/NNNNN.pkl`` with images in ``posed_images``.

Labels are stored as [y, x, z], as EmbodiedOcc and GPOcc read them, or as [x, y, z] in an export of
this program for ISO, which ``export.json`` states. The paths inside the pickles
refer to the machine that wrote them and are ignored: images are found by scene name and frame
number.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera
from world2minecraft.formats.safe_pickle import read_pickle
from world2minecraft.minecraftocc.formats.image_conventions import HALF_PX, HEIGHT_PX, WIDTH_PX
from world2minecraft.minecraftocc.importers.imported_samples import (
    ImportedFrame,
    ImportedSet,
    checked_labels,
    checked_numbers,
    make_sample,
    read_colour_if_present,
    read_depth_if_present,
    resize_colour,
    resize_depth,
)
from world2minecraft.minecraftocc.types import DEFAULT_SHAPE, OccSample

AXES = (1, 0, 2)  # From y, x, z to x, y, z.
LISTS = {
    "train": ("train_subscenes.txt", "train_final.txt"),
    "test": ("val_subscenes.txt", "test_final.txt"),
}
_LINE = re.compile(r"(?:.*/)?([\w-]{1,100}/\d{1,9})\.pkl", re.ASCII)


def stored_axes(root: Path) -> tuple[int, int, int]:
    """Return the axis order of the labels in a folder, as a transposition to x, y, z."""
    record = root / "export.json"
    stated = read_json(record) if record.is_file() else None
    return (0, 1, 2) if isinstance(stated, dict) and stated.get("axes") == "iso" else AXES


def is_occscannet(path: Path) -> bool:
    """Return whether a folder contains ``gathered_data``."""
    return (path / "gathered_data").is_dir()


def open_occscannet(path: Path) -> ImportedSet:
    """Open a folder and list its frames, with the splits given by its list files.

    Raises:
        InputError: If there are no frames.
    """
    names = sorted(
        f"{file.parent.name}/{file.stem}"
        for file in path.glob("gathered_data/*/*.pkl")
        if file.stem.isdecimal()
    )
    if not names:
        raise InputError(path, "no files found that match gathered_data/SCENE/NNNNN.pkl")
    listed = {name: split for split in LISTS for name in _listed(path, split)}
    of_key = {name.replace("/", "-"): name for name in names}
    splits = {key: listed.get(name, "") for key, name in of_key.items()}
    return ImportedSet(
        path, "occscannet", splits, lambda key: _read(path, key, of_key[key], splits[key])
    )


def _listed(path: Path, split: str) -> set[str]:
    """Return the frames that are contained in any list file of a split."""
    found: set[str] = set()
    for name in LISTS[split]:
        file = path / name
        if file.is_file():
            lines = file.read_text(errors="replace").splitlines()
            found |= {match[1] for line in lines if (match := _LINE.fullmatch(line.strip()))}
    return found


def _read(root: Path, key: str, name: str, split: str) -> OccSample:
    scene, frame = name.split("/")
    return make_sample(
        read_frame(root, name),
        key,
        scene_id=scene,
        tour_id="",
        frame=int(frame),
        split=split,
        format="occscannet",
    )


def read_frame(root: Path, name: str, labels: Any = None) -> ImportedFrame:
    """Read a frame such as ``scene0000_00/00000``, resized to 640x480 pixels as in all loaders.

    Args:
        root: Folder with ``gathered_data``.
        name: Scene name and frame number.
        labels: Labels to use instead of those in the pickle, [60, 60, 36] in the stored axis order.

    Raises:
        InputError: If the pickle does not exist.
        DamagedFileError: If the pickle is not a valid frame.
    """
    path = root / "gathered_data" / f"{name}.pkl"
    stored = read_pickle(path)
    wanted = ("target_1_4", "voxel_origin", "cam_pose", "intrinsic")
    if missing := [word for word in wanted if word not in stored]:
        raise DamagedFileError(path, f"does not contain {', '.join(missing)}")
    axes = stored_axes(root) if labels is None else AXES
    shape = (DEFAULT_SHAPE[axes[0]], DEFAULT_SHAPE[axes[1]], DEFAULT_SHAPE[axes[2]])
    checked = checked_labels(stored["target_1_4"] if labels is None else labels, shape, path)
    picture = root / "posed_images" / name
    colour = read_colour_if_present(picture.with_suffix(".jpg"))
    camera = _camera(stored["intrinsic"], colour, path)
    depth_m = read_depth_if_present(picture.with_suffix(".png"), "mm")
    return ImportedFrame(
        name=path,
        labels=np.ascontiguousarray(checked.transpose(axes)),
        origin_m=stored["voxel_origin"],
        camera_to_world=stored["cam_pose"],
        camera=camera,
        colour=None if colour is None else resize_colour(colour, WIDTH_PX, HEIGHT_PX),
        depth_m=None if depth_m is None else resize_depth(depth_m, camera),
    )


def _camera(stored: Any, colour: np.ndarray | None, path: Path) -> Camera:
    """Return the 640x480 camera. The stored matrix refers to the original image size."""
    numbers = np.asarray(stored)
    matrix = checked_numbers(numbers[:3, :3] if numbers.ndim == 2 else [], (3, 3), "matrix", path)
    height, width = (HEIGHT_PX, WIDTH_PX) if colour is None else colour.shape[:2]
    across, down = WIDTH_PX / width, HEIGHT_PX / height
    try:
        return Camera(
            WIDTH_PX,
            HEIGHT_PX,
            matrix[0, 0] * across,
            matrix[1, 1] * down,
            (matrix[0, 2] + HALF_PX) * across,
            (matrix[1, 2] + HALF_PX) * down,
        )
    except ValueError as error:
        raise DamagedFileError(path, f"intrinsic is not a valid camera matrix ({error})") from error

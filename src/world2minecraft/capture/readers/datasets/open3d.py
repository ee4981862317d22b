"""Reader of Open3D folders: numbered images with one trajectory file.

Images are in ``color``, ``rgb`` or ``image``, and in ``depth``. The trajectory is a ``.log`` file
with five lines per frame (three integers, then the 4x4 camera-to-world matrix), or a ``.json``
PinholeCameraTrajectory with world-to-camera matrices. ``camera*.json`` in the folder or its parent
is a PinholeCameraIntrinsic. Matrices in JSON files are column-major. Depth is registered to colour.
"""

from typing import Any

import numpy as np

from world2minecraft.capture.images import SUFFIXES
from world2minecraft.capture.readers.datasets.intrinsics import (
    PRIMESENSE,
    VGA,
    matrix_camera,
    stated_camera,
)
from world2minecraft.capture.readers.datasets.text_tables import (
    files_with_suffix,
    read_rows,
    to_floats,
)
from world2minecraft.capture.source_types import Capture, FrameFiles, as_floats
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera

COLOUR_FOLDERS = ("color", "colour", "rgb", "image", "images")
MAX_JSON_BYTES = 64 << 20
Trajectory = dict[int, np.ndarray]


class Open3dSource:
    """A reader of images with an Open3D trajectory."""

    layout = "color/*.jpg, depth/*.png with trajectory.log or .json (Open3D, Redwood)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains colour images, depth images and a trajectory."""
        both = _colour_folder(folder) is not None and (folder / "depth").is_dir()
        return both and bool(_trajectories(folder))

    def read(self, folder: AnyPath) -> Capture:
        """Read the pairs of colour and depth images with their poses.

        Raises:
            CaptureError: If images and trajectory do not match, or a file is not valid.
        """
        chosen, *others = _trajectories(folder)
        poses, cameras = _read_trajectory(chosen)
        pairs = _pairs(folder)
        if min(poses) < 0 or max(poses) >= len(pairs):
            raise CaptureError(
                chosen,
                f"contains a pose for frame {max(poses)}, but there are only {len(pairs)} pairs "
                "of images; copy all images",
            )
        camera, notes = _camera(folder)
        if others:
            left = ", ".join(path.name for path in others)
            notes += (f"using the poses of {chosen.name}; ignoring {left}",)
        frames = tuple(
            FrameFiles(
                colour.stem,
                poses.get(index),
                colour,
                cameras.get(index, camera),
                depth,
                cameras.get(index, camera),
                problem="" if index in poses else f"has no pose in {chosen.name}",
            )
            for index, (colour, depth) in enumerate(pairs)
        )
        return Capture(folder, "open3d", frames, notes=() if cameras else notes)


def _colour_folder(folder: AnyPath) -> AnyPath | None:
    return next((folder / name for name in COLOUR_FOLDERS if (folder / name).is_dir()), None)


def _trajectories(folder: AnyPath) -> list[AnyPath]:
    """Return the trajectory files of a folder, the best first.

    Files named as trajectories come first, and odometry, which drifts, comes last.
    """
    found = [path for path in folder.glob("*.log") if path.is_file() and _is_log(path)]
    found += [path for path in folder.glob("*.json") if _is_class(path, "PinholeCameraTrajectory")]

    def rank(path: AnyPath) -> tuple[int, str]:
        name = path.name.lower()
        return (0 if "traj" in name else 2 if "odom" in name else 1, path.name)

    return sorted(found, key=rank)


def _is_log(path: AnyPath) -> bool:
    """Return whether a text file starts like a trajectory: three integers, then four rows."""
    try:
        with path.open("rb") as stream:
            head = stream.read(400).decode("ascii", "replace").splitlines()
    except OSError:
        return False
    first = head[0].split() if head else []
    return len(first) == 3 and all(word.lstrip("-").isdecimal() for word in first)


def _is_class(path: AnyPath, name: str) -> bool:
    try:
        stated = read_json(path, MAX_JSON_BYTES)
    except InputError:
        return False
    return isinstance(stated, dict) and stated.get("class_name") == name


def _read_trajectory(path: AnyPath) -> tuple[Trajectory, dict[int, Camera]]:
    return _read_json(path) if path.suffix == ".json" else (_read_log(path), {})


def _read_log(path: AnyPath) -> Trajectory:
    rows = read_rows(path)
    poses: Trajectory = {}
    for start in range(0, len(rows), 5):
        block = rows[start : start + 5]
        right = len(block) == 5 and len(block[0]) == 3 and all(len(row) == 4 for row in block[1:])
        if not right or not block[0][0].lstrip("-").isdecimal() or len(block[0][0]) > 9:
            raise CaptureError(
                path,
                f"must contain three integers and a 4x4 matrix for each frame (row {start + 1})",
            )
        number = int(block[0][0])
        if number in poses:
            raise CaptureError(path, f"contains two poses for frame {number}; remove one")
        words = [word for row in block[1:] for word in row]
        poses[number] = to_floats(path, words).reshape(4, 4)
    return poses


def _read_json(path: AnyPath) -> tuple[Trajectory, dict[int, Camera]]:
    stated = read_json(path, MAX_JSON_BYTES).get("parameters")
    if not isinstance(stated, list) or not stated:
        raise CaptureError(path, '"parameters" must be a list of cameras')
    poses: Trajectory = {}
    cameras: dict[int, Camera] = {}
    for index, entry in enumerate(stated):
        world_to_camera = _columns(path, entry, "extrinsic", 4)
        try:
            poses[index] = np.linalg.inv(world_to_camera)
        except np.linalg.LinAlgError:
            poses[index] = np.full((4, 4), np.nan)
        cameras[index] = _intrinsic(path, entry.get("intrinsic"))
    return poses, cameras


def _columns(path: AnyPath, stated: Any, key: str, side: int) -> np.ndarray:
    """Return a matrix that JSON stores as one column-major list."""
    values = stated.get(key) if isinstance(stated, dict) else None
    matrix = as_floats(values)
    if matrix.shape != (side * side,):
        raise CaptureError(path, f'"{key}" must be a list of {side * side} numbers')
    return matrix.reshape(side, side).T


def _intrinsic(path: AnyPath, stated: Any) -> Camera:
    matrix = _columns(path, stated, "intrinsic_matrix", 3)
    width, height = stated.get("width"), stated.get("height")
    if not isinstance(width, int) or not isinstance(height, int):
        raise CaptureError(path, '"width" and "height" must be integers')
    return matrix_camera(path, (width, height), matrix)


def _camera(folder: AnyPath) -> tuple[Camera, tuple[str, ...]]:
    """Return the camera from a JSON file in the folder or its parent, or the default camera."""
    for place in (folder, folder.parent):
        for pattern in ("camera*.json", "*intrinsic*.json"):
            for path in sorted(place.glob(pattern), key=str):
                stated = read_json(path, 1 << 20)
                if isinstance(stated, dict) and "intrinsic_matrix" in stated:
                    return _intrinsic(path, stated), ()
    note = "no camera.json found; using the default intrinsics of PrimeSense cameras (525 px)"
    return stated_camera(folder, VGA, PRIMESENSE), (note,)


def _pairs(folder: AnyPath) -> list[tuple[AnyPath, AnyPath]]:
    """Pair images by name, or by order if the names differ and the counts match."""
    colour_folder = _colour_folder(folder) or folder
    colours, depths = (
        files_with_suffix(place, (*SUFFIXES, ".npy")) for place in (colour_folder, folder / "depth")
    )
    by_stem = {path.stem: path for path in depths}
    named = [(path, by_stem[path.stem]) for path in colours if path.stem in by_stem]
    if named and len(named) == len(colours):
        return named
    if len(colours) != len(depths) or not colours:
        raise CaptureError(
            folder,
            f"contains {len(colours)} images in {colour_folder.name}/ and {len(depths)} in "
            "depth/; the counts or the file names must match",
        )
    return list(zip(colours, depths, strict=True))

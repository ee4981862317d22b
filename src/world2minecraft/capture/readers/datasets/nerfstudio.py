"""Reader of ``transforms.json``, as nerfstudio, instant-ngp and many phone apps write it.

Cameras have OpenGL axes. Intrinsics stand once or in each frame; depth images are optional and
share the colour image's camera at their own size. ``applied_scale`` states by what the poses were
multiplied: it is divided out, so that they are in the unit of the depth again. Poses that COLMAP
found have no unit: ``ns-process-data`` leaves its traces in the file, by which that is detected.
"""

import math
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from world2minecraft.capture.images import SUFFIXES, read_header
from world2minecraft.capture.source_types import Capture, FrameFiles, as_floats
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import opengl_to_opencv_pose
from world2minecraft.core.errors import CaptureError, InputError, LimitError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera

_MODELS = ("OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "PERSPECTIVE", "SIMPLE_RADIAL", "RADIAL")


class NerfstudioSource:
    """Reads a folder with a ``transforms.json``."""

    layout = "transforms.json with the images it names (nerfstudio, instant-ngp)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether there is a ``transforms.json``."""
        return (folder / "transforms.json").is_file()

    def read(self, folder: AnyPath) -> Capture:
        """List the frames. Raises CaptureError as ``Source.read`` does."""
        path = folder / "transforms.json"
        stated = read_json(path)
        entries = stated.get("frames") if isinstance(stated, dict) else None
        if not isinstance(entries, list) or not entries:
            raise CaptureError(path, 'must hold "frames", a list of {file_path, transform_matrix}')
        if not any(isinstance(entry, dict) and "transform_matrix" in entry for entry in entries):
            raise CaptureError(
                path, 'no frame has a pose ("transform_matrix"); give the pictures alone'
            )
        scale = _number(path, stated, "applied_scale", 1.0)
        if scale <= 0:
            raise CaptureError(path, f'"applied_scale" must be above 0, not {scale}')
        frames = [_frame(path, stated, entry, scale) for entry in entries]
        notes = [] if scale == 1 else [f"the poses are divided by applied_scale, {scale:g}"]
        lost = sum(_depth_name(entry) is not None for entry in entries)
        lost -= sum(frame.depth_path is not None for frame in frames)
        if lost:
            notes.append(f"{lost} depth images that the file names are not there")
        return Capture(
            folder,
            "nerfstudio",
            tuple(sorted(_with_unique_names(frames), key=lambda frame: frame.name)),
            depth_unit=_depth_unit(path, stated),
            one_matrix=True,
            notes=tuple(notes),
            scale="unknown" if _is_from_colmap(stated, entries) else "metric",
        )


def _depth_unit(path: AnyPath, stated: dict[str, Any]) -> str | None:
    """Return metres per unit of the depth, by nerfstudio's name of it or instant-ngp's."""
    for key in ("depth_unit_scale_factor", "integer_depth_scale"):
        if stated.get(key) is not None:
            return f"{_number(path, stated, key):.17g}"
    return None


def _is_from_colmap(stated: dict[str, Any], entries: list[Any]) -> bool:
    """Return whether the poses were found by COLMAP, which knows no metres.

    Each frame then has ``colmap_im_id``; older versions leave ``applied_transform`` alone, which
    says the same where no depth gives a unit.
    """
    if any(isinstance(entry, dict) and "colmap_im_id" in entry for entry in entries):
        return True
    return "applied_transform" in stated and not any(map(_depth_name, entries))


def _frame(path: AnyPath, stated: dict[str, Any], entry: Any, scale: float) -> FrameFiles:
    if not isinstance(entry, dict) or not isinstance(entry.get("file_path"), str):
        raise CaptureError(path, 'every frame must be an object with "file_path"')
    colour = _file_in_folder(path, entry["file_path"])
    depth_path = _existing_file(path, _depth_name(entry))
    trust_path = _existing_file(path, entry.get("mask_path")) if depth_path else None
    labels = path.parent / "labels" / f"{colour.stem}.png"
    pose = _pose(path, entry, scale)
    try:
        camera = _camera(path, {**stated, **entry}, colour)
    except (CaptureError, LimitError):
        raise
    except InputError as error:  # No size is stated and this one image does not tell it either.
        return FrameFiles(colour.stem, pose, problem=f"{colour.name} {error.reason}")
    return FrameFiles(
        colour.stem,
        pose,
        colour,
        camera,
        depth_path,
        camera if depth_path else None,
        labels_path=labels if labels.is_file() else None,
        problem="" if pose is not None else "has no transform_matrix",
        trust_path=trust_path,
    )


def _depth_name(entry: Any) -> str | None:
    """Return the depth image that a frame names, as nerfstudio or as NeRFCapture calls it."""
    named = [entry.get(key) for key in ("depth_file_path", "depth_path")] if entry else []
    return next((name for name in named if isinstance(name, str) and name), None)


def _existing_file(path: AnyPath, named: Any) -> AnyPath | None:
    """Return the file that a frame names, None where it is not there: NeRFCapture leaves it out."""
    found = _file_in_folder(path, named) if isinstance(named, str) and named else None
    return found if found is not None and found.is_file() else None


def _file_in_folder(path: AnyPath, named: str) -> AnyPath:
    """Return the file that a frame names, which must lie in the capture's folder."""
    pure = PurePosixPath(named.replace("\\", "/"))
    if pure.is_absolute() or ".." in pure.parts or "\0" in named or not pure.name:
        raise CaptureError(
            path, f"names {named[:80]!r}; file paths must be relative and stay inside the folder"
        )
    found = path.parent / str(pure)
    if not pure.suffix and not found.is_file():  # Blender's export leaves the suffix out.
        for suffix in SUFFIXES:
            if (path.parent / f"{pure}{suffix}").is_file():
                return path.parent / f"{pure}{suffix}"
    return found


def _camera(path: AnyPath, stated: dict[str, Any], image: AnyPath) -> Camera:
    model = stated.get("camera_model", "OPENCV")
    if model not in _MODELS:
        raise CaptureError(
            path, f"camera_model {model!r} is not read; undistort to one of {', '.join(_MODELS)}"
        )
    if stated.get("is_fisheye") is True:  # How instant-ngp says it.
        raise CaptureError(path, "is of a fisheye lens, which is not read; undistort first")
    if "w" in stated and "h" in stated:
        width, height = _number(path, stated, "w"), _number(path, stated, "h")
    else:
        width, height = read_header(image).size
    focal = _focal(path, stated, width)
    lens = tuple(_number(path, stated, key, 0.0) for key in ("k1", "k2", "p1", "p2", "k3"))
    if _number(path, stated, "k4", 0.0) != 0:
        raise CaptureError(path, "has a fourth radial term k4, which is not read; undistort first")
    try:
        return Camera(
            int(width),
            int(height),
            focal,
            _number(path, stated, "fl_y", focal),
            _number(path, stated, "cx", width / 2),
            _number(path, stated, "cy", height / 2),
            lens,
        )
    except ValueError as error:
        raise CaptureError(path, f"intrinsics: {error}") from error


def _focal(path: AnyPath, stated: dict[str, Any], width: float) -> float:
    if "fl_x" in stated:
        return _number(path, stated, "fl_x")
    if "camera_angle_x" not in stated:
        raise CaptureError(path, "has no intrinsics (fl_x, fl_y, cx, cy, w, h or camera_angle_x)")
    angle = _number(path, stated, "camera_angle_x")
    if not 0 < angle < math.pi:
        raise CaptureError(path, f"camera_angle_x must lie between 0 and pi, not {angle}")
    return width / (2 * math.tan(angle / 2))


def _number(path: AnyPath, stated: dict[str, Any], key: str, default: float | None = None) -> float:
    value = stated.get(key, default)
    right = isinstance(value, int | float) and not isinstance(value, bool)
    if not right or not abs(value) < 1e300:  # A whole number of JSON may be of any length.
        raise CaptureError(path, f'"{key}" must be a number, not {str(value)[:40]}')
    return float(value)


def _pose(path: AnyPath, entry: dict[str, Any], scale: float) -> np.ndarray | None:
    if "transform_matrix" not in entry:
        return None
    pose = as_floats(entry["transform_matrix"])
    if pose.shape == (3, 4):
        pose = np.vstack([pose, [0, 0, 0, 1]])
    if pose.shape != (4, 4):
        raise CaptureError(
            path, f"transform_matrix of {entry['file_path'][:80]!r} must be four rows of four"
        )
    pose = opengl_to_opencv_pose(pose)
    pose[:3, 3] /= scale
    return pose


def _with_unique_names(frames: list[FrameFiles]) -> list[FrameFiles]:
    """Number the frames whose files share a stem, as ``left/0001`` and ``right/0001`` do."""
    seen: dict[str, int] = {}
    named = []
    for frame in frames:
        count = seen[frame.name] = seen.get(frame.name, 0) + 1
        named.append(frame if count == 1 else replace(frame, name=f"{frame.name}.{count}"))
    return named

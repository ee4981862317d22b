"""Reader of ``transforms.json``, as written by nerfstudio, instant-ngp and many phone apps.

Cameras have OpenGL axes. Intrinsics are stated once or per frame. Depth images are optional and
share the camera of the colour image at their own resolution. Poses are divided by
``applied_scale``, so that their unit matches the depth again. Poses computed by COLMAP have no
metric scale; they are recognised by fields that ``ns-process-data`` leaves in the file.
"""

import math
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from world2minecraft.capture.images import SUFFIXES, read_header
from world2minecraft.capture.readers.apps.app_values import parse_number
from world2minecraft.capture.readers.datasets.label_ids import Reading, label_reading
from world2minecraft.capture.readers.panoramas import (
    is_panorama_size,
    panorama_frames,
    panorama_note,
    view_camera,
)
from world2minecraft.capture.source_types import Capture, FrameFiles, as_floats
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import opengl_to_opencv_pose
from world2minecraft.core.errors import CaptureError, InputError, LimitError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera

PANORAMA = "EQUIRECTANGULAR"
LABEL_FOLDER = "labels"
_MODELS = ("OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "PERSPECTIVE", "SIMPLE_RADIAL", "RADIAL")


class NerfstudioSource:
    """A reader of folders with a ``transforms.json``."""

    layout = "transforms.json with its images (nerfstudio, instant-ngp)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains a ``transforms.json``."""
        return (folder / "transforms.json").is_file()

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames listed in ``transforms.json``.

        Raises:
            CaptureError: If the file lacks required data or contains invalid values.
        """
        path = folder / "transforms.json"
        stated = read_json(path)
        entries = stated.get("frames") if isinstance(stated, dict) else None
        if not isinstance(entries, list) or not entries:
            raise CaptureError(
                path, 'must contain "frames", a list of objects with file_path and transform_matrix'
            )
        if not any(isinstance(entry, dict) and "transform_matrix" in entry for entry in entries):
            raise CaptureError(
                path,
                'contains no camera poses ("transform_matrix"); use the folder of images instead',
            )
        scale = parse_number(path, stated, "applied_scale", 1.0)
        if scale <= 0:
            raise CaptureError(path, f'"applied_scale" must be above 0, got {scale}')
        reading = label_reading(folder / LABEL_FOLDER)
        frames = [one for entry in entries for one in _frames(path, stated, entry, scale, reading)]
        notes = [] if scale == 1 else [f"camera positions are divided by applied_scale, {scale:g}"]
        panoramas = len({frame.rig.place for frame in frames if frame.rig is not None})
        notes += [panorama_note(panoramas)] if panoramas else []
        lost = sum(_depth_name(entry) is not None for entry in entries)
        lost -= sum(frame.depth_path is not None for frame in frames)
        if lost:
            notes.append(f"{lost} depth images named in the file are missing")
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
    """Return metres per depth unit, from the field of nerfstudio or of instant-ngp."""
    for key in ("depth_unit_scale_factor", "integer_depth_scale"):
        if stated.get(key) is not None:
            return f"{parse_number(path, stated, key):.17g}"
    return None


def _is_from_colmap(stated: dict[str, Any], entries: list[Any]) -> bool:
    """Return whether the poses were computed by COLMAP and thus have no metric scale.

    Each frame then has a ``colmap_im_id``. Older versions only leave ``applied_transform``, which
    means the same if no depth images provide a scale.
    """
    if any(isinstance(entry, dict) and "colmap_im_id" in entry for entry in entries):
        return True
    return "applied_transform" in stated and not any(map(_depth_name, entries))


def _frames(
    path: AnyPath, stated: dict[str, Any], entry: Any, scale: float, reading: Reading
) -> list[FrameFiles]:
    """Return the frame of an entry, or the views of its panorama."""
    if not isinstance(entry, dict) or {**stated, **entry}.get("camera_model") != PANORAMA:
        return [_frame(path, stated, entry, scale, reading)]
    if not isinstance(entry.get("file_path"), str):
        raise CaptureError(path, 'every frame must be an object with "file_path"')
    picture, pose = _file_in_folder(path, entry["file_path"]), _pose(path, entry, scale)
    try:
        header = read_header(picture)
    except LimitError:
        raise
    except InputError as error:
        return [FrameFiles(picture.stem, pose, problem=f"{picture.name} {error.reason}")]
    if not is_panorama_size(header.width_px, header.height_px):
        raise CaptureError(
            picture,
            f"is {header.width_px}x{header.height_px} px, but an {PANORAMA} panorama must be twice "
            "as wide as high and at least 1000 px wide",
        )
    return panorama_frames(picture, picture.stem, view_camera(header.width_px), pose)


def _frame(
    path: AnyPath, stated: dict[str, Any], entry: Any, scale: float, reading: Reading
) -> FrameFiles:
    if not isinstance(entry, dict) or not isinstance(entry.get("file_path"), str):
        raise CaptureError(path, 'every frame must be an object with "file_path"')
    colour = _file_in_folder(path, entry["file_path"])
    depth_path = _existing_file(path, _depth_name(entry))
    trust_path = _existing_file(path, entry.get("mask_path")) if depth_path else None
    labels = path.parent / LABEL_FOLDER / f"{colour.stem}.png"
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
        labels_path=reading(labels) if labels.is_file() else None,
        problem="" if pose is not None else "has no transform_matrix",
        trust_path=trust_path,
    )


def _depth_name(entry: Any) -> str | None:
    """Return the name of a frame's depth image, from the field of nerfstudio or of NeRFCapture."""
    named = [entry.get(key) for key in ("depth_file_path", "depth_path")] if entry else []
    return next((name for name in named if isinstance(name, str) and name), None)


def _existing_file(path: AnyPath, named: Any) -> AnyPath | None:
    """Return the file that a frame refers to, or None if it is missing, as with NeRFCapture."""
    found = _file_in_folder(path, named) if isinstance(named, str) and named else None
    return found if found is not None and found.is_file() else None


def _file_in_folder(path: AnyPath, named: str) -> AnyPath:
    """Return the file that a frame refers to, which must be inside the capture's folder."""
    pure = PurePosixPath(named.replace("\\", "/"))
    if pure.is_absolute() or ".." in pure.parts or "\0" in named or not pure.name:
        raise CaptureError(
            path,
            f"contains the file path {named[:80]!r}; paths must be relative and inside the folder",
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
            path,
            f"camera_model {model!r} is not supported; undistort the images to one "
            f"of {', '.join(_MODELS)}",
        )
    if stated.get("is_fisheye") is True:  # How instant-ngp says it.
        raise CaptureError(
            path, "uses a fisheye lens, which is not supported; undistort the images first"
        )
    if "w" in stated and "h" in stated:
        width, height = parse_number(path, stated, "w"), parse_number(path, stated, "h")
    else:
        width, height = read_header(image).size
    focal = _focal(path, stated, width)
    lens = tuple(parse_number(path, stated, key, 0.0) for key in ("k1", "k2", "p1", "p2", "k3"))
    if parse_number(path, stated, "k4", 0.0) != 0:
        raise CaptureError(
            path,
            "uses the distortion coefficient k4, which is not supported; undistort "
            "the images first",
        )
    try:
        return Camera(
            int(width),
            int(height),
            focal,
            parse_number(path, stated, "fl_y", focal),
            parse_number(path, stated, "cx", width / 2),
            parse_number(path, stated, "cy", height / 2),
            lens,
        )
    except ValueError as error:
        raise CaptureError(path, f"has invalid intrinsics: {error}") from error


def _focal(path: AnyPath, stated: dict[str, Any], width: float) -> float:
    if "fl_x" in stated:
        return parse_number(path, stated, "fl_x")
    if "camera_angle_x" not in stated:
        raise CaptureError(
            path, "contains no intrinsics; expected fl_x, fl_y, cx, cy, w and h, or camera_angle_x"
        )
    angle = parse_number(path, stated, "camera_angle_x")
    if not 0 < angle < math.pi:
        raise CaptureError(path, f"camera_angle_x must be between 0 and pi, got {angle}")
    return width / (2 * math.tan(angle / 2))


def _pose(path: AnyPath, entry: dict[str, Any], scale: float) -> np.ndarray | None:
    if "transform_matrix" not in entry:
        return None
    pose = as_floats(entry["transform_matrix"])
    if pose.shape == (3, 4):
        pose = np.vstack([pose, [0, 0, 0, 1]])
    if pose.shape != (4, 4):
        raise CaptureError(
            path, f"transform_matrix of {entry['file_path'][:80]!r} must be a 4x4 matrix"
        )
    pose = opengl_to_opencv_pose(pose)
    pose[:3, 3] /= scale
    return pose


def _with_unique_names(frames: list[FrameFiles]) -> list[FrameFiles]:
    """Number the frames whose files have the same stem, as ``left/0001`` and ``right/0001`` do."""
    seen: dict[str, int] = {}
    named = []
    for frame in frames:
        count = seen[frame.name] = seen.get(frame.name, 0) + 1
        named.append(frame if count == 1 else replace(frame, name=f"{frame.name}.{count}"))
    return named

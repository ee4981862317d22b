"""Reader of Polycam's raw data: ``keyframes/`` by time stamp.

The ``corrected_`` folders, where they exist, hold undistorted pictures and poses that the app
optimised over the whole scan: they are preferred. A camera states ``t_00`` to ``t_23``, three rows
of camera to world with ARKit's axes, ``fx fy cx cy`` and the picture's size. Depth is 16-bit
millimetres, confidence 0, 127 or 255, at the size of the sensor.
"""

from typing import Any

import numpy as np

from world2minecraft.capture.readers.apps.app_values import (
    ARKIT_UP,
    arkit_pose,
    files_by_stem,
    parse_camera,
    parse_number,
    to_float,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.files import read_json

MAX_CAMERA_BYTES = 1 << 20
_PICTURES = (".jpg", ".jpeg", ".png")


class PolycamSource:
    """Reads Polycam's raw data export."""

    layout = "keyframes/ with images, cameras, depth (Polycam's raw data)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether keyframes with cameras are there."""
        keyframes = folder / "keyframes"
        return any((keyframes / name).is_dir() for name in ("cameras", "corrected_cameras"))

    def read(self, folder: AnyPath) -> Capture:
        """List the frames. Raises CaptureError as ``Source.read`` does."""
        keyframes = folder / "keyframes"
        corrected = files_by_stem(keyframes / "corrected_cameras", (".json",))
        prefix = "corrected_" if corrected and (keyframes / "corrected_images").is_dir() else ""
        cameras = files_by_stem(keyframes / f"{prefix}cameras", (".json",))
        pictures = files_by_stem(keyframes / f"{prefix}images", _PICTURES)
        if not cameras or not pictures:
            lacks = f"has no keyframes/{prefix}images with cameras beside them"
            raise CaptureError(folder, f"{lacks}; export the raw data again")
        depths = files_by_stem(keyframes / "depth", (".png",))
        trusts = files_by_stem(keyframes / "confidence", (".png",))
        frames = tuple(
            _frame(stem, cameras[stem], pictures.get(stem), depths.get(stem), trusts.get(stem))
            for stem in cameras
        )
        note = "the app's optimised poses are taken" if prefix else "the poses are ARKit's own"
        return Capture(folder, "polycam", frames, depth_unit="mm", notes=(note,), world_up=ARKIT_UP)


def _frame(
    stem: str,
    path: AnyPath,
    picture: AnyPath | None,
    depth: AnyPath | None,
    trust: AnyPath | None,
) -> FrameFiles:
    try:
        stated = read_json(path, MAX_CAMERA_BYTES)
        if not isinstance(stated, dict):
            raise CaptureError(path, "must be an object with t_00 to t_23, fx, fy, cx, cy")
        size = (parse_number(path, stated, "width"), parse_number(path, stated, "height"))
        lens = parse_camera(
            path, size, [parse_number(path, stated, key) for key in ("fx", "fy", "cx", "cy")]
        )
        pose = _pose(path, stated)
    except InputError as error:
        return FrameFiles(stem, None, problem=f"{path.name} {error.reason}")
    return FrameFiles(
        stem,
        pose,
        picture,
        lens if picture else None,
        depth,
        lens if depth else None,
        problem="" if picture or depth else "has no images",
        trust_path=trust if depth else None,
        time_s=int(stem) * 1e-6 if stem.isascii() and stem.isdigit() and len(stem) < 20 else None,
    )


def _pose(path: AnyPath, stated: dict[str, Any]) -> np.ndarray:
    matrix = np.eye(4)
    for row in range(3):
        for column in range(4):
            key = f"t_{row}{column}"
            if key not in stated:
                raise CaptureError(path, f'lacks "{key}" of the pose; export it again')
            matrix[row, column] = to_float(stated[key])
    return arkit_pose(matrix)

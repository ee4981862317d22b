"""Reader of Polycam's raw data: the ``keyframes/`` folder, with files named by time stamp.

The ``corrected_`` folders contain undistorted images and poses that the app optimised over the
whole scan, and are preferred if they exist. A camera file contains ``t_00`` to ``t_23`` (three rows
of the camera-to-world matrix with ARKit axes), ``fx fy cx cy`` and the image size. Depth is in
16-bit millimetres and confidence is 0, 127 or 255, both at the resolution of the sensor.
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
    """A reader of raw data exported by Polycam."""

    layout = "keyframes/ with images, cameras, depth (Polycam's raw data)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains keyframes with cameras."""
        keyframes = folder / "keyframes"
        return any((keyframes / name).is_dir() for name in ("cameras", "corrected_cameras"))

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a Polycam raw data export.

        Raises:
            CaptureError: If images or cameras are missing.
        """
        keyframes = folder / "keyframes"
        corrected = files_by_stem(keyframes / "corrected_cameras", (".json",))
        prefix = "corrected_" if corrected and (keyframes / "corrected_images").is_dir() else ""
        cameras = files_by_stem(keyframes / f"{prefix}cameras", (".json",))
        pictures = files_by_stem(keyframes / f"{prefix}images", _PICTURES)
        if not cameras or not pictures:
            lacks = f"does not contain keyframes/{prefix}images with matching cameras"
            raise CaptureError(folder, f"{lacks}; export the raw data again")
        depths = files_by_stem(keyframes / "depth", (".png",))
        trusts = files_by_stem(keyframes / "confidence", (".png",))
        frames = tuple(
            _frame(stem, cameras[stem], pictures.get(stem), depths.get(stem), trusts.get(stem))
            for stem in cameras
        )
        note = "using the poses optimised by the app" if prefix else "using the poses of ARKit"
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
            raise CaptureError(path, "must be a JSON object with t_00 to t_23, fx, fy, cx and cy")
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
                raise CaptureError(
                    path, f'does not contain "{key}" of the camera pose; export the data again'
                )
            matrix[row, column] = to_float(stated[key])
    return arkit_pose(matrix)

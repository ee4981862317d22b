"""Reader of Replica sequences as rendered for NICE-SLAM: ``results/`` and ``traj.txt``.

Images are named ``frame000000.jpg`` and ``depth000000.png``. Each line of ``traj.txt`` is a 4x4
camera-to-world matrix with OpenCV axes. ``cam_params.json`` in the folder or its parent contains w,
h, fx, fy, cx, cy and scale, the number of depth units per metre.
"""

import math

import numpy as np

from world2minecraft.capture.readers.apps.app_values import to_float
from world2minecraft.capture.readers.datasets.intrinsics import stated_camera
from world2minecraft.capture.readers.datasets.text_tables import (
    numbered_files,
    read_rows,
    to_floats,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Camera

PARAMETERS = "cam_params.json"
# w h fx fy cx cy scale: the one camera of this data set.
PUBLISHED = (1200, 680, 600.0, 600.0, 599.5, 339.5, 6553.5)


class ReplicaSource:
    """A reader of rooms in Replica's rendered sequences."""

    layout = "results/frame000000.jpg, depth000000.png and traj.txt (Replica of NICE-SLAM)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains a trajectory and images with Replica names."""
        results = folder / "results"
        named = (folder / "traj.txt").is_file() and results.is_dir()
        return named and next(iter(results.glob("frame*.*")), None) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a Replica sequence.

        Raises:
            CaptureError: If the trajectory or the camera parameters are not valid.
        """
        path = folder / "traj.txt"
        rows = read_rows(path)
        if not rows or any(len(row) != 16 for row in rows):
            raise CaptureError(path, "must contain 16 numbers per line, a 4x4 pose")
        words = [word for row in rows for word in row]
        poses = to_floats(path, words).reshape(len(rows), 4, 4)
        images = numbered_files((folder / "results").glob("frame*.*"), "frame")
        depths = numbered_files((folder / "results").glob("depth*.*"), "depth")
        camera, scale, notes = _camera(folder)
        frames = []
        for number, colour in sorted(images.items()):
            depth = depths.get(number)
            known = number < len(poses)
            frames.append(
                FrameFiles(
                    colour.stem,
                    poses[number] if known else None,
                    colour,
                    camera,
                    depth,
                    camera if depth else None,
                    problem="" if known else "has no line in traj.txt",
                )
            )
        unit = repr(1 / scale)
        return Capture(
            folder, "replica", tuple(frames), depth_unit=unit, notes=notes, depth_kind="exact"
        )


def _camera(folder: AnyPath) -> tuple[Camera, float, tuple[str, ...]]:
    keys = ("w", "h", "fx", "fy", "cx", "cy", "scale")
    for path in (folder / PARAMETERS, folder.parent / PARAMETERS):
        if not path.is_file():
            continue
        stated = read_json(path, 1 << 20)
        stated = stated.get("camera", stated) if isinstance(stated, dict) else {}
        values = [stated.get(key) if isinstance(stated, dict) else None for key in keys]
        numbers = [to_float(value) for value in values]
        if not all(math.isfinite(number) and number > 0 for number in numbers):
            raise CaptureError(path, f"must contain {', '.join(keys)}, each above 0")
        return _stated(path, numbers), numbers[-1], ()
    note = f"no {PARAMETERS} found; using the intrinsics published for Replica (1200x680, 600 px)"
    return _stated(folder, list(PUBLISHED)), PUBLISHED[-1], (note,)


def _stated(where: AnyPath, numbers: list[float]) -> Camera:
    width, height, *lens = numbers[:6]
    return stated_camera(where, (round(width), round(height)), np.array(lens))

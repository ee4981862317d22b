"""Reader of "All Data" exports of the 3D Scanner App: ``frame_00000.json``, images and depth.

The JSON file of a frame contains ``cameraPoseARFrame`` (camera-to-world, row-major, ARKit axes) and
``intrinsics`` (3x3, row-major, for the size of the colour image). ``depth_00000.png`` is in 16-bit
millimetres (older versions: ``frame_00000.exr`` in metres), and ``conf_00000.png`` ranges from 0 to
2. Only the frames with a colour image, ``frame_00000.jpg``, are used.
"""

import re
from pathlib import Path

from world2minecraft.capture.images import read_header
from world2minecraft.capture.readers.apps.app_values import (
    ARKIT_UP,
    arkit_pose,
    parse_camera,
    parse_numbers,
)
from world2minecraft.capture.readers.apps.exr import ExrImage
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.files import read_json

MAX_FRAME_BYTES = 4 << 20
_FILE = re.compile(r"(frame|depth|conf)_(\d{1,9})\.(json|jpg|png|exr)", re.ASCII)


class ScannerAppSource:
    """A reader of "All Data" exports of the 3D Scanner App."""

    layout = "frame_00000.json, .jpg, depth_00000.png (3D Scanner App, All Data)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains JSON files with the app's frame names."""
        return folder.is_dir() and next(iter(folder.glob("frame_[0-9]*.json")), None) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames that have a colour image.

        Raises:
            CaptureError: If there are no frames or no colour images.
        """
        found = _files(folder)
        stated = {index: files for index, files in found.items() if "frame.json" in files}
        pictured = {index: files for index, files in stated.items() if "frame.jpg" in files}
        if not stated:
            raise CaptureError(
                folder, 'does not contain frame_00000.json; export "All Data" from the app'
            )
        if not pictured:
            raise CaptureError(
                folder,
                'contains no colour images (frame_00000.jpg); export "All Data" from the app',
            )
        metres = not any("depth.png" in files for files in pictured.values())
        frames = tuple(_frame(index, files) for index, files in sorted(pictured.items()))
        left = len(stated) - len(pictured)
        notes = (f"{left} frames without a colour image are ignored",) if left else ()
        return Capture(
            folder,
            "scanner_app",
            frames,
            depth_unit="m" if metres else "mm",
            notes=notes,
            full_trust=2.0,
            world_up=ARKIT_UP,
        )


def _files(folder: AnyPath) -> dict[int, dict[str, AnyPath]]:
    """Return the files of each frame by kind and suffix, such as ``depth.png``."""
    found: dict[int, dict[str, AnyPath]] = {}
    for path in folder.iterdir():
        match = _FILE.fullmatch(path.name)
        if match:
            found.setdefault(int(match[2]), {})[f"{match[1]}.{match[3]}"] = path
    return found


def _frame(index: int, files: dict[str, AnyPath]) -> FrameFiles:
    name = f"{index:05d}"
    path, picture = files["frame.json"], files["frame.jpg"]
    try:
        stated = read_json(path, MAX_FRAME_BYTES)
        if not isinstance(stated, dict):
            raise CaptureError(path, "must be a JSON object with cameraPoseARFrame and intrinsics")
        pose = parse_numbers(path, "cameraPoseARFrame", stated.get("cameraPoseARFrame"), 16)
        matrix = parse_numbers(path, "intrinsics", stated.get("intrinsics"), 9).reshape(3, 3)
        lens = [matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2]]
        stated_camera = parse_camera(path, read_header(picture).size, lens)
    except InputError as error:
        return FrameFiles(name, None, problem=f"{Path(error.path).name} {error.reason}")
    depth = files.get("depth.png")
    packed = ExrImage(files["frame.exr"]) if depth is None and "frame.exr" in files else None
    has_depth = depth is not None or packed is not None
    return FrameFiles(
        name,
        arkit_pose(pose.reshape(4, 4)),
        picture,
        stated_camera,
        depth or packed,
        stated_camera if has_depth else None,
        trust_path=files.get("conf.png") if has_depth else None,
    )

"""Reader of 7-Scenes: ``frame-000000.color.png``, ``.depth.png`` and ``.pose.txt`` files.

Frames are in the folder itself, in ``frames/`` or in ``seq-01/``, ``seq-02/`` and so on, which
share one world frame. ``camera-intrinsics.txt`` (3x3) in that folder or its parent contains the
intrinsic matrix. The original data set has no such file and names its colour images ``.png``; in
that case, the published Kinect matrix is used. The matrix is that of the depth camera; the colour
camera is a separate camera next to it.
"""

import re

import numpy as np

from world2minecraft.capture.images import read_header
from world2minecraft.capture.pose_validation import read_pose
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, DamagedFileError, InputError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import Camera

INTRINSICS = "camera-intrinsics.txt"
PUBLISHED = (585.0, 585.0, 320.0, 240.0)  # fx fy cx cy at 640x480, from the data set's page.
_FRAME = re.compile(r"(frame-\d{1,9})\.(color|depth|pose)\.(png|jpg|jpeg|txt|npy)", re.ASCII)


class SevenScenesSource:
    """A reader of 7-Scenes scenes and sequences."""

    layout = "frame-000000.color.png, .depth.png, .pose.txt (7-Scenes)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder or its sequence folders contain frames with 7-Scenes names."""
        return any(
            _FRAME.fullmatch(path.name)
            for part in _parts(folder)
            for path in part.glob("frame-*.*.*")
        )

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of all sequences of a scene.

        Raises:
            CaptureError: If poses or intrinsics are missing or not valid.
        """
        parts = _parts(folder)
        listed = [(part, stem, found) for part in parts for stem, found in _frames(part)]
        if not any("pose" in found for _, _, found in listed):
            raise CaptureError(
                folder, "contains no camera poses (frame-000000.pose.txt next to the images)"
            )
        every = [found for _, _, found in listed]
        matrix, notes = _intrinsics(folder, parts, every)
        camera = _camera(folder, every, matrix)
        several = len({part for part, _, _ in listed}) > 1
        frames = tuple(
            _frame(f"{part.name}.{stem}" if several else stem, found, camera)
            for part, stem, found in listed
        )
        return Capture(folder, "seven_scenes", frames, one_matrix=True, notes=notes)


def _parts(folder: AnyPath) -> list[AnyPath]:
    """Return the folders that may contain frames: this folder, ``frames/`` and the sequences."""
    inner = [folder / "frames", *sorted(folder.glob("seq-*"))]
    return [folder, *(part for part in inner if part.is_dir())]


def _frames(part: AnyPath) -> list[tuple[str, dict[str, AnyPath]]]:
    """Return the files of each frame by kind, sorted by name."""
    frames: dict[str, dict[str, AnyPath]] = {}
    for path in sorted(part.glob("frame-*.*.*")):
        match = _FRAME.fullmatch(path.name)
        if match:
            frames.setdefault(match[1], {})[match[2]] = path
    return sorted(frames.items())


def _intrinsics(
    folder: AnyPath, parts: list[AnyPath], frames: list[dict[str, AnyPath]]
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the 3x3 intrinsic matrix, and a note if it is not part of the capture."""
    for place in (*parts, folder.parent):
        if (place / INTRINSICS).is_file():
            return _read_matrix(place / INTRINSICS), ()
    true_names = all(found["color"].suffix == ".png" for found in frames if "color" in found)
    if not true_names:
        raise CaptureError(
            folder,
            f"does not contain {INTRINSICS} (3x3: fx 0 cx, 0 fy cy, 0 0 1); create "
            "it next to the frames",
        )
    fx, fy, cx, cy = PUBLISHED
    note = (
        "no camera-intrinsics.txt found; using the intrinsics published for 7-Scenes "
        "(585, 320, 240)"
    )
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), (note,)


def _read_matrix(path: AnyPath) -> np.ndarray:
    words = read_bytes(path, 10_000).decode("ascii", "replace").split()
    try:
        values = np.array([float(word) for word in words])
    except ValueError as error:
        raise CaptureError(path, f"contains text where a number is expected ({error})") from error
    if len(values) not in (9, 16):
        raise CaptureError(path, f"must contain 9 numbers (a 3x3 matrix), got {len(values)}")
    side = 3 if len(values) == 9 else 4
    matrix = values.reshape(side, side)[:3, :3]
    right_form = np.allclose(matrix[2], [0, 0, 1]) and np.allclose(matrix[[0, 1], [1, 0]], 0)
    if not np.isfinite(matrix).all() or not right_form or min(matrix[0, 0], matrix[1, 1]) <= 0:
        raise CaptureError(
            path, f"must have the form fx 0 cx, 0 fy cy, 0 0 1, got {matrix.tolist()}"
        )
    return matrix


def _camera(folder: AnyPath, frames: list[dict[str, AnyPath]], matrix: np.ndarray) -> Camera:
    """Return the camera for the matrix, with the image size that the matrix refers to.

    The file states no size. The size is that of the stream whose centre is closest to the principal
    point; ties go to depth, because the matrix is that of the depth camera.
    """
    sizes = [size for kind in ("depth", "color") if (size := _first_size(frames, kind)) is not None]
    if not sizes:
        raise CaptureError(
            folder, "contains poses but no readable image (frame-000000.color.png, .depth.png)"
        )
    cx, cy = matrix[0, 2], matrix[1, 2]
    width, height = min(sizes, key=lambda size: abs(cx / size[0] - 0.5) + abs(cy / size[1] - 0.5))
    return Camera(width, height, float(matrix[0, 0]), float(matrix[1, 1]), float(cx), float(cy))


def _first_size(frames: list[dict[str, AnyPath]], kind: str) -> tuple[int, int] | None:
    for found in frames:
        if kind in found:
            try:
                return read_header(found[kind]).size
            except DamagedFileError:
                continue  # It will be listed as damaged; its neighbours tell the size.
    return None


def _frame(name: str, found: dict[str, AnyPath], camera: Camera) -> FrameFiles:
    colour, depth = found.get("color"), found.get("depth")
    pose, problem = None, ""
    try:
        pose = read_pose(found["pose"])
    except KeyError:
        problem = "has no pose file"
    except InputError as error:
        problem = f"{found['pose'].name}: {error.reason}"
    return FrameFiles(
        name,
        pose,
        colour,
        camera if colour else None,
        depth,
        camera if depth else None,
        problem=problem if colour or depth else "has no images",
    )

"""Reader of exported ScanNet scenes: numbered files in ``color/``, ``depth/`` and ``pose/``.

``intrinsic/intrinsic_color.txt`` and ``intrinsic_depth.txt`` (4x4) refer to the images as recorded,
which are often exported at a smaller size. Depth is in millimetres. Poses with -inf mark lost
tracking.
"""

import numpy as np

from world2minecraft.capture.images import SUFFIXES
from world2minecraft.capture.pose_validation import read_pose
from world2minecraft.capture.readers.datasets.intrinsics import (
    VGA,
    first_image_size,
    intrinsics_size,
    matrix_camera,
)
from world2minecraft.capture.readers.datasets.label_ids import MappedLabels
from world2minecraft.capture.readers.datasets.scannet_metadata import (
    find_labels,
    read_scene_info,
    up_vector,
)
from world2minecraft.capture.readers.datasets.text_tables import (
    files_with_suffix,
    numbered_files,
    read_matrix,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.types import Camera

RECORDED = (1296, 968)  # The iPad's colour images; the depth images are VGA.


class ScanNetFolderSource:
    """A reader of exported ScanNet scenes."""

    layout = "color/0.jpg, depth/0.png, pose/0.txt, intrinsic/intrinsic_depth.txt (ScanNet export)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains image and pose folders and an intrinsic matrix."""
        images = (folder / "color").is_dir() or (folder / "depth").is_dir()
        return images and (folder / "pose").is_dir() and bool(_matrix_files(folder))

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of an exported ScanNet scene.

        Raises:
            CaptureError: If images, poses or intrinsics are missing or not valid.
        """
        colours = numbered_files(files_with_suffix(folder / "color", SUFFIXES))
        depths = numbered_files(files_with_suffix(folder / "depth", SUFFIXES))
        poses = numbered_files((folder / "pose").glob("*.txt"))
        numbers = sorted(colours.keys() | depths.keys())
        if not numbers or not poses:
            raise CaptureError(folder, "contains no numbered images and poses, such as pose/0.txt")
        cameras = _cameras(folder, list(colours.values()), list(depths.values()))
        facts_path = folder / f"{folder.name}.txt"
        labels, notes = find_labels(folder, folder.name)
        frames = tuple(
            _frame(n, colours.get(n), depths.get(n), poses.get(n), labels.get(n), cameras)
            for n in numbers
        )
        up = up_vector(facts_path, read_scene_info(facts_path))
        return Capture(folder, "scannet_folder", frames, depth_unit="mm", notes=notes, world_up=up)


def _matrix_files(folder: AnyPath) -> dict[str, AnyPath]:
    """Return the matrix files by kind; exporters use different names."""
    found = {}
    for kind in ("color", "depth"):
        for name in (
            f"intrinsic/intrinsic_{kind}.txt",
            f"intrinsic_{kind}.txt",
            f"intrinsics_{kind}.txt",
        ):
            if (folder / name).is_file():
                found[kind] = folder / name
                break
    return found


def _cameras(folder: AnyPath, colours: list[AnyPath], depths: list[AnyPath]) -> dict[str, Camera]:
    """Return the cameras by kind, with the image size that each matrix refers to."""
    files = _matrix_files(folder)
    cameras = {}
    for kind, images, recorded in (("color", colours, RECORDED), ("depth", depths, VGA)):
        if not images:
            continue
        path = files.get(kind)
        if path is None:
            raise CaptureError(
                folder, f"does not contain intrinsic/intrinsic_{kind}.txt (4x4 matrix)"
            )
        matrix = read_matrix(path, [(4, 4), (3, 3)])
        size = intrinsics_size(
            (matrix[0, 2], matrix[1, 2]), [first_image_size(images), recorded, VGA]
        )
        cameras[kind] = matrix_camera(path, size or recorded, matrix)
    return cameras


def _frame(
    number: int,
    colour: AnyPath | None,
    depth: AnyPath | None,
    pose_path: AnyPath | None,
    labels: MappedLabels | None,
    cameras: dict[str, Camera],
) -> FrameFiles:
    pose, problem = None, ""
    if pose_path is None:
        problem = f"has no pose/{number}.txt"
    else:
        try:
            pose = read_pose(pose_path)
        except InputError as error:
            problem = f"{pose_path.name}: {error.reason}"
    return FrameFiles(
        f"{number:06d}",
        pose,
        colour,
        cameras["color"] if colour else None,
        depth,
        cameras["depth"] if depth else None,
        np.eye(4),
        labels if colour else None,
        problem,
    )

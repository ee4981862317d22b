"""Pose files for tours and screenshots, with one JSON object per line.

Each line contains the names of its tour and scene, the ``frame`` number within the tour, and
``room`` and ``kind`` (axis, diagonal or free) in addition to the keys described in
``rendering.views.pose_file``.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.screenshots import RecordedView
from world2minecraft.minecraftocc.tours.types import PlannedView, nyu_camera
from world2minecraft.rendering.views.cameras import Shot, camera_of, game_pose_of
from world2minecraft.rendering.views.pose_file import TourPose, read_tour, tour_line, write_lines


def write_views(
    path: str | Path, views: Sequence[PlannedView], block_to_room: np.ndarray, scene_id: str = ""
) -> None:
    """Write views as a tour file, which ``read_views`` reads without loss.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_lines(path, [view_line(view, block_to_room, scene_id) for view in views])


def view_line(view: PlannedView, block_to_room: np.ndarray, scene_id: str) -> dict[str, Any]:
    """Return the line of a tour file for a view, as a dict."""
    shot = Shot(view.camera, view.camera_to_room, view.t_s)
    own: dict[str, Any] = {"scene_id": scene_id, "tour_id": view.tour_id}
    more = {**own, "room": view.room, "kind": view.kind}
    line = tour_line(shot, view.frame, block_to_room, more)
    if not _keeps_intrinsics(line, view.camera):
        line["intrinsics"] = view.camera.matrix.tolist()
    return line


def read_views(
    path: str | Path, block_to_room: np.ndarray, camera: Camera | None = None
) -> list[PlannedView]:
    """Read the views of a tour file.

    Args:
        path: JSONL or CSV file. Lines without a ``tour_id`` form one tour in line order.
        block_to_room: Matrix from block coordinates to room coordinates of the world, float64 [4,
            4].
        camera: Camera for lines that do not specify their own. Defaults to that of NYUv2.

    Raises:
        InputError: If the file cannot be read.
        DamagedFileError: If a line is not a valid pose, or if the file has no poses.
        LimitError: If the file is too large.
    """
    eye_blocks = eye_height_blocks(1 / float(np.linalg.norm(block_to_room[:3, 0])))
    views, counts = [], {}
    for one in read_tour(path):
        tour_id = one.tour_id or "t000"
        number = counts.get(tour_id, 0)
        counts[tour_id] = number + 1
        views.append(_view(one, tour_id, number, block_to_room, eye_blocks, camera))
    return views


def _view(
    one: TourPose,
    tour_id: str,
    number: int,
    block_to_room: np.ndarray,
    eye_blocks: float,
    camera: Camera | None,
) -> PlannedView:
    return PlannedView(
        tour_id,
        number if one.frame is None else one.frame,
        one.camera or camera or nyu_camera(),
        one.pose.camera_to_room(block_to_room, eye_blocks),
        one.pose,
        one.t_s,
    )


def _keeps_intrinsics(line: dict[str, Any], camera: Camera) -> bool:
    """Return whether the size and vertical field of view of a line describe this camera exactly."""
    try:
        expected = camera_of(
            *(line["width"], line["height"]), vertical_fov_deg=line["vertical_fov_deg"]
        )
    except UsageError:
        return False
    return expected == camera


def write_recorded_views(
    path: str | Path, views: Sequence[RecordedView], block_to_room: np.ndarray, scene_id: str
) -> None:
    """Write screenshots as a tour file, with poses at the eye and relative image paths.

    Args:
        path: Output file.
        views: Result of ``read_screenshots``.
        block_to_room: Matrix from block coordinates to room coordinates of the world, float64 [4,
            4].
        scene_id: Name of the scene.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_lines(path, [_line(view, block_to_room, scene_id, Path(path)) for view in views])


def _line(
    view: RecordedView, block_to_room: np.ndarray, scene_id: str, path: Path
) -> dict[str, Any]:
    camera_to_room = view.camera_to_room(block_to_room)
    pose = game_pose_of(camera_to_room, block_to_room)
    planned = PlannedView(
        view.tour_id or "t000", view.frame, view.camera, camera_to_room, pose, view.t_s
    )
    line = view_line(planned, block_to_room, scene_id)
    try:
        image = view.image.resolve().relative_to(path.resolve().parent).as_posix()
    except ValueError:
        image = view.image.resolve().as_posix()
    return {key: value for key, value in line.items() if key != "room"} | {"image": image}

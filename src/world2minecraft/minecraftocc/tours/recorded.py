"""Screenshots with poses as a tour file, so that what reads tours reads them too."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.minecraftocc.screenshots import RecordedView
from world2minecraft.minecraftocc.tours.files import view_line
from world2minecraft.minecraftocc.tours.values import PlannedView
from world2minecraft.rendering.views.cameras import game_pose_of
from world2minecraft.rendering.views.pose_file import write_lines


def write_recorded(
    path: str | Path, views: Sequence[RecordedView], block_to_room: np.ndarray, scene_id: str
) -> None:
    """Write screenshots as a tour file: poses at the eye, ``image`` as it lies from there.

    Args:
        path: the file.
        views: of ``read_screenshots``.
        block_to_room: of the world that they show.
        scene_id: what the world is called.

    Raises:
        OutputError: it cannot be written.
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

"""Recorded views for a data set: the poses in a tour file, or screenshots taken in the game."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.plan import GivenViews
from world2minecraft.minecraftocc.screenshots import RecordedView, read_screenshots
from world2minecraft.minecraftocc.tours import PlannedView, read_views

MAX_TOUR_NAME = 30  # Characters of a tour name in the keys of its samples.


def load_given_views(
    given: GivenViews, block_to_room: np.ndarray, camera: Camera
) -> list[PlannedView]:
    """Load recorded views in their order, with unique names.

    Args:
        given: Tour file or folder of screenshots to load.
        block_to_room: 4x4 matrix from block coordinates to room coordinates of the world.
        camera: Camera for poses that do not specify their own.

    Raises:
        InputError: If the views cannot be read.
        UsageError: If settings required to read the views are missing.
    """
    if not given.is_screenshots:
        return _with_unique_names(read_views(given.path, block_to_room, camera))
    return _with_unique_names(
        [
            PlannedView(
                one.tour_id, one.frame, one.camera, one.camera_to_room(block_to_room), one.pose,
                one.t_s,
            )
            for one in load_screenshot_views(given)
        ]
    )  # fmt: skip


def load_screenshot_views(given: GivenViews) -> list[RecordedView]:
    """Load the screenshots in a folder with their poses.

    Raises the same exceptions as ``read_screenshots``.
    """
    return read_screenshots(
        given.path,
        at=given.at,
        pattern=given.pattern,
        vertical_fov_deg=given.vertical_fov_deg,
    )


def load_screenshot(path: Path, camera: Camera) -> np.ndarray:
    """Load a screenshot as uint8 [H, W, 3].

    Raises:
        DamagedFileError: If the file cannot be read, or if its size differs from that of the
            camera.
    """
    try:
        with Image.open(path, formats=("PNG",)) as image:
            if image.size != (camera.width_px, camera.height_px):
                raise DamagedFileError(
                    path,
                    f"size changed to {image.width}x{image.height} pixels since the "
                    "folder was first read",
                )
            return np.array(image.convert("RGB"))
    except (OSError, ValueError, SyntaxError) as error:
        raise DamagedFileError(path, f"cannot be read ({error})") from error


def _with_unique_names(views: list[PlannedView]) -> list[PlannedView]:
    """Make tour names valid in sample keys, and renumber frames if names are not unique."""
    plain = [
        replace(
            view, tour_id=re.sub(r"[^A-Za-z0-9_]+", "_", view.tour_id)[:MAX_TOUR_NAME] or "t000"
        )
        for view in views
    ]
    names = {(view.tour_id, view.frame) for view in plain}
    if len(names) == len(plain) and all(0 <= view.frame < 1_000_000 for view in plain):
        return plain
    return [replace(view, frame=number) for number, view in enumerate(plain)]

"""The picture of the true room, from the corner from which the preview shows the built one."""

from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.evaluation.scoring.truth_files import read_colour, read_instances, read_truth
from world2minecraft.evaluation.scoring.used_frames import move_truth
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.scan_record import read_source_to_scan
from world2minecraft.procgen import room_view
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.rendering.preview import PreviewView


def truth_picture(folder: Path, truth: Path, view: PreviewView) -> np.ndarray | None:
    """Return the true room from the pose of a preview, uint8 [height, width, 3].

    Args:
        folder: The folder of the run.
        truth: The folder of the ground truth.
        view: What the preview of the run shows.

    Returns:
        The picture, or None for a ground truth of surfaces or without colours, and for a house of
        several storeys.

    Raises:
        InputError: If a file is missing or damaged.
    """
    known = move_truth(read_truth(truth), read_source_to_scan(folder / "scan.json"))
    levels = {layout.floor_z_m for layout in known.layouts}
    if known.is_partial or len(levels) != 1 or view.storeys != 1:
        return None
    if (colour := read_colour(known)) is None:
        return None
    _, scan_to_room = read_room(folder / "room.npz")
    room_to_truth = invert_rigid(scan_to_room @ known.truth_to_scan)
    room = Room(
        kind="",
        seed=0,
        layouts=known.layouts,
        labels=known.labels,
        instance=read_instances(known),
        colour=colour,
        voxel_m=known.voxel_m,
        origin_m=known.origin_m,
    )
    return room_view(
        room, view.camera, room_to_truth @ view.camera_to_room, _near(view, room_to_truth)
    )


def _near(view: PreviewView, room_to_truth: np.ndarray) -> tuple[int, int]:
    """Return the near sides of a preview in the frame of the truth, which may be turned."""
    x, y = np.where(room_to_truth[:2, :2] @ view.near > 0, 1, -1).tolist()
    return x, y

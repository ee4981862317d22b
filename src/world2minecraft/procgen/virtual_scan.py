"""Virtual scans: a generated room as a capture on disk, as a sensor would write it, with its truth.

The capture is in our plain layout; its world frame is turned, tilted and shifted, so that the
alignment has work. ``truth.npz`` and ``truth.json`` hold what no sensor knows.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Layout, LayoutObject, Opening, View
from world2minecraft.formats.objects_and_placements import round_metres
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.phone import phone_shots, write_photos, write_video
from world2minecraft.procgen.sensors.scan_frames import (
    FrameTruth,
    ScanSettings,
    Shot,
    room_shots,
    room_to_scan,
)


def scan_room(
    room: Room,
    folder: str | Path,
    *,
    sensor: str = "rgbd",
    frames: int | None = None,
    seed: int = 0,
    with_labels: bool = False,
    label_error: float = 0.0,
    depth_scale_sigma: float = 0.0,
    coverage: float = 1.0,
    width: int = 640,
    height: int = 480,
    progress: Progress = no_progress,
) -> None:
    """Scan a room or a house virtually and write the capture with its truth.

    Args:
        room: the room or the house.
        folder: where the capture goes; made if missing.
        sensor: ``rgbd`` or ``clean``; or a phone's without depth: ``photo`` (photos with their
            poses), ``photos`` (JPEGs and nothing else), ``video`` (``capture.mp4``).
        frames: how many pictures the whole tour has; else 40, 100 photos, or 240 of a video.
        seed: of the tour, the world frame and the noise; the same seed gives the same bytes.
        with_labels: whether to write label images.
        label_error: the share of the label images, in patches, that says another class.
        depth_scale_sigma: each frame's depth is multiplied by a factor of its own, 1 give or
            take this much, as depth networks and badly calibrated sensors do.
        coverage: the share of the tour that is walked, above 0 and up to 1: the pictures of 0.6
            are the first 60 % of those of 1, so that some corners stay unseen.
        width: of the pictures, in pixels.
        height: of the pictures, in pixels.
        progress: called after each frame, stage ``capture``.

    Raises:
        UnknownNameError: no sensor has this name. ValueError: a figure is out of its range.
        OutputError: the folder cannot be written. MissingExtraError: ``av`` is not installed, which
            writes videos.
    """
    how = ScanSettings(
        sensor, frames, seed, with_labels, label_error, depth_scale_sigma, coverage, width, height
    )
    truths: list[FrameTruth] = []
    views = _views(_shots(room, how), truths, how.taken, progress)
    if how.sensor == "photos":
        write_photos(folder, views)
    elif how.sensor == "video":
        write_video(Path(folder) / "capture.mp4", views)
    else:
        write_plain(folder, views, jpeg=how.phone)
    write_truth(room, folder, room_to_scan(seed), truths)


def room_views(
    room: Room,
    *,
    sensor: str = "rgbd",
    frames: int | None = None,
    seed: int = 0,
    with_labels: bool = False,
    label_error: float = 0.0,
    depth_scale_sigma: float = 0.0,
    coverage: float = 1.0,
    width: int = 640,
    height: int = 480,
) -> Iterator[View]:
    """Yield the views of a virtual scan one at a time; arguments as ``scan_room``."""
    how = ScanSettings(
        sensor, frames, seed, with_labels, label_error, depth_scale_sigma, coverage, width, height
    )
    return (shot.view for shot in _shots(room, how))


def _shots(room: Room, how: ScanSettings) -> Iterator[Shot]:
    return phone_shots(room, how) if how.phone else room_shots(room, how)


def _views(
    shots: Iterator[Shot], truths: list[FrameTruth], total: int, progress: Progress
) -> Iterator[View]:
    """Pass the views on, and keep what is true of each; the pictures are not kept."""
    for shot in shots:
        yield shot.view
        truths.append(shot.truth)
        progress("capture", len(truths), total, shot.view.name)


def write_truth(
    room: Room,
    folder: str | Path,
    truth_room_to_scan: np.ndarray,
    frames: Sequence[FrameTruth] = (),
) -> None:
    """Write ``truth.npz`` and ``truth.json`` beside a capture.

    ``truth.npz`` holds ``labels``, ``instance``, ``voxel_m``, ``origin_m``,
    ``truth_room_to_scan`` and, a row a frame, ``frame_names``, ``camera_to_truth`` (float64
    [F, 4, 4], the true pose of the camera in the room) and ``depth_scale`` (float64 [F], what
    true depth was multiplied by). ``truth.json`` holds the kind, the seed, the objects and the
    layouts.

    Raises:
        OutputError: the folder cannot be written.
    """
    write_npz(
        Path(folder) / "truth.npz",
        {
            "labels": room.labels,
            "instance": room.instance,
            "voxel_m": np.array(room.voxel_m),
            "origin_m": room.origin_m,
            "truth_room_to_scan": truth_room_to_scan,
            "frame_names": np.array([frame.name for frame in frames], np.str_),
            "camera_to_truth": np.array(
                [frame.camera_to_truth for frame in frames], np.float64
            ).reshape(-1, 4, 4),
            "depth_scale": np.array([frame.depth_scale for frame in frames], np.float64),
        },
    )
    truth = {
        "kind": room.kind,
        "seed": room.seed,
        "size_m": round_metres(room.size_m),
        "objects": [object_to_json(n, item) for n, item in enumerate(room.objects, start=1)],
        "layouts": [_stated_layout(layout) for layout in room.layouts],
    }
    write_json(Path(folder) / "truth.json", truth)


def object_to_json(number: int, item: LayoutObject) -> dict[str, Any]:
    """Return an object as ``truth.json`` states it; ``number`` is its instance, from 1."""
    return {
        "id": number,
        "class": CLASS_NAMES[item.class_id],
        "name": item.name,
        "center_m": round_metres(item.center_m),
        "size_m": round_metres(item.size_m),
        "yaw_deg": item.yaw_deg,
    }


def _stated_layout(layout: Layout) -> dict[str, Any]:
    return {
        "name": layout.name,
        "floor_z_m": round(layout.floor_z_m, 4),
        "wall_height_m": round(layout.wall_height_m, 4),
        "floor_polygon_m": [round_metres(corner) for corner in layout.floor_polygon_m],
        "openings": [_stated_opening(opening) for opening in layout.openings],
    }


def _stated_opening(opening: Opening) -> dict[str, Any]:
    return {
        "kind": opening.kind,
        "start_m": round_metres(opening.start_m),
        "end_m": round_metres(opening.end_m),
        "sill_m": round(opening.sill_m, 4),
        "head_m": round(opening.head_m, 4),
    }

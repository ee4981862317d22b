"""Virtual scans, which record a generated room as a capture folder with its ground truth.

The capture uses the plain layout. Its world frame is rotated, tilted and shifted, so that the room
must be aligned. ``truth.npz`` and ``truth.json`` contain the ground truth.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.core.output_folders import check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import LayoutObject, View
from world2minecraft.core.whole_reads import changing
from world2minecraft.formats.objects_and_placements import round_metres
from world2minecraft.procgen.room_files import layout_to_json
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
    label_names: bool = False,
    progress: Progress = no_progress,
) -> None:
    """Scan a room or a house virtually, and write the capture and its ground truth.

    Args:
        room: The room or house.
        folder: The output folder, which is created if it does not exist.
        sensor: ``rgbd`` or ``clean`` for a depth camera, or a phone without depth: ``photo``
            (photos with poses), ``photos`` (JPEG photos only) or ``video`` (``capture.mp4``).
        frames: Number of frames of the whole tour. The default is 40 with depth, 100 photos or 240
            video frames.
        seed: Seed of the tour, the world frame and the noise. The same seed gives the same bytes.
        with_labels: Whether to write label images.
        label_error: Share of the label images, in patches, that has a wrong class.
        depth_scale_sigma: Standard deviation of a random factor, with mean 1, that multiplies the
            depth of each frame. It simulates depth networks and badly calibrated sensors.
        coverage: Share of the tour that is recorded, above 0 and at most 1. With 0.6, only the
            first 60 % of the frames are recorded, so that some corners remain unseen.
        width: Width of the images in pixels.
        height: Height of the images in pixels.
        label_names: Whether the label images have the names of objects, with a ``labels.json``,
            instead of the twelve classes.
        progress: Callback after each frame, with the stage ``capture``.

    Raises:
        UnknownNameError: If the sensor is unknown.
        ValueError: If a value is out of range.
        OutputError: If the folder cannot be written.
        MissingExtraError: If ``av``, which is required for videos, is not installed.
    """
    how = ScanSettings(
        sensor,
        frames,
        seed,
        with_labels,
        label_error,
        depth_scale_sigma,
        coverage,
        width,
        height,
        label_names,
    )
    truths: list[FrameTruth] = []
    views = _views(_shots(room, how), truths, how.taken, progress)
    check_writable(Path(folder))
    with changing(Path(folder), "written"):
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
    label_names: bool = False,
) -> Iterator[View]:
    """Yield the views of a virtual scan one at a time.

    The arguments are those of ``scan_room``.
    """
    how = ScanSettings(
        sensor,
        frames,
        seed,
        with_labels,
        label_error,
        depth_scale_sigma,
        coverage,
        width,
        height,
        label_names,
    )
    return (shot.view for shot in _shots(room, how))


def _shots(room: Room, how: ScanSettings) -> Iterator[Shot]:
    return phone_shots(room, how) if how.phone else room_shots(room, how)


def _views(
    shots: Iterator[Shot], truths: list[FrameTruth], total: int, progress: Progress
) -> Iterator[View]:
    """Yield the views and store their ground truth without the images."""
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
    """Write the ground truth of a capture as ``truth.npz`` and ``truth.json``.

    ``truth.npz`` contains ``labels``, ``instance``, ``colour``, ``voxel_m``, ``origin_m`` and
    ``truth_room_to_scan``, and for each frame ``frame_names``, ``camera_to_truth`` (the true camera
    pose in the room, float64 [F, 4, 4]) and ``depth_scale`` (the factor applied to the true depth,
    float64 [F]). ``truth.json`` contains the kind, the seed, the objects and the layouts.

    Raises:
        OutputError: If the folder cannot be written.
    """
    write_npz(
        Path(folder) / "truth.npz",
        {
            "labels": room.labels,
            "instance": room.instance,
            "colour": room.colour,
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
        "layouts": [layout_to_json(layout) for layout in room.layouts],
    }
    write_json(Path(folder) / "truth.json", truth)


def object_to_json(number: int, item: LayoutObject) -> dict[str, Any]:
    """Return the ``truth.json`` entry of an object with an instance number from 1."""
    return {
        "id": number,
        "class": CLASS_NAMES[item.class_id],
        "name": item.name,
        "center_m": round_metres(item.center_m),
        "size_m": round_metres(item.size_m),
        "yaw_deg": item.yaw_deg,
    }

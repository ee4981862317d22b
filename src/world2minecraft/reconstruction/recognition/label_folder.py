"""Label images of a whole capture, written to a folder: one PNG for each colour image.

A file ``labels.json`` beside the images states that their values are NYU40 ids, so that a
reconstruction can read the folder as label images.
"""

import io
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.capture.alignment.image_rotation import RotatedImage
from world2minecraft.capture.alignment.room_frame import ImplausibleRoomError, align
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import ImagePlace, read_header
from world2minecraft.capture.label_images import write_label_facts
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.meshes.mesh_source import MeshSource
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import ValidatedCapture, evenly_spaced, validate
from world2minecraft.capture.view_stream import CaptureViews, read_view, without_colour
from world2minecraft.core.errors import CaptureError, InputError, UsageError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera, View
from world2minecraft.core.vocabulary import NYU40_COUNT
from world2minecraft.reconstruction.recognition.label_images import (
    PixelClassifier,
    class_name,
    draw_overlay,
    segment_view,
)

MESH_SOURCE = "solid"  # First word of the source of meshes and point clouds.
NO_PICTURES = (
    "is a mesh or point cloud, which has no pictures to segment; segment the photos or frames that "
    "it was made from"
)
ALIGNMENT_FRAMES = 24
OVERLAY_SUFFIX, OVERLAY_QUALITY = ".overlay.jpg", 88
READ, SEGMENT = "frames", "segment"  # Stages of the progress.


@dataclass(frozen=True, eq=False)
class LabelledFolder:
    """The label images that were written for a capture.

    Attributes:
        folder: Folder of the images.
        names: Names of the frames with a label image.
        skipped: Names of the frames without, with reasons.
        shares: Share of all pixels by class name, the largest first.
    """

    folder: Path
    names: tuple[str, ...]
    skipped: tuple[tuple[str, str], ...]
    shares: dict[str, float]


def write_label_images(
    path: Path,
    out: Path,
    model: PixelClassifier,
    *,
    network: str = "nyu",
    options: ScanOptions | None = None,
    min_probability: float = 0.0,
    overlay: bool = False,
    progress: Progress = no_progress,
) -> LabelledFolder:
    """Write the label image of each colour image of a capture, with or without poses.

    Args:
        path: Path of the capture.
        out: Folder for ``NAME.png``, uint8 with NYU40 ids and 0 for unknown, at the size of the
            colour image. Files with the same names are replaced.
        model: The network.
        network: Name of the network, for ``labels.json``.
        options: Options of the capture reader.
        min_probability: Pixels whose most likely class is less likely than this are 0.
        overlay: Whether to write ``NAME.overlay.jpg`` as well.
        progress: Callback for the stages ``frames`` and ``segment``.

    Raises:
        UsageError: If the folder is inside the capture.
        InputError: If the weights of the network cannot be read.
        CaptureError: If the capture cannot be read or has no colour images.
        OutputError: If a file cannot be written.
    """
    if out.resolve().is_relative_to(path.resolve()):
        raise UsageError(f"{out} is inside the capture; choose another output folder")
    options = options or ScanOptions()
    if path.is_file() and MeshSource().recognise(path):
        raise CaptureError(path, NO_PICTURES)
    found = find_capture(path, options)
    if found.source.partition(" ")[0] == MESH_SOURCE:
        raise CaptureError(path, NO_PICTURES)
    validated = validate(found, options, step=lambda done, total: progress(READ, done, total))
    frames = [frame for frame in validated.frames if frame.colour_path is not None]
    if not frames:
        raise CaptureError(path, "contains no colour images; depth alone is not segmented")
    stored = {frame.name: frame.colour_path for frame in found.frames}
    scan_to_room = _estimate_room_frame(validated)
    write_label_facts(out, network)
    counts = np.zeros(NYU40_COUNT + 1, np.int64)
    skipped = list(validated.skipped)
    names = []
    for done, frame in enumerate(frames):
        progress(SEGMENT, done, len(frames), frame.name)
        try:
            view = read_picture(frame, validated)
        except InputError as error:
            skipped.append((frame.name, str(error)))
            continue
        up, height_m = _up_and_height(view, frame, scan_to_room, found.world_up)
        ids = segment_view(
            model, view, up=up, camera_height_m=height_m, min_probability=min_probability
        )
        _write_images(out, view, _as_stored(ids, frame, stored[frame.name]), ids, overlay)
        counts += np.bincount(ids.reshape(-1), minlength=len(counts))
        names.append(frame.name)
    progress(SEGMENT, len(frames), len(frames))
    if not names:
        raise CaptureError(path, f"no colour image can be decoded: {skipped[-1][1]}")
    return LabelledFolder(out, tuple(names), tuple(skipped), dict(_named_shares(counts)))


def read_picture(frame: FrameFiles, validated: ValidatedCapture) -> View:
    """Read a frame with colour as a view; without a pose, the pose of the view is the identity.

    If the intrinsics of the colour image are not stated, its depth is left out.

    Raises:
        InputError: If an image of the frame cannot be decoded.
    """
    pose = np.eye(4) if frame.camera_to_world is None else frame.camera_to_world
    frame = replace(frame, camera_to_world=pose, labels_path=None)
    if frame.colour_camera is None and frame.colour_path is not None:
        width, height = read_header(frame.colour_path).size
        focal = float(max(width, height))
        camera = Camera(width, height, focal, focal, width / 2, height / 2)
        frame = replace(frame, colour_camera=camera, depth_path=None)
    if frame.depth_camera is None:
        frame = replace(frame, depth_path=None, trust_path=None)
    return read_view(frame, validated.encoding, validated.capture.full_trust)


def _estimate_room_frame(validated: ValidatedCapture) -> np.ndarray | None:
    """Return the transform from the scan to the level room, or None if it is unknown."""
    capture = validated.capture
    if capture.room is not None:
        return capture.room[0]
    if not validated.complete or capture.scale == "unknown":
        return None
    stream = CaptureViews(validated.frames, validated.encoding, capture.full_trust)
    try:
        chosen = evenly_spaced(without_colour(validated.frames), ALIGNMENT_FRAMES)
        return align(stream.read(chosen), capture.world_up).scan_to_room
    except ImplausibleRoomError:
        return None


def _up_and_height(
    view: View, frame: FrameFiles, scan_to_room: np.ndarray | None, world_up: np.ndarray | None
) -> tuple[np.ndarray | None, float | None]:
    """Return up in the frame of the camera and the height of the camera, as far as known."""
    if frame.camera_to_world is None:
        return None, None
    if scan_to_room is not None:
        pose = scan_to_room @ view.camera_to_scan
        return pose[2, :3], float(pose[2, 3])
    if world_up is not None:
        return view.camera_to_scan[:3, :3].T @ world_up, None
    return None, None


def _as_stored(ids: np.ndarray, frame: FrameFiles, stored: ImagePlace | None) -> np.ndarray:
    """Return a label image in the orientation of the capture's file, which may not be upright."""
    place = frame.colour_path
    if place is stored or not isinstance(place, RotatedImage):
        return ids
    return np.ascontiguousarray(np.rot90(ids, -place.quarter_turns))


def _write_images(
    out: Path, view: View, stored: np.ndarray, upright: np.ndarray, overlay: bool
) -> None:
    write_bytes(out / f"{view.name}.png", _encoded(Image.fromarray(stored), "PNG"))
    if overlay and view.colour is not None:
        drawn = draw_overlay(view.colour, upright)
        data = _encoded(drawn, "JPEG", quality=OVERLAY_QUALITY)
        write_bytes(out / f"{view.name}{OVERLAY_SUFFIX}", data)


def _encoded(image: Image.Image, kind: str, **facts: int) -> bytes:
    stream = io.BytesIO()
    image.save(stream, kind, **facts)
    return stream.getvalue()


def _named_shares(counts: np.ndarray) -> Iterator[tuple[str, float]]:
    """Yield the names of the classes that occur with their shares, the largest first."""
    for number in np.argsort(-counts, kind="stable"):
        if counts[number]:
            yield class_name(int(number)), round(float(counts[number] / counts.sum()), 6)

"""A single photo as a capture, with depth from a network or with an assumed camera position.

With depth, the camera position follows from the floor and the walls. Without depth, the camera is
assumed to be level, at chest height, in the middle of the back of the box that monocular networks
predict, unless the parameters state otherwise.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.options import parse_options
from world2minecraft.capture.photo_stream import photos_of_capture
from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.capture.readers.single_photo import SOURCE
from world2minecraft.capture.stereo import DepthModel, load_depth_model
from world2minecraft.capture.validation import ValidatedCapture
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera, View
from world2minecraft.geometry.undistort import pinhole_camera, undistort_image
from world2minecraft.geometry.view_region import DEFAULT_SHAPE, DEFAULT_VOXEL_M
from world2minecraft.reconstruction.opening.photo_views import DEPTH_UNIT, undistorted
from world2minecraft.reconstruction.parameters import Parameters

DEPTH_WIDE_PX = 640
TRUST = 255  # Full confidence, because there is no other source of depth.
SIGMA_DEPTH, SIGMA_NONE = 0.10, 0.20  # Estimates: network scale, assumed camera height.
MONO = "mono"


def is_one_photo(source: str) -> bool:
    """Return whether the source of a capture is a single photo."""
    return source == SOURCE


def prepare_photo(judged: ValidatedCapture, folder: Path, chosen: Parameters) -> None:
    """Write a single photo as a capture that can be opened.

    Raises:
        CaptureError: If neither a depth network nor a monocular network is requested, or if the
            depth network does not predict metres.
        UsageError: As raised by ``load_depth_model``.
        InputError: As raised by ``load_depth_model``.
    """
    by_network = chosen.predictor.partition(":")[0] == MONO
    if not chosen.depth_model and not by_network:
        raise CaptureError(
            judged.capture.folder,
            "a single photo has no depth; take 30 or more photos of the room, or estimate depth "
            "with a network (--depth hf:ORG/NAME or --predictor mono)",
        )
    stated: dict[str, Any] = {
        "made_from": judged.capture.source,
        "depth_kind": "network",
        "scale": "estimated",
        "skipped": [[*row] for row in judged.skipped],
    }
    if chosen.depth_model:
        model = load_depth_model(chosen.depth_model)
        if model.kind != "metric":
            raise CaptureError(
                judged.capture.folder,
                f"a single photo requires depth in metres, which {model.name} does not predict; "
                "use another model (--depth "
                "hf:depth-anything/Depth-Anything-V2-Metric-Indoor-Small-hf)",
            )
        views = _with_depth(judged, model)
        stated |= {"scale_sigma": SIGMA_DEPTH, "notes": [*judged.notes, _told_depth(model)]}
    else:
        options = parse_options(chosen.capture)
        pose, size_m = place_photo(options.eye_height_m, options.pitch_deg)
        views = _bare(judged, pose)
        note = (
            f"the photo has no depth: its camera is assumed to be {options.eye_height_m:g} m above "
            f"the floor and to look {_way(options.pitch_deg)}; change this with "
            "capture.eye_height_m and capture.pitch_deg"
        )
        room = {"scan_to_room": np.eye(4).tolist(), "size_m": size_m.tolist()}
        stated |= {"scale_sigma": SIGMA_NONE, "notes": [*judged.notes, note], "room": room}
    for name in ("depth", "trust"):  # Of the same photo with other networks.
        for path in (folder / name).glob("*"):
            path.unlink()
    write_plain(folder, views, depth_unit=DEPTH_UNIT, stated=stated, jpeg=True)


def place_photo(eye_height_m: float, pitch_deg: float) -> tuple[np.ndarray, np.ndarray]:
    """Return ``camera_to_room`` of a photo without depth, and the size of the assumed room."""
    size_m = np.array(DEFAULT_SHAPE) * DEFAULT_VOXEL_M
    eye = np.array([size_m[0] / 2, 0.0, eye_height_m])
    pitch = np.radians(pitch_deg)
    ahead = np.array([0.0, np.cos(pitch), np.sin(pitch)])
    return look_at(eye, eye + ahead), size_m


def _way(pitch_deg: float) -> str:
    if pitch_deg == 0:
        return "straight ahead"
    return f"{abs(pitch_deg):g} degrees {'up' if pitch_deg > 0 else 'down'}"


def _told_depth(model: DepthModel) -> str:
    return f"{model.name} estimated the depth and the size of the room from a single photo"


def _straight(judged: ValidatedCapture) -> tuple[str, np.ndarray, Camera]:
    """Return the photo's name, its undistorted image, and the camera of that image."""
    photo = next(iter(photos_of_capture(judged)), None)
    if photo is None or photo.camera is None:
        raise CaptureError(judged.capture.folder, "cannot decode the photo; export it as JPEG")
    return (photo.name, *undistorted(photo.colour, photo.camera))


def _with_depth(judged: ValidatedCapture, model: DepthModel) -> Iterator[View]:
    name, colour, camera = _straight(judged)
    small = pinhole_camera(camera, min(camera.width_px, DEPTH_WIDE_PX))
    depth_m = model.predict(undistort_image(colour, camera, small), small)
    depth_m = np.where(np.isfinite(depth_m) & (depth_m > 0), depth_m, 0).astype(np.float32)
    trust = np.where(depth_m > 0, TRUST, 0).astype(np.uint8)
    yield View(name, np.eye(4), colour, camera, depth_m, small, trust=trust)


def _bare(judged: ValidatedCapture, pose: np.ndarray) -> Iterator[View]:
    name, colour, camera = _straight(judged)
    yield View(name, pose, colour, camera)

"""The metric scale of a capture: from measured depth, a known length, or typical rooms."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.alignment.room_frame import ImplausibleRoomError
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.scale import (
    KnownDistance,
    collect_unscaled,
    estimate_scale,
    parse_known_length,
)
from world2minecraft.capture.validation import ValidatedCapture, evenly_spaced, validate_capture
from world2minecraft.capture.view_stream import CaptureViews, read_view, without_colour
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError, InputError, UnknownNameError, UsageError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import SparseScene, View
from world2minecraft.geometry.unprojection import project
from world2minecraft.reconstruction.opening.photo_views import posed_frame
from world2minecraft.reconstruction.parameters import Parameters

MIN_RATIOS = 50
LOOKED_AT = 24  # Number of frames whose depth is compared with the points.
HANDY_DEPTH = 2.5
FRAME_SIGMA = 0.02  # Scale error of the depth of a sensor.


def scale_by_depth(judged: ValidatedCapture, scene: SparseScene) -> tuple[SparseScene, float]:
    """Scale a scene to the metres of measured depth, and return the relative standard deviation.

    Raises:
        CaptureError: If too few points have measured depth.
    """
    frames = {frame.name: frame for frame in judged.frames}
    indices = [i for i, name in enumerate(scene.names) if frames[name].depth_path is not None]
    ratios, middles = [], []
    for index in evenly_spaced(indices, LOOKED_AT):
        frame = posed_frame(frames[scene.names[index]], scene, index)
        try:
            view = read_view(frame, judged.encoding, judged.capture.full_trust)
        except InputError:
            continue
        found = depth_ratios(view, scene.points_m[scene.track_point[scene.track_frame == index]])
        ratios.append(found)
        middles += [float(np.median(found))] * (len(found) > 0)
    every = np.concatenate(ratios) if ratios else np.zeros(0)
    if len(every) < MIN_RATIOS:
        raise CaptureError(
            judged.capture.folder,
            "too few image features have valid depth to compute the scale; check that each depth "
            "map belongs to its colour image and has the same proportions",
        )
    scale = float(np.median(every))
    spread = float(np.median(np.abs(np.array(middles) / scale - 1)))
    sigma = float(np.hypot(FRAME_SIGMA, 1.5 * spread / np.sqrt(len(middles))))
    return scaled(scene, scale), round(sigma, 4)


def depth_ratios(view: View, points_m: np.ndarray) -> np.ndarray:
    """Return the ratios of measured to expected depth, [n], at the points with valid depth."""
    if view.depth_m is None or view.depth_camera is None:
        return np.zeros(0)
    at = apply(invert_rigid(view.depth_camera_to_scan), points_m.astype(np.float64))
    at = at[at[:, 2] > 1e-6]
    pixels = np.floor(project(at, view.depth_camera)).astype(np.int64)
    size = (view.depth_camera.width_px, view.depth_camera.height_px)
    inside = ((pixels >= 0) & (pixels < size)).all(axis=1)
    depth = view.depth_m[pixels[inside, 1], pixels[inside, 0]]
    return (depth / at[inside, 2])[depth > 0].astype(np.float64)


def scaled(scene: SparseScene, scale: float) -> SparseScene:
    """Multiply all lengths of a scene by a factor."""
    poses = scene.camera_to_scan.copy()
    poses[:, :3, 3] *= scale
    points = (scene.points_m.astype(np.float64) * scale).astype(np.float32)
    return replace(scene, camera_to_scan=poses, points_m=points)


def scale_capture(
    folder: Path, chosen: Parameters, size_of: Callable[[str], tuple[int, int]]
) -> None:
    """Update the scale of a capture whose scale is unknown or now better known.

    Only ``capture.json`` is changed: the camera positions, the metres per depth unit, and the
    information on the scale.

    Args:
        folder: Folder of the capture.
        chosen: Parameters with the known lengths.
        size_of: Function that returns the size of an original photo, in whose pixels points are
            given.

    Raises:
        UsageError: If a known length cannot be measured in this capture.
    """
    judged = validate_capture(folder, ScanOptions())
    knowns = [] if chosen.known is None else [parse_known_length(*chosen.known)]
    if judged.capture.scale == "metric" and not knowns and chosen.known_points is None:
        return
    stream = CaptureViews(judged.frames, judged.encoding, judged.capture.full_trust)
    if chosen.known_points is not None:
        knowns.append(clicked(*chosen.known_points, judged, size_of).known(stream.depth_views()))
    views = list(stream.read(evenly_spaced(without_colour(judged.frames), LOOKED_AT)))
    try:
        found = estimate_scale(collect_unscaled(views), knowns)
    except ImplausibleRoomError as error:
        raise CaptureError(judged.capture.folder, str(error)) from error
    stated = read_json(folder / "capture.json")
    for holder in (stated, *stated["frames"]):
        for key in ("camera_to_world", "depth_to_colour"):
            if key in holder:
                holder[key] = _stretched(holder[key], found.scale)
    stated["depth_unit"] = repr(float(stated["depth_unit"]) * found.scale)
    stated["scale"] = "metric" if knowns else "estimated"
    stated["scale_sigma"] = round(found.sigma, 4)
    stated["notes"] = [*stated["notes"], *found.notes]
    write_json(folder / "capture.json", stated)


def _stretched(matrix: list[list[float]], scale: float) -> list[list[float]]:
    """Return a 4x4 transform with its translation multiplied by the scale."""
    stretched = np.array(matrix)
    stretched[:3, 3] *= scale
    return stretched.tolist()


def clicked(
    first: str,
    second: str,
    length_m: float,
    judged: ValidatedCapture,
    size_of: Callable[[str], tuple[int, int]],
) -> KnownDistance:
    """Return the known distance between two points, each given as ``PHOTO:x,y``.

    Raises:
        UsageError: If a point is malformed or its photo is unknown.
    """
    cameras = {frame.name: frame.colour_camera for frame in judged.frames}

    def found(text: str) -> tuple[str, tuple[float, float]]:
        """Return a photo's name and a clicked point in the pixels of its camera."""
        image, (x, y) = _clicked(text)
        name = image if image in cameras else Path(image).stem
        camera = cameras.get(name)
        if camera is None:
            raise UnknownNameError("photo", name, cameras)
        wide, high = size_of(name)
        return name, (x * camera.width_px / wide, y * camera.height_px / high)

    (image_a, point_a), (image_b, point_b) = found(first), found(second)
    return KnownDistance(image_a, point_a, image_b, point_b, length_m)


def _clicked(text: str) -> tuple[str, tuple[float, float]]:
    image, _, pixel = text.rpartition(":")
    across, _, down = pixel.partition(",")
    try:
        return image, (float(across), float(down))
    except ValueError:
        raise UsageError(
            f"--known-points must be PHOTO:x,y, such as IMG_0007:812,344, got {text!r}"
        ) from None


def normalise_scale(scene: SparseScene) -> SparseScene:
    """Scale a scene without metric unit so that its median depth is 2.5."""
    poses = scene.camera_to_scan[scene.track_frame]
    points = scene.points_m[scene.track_point].astype(np.float64)
    depth = np.einsum("ta,ta->t", points - poses[:, :3, 3], poses[:, :3, 2])
    middle = float(np.median(depth[depth > 0])) if (depth > 0).any() else 1.0
    return scaled(scene, HANDY_DEPTH / middle)

"""Open any capture as an aligned scan, computing missing poses, depth and scale first.

Computed data is stored in ``OUT/capture`` and reused the next time.
"""

from collections.abc import Iterator
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import read_header
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.photo_stream import CapturePhotos, photos_of_capture
from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.capture.sfm import check_poses, find_poses
from world2minecraft.capture.source_types import Capture
from world2minecraft.capture.stereo import compute_depth_maps, load_depth_model, network_maps
from world2minecraft.capture.validation import ValidatedCapture, validate
from world2minecraft.core.errors import (
    CaptureError,
    DamagedFileError,
    InputError,
    UnknownNameError,
    UsageError,
)
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.output_folders import check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Scan, SparseScene, View
from world2minecraft.reconstruction.opening.metric_scale import (
    normalise_scale,
    scale_by_depth,
    scale_capture,
)
from world2minecraft.reconstruction.opening.one_photo import is_one_photo, prepare_photo
from world2minecraft.reconstruction.opening.photo_views import DEPTH_UNIT, depth_views, stereo_views
from world2minecraft.reconstruction.opening.predicted_room import prepare_predicted
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.run_folder import hash_capture

FOLDER = "capture"
STAMP = "prepared.json"
UNNAMED_CAPTURE = "photos"  # Name of the capture in steps that know no path.
MIN_PHOTOS = 3
Told = dict[str, Any]

# Names of folders that say nothing of their scene.
GENERIC_NAMES = ("capture", "frames", "scan", "data", "input")


def prepare_capture(
    capture: Path, out: Path, chosen: Parameters, progress: Progress = no_progress
) -> Path:
    """Return the folder of a capture with poses and depth.

    Args:
        capture: Capture given by the user.
        out: Folder of the run. Computed data is written to ``out / FOLDER`` and reused if it was
            made from the same images with the same parameters.
        chosen: Parameters of the reconstruction.
        progress: Callback for progress, called with the stages ``photos``, ``poses`` and
            ``stereo``.

    Raises:
        CaptureError: If the images cannot be used; the message states a remedy.
        MissingExtraError: If pycolmap is not installed.
        OutputError: If ``out`` cannot be written.
        UsageError: If ``out`` would be written into the images of the capture.
    """
    options = parse_options(chosen.capture)
    found = find_capture(capture, options)
    if has_poses_and_depth(found):
        if chosen.known is not None or chosen.known_points is not None:
            raise UsageError(
                f"{capture} contains poses and depth, so its scale is fixed; omit the known "
                "lengths (--known, --known-points)"
            )
        return capture
    if capture.resolve() == (out / FOLDER).resolve():
        raise UsageError(
            f"{capture} is the folder for intermediate results of {out}; choose another output "
            "folder"
        )
    fresh = not out.exists()
    check_writable(out)
    folder, stamp = out / FOLDER, stamp_of(capture, chosen, out)
    if is_one_photo(found.source):
        stamp["predictor"] = chosen.predictor.partition(":")[0]
    if chosen.predictions.path:
        stamp["predictions"] = hash_capture(Path(chosen.predictions.path))
        stamp["parameters"]["predictions"] = chosen.as_json()["predictions"]
    if not _made_before(folder, stamp):
        (folder / STAMP).unlink(missing_ok=True)
        try:
            _prepare(found, folder, chosen, progress)
        except CaptureError as error:
            if fresh and not any(out.iterdir()):
                out.rmdir()
            if error.path != UNNAMED_CAPTURE:
                raise
            posed = any(frame.camera_to_world is not None for frame in found.frames)
            lead = "" if posed else "contains no poses, and its images do not yield any: "
            raise CaptureError(found.folder, lead + error.reason) from error
        write_json(folder / STAMP, stamp)
    return folder


def has_poses_and_depth(found: Capture) -> bool:
    """Return whether a capture has frames with poses and frames with depth."""
    return any(frame.depth_path is not None for frame in found.frames) and any(
        frame.camera_to_world is not None for frame in found.frames
    )


def stamp_of(capture: Path, chosen: Parameters, out: Path) -> dict[str, Any]:
    """Return all inputs that determine the computed capture in ``out``."""
    parameters = chosen.as_json()
    keys = ("capture", "posing", "stereo", "known", "known_points", "depth_model")
    return {
        "capture": hash_capture(capture, without=out),
        "parameters": {key: parameters[key] for key in keys},
        "versions": {name: _version(name) for name in ("numpy", "numba", "pycolmap", "pillow")},
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except ImportError:
        return "none"


def _made_before(folder: Path, stamp: dict[str, Any]) -> bool:
    try:
        return (folder / "capture.json").is_file() and read_json(folder / STAMP) == stamp
    except (InputError, DamagedFileError):
        return False


def _prepare(found: Capture, folder: Path, chosen: Parameters, progress: Progress) -> None:
    judged = validate(
        found,
        parse_options(chosen.capture),
        None,
        lambda done, total: progress("photos", done, total),
    )
    alone = not judged.has_depth and not chosen.depth_model
    if chosen.predictions.path and alone and (judged.posed or is_one_photo(found.source)):
        return prepare_predicted(judged, folder, chosen)
    if is_one_photo(found.source):
        return prepare_photo(judged, folder, chosen)
    photos = photos_of_capture(judged)
    if len(photos) < MIN_PHOTOS:
        raise CaptureError(
            found.folder,
            f"contains {len(photos)} usable photos and no depth; at least {MIN_PHOTOS} overlapping "
            "photos are required, 40 or more are recommended for a room",
        )
    finder = check_poses if judged.posed else find_poses
    scene = finder(photos, chosen.posing, progress)
    scale = found.scale if judged.posed else "unknown"
    if scale == "unknown":
        scene = normalise_scale(scene)
    if judged.has_depth:
        views, told = _with_own_depth(judged, photos, scene)
        kind = found.depth_kind
    else:
        views, told = _with_stereo(photos, scene, chosen, progress), {}
        kind = "network" if chosen.stereo.network_alone else "stereo"
    up = found.world_up
    stated = {
        "made_from": found.source,
        "depth_kind": kind,
        "world_up": up.tolist() if up is not None and judged.posed else None,
        "scale": scale,
        "source_to_scan": found.source_to_scan.tolist(),
        "notes": [*judged.notes, *scene.notes],
        "skipped": [[*row] for row in (*judged.skipped, *photos.damaged.items(), *scene.left_out)],
    } | told
    extra = {"posing": dict(scene.facts)}
    write_plain(folder, views, depth_unit=DEPTH_UNIT, extra=extra, stated=stated, jpeg=True)
    scale_capture(folder, chosen, lambda name: _size_of(judged, name))


def _size_of(judged: ValidatedCapture, name: str) -> tuple[int, int]:
    """Return the size in pixels of an original photo."""
    places = {frame.name: frame.colour_path for frame in judged.frames}
    place = places.get(name)
    if place is None:
        raise UnknownNameError("photo", name, places)
    return read_header(place).size


def _with_own_depth(
    judged: ValidatedCapture, photos: CapturePhotos, scene: SparseScene
) -> tuple[Iterator[View], Told]:
    """Return the views of a capture with measured depth and computed poses."""
    scaled, sigma = scale_by_depth(judged, scene)
    told = {"scale": "metric", "scale_sigma": sigma}
    return depth_views(judged, photos, scaled), told


def _with_stereo(
    photos: CapturePhotos, scene: SparseScene, chosen: Parameters, progress: Progress
) -> Iterator[View]:
    guide = load_depth_model(chosen.depth_model) if chosen.depth_model else None
    if not chosen.stereo.network_alone:
        maps = compute_depth_maps(photos, scene, chosen.stereo, progress, guide)
    elif guide is None:
        raise UsageError("stereo.network_alone=true requires a depth model (--depth hf:ORG/NAME)")
    else:
        maps = network_maps(photos, scene, guide, chosen.stereo, progress)
    return stereo_views(photos, scene, maps)


def prepare_and_open(
    capture: Path,
    out: Path,
    chosen: Parameters,
    labels: Path | None = None,
    progress: Progress = no_progress,
    *,
    registered: bool = False,
) -> Scan:
    """Open a capture, computing missing poses and depth in ``out`` first.

    If it was ``registered`` in ``out`` before, the recorded alignment is used.

    Raises the exceptions of ``prepare_capture`` and ``open_scan``.
    """
    complete = prepare_capture(capture, out, chosen, progress)
    options = chosen.capture if complete == capture else {}  # Else they were heeded already.
    recorded = out / "scan.json"
    scan = open_scan(
        complete,
        voxel_m=chosen.voxel_m,
        labels=labels,
        progress=progress,
        options=options,
        recorded=recorded if registered and recorded.is_file() else None,
    )
    return replace(scan, name=scene_name(capture))


def scene_name(capture: Path) -> str:
    """Return the scene name of a capture: its folder name, or an empty string if it is generic."""
    capture = capture.resolve()
    name = (capture.name if capture.is_dir() else capture.stem).replace("_", " ")
    return name if name.isprintable() and name not in GENERIC_NAMES else ""

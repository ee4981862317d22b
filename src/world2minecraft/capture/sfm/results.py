"""Results of structure from motion: a ``SparseScene``, and reasons for unplaced photos."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from world2minecraft.capture.sfm.bundle_adjustment import SparseModel
from world2minecraft.capture.sfm.features import Features
from world2minecraft.capture.sfm.matching import MatchGraph
from world2minecraft.capture.sfm.pycolmap_access import PHOTOS
from world2minecraft.capture.sfm.similarity_transform import Similarity
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera, SparseScene

MIN_FEATURES = 60  # A photo with fewer shows a bare wall, or is out of focus.
CHANCE_MATCHES = 6  # Number of features that match by chance.
BLURRED_SHARE = 0.5  # Share of the median sharpness.
CAPTURE_ADVICE = (
    "move sideways around the room so that each photo overlaps the next by more than half"
)
DIGITS = 9  # Decimals kept of sums: a nanometre.


def explain_left_out(
    photos: list[Features], placed: Iterable[int], links: MatchGraph
) -> list[tuple[str, str]]:
    """Return the name and the reason for each photo without an estimated pose."""
    inside = set(placed)
    median_sharpness = float(np.median([photo.sharpness for photo in photos]))
    return [
        (photo.name, _reason(i, photos, inside, links, median_sharpness))
        for i, photo in enumerate(photos)
        if i not in inside
    ]


def _reason(
    i: int, photos: list[Features], inside: set[int], links: MatchGraph, median_sharpness: float
) -> str:
    photo = photos[i]
    blurred = photo.sharpness < BLURRED_SHARE * median_sharpness
    if len(photo.pixels) < MIN_FEATURES:
        return f"shows only {len(photo.pixels)} details ({'blurred' if blurred else 'bare'})"
    if blurred:
        return "is blurred; hold the camera still and use more light"
    partners = links.of(i)
    near = _nearest(i, inside, links)
    advice = (
        f"take more photos between {photo.name} and {photos[near].name}"
        if inside
        else CAPTURE_ADVICE
    )
    if not partners:
        return f"has no details in common with the other photos; {advice}"
    if not inside & set(partners):
        return f"has no details in common with the photos that have poses; {advice}"
    return f"has too few details in common with the photos that have poses; {advice}"


def _nearest(i: int, inside: set[int], links: MatchGraph) -> int:
    """Return the photo with a pose that is most similar to a given photo."""
    if not inside:
        return i
    shared = np.maximum(links.alike[i] - CHANCE_MATCHES, 0)
    return min(inside, key=lambda j: (-shared[j], abs(i - j), j))


def check_enough(photos: list[Features], least: int) -> None:
    """Check that there are enough photos with details.

    Raises:
        CaptureError: If there are too few photos, or too few photos with details.
    """
    if len(photos) < least:
        count = "there are no photos" if not photos else f"there are only {len(photos)} photos"
        raise CaptureError(PHOTOS, f"{count}; take 20 to 60 photos of the room: {CAPTURE_ADVICE}")
    bare = sum(len(photo.pixels) < MIN_FEATURES for photo in photos)
    if len(photos) - bare < least:
        raise CaptureError(
            PHOTOS,
            f"{bare} of {len(photos)} photos show too few details (blank, blurred or dark); "
            "switch on the lights, and step back to show furniture and corners",
        )


def too_few_error(placed: int, given: int) -> CaptureError:
    """Return the error for captures in which only a few photos could be placed."""
    return CaptureError(
        PHOTOS,
        f"poses were found for only {placed} of {given} photos, which is not reliable; "
        f"{CAPTURE_ADVICE}, and step back to show furniture and corners",
    )


def no_model_error(
    photos: list[Features], links: MatchGraph, cameras: dict[int, Camera]
) -> CaptureError:
    """Return the error for photos from which no model could be computed."""
    linked = {i for pair in links.matches for i in pair}
    if len(linked) < 3:
        reason = f"no three of the {len(photos)} photos show the same objects; {CAPTURE_ADVICE}"
    elif links.turned(cameras) > 0.5:
        reason = (
            "the camera only rotated, which gives no depth; move 20 to 40 cm sideways "
            "between photos"
        )
    elif links.flat() > 0.5:
        reason = (
            "the photos mostly show a single flat surface (floor, wall or poster), which is not "
            "enough to estimate poses; hold the camera level to show furniture and corners"
        )
    else:
        reason = (
            f"{len(linked)} of the {len(photos)} photos have common details, but too few to "
            f"estimate poses; {CAPTURE_ADVICE}"
        )
    return CaptureError(PHOTOS, reason)


def panoramas_error(count: int) -> CaptureError:
    """Return the error for panoramas from which no model could be computed."""
    return CaptureError(
        PHOTOS,
        f"the positions of {count} panoramas cannot be estimated; take panoramas 0.5 "
        "to 1.5 m apart, 4 or more in a room, with lights on and nothing moving, or state their "
        "poses in a transforms.json with the camera_model EQUIRECTANGULAR",
    )


def to_sparse_scene(
    photos: list[Features],
    found: SparseModel,
    change: Similarity | None = None,
    unchanged: dict[int, tuple[Camera, np.ndarray]] | None = None,
    **details: Any,
) -> SparseScene:
    """Convert a model to a SparseScene.

    Args:
        photos: All photos in order.
        found: Poses and points.
        change: Similarity to the frame of the result, or None.
        unchanged: Cameras and poses by photo number that are returned exactly, without rounding.
        details: Further fields of the scene: ``left_out``, ``notes`` and ``facts``.
    """
    unchanged = unchanged or {}
    order = sorted({*found.poses, *unchanged})
    number = np.full(len(photos), -1)
    number[order] = range(len(order))
    poses = np.array([found.poses.get(i, np.eye(4)) for i in order])
    points = found.points
    if change is not None:
        poses, points = change.poses(poses), change.points(points)
    poses = np.round(poses, DIGITS) + 0.0  # No minus zero.
    for row, i in enumerate(order):
        if i in unchanged:
            poses[row] = unchanged[i][1]
    pixels = _pixels(photos, found)
    facts = {
        "photos_given": len(photos),
        "photos_placed": len(order),
        "error_px": round(found.median_px, 4) if len(found.error_px) else None,
        "points": len(points),
        "triangulation_deg": round(median_triangulation_angle_deg(found), 3),
        **details.pop("facts", {}),
    }
    return SparseScene(
        tuple(photos[i].name for i in order),
        tuple(unchanged[i][0] if i in unchanged else found.cameras[i] for i in order),
        poses,
        np.round(points, DIGITS).astype(np.float32),
        _colours(photos, found),
        number[found.track_photo].astype(np.int32),
        found.track_point.astype(np.int32),
        pixels.astype(np.float32),
        round(float(found.error_px.mean()), 6) if len(found.error_px) else 0.0,
        facts=facts,
        **details,
    )


def median_depth(found: SparseModel) -> float:
    """Return the median depth of the points that the photos observe."""
    return float(np.median(np.concatenate([_depths(found, i) for i in sorted(found.poses)])))


def depths_seen(found: SparseModel, photos: list[int]) -> np.ndarray:
    """Return the median depth of the points that each photo observes, float64 [N].

    Photos without points get the median of all.
    """
    usual = median_depth(found)
    each = [_depths(found, i) for i in photos]
    return np.array([float(np.median(depths)) if len(depths) else usual for depths in each])


def _depths(found: SparseModel, photo: int) -> np.ndarray:
    pose = found.poses[photo]
    seen = found.points[found.track_point[found.track_photo == photo]]
    return (seen - pose[:3, 3]) @ pose[:3, 2]


def median_triangulation_angle_deg(found: SparseModel) -> float:
    """Return the median over points of the widest angle between the first ray and another ray."""
    if len(found.points) == 0:
        return 0.0
    centres = np.zeros((max(found.poses) + 1, 3))
    for i, pose in found.poses.items():
        centres[i] = pose[:3, 3]
    rays = centres[found.track_photo] - found.points[found.track_point]
    rays /= np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-12)
    starts = np.searchsorted(found.track_point, np.arange(len(found.points)))
    cosines = (rays * rays[starts[found.track_point]]).sum(axis=1)
    widest = np.minimum.reduceat(cosines, starts)
    return float(np.degrees(np.median(np.arccos(np.clip(widest, -1, 1)))))


def _pixels(photos: list[Features], found: SparseModel) -> np.ndarray:
    pixels = np.zeros((len(found.track_photo), 2))
    for i in found.poses:
        mine = found.track_photo == i
        pixels[mine] = photos[i].pixels[found.track_feature[mine]]
    return pixels


def _colours(photos: list[Features], found: SparseModel) -> np.ndarray:
    """Return the mean colour of each point, uint8 [P, 3]."""
    count = len(found.points)
    total = np.zeros((count, 3), np.int64)
    for i in found.poses:
        mine = found.track_photo == i
        colours = photos[i].colours[found.track_feature[mine]]
        np.add.at(total, found.track_point[mine], colours.astype(np.int64))
    seen = np.maximum(np.bincount(found.track_point, minlength=count), 1)
    return ((2 * total + seen[:, None]) // (2 * seen[:, None])).astype(np.uint8)

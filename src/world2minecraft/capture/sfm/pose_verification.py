"""Verification of stated poses and cameras, with refinement if they are inaccurate."""

from dataclasses import dataclass, field, replace

import numpy as np

from world2minecraft.capture.sfm.bundle_adjustment import SparseModel, triangulate_and_adjust
from world2minecraft.capture.sfm.camera_groups import (
    CameraGroup,
    camera_by_photo,
    group_cameras,
    normalise_pixels,
    sensor_of,
    to_colmap,
)
from world2minecraft.capture.sfm.features import Features, extract_features, pixel_unit
from world2minecraft.capture.sfm.incremental_mapping import (
    focal_facts,
    map_from_scratch,
    refine_poses,
    replace_cameras,
)
from world2minecraft.capture.sfm.matching import MatchGraph, match_photos
from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.progress import ProgressSteps
from world2minecraft.capture.sfm.pycolmap_access import PHOTOS, pycolmap_session
from world2minecraft.capture.sfm.results import (
    check_enough,
    depths_seen,
    explain_left_out,
    median_depth,
    to_sparse_scene,
)
from world2minecraft.capture.sfm.similarity_transform import Similarity, align_views
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera, SparseScene
from world2minecraft.core.types.photos import PhotoStream

MIN_INLIERS = 30  # Points that support a recovered pose; COLMAP's default minimum.
MIN_POINTS = 50  # Fewer points do not verify poses.
MIN_POINTS_PER_PHOTO = 80  # With this mean, poses may leave the stated ones.
NEARLY_RIGHT_PX = 4.0  # Or with a larger error. Bare generated rooms: 20 points and 2 px.
KNOWN = ("stated", "exact")  # Cameras that are correct if the poses are.
MAX_REFINED_ERROR_PX = 1.5  # Refined poses with a larger error have diverged.


def epipolar_errors_px(
    photos: list[Features],
    links: MatchGraph,
    poses: dict[int, np.ndarray],
    cameras: dict[int, Camera],
) -> dict[int, float]:
    """Return the median epipolar error of each photo's matches for the given poses, in pixels.

    The Sampson error is used, which requires neither points nor a threshold. Photos without links
    are not part of the result.
    """
    rays = {i: normalise_pixels(cameras[i], photos[i].pixels) for i in poses}
    off: dict[int, list[np.ndarray]] = {}
    for (i, j), both in links.matches.items():
        if i in poses and j in poses:
            first_to_second = np.linalg.inv(poses[j]) @ poses[i]
            focal = (cameras[i].fx_px * cameras[j].fx_px) ** 0.5
            each = focal * sampson_errors(rays[i][both[:, 0]], rays[j][both[:, 1]], first_to_second)
            off.setdefault(i, []).append(each)
            off.setdefault(j, []).append(each)
    return {i: float(np.median(np.concatenate(each))) for i, each in sorted(off.items())}


def sampson_errors(
    first: np.ndarray, second: np.ndarray, first_to_second: np.ndarray
) -> np.ndarray:
    """Return the Sampson errors of matched rays, given as [K, 2] on the plane z = 1, as [K]."""
    x, y, z = first_to_second[:3, 3]
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    essential = cross @ first_to_second[:3, :3]
    a = np.concatenate([first, np.ones((len(first), 1))], axis=1)
    b = np.concatenate([second, np.ones((len(second), 1))], axis=1)
    lines, back = a @ essential.T, b @ essential
    steep = (lines[:, :2] ** 2).sum(axis=1) + (back[:, :2] ** 2).sum(axis=1)
    return np.abs((b * lines).sum(axis=1)) / np.sqrt(np.maximum(steep, 1e-24))


def find_outliers(off_px: dict[int, float], unit: float, parameters: SfmParameters) -> set[int]:
    """Return the photos whose stated poses are wrong rather than inaccurate."""
    if len(off_px) < 4:
        return set()  # Of three, nobody can say which one is wrong.
    usual = float(np.median(list(off_px.values())))
    limit = max(unit * parameters.outlier_px, parameters.outlier_times * usual)
    return {i for i, off in off_px.items() if off > limit}


def register_photo(
    photo: int,
    photos: list[Features],
    links: MatchGraph,
    found: SparseModel,
    camera: Camera,
    parameters: SfmParameters,
) -> np.ndarray | None:
    """Estimate the pose of a photo from the points that linked photos observe.

    Returns:
        The camera-to-world matrix, or None if there are too few points.
    """
    point_of = {
        (int(i), int(f)): int(p)
        for p, i, f in zip(found.track_point, found.track_photo, found.track_feature, strict=True)
    }
    pairs: set[tuple[int, int]] = set()
    for (i, j), both in links.matches.items():
        if photo in (i, j):
            mine, other = (0, 1) if photo == i else (1, 0)
            for row in both.tolist():
                point = point_of.get((j if photo == i else i, row[other]))
                if point is not None:
                    pairs.add((row[mine], point))
    if len(pairs) < MIN_INLIERS:
        return None
    rows = np.array(sorted(pairs))
    with pycolmap_session() as pycolmap:
        options = pycolmap.AbsolutePoseEstimationOptions()
        options.ransac.random_seed = parameters.seed
        options.ransac.max_error = 4.0 * pixel_unit(photos)
        answer = pycolmap.estimate_and_refine_absolute_pose(
            photos[photo].pixels[rows[:, 0]],
            found.points[rows[:, 1]],
            to_colmap(pycolmap, camera, 1, simple=False),
            options,
        )
    if answer is None or answer["num_inliers"] < MIN_INLIERS:
        return None
    there = np.eye(4)
    there[:3] = answer["cam_from_world"].matrix()
    return np.linalg.inv(there)


@dataclass(frozen=True, eq=False)
class StatedPoses:
    """Stated poses and matches before refinement."""

    photos: list[Features]
    groups: list[CameraGroup]
    links: MatchGraph
    poses: dict[int, np.ndarray]
    wrong: set[int]
    parameters: SfmParameters
    notes: list[str] = field(default_factory=list)


def check_poses(
    photos: PhotoStream,
    parameters: SfmParameters | None = None,
    progress: Progress = no_progress,
) -> SparseScene:
    """Verify the stated poses of photos, and refine them if necessary.

    Poses and intrinsics with errors of at most ``good_px`` are returned unchanged. Others are
    refined together and transformed back to the stated frame by a similarity. Single wrong poses
    are estimated again from their neighbours, or removed.

    Raises:
        CaptureError: If the photos have too few common details to measure their poses.
        MissingExtraError: If pycolmap is not installed.
    """
    chosen = parameters or SfmParameters()
    count = len(photos)
    steps = ProgressSteps(
        progress, {"features": count, "alike": 9, "matches": 9, "places": count + 1}
    )
    features = extract_features(photos, chosen, steps)
    check_enough(features, 2)
    groups = group_cameras(features)
    links = match_photos(features, groups, chosen, steps)
    poses = {i: p for i, one in enumerate(features) if (p := one.camera_to_scan) is not None}
    shared = camera_by_photo(groups)
    cameras = {i: one.camera or shared[i] for i, one in enumerate(features)}
    unit = pixel_unit(features)
    off_px = epipolar_errors_px(features, links, poses, cameras)
    wrong = find_outliers(off_px, unit, chosen)
    stated = StatedPoses(features, groups, links, poses, wrong, chosen)
    measured = _triangulate_stated(stated, cameras)
    if len(measured.points) < MIN_POINTS and len(links.matches) < 2:
        raise CaptureError(
            PHOTOS,
            "the photos have too few common details to check their poses "
            f"({len(measured.points)} points); take overlapping photos in good light",
        )
    before = _error_px(measured, off_px, wrong)
    good = before <= unit * chosen.good_px and all(group.known in KNOWN for group in groups)
    scene = (
        _keep_stated(stated, measured, before, cameras)
        if good
        else _refine_stated(stated, measured, before, steps)
    )
    steps.end()
    return scene


def _triangulate_stated(stated: StatedPoses, cameras: dict[int, Camera]) -> SparseModel:
    """Return the points triangulated with unchanged stated poses and wide thresholds."""
    poses = {i: pose for i, pose in stated.poses.items() if i not in stated.wrong}
    return triangulate_and_adjust(
        stated.photos,
        stated.links,
        poses,
        _exact_groups(stated.photos, cameras, poses),
        stated.parameters.wide_px,
        stated.parameters,
        free=False,
    )


def _error_px(measured: SparseModel, off_px: dict[int, float], wrong: set[int]) -> float:
    """Return the error of the stated poses in pixels.

    Points exist only if matches agree within a threshold, so the reprojection error underestimates
    large pose errors. The epipolar error has no threshold.
    """
    usual = [off for i, off in off_px.items() if i not in wrong]
    return max(measured.median_px, float(np.median(usual)) if usual else 0.0)


def _exact_groups(
    photos: list[Features], cameras: dict[int, Camera], poses: dict
) -> list[CameraGroup]:
    """Return a camera group for each distinct stated camera and sensor of a rig."""
    groups: dict[tuple[Camera, int | None], list[int]] = {}
    for i in sorted(poses):
        groups.setdefault((cameras[i], sensor_of(photos[i])), []).append(i)
    return [CameraGroup(key[0], tuple(group), "stated") for key, group in groups.items()]


def _register_missing(
    stated: StatedPoses, found: SparseModel, cameras: dict[int, Camera]
) -> dict[int, np.ndarray]:
    """Return poses for photos with a missing or wrong pose, from the points of the others."""
    fresh = {}
    for i in range(len(stated.photos)):
        if i in stated.wrong or i not in stated.poses:
            pose = register_photo(
                i, stated.photos, stated.links, found, cameras[i], stated.parameters
            )
            if pose is not None:
                fresh[i] = pose
    return fresh


def _keep_stated(
    stated: StatedPoses, measured: SparseModel, before: float, cameras: dict[int, Camera]
) -> SparseScene:
    """Return the scene with all good poses unchanged."""
    fresh = _register_missing(stated, measured, cameras)
    retained = {i: (cameras[i], p) for i, p in stated.poses.items() if i not in stated.wrong}
    poses = {**{i: pose for i, (_, pose) in retained.items()}, **fresh}
    gate = stated.parameters.gates_px[-1]
    found = triangulate_and_adjust(
        stated.photos, stated.links, poses, _exact_groups(stated.photos, cameras, poses), gate,
        stated.parameters, free=False,
    )  # fmt: skip
    error = round(before, 4)
    facts = {
        "error_before_px": error,
        "error_after_px": error,
        "moved_median_mm": 0.0,
        "turned_median_deg": 0.0,
        "scale_correction": 1.0,
        **_focal_facts(stated, found),
    }
    return _to_scene(stated, found, None, retained, fresh, facts)


def _refine_stated(
    stated: StatedPoses, measured: SparseModel, before: float, steps: ProgressSteps
) -> SparseScene:
    """Return the scene with refined poses and cameras in the stated frame."""
    notes = stated.notes
    found = _refine_from_stated(stated, _is_poor(stated, measured, before))
    if found is None:
        notes.append("the stated poses are too inaccurate to refine; new poses were estimated")
        found, more, _ = map_from_scratch(
            stated.photos, stated.groups, stated.links, stated.parameters, steps
        )
        notes += more
    change, shared = _align_to_stated(stated, found)
    moved = change.off_m
    facts = {
        "error_before_px": round(before, 4) if np.isfinite(before) else None,
        "error_after_px": round(found.median_px, 4),
        "moved_median_mm": round(1000 * float(np.median(moved)), 3),
        "turned_median_deg": round(float(np.median(change.off_deg)), 4),
        "scale_correction": _scale_correction(measured, found, change),
        **_focal_facts(stated, found),
    }
    notes.append(
        f"the median error of the stated poses was {before:.1f} px; after refinement it "
        f"is {found.median_px:.2f} px, which moved the poses by "
        f"{facts['moved_median_mm']:.0f} mm and {facts['turned_median_deg']:.1f} degrees"
    )
    fresh = {i: pose for i, pose in found.poses.items() if i not in shared}
    return _to_scene(stated, found, change, {}, fresh, facts)


def _scale_correction(
    measured: SparseModel, found: SparseModel, change: Similarity
) -> float | None:
    """Return the ratio of the refined to the stated median depth."""
    if len(measured.points) < MIN_POINTS:
        return None
    return round(change.scale * median_depth(found) / median_depth(measured), 4)


def _is_poor(stated: StatedPoses, measured: SparseModel, before: float) -> bool:
    """Return whether there are too few points to override poses that are almost correct."""
    unit = pixel_unit(stated.photos)
    seen = len(measured.track_photo) / max(1, len(measured.poses))
    return seen < MIN_POINTS_PER_PHOTO and before < NEARLY_RIGHT_PX * unit


def _refine_from_stated(stated: StatedPoses, poor: bool) -> SparseModel | None:
    """Return refined poses, starting from the stated ones, or None if that fails.

    In a ``poor`` capture, the stated poses act as anchors and the intrinsics are fixed.
    """
    links, chosen = stated.links, stated.parameters
    linked = {i for pair in links.matches for i in pair}
    poses = {i: p for i, p in stated.poses.items() if i not in stated.wrong and i in linked}
    if len(poses) < 2:
        return None
    trusted = dict(poses) if poor else None
    groups = [replace(one, known="assumed") if poor else one for one in stated.groups]
    first, later = chosen.gates_px[:1], chosen.gates_px[1:]
    found = refine_poses(stated.photos, links, poses, groups, first, chosen, trusted)
    groups = replace_cameras(groups, found.cameras)
    fresh = _register_missing(stated, found, camera_by_photo(groups))
    poses = {**found.poses, **fresh}
    if later:
        found = refine_poses(stated.photos, links, poses, groups, later, chosen, trusted)
    settled = found.median_px <= MAX_REFINED_ERROR_PX * pixel_unit(stated.photos)
    if not settled or len(found.poses) < 0.5 * len(linked):
        return None
    return found


def _align_to_stated(stated: StatedPoses, found: SparseModel) -> tuple[Similarity, set[int]]:
    """Return the similarity to the stated frame, and the photos from which it was computed."""
    shared = sorted(i for i in found.poses if i in stated.poses and i not in stated.wrong)
    given = np.array([found.poses[i] for i in shared]).reshape(-1, 4, 4)
    wanted = np.array([stated.poses[i] for i in shared]).reshape(-1, 4, 4)
    try:
        return align_views(given, wanted, depths_seen(found, shared)), set(shared)
    except ValueError as error:
        raise CaptureError(
            PHOTOS,
            f"the poses cannot be aligned with the stated poses ({error}); remove the stated poses",
        ) from error


def _focal_facts(stated: StatedPoses, found: SparseModel) -> dict:
    facts = focal_facts(stated.photos, found, stated.groups)
    return {**facts, "focal_stated_px": facts["focal_given_px"]}


def _to_scene(stated, found, change, retained, fresh, facts) -> SparseScene:
    photos, notes = stated.photos, stated.notes
    placed = {*found.poses, *retained}
    wrong = sorted(stated.wrong)
    for i in wrong:
        how = "estimated again" if i in fresh else "removed"
        notes.append(f"the stated pose of {photos[i].name} contradicts the images and was {how}")
    out = dict(explain_left_out(photos, placed, stated.links))
    for i in wrong:
        if i not in placed:
            out[photos[i].name] = "the stated pose contradicts the images; take the photo again"
    facts = {"stated_wrong": len(wrong), **facts}
    return to_sparse_scene(
        photos, found, change, retained,
        left_out=tuple(out.items()), notes=tuple(notes), facts=facts,
    )  # fmt: skip

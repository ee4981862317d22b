"""Depth maps of all photos by plane sweep, consistency checks and hole filling."""

from collections.abc import Iterator

import numpy as np
from threadpoolctl import threadpool_limits

from world2minecraft.capture.stereo.consistency import check_consistency, filter_speckles
from world2minecraft.capture.stereo.monocular_depth import DepthModel, fill_holes
from world2minecraft.capture.stereo.parameters import StereoParameters
from world2minecraft.capture.stereo.photo_preparation import StereoPhoto, prepare_stereo_photos
from world2minecraft.capture.stereo.planar_regions import fill_planar_regions
from world2minecraft.capture.stereo.plane_sweep import depth_range, sweep_depth
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.parallel import map_parallel
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import DepthMap, PhotoStream, SparseScene
from world2minecraft.geometry.unprojection import pixel_rays, project
from world2minecraft.rendering.thread_pool import run_parallel

SAMPLE_GRID = 7  # A grid of 7x7 rays, each at three depths, stands for what a photo sees.
DEPTH_PERCENTILES = (20, 50, 80)
MIN_SHARED_POINTS = 20  # Common points that prove an unobstructed view.
PARALLEL_PHOTOS = 2  # Photos swept side by side; each needs about 60 MB.
TRUST = np.array([30, 60, 130, 180, 255], np.uint8)  # By number of confirming photos; the last: 4.
SURE_TRUST = 160  # Trust of depth that may decide where a flat patch lies.
PLANE_TRUST = np.uint8(96)
MIN_PLANE_VOTES = 2  # Two photos may agree by chance; three hardly do.
MIN_SPARSE_POINTS = 20
STAGE = "stereo"


def select_neighbours(
    photos: list[StereoPhoto], depths_m: np.ndarray, count: int, angle_deg: float
) -> list[np.ndarray]:
    """Select up to ``count`` neighbours for each photo, the best first.

    Args:
        photos: All photos.
        depths_m: Three representative depths of each photo, float64 [F, 3].
        count: Maximum number of neighbours.
        angle_deg: Ideal angle between the two rays to a point, in degrees.

    Returns:
        The indices of the neighbours of each photo.
    """
    result = []
    poses = np.array([photo.camera_to_scan for photo in photos])
    to_cameras = np.array([invert_rigid(pose) for pose in poses])
    for number, photo in enumerate(photos):
        points_m, depth_m = _sample_points(photo, depths_m[number])
        scores = np.array(
            [
                _neighbour_score(
                    photo, photos[other], to_cameras[other], points_m, depth_m, angle_deg
                )
                if other != number
                else 0.0
                for other in range(len(photos))
            ]
        )
        order = np.argsort(-scores, kind="stable")
        result.append(order[scores[order] > 0.02][:count])
    return result


def _sample_points(photo: StereoPhoto, depths_m: np.ndarray):
    """Return points [P, 3] in the scan frame that the photo may show, and their depth."""
    camera = photo.camera
    u, v = np.meshgrid(
        (np.arange(SAMPLE_GRID) + 0.5) / SAMPLE_GRID * camera.width_px,
        (np.arange(SAMPLE_GRID) + 0.5) / SAMPLE_GRID * camera.height_px,
    )
    x, y = (u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px
    rays = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)
    points_m = (rays[None] * depths_m[:, None, None]).reshape(-1, 3)
    return apply(photo.camera_to_scan, points_m), np.repeat(depths_m, len(rays))


def _neighbour_score(photo, other, to_other, points_m, depth_m, angle_deg) -> float:
    """Return the weighted share of points that the other photo shows, by angle and distance."""
    seen_m = apply(to_other, points_m)
    z = seen_m[:, 2]
    ahead = z > 0.3 * depth_m
    at_px = project(np.where(ahead[:, None], seen_m, 1.0), other.camera)
    size = (other.camera.width_px, other.camera.height_px)
    inside = ahead & ((at_px >= 0) & (at_px < size)).all(axis=1)
    if not inside.any():
        return 0.0
    here = points_m[inside] - photo.camera_to_scan[:3, 3]
    there = points_m[inside] - other.camera_to_scan[:3, 3]
    lengths = np.linalg.norm(here, axis=1) * np.linalg.norm(there, axis=1)
    cosine = (here * there).sum(axis=1) / np.maximum(lengths, 1e-12)
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    octaves = np.log2(np.maximum(angle, 1e-3) / angle_deg)
    distance = np.log2(z[inside] / depth_m[inside])
    worth = np.exp(-0.5 * octaves**2 - 0.5 * (distance / 0.5) ** 2)
    shared = len(np.intersect1d(photo.guide_point, other.guide_point, assume_unique=True))
    return float(worth.sum() / len(points_m) * (0.2 + 0.8 * min(1.0, shared / MIN_SHARED_POINTS)))


def compute_depth_maps(
    photos: PhotoStream,
    scene: SparseScene,
    parameters: StereoParameters | None = None,
    progress: Progress = no_progress,
    guide: DepthModel | None = None,
) -> Iterator[DepthMap]:
    """Yield the depth map of each photo of a scene, in its order.

    Args:
        photos: Photos, read once; photos that are not in the scene are ignored.
        scene: Poses and sparse points in any unit; depths have the same unit.
        parameters: Stereo parameters, or None for the defaults.
        progress: Callback for the progress of the stage ``stereo``.
        guide: Network that fills remaining holes with low confidence; see ``monocular_depth``.

    Raises:
        CaptureError: If no two photos show the same surface from different positions, or a photo is
            missing.
    """
    values = parameters or StereoParameters()
    small = prepare_stereo_photos(photos, scene, values.width_px, no_progress)
    swept, neighbours = sweep_photos(small, values, progress)
    every_m = np.concatenate([photo.guide_m for photo in small])

    def filtered(number: int) -> tuple[DepthMap, np.ndarray, np.ndarray]:
        found = filter_consistent(number, small, swept, neighbours, values)
        return found, *_fill_planes(found, small[number], every_m)

    with threadpool_limits(1, "blas"):  # Small products: our threads are enough.
        estimates = map_parallel(filtered, range(len(small)))
    guesses_m = [guess_m for _, guess_m, _ in estimates]
    for number, (photo, (found, guess_m, guessed)) in enumerate(zip(small, estimates, strict=True)):
        votes, _ = count_votes(number, small, guesses_m, neighbours[number], values.agreement)
        agreed = votes >= max(values.agreeing, MIN_PLANE_VOTES)
        result = _merge_planes(found, guess_m, guessed, agreed)
        yield result if guide is None else _fill_from_network(result, photo, guide)
        progress(STAGE, len(small) + number + 1, 2 * len(small), photo.name)


def _fill_planes(
    found: DepthMap, photo: StereoPhoto, every_m: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a depth estimate for flat patches; see ``planar_regions``."""
    sure = found.trust >= SURE_TRUST
    return fill_planar_regions(photo.colour, found.depth_m, sure, depth_range(photo, every_m))


def _merge_planes(
    found: DepthMap, guess_m: np.ndarray, guessed: np.ndarray, agreed: np.ndarray
) -> DepthMap:
    """Use the estimate where other photos agree, and remove the contradicted depth elsewhere."""
    depth_m = np.where(guessed, np.where(agreed, guess_m, np.float32(0)), found.depth_m)
    trust = np.where(guessed, np.where(agreed, PLANE_TRUST, np.uint8(0)), found.trust)
    return DepthMap(found.name, found.camera, depth_m, trust)


def _fill_from_network(found: DepthMap, photo: StereoPhoto, guide: DepthModel) -> DepthMap:
    """Fill holes with the prediction of a network."""
    guess = guide.predict(photo.colour, photo.camera)
    depth_m, trust = fill_holes(
        found.depth_m, found.trust, guess, guide.kind, photo.guide_px, photo.guide_m
    )
    return DepthMap(found.name, found.camera, depth_m, trust)


def sweep_photos(
    small: list[StereoPhoto], values: StereoParameters, progress: Progress = no_progress
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return the depth of each photo by plane sweep, and the indices of its neighbours.

    Depth maps are float32 [h, w], without consistency checks.

    Raises:
        CaptureError: If the photos have no common points, or no two photos show the same surface
            from different positions.
    """
    every_m = np.concatenate([photo.guide_m for photo in small])
    if not len(every_m):
        raise CaptureError(
            "photos",
            "the photos share no points, so depth cannot be computed; take more "
            "photos from closer together",
        )
    known = [p.guide_m if len(p.guide_m) > MIN_SPARSE_POINTS else every_m for p in small]
    usual = np.array([np.percentile(found, DEPTH_PERCENTILES) for found in known])
    neighbours = select_neighbours(small, usual, values.neighbours, values.angle_deg)
    if not any(len(found) for found in neighbours):
        raise CaptureError(
            "photos",
            "no two photos show the same surface from different positions; "
            "move sideways between photos",
        )
    swept: list[np.ndarray] = [np.zeros(0, np.float32)] * len(small)

    def one(number: int) -> None:
        others = [small[other] for other in neighbours[number]]
        swept[number] = _sweep_photo(small[number], others, every_m, values)

    for first in range(0, len(small), PARALLEL_PHOTOS):
        run_parallel(one, range(first, min(first + PARALLEL_PHOTOS, len(small))))
        done = min(first + PARALLEL_PHOTOS, len(small))
        progress(STAGE, done, 2 * len(small), small[done - 1].name)
    return swept, neighbours


def _sweep_photo(
    photo: StereoPhoto, others: list[StereoPhoto], every_m: np.ndarray, values: StereoParameters
) -> np.ndarray:
    if not others:
        return np.zeros((photo.camera.height_px, photo.camera.width_px), np.float32)
    return sweep_depth(photo, others, depth_range(photo, every_m), values)


def filter_consistent(
    number: int,
    small: list[StereoPhoto],
    swept: list[np.ndarray],
    neighbours: list[np.ndarray],
    values: StereoParameters,
) -> DepthMap:
    """Return the depth map of a photo, reduced to depths that its neighbours confirm."""
    photo = small[number]
    votes, mean = count_votes(number, small, swept, neighbours[number], values.agreement)
    neighbour_count = max(1, len(neighbours[number]))
    depth_m = np.where(votes >= min(values.agreeing, neighbour_count), mean, np.float32(0))
    min_size_px = round(values.island_share * depth_m.size)
    depth_m = filter_speckles(depth_m, min_size_px, values.island_step)
    trust = TRUST[np.clip(4 - min(neighbour_count, 4) + votes, 0, 4)]
    return DepthMap(photo.name, photo.camera, depth_m, np.where(depth_m > 0, trust, np.uint8(0)))


def count_votes(
    number: int,
    small: list[StereoPhoto],
    swept: list[np.ndarray],
    others: np.ndarray,
    agreement: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return how many photos confirm each pixel's depth, uint8 [h, w], and the mean depth."""
    photo = small[number]
    votes = np.zeros(swept[number].shape, np.uint8)
    mean = swept[number].copy()
    if not len(others):
        return votes, mean
    # Photos upright and lying have other shapes; each shape is asked at once.
    total = np.zeros(votes.shape, np.float64)
    for shape in sorted({swept[other].shape for other in others}):
        same = [other for other in others if swept[other].shape == shape]
        found, middle = check_consistency(
            swept[number], pixel_rays(photo.camera),
            np.stack([swept[other] for other in same]),
            np.array([invert_rigid(small[o].camera_to_scan) @ photo.camera_to_scan for o in same]),
            np.array([_intrinsics(small[other]) for other in same]), agreement,
        )  # fmt: skip
        total += middle.astype(np.float64) * (found + 1.0) - swept[number]
        votes += found
    return votes, ((total + swept[number]) / (votes + 1.0)).astype(np.float32)


def _intrinsics(photo: StereoPhoto) -> list[float]:
    camera = photo.camera
    return [camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px]

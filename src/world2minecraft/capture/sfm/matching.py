"""Matching of photos: candidate pairs, descriptor matches and two-view verification.

Descriptors are bytes, so their dot products are integers below 2^24, which float32 represents
exactly. The result is therefore independent of the summation order and the number of threads.
"""

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from world2minecraft.capture.sfm.camera_groups import CameraGroup, to_colmap
from world2minecraft.capture.sfm.features import Features
from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.progress import ProgressSteps
from world2minecraft.capture.sfm.pycolmap_access import pycolmap_session
from world2minecraft.capture.sfm.rigs import places_of
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.types import Camera

SELF_PRODUCT = 512.0**2  # Product of a descriptor with itself.
MAX_RATIO = 0.8  # Lowe's ratio of the best to the second best distance.
MAX_ANGLE_RAD = 0.7  # Angle between two descriptors; COLMAP's default.
MAX_WORDS = 512  # Number of descriptors used as words to find similar photos in large captures.
MAX_THREADS = 4  # Matrix products fill the memory's bandwidth with more.

Pair = tuple[int, int]
MAX_TRIALS = 2000  # RANSAC finds a geometry that a fifth of the matches support.
# Of the longer side: matches of larger pictures lie that far off, 4 px at least.
MAX_ERROR_SHARE = 0.004
PLANAR_CONFIGS = (4, 5, 6)  # COLMAP's codes for planar, panoramic, and either.
# A turn has singular values that are all one; a focal length 10 % off shows so.
MAX_ROTATION_STRETCH = 1.1


def match_descriptors(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return mutual nearest neighbours of two descriptor arrays, uint8 [K, 128], as int64 [M, 2].

    A match must be the best in both directions, clearly better than the second best, and close.
    """
    if len(first) == 0 or len(second) < 2:
        return np.zeros((0, 2), np.int64)
    a, b = first.astype(np.float32), second.astype(np.float32)
    products = a @ b.T
    rows = np.arange(len(a))
    best = products.argmax(axis=1)
    angle = np.arccos(np.minimum(products[rows, best] / SELF_PRODUCT, 1))
    products[rows, best] = -1
    next_angle = np.arccos(np.minimum(products.max(axis=1) / SELF_PRODUCT, 1))
    some = np.flatnonzero((angle < MAX_ANGLE_RAD) & (angle < MAX_RATIO * next_angle))
    back = (b[best[some]] @ a.T).argmax(axis=1)
    some = some[back == some]
    return np.stack([some, best[some]], axis=1)


def count_common_features(
    photos: list[Features], parameters: SfmParameters, steps: ProgressSteps
) -> np.ndarray:
    """Return the number of matches between the largest features of each two photos, int [N, N].

    The number is 0 for pairs that were not compared.
    """
    strong = [photo.descriptors[: parameters.strong] for photo in photos]
    places = places_of(photos)  # Photos of one place tell no depth, and their turn is known.
    pairs = [(i, j) for i, j in _candidate_pairs(strong, parameters) if places[i] != places[j]]
    alike = np.zeros((len(photos), len(photos)), np.int64)
    rows: dict[int, list[int]] = {}
    for i, j in pairs:
        rows.setdefault(i, []).append(j)

    def row(i: int) -> list[int]:
        return [len(match_descriptors(strong[i], strong[j])) for j in rows[i]]

    with ThreadPoolExecutor(thread_count()) as pool:
        for n, (i, counts) in enumerate(zip(rows, pool.map(row, rows), strict=True)):
            alike[i, rows[i]] = alike[rows[i], i] = counts
            steps.done("alike", n + 1, len(rows))
    return alike


def select_pairs(alike: np.ndarray, parameters: SfmParameters) -> list[Pair]:
    """Select the pairs (i < j) to match fully: the most similar of each photo, and neighbours."""
    pairs: set[Pair] = set()
    count = len(alike)
    for i in range(count):
        for j in np.argsort(-alike[i], kind="stable")[: parameters.partners].tolist():
            if alike[i, j] >= parameters.least_strong:
                pairs.add((min(i, j), max(i, j)))
        for j in range(i + 1, min(count, i + 1 + parameters.neighbours)):
            if alike[i, j] >= parameters.least_strong // 2:
                pairs.add((i, j))
    return sorted(pairs)


def thread_count() -> int:
    """Return the number of threads used for matching, which does not affect the result."""
    return min(usable_cores(), MAX_THREADS)


def _candidate_pairs(strong: list[np.ndarray], parameters: SfmParameters) -> list[Pair]:
    count = len(strong)
    if count <= parameters.exhaustive:
        return [(i, j) for i in range(count) for j in range(i + 1, count)]
    pairs = {(i, j) for i in range(count) for j in range(i + 1, min(count, i + 11))}
    words = _visual_words(strong)
    shared = words @ words.T
    np.fill_diagonal(shared, -1)
    for i in range(count):
        nearest = np.argsort(-shared[i], kind="stable")[: parameters.exhaustive // 3]
        pairs |= {(min(i, j), max(i, j)) for j in nearest.tolist()}
    return sorted(pairs)


def _visual_words(strong: list[np.ndarray]) -> np.ndarray:
    """Return weighted histograms of visual words for each photo, unit length, float64 [N, words].

    The words are descriptors of the photos themselves, so that no vocabulary file is required.
    """
    every = np.concatenate([photo[::4] for photo in strong])
    if len(every) == 0:
        return np.zeros((len(strong), 1))
    some = np.linspace(0, len(every) - 1, min(MAX_WORDS, len(every))).astype(np.intp)
    words = every[some].astype(np.float32)
    counts = np.zeros((len(strong), len(words)))
    for i, photo in enumerate(strong):
        if len(photo):
            nearest = (photo.astype(np.float32) @ words.T).argmax(axis=1)
            counts[i] = np.bincount(nearest, minlength=len(words))
    rare = np.log((1 + len(strong)) / (1 + (counts > 0).sum(axis=0)))
    weighed = np.sqrt(counts) * rare
    length = np.linalg.norm(weighed, axis=1, keepdims=True)
    return np.round(weighed / np.maximum(length, 1e-12), 9)


@dataclass(frozen=True, eq=False)
class MatchGraph:
    """Verified matches between photos.

    Attributes:
        matches: Matched features, int64 [M, 2], of each linked pair (i < j) of photos.
        geometry: Two-view geometry of pycolmap for each linked pair.
        alike: Number of initial matches of all pairs, int [N, N].
    """

    matches: dict[Pair, np.ndarray]
    geometry: dict[Pair, Any]
    alike: np.ndarray

    def of(self, photo: int) -> list[int]:
        """Return the photos linked with a photo."""
        return [j if i == photo else i for i, j in self.matches if photo in (i, j)]

    def flat(self) -> float:
        """Return the share of links that a planar scene or a pure rotation explains."""
        return sum(one.config in PLANAR_CONFIGS for one in self.geometry.values()) / max(
            1, len(self.geometry)
        )

    def turned(self, cameras: dict[int, Camera]) -> float:
        """Return the share of links that a pure rotation of the camera explains."""
        count = 0
        for (i, j), one in self.geometry.items():
            if one.config in PLANAR_CONFIGS and one.H is not None:
                turn = np.linalg.inv(cameras[j].matrix) @ one.H @ cameras[i].matrix
                stretch = np.linalg.svd(turn, compute_uv=False)
                count += stretch[0] / stretch[2] < MAX_ROTATION_STRETCH
        return count / max(1, len(self.geometry))


def match_photos(
    photos: list[Features],
    groups: list[CameraGroup],
    parameters: SfmParameters,
    steps: ProgressSteps,
) -> MatchGraph:
    """Return the verified matches between photos with approximately known cameras."""
    with threadpool_limits(1, "blas"):  # Small products: our threads are enough.
        return _match_and_verify(photos, groups, parameters, steps)


def _match_and_verify(
    photos: list[Features],
    groups: list[CameraGroup],
    parameters: SfmParameters,
    steps: ProgressSteps,
) -> MatchGraph:
    alike = count_common_features(photos, parameters, steps)
    pairs = select_pairs(alike, parameters)
    found: dict[Pair, np.ndarray] = {}
    geometry: dict[Pair, Any] = {}
    with pycolmap_session() as pycolmap:
        cameras = {
            i: to_colmap(pycolmap, group.camera, number + 1, simple=False)
            for number, group in enumerate(groups)
            for i in group.photos
        }
        options = _options(pycolmap, max(max(photo.size) for photo in photos), parameters)

        def link(pair: Pair) -> tuple[np.ndarray, Any]:
            return _verify_pair(pycolmap, photos, cameras, pair, options)

        with ThreadPoolExecutor(thread_count()) as pool:
            for n, (pair, (both, one)) in enumerate(_in_order(pairs, pool.map(link, pairs))):
                if len(both) >= parameters.least_matches:
                    found[pair], geometry[pair] = both, one
                steps.done("matches", n + 1, len(pairs))
    return MatchGraph(found, geometry, alike)


def _in_order(pairs: list[Pair], results: Iterable[tuple[np.ndarray, Any]]):
    return zip(pairs, results, strict=True)


def _options(pycolmap: Any, longest: int, parameters: SfmParameters) -> Any:
    options = pycolmap.TwoViewGeometryOptions()
    options.min_num_inliers = parameters.least_matches
    options.detect_watermark = False
    options.ransac.random_seed = parameters.seed
    options.ransac.max_num_trials = MAX_TRIALS
    options.ransac.max_error = max(4.0, MAX_ERROR_SHARE * longest)
    options.ransac.num_threads = 1
    return options


def _verify_pair(pycolmap: Any, photos: list[Features], cameras: dict, pair: Pair, options: Any):
    i, j = pair
    both = match_descriptors(photos[i].descriptors, photos[j].descriptors)
    if len(both) < options.min_num_inliers:
        return both[:0], None
    rows = np.repeat(np.arange(len(both), dtype=np.uint32)[:, None], 2, axis=1)
    one = pycolmap.estimate_two_view_geometry(
        cameras[i], photos[i].pixels[both[:, 0]],
        cameras[j], photos[j].pixels[both[:, 1]],
        rows, options,
    )  # fmt: skip
    inliers = np.asarray(one.inlier_matches, np.int64).reshape(-1, 2)[:, 0]
    one.inlier_matches = np.ascontiguousarray(both[inliers].astype(np.uint32))
    return both[inliers], one

"""Links between photos: the matches that one geometry explains."""

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from world2minecraft.capture.sfm.camera_groups import Lens, to_colmap
from world2minecraft.capture.sfm.colmap import colmap
from world2minecraft.capture.sfm.features import Features
from world2minecraft.capture.sfm.matching import Pair, likeness, matches, threads, worth_matching
from world2minecraft.capture.sfm.parameters import PosingParameters
from world2minecraft.capture.sfm.progress import Steps
from world2minecraft.core.types import Camera

TRIALS = 2000  # Of RANSAC: finds a geometry that a fifth of the matches obey.
NEAR = 0.004  # Of the longer side: matches of larger pictures lie that far off, 4 px at least.
FLAT = (4, 5, 6)  # COLMAP's numbers of planar, panoramic, and either.
TURNED = 1.1  # A turn has singular values that are all one; a focal length 10 % off shows so.


@dataclass(frozen=True, eq=False)
class Links:
    """What connects photos.

    ``matches`` int64 [M, 2] of features for each linked pair (i < j) of photos; ``geometry``
    pycolmap's value for the same; ``alike`` int [N, N] is a first count for all pairs.
    """

    matches: dict[Pair, np.ndarray]
    geometry: dict[Pair, Any]
    alike: np.ndarray

    def of(self, photo: int) -> list[int]:
        """Return the photos that one is linked with."""
        return [j if i == photo else i for i, j in self.matches if photo in (i, j)]

    def flat(self) -> float:
        """Return the share of links that one flat surface, or a mere turn, explains."""
        return sum(one.config in FLAT for one in self.geometry.values()) / max(
            1, len(self.geometry)
        )

    def turned(self, cameras: dict[int, Camera]) -> float:
        """Return the share of links that a camera that only turned, on one spot, would make."""
        count = 0
        for (i, j), one in self.geometry.items():
            if one.config in FLAT and one.H is not None:
                turn = np.linalg.inv(cameras[j].matrix) @ one.H @ cameras[i].matrix
                stretch = np.linalg.svd(turn, compute_uv=False)
                count += stretch[0] / stretch[2] < TURNED
        return count / max(1, len(self.geometry))


def link_photos(
    photos: list[Features], lenses: list[Lens], parameters: PosingParameters, steps: Steps
) -> Links:
    """Return the links of photos whose lenses are about right."""
    with threadpool_limits(1, "blas"):  # Small products: our threads are enough.
        return _linked(photos, lenses, parameters, steps)


def _linked(
    photos: list[Features], lenses: list[Lens], parameters: PosingParameters, steps: Steps
) -> Links:
    alike = likeness(photos, parameters, steps)
    pairs = worth_matching(alike, parameters)
    found: dict[Pair, np.ndarray] = {}
    geometry: dict[Pair, Any] = {}
    with colmap() as pycolmap:
        cameras = {
            i: to_colmap(pycolmap, lens.camera, number + 1, simple=False)
            for number, lens in enumerate(lenses)
            for i in lens.photos
        }
        options = _options(pycolmap, max(max(photo.size) for photo in photos), parameters)

        def link(pair: Pair) -> tuple[np.ndarray, Any]:
            return _link(pycolmap, photos, cameras, pair, options)

        with ThreadPoolExecutor(threads()) as pool:
            for n, (pair, (both, one)) in enumerate(_in_order(pairs, pool.map(link, pairs))):
                if len(both) >= parameters.least_matches:
                    found[pair], geometry[pair] = both, one
                steps.done("matches", n + 1, len(pairs))
    return Links(found, geometry, alike)


def _in_order(pairs: list[Pair], results: Iterable[tuple[np.ndarray, Any]]):
    return zip(pairs, results, strict=True)


def _options(pycolmap: Any, longest: int, parameters: PosingParameters) -> Any:
    options = pycolmap.TwoViewGeometryOptions()
    options.min_num_inliers = parameters.least_matches
    options.detect_watermark = False
    options.ransac.random_seed = parameters.seed
    options.ransac.max_num_trials = TRIALS
    options.ransac.max_error = max(4.0, NEAR * longest)
    options.ransac.num_threads = 1
    return options


def _link(pycolmap: Any, photos: list[Features], cameras: dict, pair: Pair, options: Any):
    i, j = pair
    both = matches(photos[i].descriptors, photos[j].descriptors)
    if len(both) < options.min_num_inliers:
        return both[:0], None
    rows = np.repeat(np.arange(len(both), dtype=np.uint32)[:, None], 2, axis=1)
    one = pycolmap.estimate_two_view_geometry(
        cameras[i], photos[i].pixels[both[:, 0]],
        cameras[j], photos[j].pixels[both[:, 1]],
        rows, options,
    )  # fmt: skip
    kept = np.asarray(one.inlier_matches, np.int64).reshape(-1, 2)[:, 0]
    one.inlier_matches = np.ascontiguousarray(both[kept].astype(np.uint32))
    return both[kept], one

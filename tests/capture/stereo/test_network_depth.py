"""Depth by a network whose scale is off by some per cent a frame, each frame its own way."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage
from tests.exact_room import CAMERA, BoxRoom
from tests.reconstruction.opening.test_preparation import scene_of

from world2minecraft.capture.stereo import network_maps
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import DepthMap, Photo, Scan
from world2minecraft.reconstruction.fusion import FusionParameters, extract_grid, fuse_views
from world2minecraft.reconstruction.occupancy import predictor
from world2minecraft.reconstruction.registration import (
    RegistrationParameters,
    apply_corrections,
    register,
)

ROOM = BoxRoom((7.0, 5.5, 2.7))  # So large that 5 % of a wall's distance is more than a voxel.
OFF = 0.05  # Up to so much, as monocular networks are known for.
WITHIN = ndimage.generate_binary_structure(3, 3)


class Jittery:
    """A network that knows the room, each picture 5 % too large or too small and a little bent."""

    name, kind = "fake:jittery", "metric"

    def __init__(self, views, kind="metric", seed=0):
        rng = np.random.default_rng(seed)
        self.kind = kind
        self.factor = {v.name: 1 + OFF * s for v, s in zip(views, even(rng, views), strict=True)}
        self.of = {view.colour.tobytes(): view for view in views}

    def predict(self, colour, camera):
        view = self.of[colour.tobytes()]
        bend = 1 + 0.01 * np.linspace(-1, 1, camera.width_px, dtype=np.float32)[None]
        depth_m = view.depth_m * np.float32(1.4 * self.factor[view.name]) * bend
        return depth_m if self.kind == "metric" else 0.3 + 2 / depth_m


def even(rng, views) -> np.ndarray:
    """As many too large as too small, by all amounts up to the most."""
    return rng.permutation(np.linspace(-1, 1, len(views)))


@pytest.fixture(scope="module")
def views():
    return ROOM.views(16)


def photos_of(views):
    return [Photo(v.name, v.colour, v.colour_camera, False, v.camera_to_scan) for v in views]


def as_views(views, maps: list[DepthMap]):
    return [
        replace(v, depth_m=m.depth_m, depth_camera=m.camera, trust=m.trust)
        for v, m in zip(views, maps, strict=True)
    ]


def scan_of(views, kind="network") -> Scan:
    names = tuple(view.name for view in views)
    return Scan(views, np.eye(4), np.array(ROOM.size_m), names, depth_kind=kind)


def cells_of(scan: Scan) -> np.ndarray:
    fused = fuse_views(predictor("depth").predict(scan), scan, FusionParameters().suited("network"))
    low = np.round(fused.origin_m / fused.voxel_m).astype(int)
    return np.argwhere(extract_grid(fused).occupied) + low


@pytest.fixture(scope="module")
def true_cells(views) -> np.ndarray:
    return cells_of(scan_of(views))


def within_one_voxel(scan: Scan, wanted: np.ndarray) -> tuple[float, float]:
    """The share of found cells that lie within one voxel of a true one, and of true ones found."""
    found = cells_of(scan)
    low = np.minimum(found.min(axis=0), wanted.min(axis=0)) - 1
    shape = np.maximum(found.max(axis=0), wanted.max(axis=0)) - low + 2
    grids = []
    for cells in (found, wanted):
        grid = np.zeros(shape, bool)
        grid[tuple((cells - low).T)] = True
        grids.append(grid)
    near = [ndimage.binary_dilation(grid, WITHIN) for grid in grids]
    return float(near[1][grids[0]].mean()), float(near[0][grids[1]].mean())


def registered(scan: Scan) -> Scan:
    return apply_corrections(
        scan, register(scan, RegistrationParameters().suited("network")).corrections
    )


@pytest.mark.parametrize("seed", [0, 1])
def test_without_points_registration_evens_the_scales_out(views, true_cells, seed):
    """No sparse point: the frames alone tell each other how far each is off."""
    network = Jittery(views, seed=seed)
    jittered = [
        replace(v, depth_m=v.depth_m * np.float32(network.factor[v.name])) for v in views
    ]  # fmt: skip
    without = within_one_voxel(scan_of(jittered), true_cells)
    evened = within_one_voxel(registered(scan_of(jittered)), true_cells)
    assert min(evened) > 0.99, f"{without} -> {evened}"
    assert without[0] < 0.9, "else the jitter is no trial"


@pytest.mark.parametrize("kind", ["metric", "inverse"])
def test_each_map_is_fitted_to_the_points_of_its_photo(views, true_cells, kind):
    network = Jittery(views, kind)
    maps = list(network_maps(photos_of(views), scene_of(views), network))
    for view, made in zip(views, maps, strict=True):
        assert made.name == view.name and (made.trust[made.depth_m > 0] > 128).all()
        off = made.depth_m / view.depth_m - 1
        assert abs(np.median(off)) < 0.005 and np.percentile(np.abs(off), 90) < 0.03
    assert min(within_one_voxel(scan_of(as_views(views, maps)), true_cells)) > 0.97


def test_a_photo_without_points_takes_the_median_factor(views, true_cells):
    """Half of the photos have no point at all; nothing of the room's size is lost."""
    network = Jittery(views)
    scene = scene_of(views)
    kept = scene.track_frame % 2 == 0
    few = replace(
        scene,
        track_frame=scene.track_frame[kept],
        track_point=scene.track_point[kept],
        track_px=scene.track_px[kept],
    )
    maps = list(network_maps(photos_of(views), few, network))
    laid = scan_of(as_views(views, maps))
    off = [np.median(m.depth_m / v.depth_m) - 1 for v, m in zip(views, maps, strict=True)]
    assert np.abs(off[::2]).max() < 0.005 < np.abs(off[1::2]).max() < 0.08
    before, after = (within_one_voxel(s, true_cells) for s in (laid, registered(laid)))
    assert min(after) > 0.97 > before[0], f"{before} -> {after}"


def test_without_any_point_there_is_no_scale(views):
    scene = scene_of(views)
    none = replace(
        scene,
        track_frame=scene.track_frame[:0],
        track_point=scene.track_point[:0],
        track_px=scene.track_px[:0],
    )
    with pytest.raises(
        CaptureError, match="too few common points to determine the scale of fake:jittery"
    ):
        list(network_maps(photos_of(views), none, Jittery(views)))


def test_the_camera_of_a_map_is_that_of_its_photo(views):
    made = next(network_maps(photos_of(views), scene_of(views), Jittery(views)))
    assert made.camera == CAMERA

"""The predictor of monocular networks: where its box lies, what it sees, what it colours."""

from dataclasses import replace

import numpy as np
import pytest
from tests.exact_room import CAMERA, BoxRoom
from tests.reconstruction.occupancy.tiny_network import FACTS, sized, write_network

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.coordinates import apply, invert_rigid, look_at, rotation_about_z
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera, Scan, View
from world2minecraft.geometry.unprojection import project, unproject_depth
from world2minecraft.minecraftocc.labels.camera_region import RegionRule, label_region
from world2minecraft.reconstruction.fusion import extract_grid, fuse_views
from world2minecraft.reconstruction.occupancy import monocular_occupancy as mono
from world2minecraft.reconstruction.occupancy import predictor
from world2minecraft.reconstruction.occupancy.monocular_occupancy import (
    MonoPredictor,
    before_walls,
    depth_of,
    fitted,
    region_before,
)

ROOM = BoxRoom((4.4, 4.0, 2.6))
POSES = [
    look_at(np.array([2.2, 0.5, 1.5]), np.array([2.2, 3.0, 1.2])),
    look_at(np.array([0.5, 0.5, 1.5]), np.array([3.0, 3.0, 1.2])),
]


def view_at(pose: np.ndarray, **changes) -> View:
    depth_m, colour = ROOM.render(pose)
    return replace(View("v", pose, colour, CAMERA, depth_m, CAMERA), **changes)


@pytest.fixture
def network(tmp_path):
    return write_network(tmp_path / "n.onnx")


@pytest.mark.parametrize("pose", POSES)
def test_the_box_is_the_one_that_training_labels_have(pose):
    for facts in (FACTS, sized((60, 60, 36), 0.08)):
        expected = label_region(pose, RegionRule(), floor_m=0.0)
        found = region_before(pose, facts)
        assert np.array_equal(found.region_to_room, expected.region_to_room)
        assert found.shape == facts.grid_shape and found.voxel_m == facts.voxel_m


def test_the_network_is_told_where_the_picture_was_taken(network, monkeypatch):
    """A cell's centre, carried back by what it is told, meets the pixel that it meets."""
    given = {}
    used = MonoPredictor(network)
    found = used.network.probabilities

    def heard(image, intrinsics, camera_to_grid, depth_m=None):
        given.update(image=image, intrinsics=intrinsics, camera_to_grid=camera_to_grid)
        return found(image, intrinsics, camera_to_grid, depth_m)

    monkeypatch.setattr(used.network, "probabilities", heard)
    room_to_scan = rotation_about_z(30.0)
    room_to_scan[:3, 3] = [1.0, -2.0, 0.3]
    view = view_at(POSES[1], camera_to_scan=room_to_scan @ POSES[1])
    said = used.look(view, invert_rigid(room_to_scan))
    assert given["image"].shape == (3, 24, 32) and given["image"].max() <= 1
    point_m = np.array([[2.0, 2.0, 1.0]])
    in_grid = apply(invert_rigid(said.grid_to_scan), apply(room_to_scan, point_m))
    in_camera = apply(invert_rigid(given["camera_to_grid"]), in_grid)
    np.testing.assert_allclose(in_camera, apply(invert_rigid(POSES[1]), point_m), atol=1e-9)
    at_px = in_camera[0] @ given["intrinsics"].T
    expected = project(in_camera, CAMERA)[0] * 32 / 160
    np.testing.assert_allclose(at_px[:2] / at_px[2], expected, atol=1e-6)


def test_seen_are_the_cells_whose_centre_falls_into_the_picture(tmp_path):
    bias = np.zeros((12, *FACTS.grid_shape))
    bias[CLASS_NAMES.index("chair")] = 9  # Everywhere, so that no wall hides a thing.
    network = write_network(tmp_path / "n.onnx", bias=bias)
    said = MonoPredictor(network).look(view_at(POSES[0]), np.eye(4))
    for cell in np.argwhere(np.ones(said.seen.shape))[::97]:
        centre = apply(said.grid_to_scan, (cell[None] + 0.5) * said.voxel_m)
        at = apply(invert_rigid(POSES[0]), centre)
        u, v = project(np.where(at[:, 2:] > 0, at, 1.0), CAMERA)[0]
        inside = at[0, 2] > 0.1 and 0 <= u < 160 and 0 <= v < 120
        assert said.seen[tuple(cell)] == inside
    assert 0.1 < said.seen.mean() < 0.6


def test_beyond_a_wall_nothing_is_seen():
    facts = FACTS
    region = region_before(POSES[0], facts)
    camera_to_grid = invert_rigid(region.region_to_room) @ POSES[0]
    labels = np.zeros(facts.grid_shape, np.uint8)
    open_room = before_walls(labels, region, camera_to_grid, CAMERA)
    labels[:, 12] = CLASS_NAMES.index("wall")  # Right across the view, which goes along y.
    labels[10:20, 12, 5:12] = 0  # A doorway.
    seen = before_walls(labels, region, camera_to_grid, CAMERA)
    assert np.array_equal(seen[:, :13], open_room[:, :13])
    for side in (slice(0, 5), slice(25, 30)):  # But for what the wall's last column lets by.
        assert seen[side, 18:21].sum() < 0.1 * open_room[side, 18:21].sum()
    assert seen[14:16, 20, 8].all() and not (seen & ~open_room).any()
    labels[:, 12] = CLASS_NAMES.index("bed")  # What is no wall may hide things that are there.
    assert np.array_equal(before_walls(labels, region, camera_to_grid, CAMERA), open_room)


@pytest.mark.parametrize("size_px", [(64, 48), (64, 64), (80, 40), (32, 24)])
def test_a_picture_is_cut_to_the_networks_proportions(size_px):
    """A point seen through the cut camera shows what it shows through the whole one."""
    colour = np.zeros((120, 160, 3), np.uint8)
    colour[:, :, 0] = np.linspace(0, 255, 160)[None]
    colour[:, :, 1] = np.linspace(0, 255, 120)[:, None]
    picture, camera = fitted(view_at(POSES[0], colour=colour), size_px)
    assert picture.shape == (size_px[1], size_px[0], 3)
    assert (camera.width_px, camera.height_px) == size_px
    assert camera.fx_px / camera.fy_px == pytest.approx(CAMERA.fx_px / CAMERA.fy_px)
    for point in ([0.1, 0.05, 1.0], [-0.2, 0.1, 1.2], [0.0, 0.0, 1.0]):
        whole = project(np.array([point]), CAMERA)[0].astype(int)
        cut = project(np.array([point]), camera)[0].astype(int)
        far = np.abs(picture[cut[1], cut[0], :2].astype(int) - colour[whole[1], whole[0], :2])
        assert far.max() <= 8


def test_distortion_is_undone():
    lens = Camera(160, 120, 130.0, 130.0, 80.0, 60.0, (-0.2, 0.05, 0.0, 0.0, 0.0))
    _, camera = fitted(view_at(POSES[0], colour_camera=lens), (32, 24))
    assert not any(camera.distortion)


def test_depth_is_seen_from_the_colours_place():
    aside = np.eye(4)
    aside[:3, 3] = [0.05, 0.0, 0.0]
    lens = Camera(80, 60, 65.0, 65.0, 40.0, 30.0)
    depth_m, _ = ROOM.render(POSES[0] @ aside, lens)
    view = view_at(POSES[0], depth_m=depth_m, depth_camera=lens, depth_to_colour=aside)
    camera = CAMERA.resized(40, 30)
    found = depth_of(view, camera)
    expected, _ = ROOM.render(POSES[0], camera)
    assert found is not None
    filled = found > 0
    assert filled.mean() > 0.9
    assert np.median(np.abs(found[filled] / expected[filled] - 1)) < 0.02
    assert depth_of(replace(view, depth_m=None, depth_camera=None), camera) is None


def test_colours_are_what_the_picture_shows_of_each_cell(tmp_path):
    """A network that says the truth: its front cells take the colour of their own surface."""
    pose, facts = POSES[0], sized((60, 60, 36), 0.08)
    depth_m, colour = ROOM.render(pose)
    region = region_before(pose, facts)
    points, pixels = unproject_depth(depth_m, CAMERA, invert_rigid(region.region_to_room) @ pose)
    cells = np.floor(points / 0.08 + 1e-4).astype(int)
    held = ((cells >= 0) & (cells < facts.grid_shape)).all(axis=1)
    bias = np.zeros((12, *facts.grid_shape))
    bias[0] = 9.0
    at = tuple(cells[held].T)
    bias[(0, *at)], bias[(3, *at)] = -9.0, 9.0
    path = write_network(tmp_path / "n.onnx", replace(facts, image_size_px=(160, 120)), bias=bias)
    said = MonoPredictor(path).look(view_at(pose), np.eye(4))
    assert said.colour is not None
    shown = said.colour[at].astype(int)
    wanted = colour.reshape(-1, 3)[pixels[held]].astype(int)
    assert (np.abs(shown - wanted).max(axis=1) < 12).mean() > 0.85
    assert not said.colour[said.probabilities[..., 0] > 0.5].any()


def test_a_scan_becomes_a_map_whatever_the_order_of_its_views(network):
    views = [view_at(pose, name=f"v{n}") for n, pose in enumerate(POSES)]
    used = predictor(f"mono:{network}")
    maps = []
    for order in (views, views[::-1]):
        scan = Scan(order, np.eye(4), np.array([4.4, 4.0, 2.6]), tuple(v.name for v in order))
        maps.append(fuse_views(used.predict(scan), scan))
    np.testing.assert_allclose(maps[0].log_odds, maps[1].log_odds, atol=2e-3)
    np.testing.assert_allclose(maps[0].votes, maps[1].votes, rtol=2e-3, atol=2e-3)
    grid = extract_grid(maps[0])
    assert grid.occupied.any() and grid.colour[grid.occupied].any()


def test_without_pictures_there_is_nothing_to_say(network):
    bare = view_at(POSES[0], colour=None, colour_camera=None)
    scan = Scan([bare], np.eye(4), np.ones(3), ("v",))
    with pytest.raises(CaptureError, match="contains no colour images; use the predictor depth"):
        list(predictor(f"mono:{network}").predict(scan))


def test_the_shipped_network_sees_the_room_that_it_is_shown():
    scan = Scan([view_at(pose) for pose in POSES[:1]], np.eye(4), np.ones(3), ("v",))
    used = predictor("mono")
    facts = used.network.facts
    assert facts.voxel_m == 0.16 and not facts.wants_depth and facts.region == "paper"
    (said,) = used.predict(scan)
    assert said.probabilities.shape == (*facts.grid_shape, 12)
    np.testing.assert_allclose(said.probabilities.sum(axis=-1), 1, atol=5e-3)
    labels = said.probabilities.argmax(axis=-1)
    low = labels[..., 0][said.seen[..., 0]]
    assert np.mean(low == CLASS_NAMES.index("floor")) > 0.9
    high = np.bincount(labels[..., 9][said.seen[..., 9]], minlength=12) / said.seen[..., 9].sum()
    assert high[0] > 0.5 and high[CLASS_NAMES.index("wall")] > 0.1 and high[[0, 3]].sum() > 0.9
    assert mono.SHIPPED.stat().st_size <= 8_000_000

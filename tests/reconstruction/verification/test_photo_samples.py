"""Photos on a coarse raster, from cameras with other lenses and places than the depth's."""

from dataclasses import replace

import numpy as np
import pytest
from tests.exact_room import CAMERA, BoxRoom

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import Camera, Scan, View
from world2minecraft.reconstruction.naming.name_votes import CUBE_M, NameVoteMap
from world2minecraft.reconstruction.verification.photo_samples import sample_photos

ROOM = BoxRoom()
LARGE = Camera(320, 240, 250.0, 250.0, 160.0, 120.0)


def scan_of(views: list[View]) -> Scan:
    scan_to_room = rotation_about_z(30.0)
    scan_to_room[:3, 3] = [1.0, 2.0, 0.5]
    names = tuple(view.name for view in views)
    return Scan(tuple(views), scan_to_room, np.array(ROOM.size_m), names)


def votes_for(scan: Scan, number: int):
    """Votes for one class on every surface of the room."""
    votes = NameVoteMap()
    for sample in sample_photos(scan, model=Silent()):
        points_m = sample.points_m[sample.depth_m > 0]
        shares = np.zeros((len(points_m), 40), np.float32)
        shares[:, number - 1] = 1
        votes.add(points_m, np.arange(len(points_m)), shares)
    return votes.votes()


class Silent:
    """A network that sees walls."""

    def predict(self, colour, depth_m, camera, up=None, camera_height_m=None) -> np.ndarray:
        shares = np.zeros((30, 40, 40), np.float32)
        shares[..., 0] = 1
        return shares


def offset_view() -> View:
    """A view whose depth camera is turned and shifted against its colour camera."""
    pose = ROOM.poses(3)[0]
    depth_to_colour = np.eye(4)
    depth_to_colour[:3, 3] = [0.05, 0.01, -0.02]
    depth_m, _ = ROOM.render(pose @ depth_to_colour)
    _, colour = ROOM.render(pose, LARGE)
    return View("offset", pose, colour, LARGE, depth_m, CAMERA, depth_to_colour)


def test_depth_is_that_of_the_colour_camera():
    view = offset_view()
    (sample,) = sample_photos(scan_of([view]), model=Silent())
    assert sample.camera.width_px == 160 and sample.colour.shape == (120, 160, 3)
    true_m, _ = ROOM.render(view.camera_to_scan, sample.camera)
    known = sample.depth_m > 0
    assert known.mean() > 0.6
    assert np.median(np.abs(sample.depth_m - true_m)[known]) < 0.01
    assert np.mean(np.abs(sample.depth_m - true_m)[known] < 0.1) > 0.95


def test_points_are_in_the_room_frame():
    scan = scan_of(ROOM.views(2))
    for sample in sample_photos(scan, model=Silent()):
        points_m = sample.points_m[sample.depth_m > 0]
        in_box_m = (points_m - scan.scan_to_room[:3, 3]) @ scan.scan_to_room[:3, :3]
        assert (in_box_m > -0.05).all() and (in_box_m < np.array(ROOM.size_m) + 0.05).all()


def test_votes_are_read_where_the_point_lies():
    scan = scan_of(ROOM.views(2))
    votes = votes_for(scan, 7)
    for sample in sample_photos(scan, votes):
        assert (sample.seen[sample.depth_m > 0] == 7).all()
    far = replace(votes, cubes=votes.cubes + np.int32(round(20 / CUBE_M)))
    assert not any(sample.seen.any() for sample in sample_photos(scan, far))


def test_the_network_sees_photos_without_votes():
    for sample in sample_photos(scan_of(ROOM.views(1)), model=Silent()):
        assert (sample.seen == 1).all()


@pytest.mark.parametrize("missing", ["colour", "depth"])
def test_views_without_colour_or_depth_give_no_sample(missing):
    view = ROOM.views(1)[0]
    gone = (
        replace(view, colour=None, colour_camera=None)
        if missing == "colour"
        else replace(view, depth_m=None, depth_camera=None)
    )
    assert sample_photos(scan_of([gone]), model=Silent()) == ()


def test_samples_are_spread_over_the_used_frames():
    views = ROOM.views(9)
    scan = replace(scan_of(views), frames_used=tuple(view.name for view in views[:6]))
    names = [sample.name for sample in sample_photos(scan, count=3, model=Silent())]
    assert names == ["000001", "000003", "000005"]


def test_lens_distortion_is_removed():
    bent = replace(LARGE, distortion=(0.1, 0.0, 0.0, 0.0, 0.0))
    view = replace(offset_view(), colour_camera=bent)
    (sample,) = sample_photos(scan_of([view]), model=Silent())
    assert not any(sample.camera.distortion)
    assert sample.colour.shape[:2] == sample.depth_m.shape

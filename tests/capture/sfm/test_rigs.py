"""Views of panoramas share a place, also where the place is found from pixels alone."""

import numpy as np
import pytest
from tests.capture.sfm.box_room import picture, poses

from world2minecraft.capture.readers.panoramas import VIEWS, view_to_panorama
from world2minecraft.capture.sfm import SfmParameters, align_similarity, check_poses, find_poses
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo, RigMember

SMALL = SfmParameters(working_px=76_800, most_features=600)
CAMERA = Camera(240, 240, 120.0, 120.0, 120.0, 120.0)


def views(places, stated=None, seed=1):
    """The views of panoramas at places, with the poses that they state, if any."""
    made = []
    for n, place in enumerate(places):
        for view in range(VIEWS):
            own = view_to_panorama(view)
            given = None if stated is None else stated[n] @ own
            colour = picture(place @ own, CAMERA, seed=seed)
            rig = RigMember(f"p{n}", view, own)
            made.append(Photo(f"p{n}.{view}", colour, CAMERA, False, given, rig))
    return made


def level(places):
    """Poses at the same places, upright, turned by different angles."""
    made = np.tile(np.eye(4), (len(places), 1, 1))
    for n, pose in enumerate(made):
        yaw = 0.7 * n
        ahead, down = np.array([np.cos(yaw), np.sin(yaw), 0]), np.array([0, 0, -1.0])
        pose[:3, :3] = np.stack([np.cross(down, ahead), down, ahead], axis=1)
        pose[:3, 3] = places[n, :3, 3]
    return made


@pytest.fixture(scope="module")
def places():
    return level(poses(4))


@pytest.fixture(scope="module")
def truth(places):
    return np.array([place @ view_to_panorama(view) for place in places for view in range(VIEWS)])


def assert_rigid(camera_to_scan):
    """The views of each panorama have one place and their known directions."""
    for first in range(0, len(camera_to_scan), VIEWS):
        rig = camera_to_scan[first : first + VIEWS]
        for view in range(VIEWS):
            assert rig[view] == pytest.approx(rig[0] @ view_to_panorama(view), abs=1e-6)


def test_places_of_panoramas_are_found_from_pixels(places, truth):
    found = find_poses(views(places), SMALL)
    assert len(found.names) == 4 * VIEWS and found.left_out == ()
    off = align_similarity(found.camera_to_scan, truth)
    assert off.off_m.max() < 0.01 and off.off_deg.max() < 0.3
    assert_rigid(found.camera_to_scan)
    assert {camera.fx_px for camera in found.cameras} == {120.0}


def test_good_poses_are_kept(places, truth):
    found = check_poses(views(places, places), SMALL)
    assert found.camera_to_scan == pytest.approx(truth, abs=1e-9)
    assert len(found.points_m) > 100


def test_poses_that_are_off_are_refined_as_rigs(places, truth):
    stated = places.copy()
    stated[:, :3, 3] += np.random.default_rng(0).normal(0, 0.03, (4, 3))
    found = check_poses(views(places, stated), SMALL)
    off = align_similarity(found.camera_to_scan, truth)
    assert off.off_m.max() < 0.01
    assert_rigid(found.camera_to_scan)


def test_panoramas_of_different_rooms_are_refused_by_name(places):
    apart = [photo for n in range(3) for photo in views(places[n : n + 1], seed=n + 2)]
    apart = [
        Photo(f"p{i // VIEWS}.{i % VIEWS}", one.colour, CAMERA, False, None,
              RigMember(f"p{i // VIEWS}", i % VIEWS, view_to_panorama(i % VIEWS)))
        for i, one in enumerate(apart)
    ]  # fmt: skip
    with pytest.raises(CaptureError, match="the positions of 3 panoramas cannot be estimated"):
        find_poses(apart, SMALL)

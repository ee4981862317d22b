"""The rival of our stereo finds the plane that it is shown, however the photos lie."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks import rival_sgbm
from tests.capture.stereo.plane_photos import row_of_photos, scene_of

from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo

# A camera on its side: x is what was -y, y what was x.
ON_ITS_SIDE = np.array([[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def turned(photo):
    """The photo as it would be with the camera on its side."""
    camera = Camera(120, 160, 150.0, 150.0, 60.0, 80.0)
    colour = np.ascontiguousarray(np.rot90(photo.colour, -1))
    return Photo(photo.name, colour, camera, False, photo.camera_to_scan @ ON_ITS_SIDE)


def halved(depth_m):
    return depth_m.reshape(depth_m.shape[0] // 2, 2, depth_m.shape[1] // 2, 2).mean(axis=(1, 3))


@pytest.mark.parametrize("on_its_side", [False, True])
def test_a_slanted_plane_is_found(on_its_side):
    photos, depths = row_of_photos(0.3)
    if on_its_side:
        photos = [turned(photo) for photo in photos]
        depths = [np.rot90(depth_m, -1) for depth_m in depths]
    made = list(rival_sgbm.depth_maps(photos, scene_of(photos, 0.3)))
    assert [one.name for one in made] == [photo.name for photo in photos]
    for one, depth_m in zip(made, depths, strict=True):
        found = one.depth_m > 0
        assert found.mean() > 0.5
        assert ((one.trust > 0) == found).all()
        error = one.depth_m[found] / halved(depth_m)[found] - 1
        assert np.median(np.abs(error)) < 0.01


def test_motion_along_the_view_gives_no_pair():
    photos, _ = row_of_photos(0.0, 2)
    ahead = np.eye(4)
    ahead[2, 3] = 0.3
    photos = [photos[0], replace(photos[1], camera_to_scan=photos[0].camera_to_scan @ ahead)]
    for one in rival_sgbm.depth_maps(photos, scene_of(photos, 0.0)):
        assert not one.depth_m.any()

from dataclasses import replace

import numpy as np
import pytest
from tests.capture.stereo.plane_photos import row_of_photos, scene_of

from world2minecraft.capture.stereo import StereoParameters, compute_depth_maps, depth_maps
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo

FEW = StereoParameters(width_px=160, planes=48)


def found(photos, scene, values=FEW):
    return {one.name: one for one in compute_depth_maps(photos, scene, values)}


@pytest.mark.parametrize("slope", [0.0, 0.3, -0.6])
def test_a_plane_is_found_finer_than_the_planes_tried(slope):
    photos, depths = row_of_photos(slope)
    result = found(photos, scene_of(photos, slope))
    for photo, true_m in zip(photos, depths, strict=True):
        one = result[photo.name]
        inner = np.s_[12:-12, 24:-24]
        kept = one.depth_m[inner] > 0
        assert kept.mean() > 0.9
        error = np.abs(1 / one.depth_m[inner][kept] - 1 / true_m[inner][kept])
        step = (1 / (0.8 * true_m.min()) - 1 / (1.25 * true_m.max())) / (FEW.planes - 1)
        assert np.median(error) < 0.35 * step


def test_the_order_of_the_photos_changes_nothing():
    photos, _ = row_of_photos(0.2, 4)
    scene = scene_of(photos, 0.2)
    one, other = found(photos, scene), found(photos[::-1], scene)
    assert list(one) == list(other) == list(scene.names)
    for name in one:
        np.testing.assert_array_equal(one[name].depth_m, other[name].depth_m)


def test_a_scene_twice_as_large_has_depths_twice_as_large():
    photos, _ = row_of_photos(0.2, 4)
    scene = scene_of(photos, 0.2)
    poses = scene.camera_to_scan.copy()
    poses[:, :3, 3] *= 2
    large = replace(scene, camera_to_scan=poses, points_m=scene.points_m * 2)
    one, other = found(photos, scene), found(photos, large)
    for name in one:
        np.testing.assert_allclose(other[name].depth_m, 2 * one[name].depth_m, rtol=1e-4)
        np.testing.assert_array_equal(other[name].trust, one[name].trust)


def test_the_number_of_threads_changes_nothing(monkeypatch):
    photos, _ = row_of_photos(0.2, 4)
    scene = scene_of(photos, 0.2)
    one = found(photos, scene)
    monkeypatch.setattr(depth_maps, "PARALLEL_PHOTOS", 1)
    other = found(photos, scene)
    for name in one:
        assert one[name].depth_m.tobytes() == other[name].depth_m.tobytes()


def test_trust_and_depth_cover_the_same_pixels():
    photos, _ = row_of_photos(0.0, 3)
    for one in compute_depth_maps(photos, scene_of(photos, 0.0), FEW):
        np.testing.assert_array_equal(one.depth_m > 0, one.trust > 0)


def test_upright_and_lying_photos_see_each_other():
    photos, _ = row_of_photos(0.0, 4)
    upright = []
    for photo in photos[:2]:  # The same camera, cut to a narrower picture.
        cut = Camera(96, 120, 150.0, 150.0, 48.0, 60.0)
        upright.append(Photo(photo.name, photo.colour[:, 32:128], cut, False, photo.camera_to_scan))
    mixed = [*upright, *photos[2:]]
    result = found(mixed, scene_of(mixed, 0.0))
    for photo in mixed:
        kept = result[photo.name].depth_m[result[photo.name].depth_m > 0]
        assert kept.size > 0.5 * photo.colour.shape[0] * photo.colour.shape[1]
        assert abs(np.median(kept) - 2.0) < 0.02


def test_progress_ends_with_all_done():
    photos, _ = row_of_photos(0.0, 3)
    told = []
    list(compute_depth_maps(photos, scene_of(photos, 0.0), FEW, lambda *words: told.append(words)))
    assert {words[0] for words in told} == {"stereo"}
    assert told[-1][1] == told[-1][2]
    assert [words[1] for words in told] == sorted(words[1] for words in told)


def test_a_missing_photo_is_named():
    photos, _ = row_of_photos(0.0, 3)
    with pytest.raises(CaptureError, match="p1: is part of the scene but missing in the photos"):
        list(compute_depth_maps([photos[0], photos[2]], scene_of(photos, 0.0), FEW))


def test_a_photo_of_another_size_is_named():
    photos, _ = row_of_photos(0.0, 3)
    scene = scene_of(photos, 0.0)
    small = Camera(80, 60, 75.0, 75.0, 40.0, 30.0)
    wrong = replace(scene, cameras=(small, *scene.cameras[1:]))
    with pytest.raises(
        CaptureError, match="p0: the photo is 160x120 px, but its camera is 80x60 px"
    ):
        list(compute_depth_maps(photos, wrong, FEW))


def test_photos_from_one_place_give_no_depth():
    photos, _ = row_of_photos(0.0, 3)
    scene = scene_of(photos, 0.0)
    still = replace(scene, camera_to_scan=np.tile(np.eye(4), (3, 1, 1)))
    with pytest.raises(
        CaptureError, match="no two photos show the same surface from different positions"
    ):
        list(compute_depth_maps(photos, still, FEW))


@pytest.mark.parametrize(("name", "value"), [("planes", 7), ("window_px", 8), ("agreement", 0.0)])
def test_parameters_are_checked(name, value):
    with pytest.raises(ValueError, match=name):
        StereoParameters(**{name: value})


class Knowing:
    """A model that knows the plane, at twice its distance."""

    name, kind = "knowing", "metric"

    def predict(self, colour, camera):
        return np.full(colour.shape[:2], 4.0, np.float32)


def test_a_guide_fills_what_is_open_and_touches_nothing_else():
    photos, _ = row_of_photos(0.0, 4)
    scene = scene_of(photos, 0.0)
    strict = replace(FEW, agreeing=3)
    alone = list(compute_depth_maps(photos, scene, strict))
    guided = list(compute_depth_maps(photos, scene, strict, guide=Knowing()))
    for one, more in zip(alone, guided, strict=True):
        known = one.depth_m > 0
        assert not known.all()
        np.testing.assert_array_equal(more.depth_m[known], one.depth_m[known])
        assert (more.depth_m[~known] > 0).mean() > 0.9
        assert np.abs(more.depth_m[~known & (more.depth_m > 0)] - 2).max() < 0.05
        assert set(np.unique(more.trust[~known])) <= {0, 96}

"""Rooms opened for views from outside, and the ground that they stand on."""

import numpy as np
from scenes import volume_of

from world2minecraft.core.coordinates import look_at
from world2minecraft.rendering.presentation.opened_room import OpenedBuild, has_ceiling
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions
from world2minecraft.rendering.presentation.turntable import GROUND, studio_of, turntable
from world2minecraft.rendering.views import camera_of, orbit_shots

CAMERA = camera_of(48, 36, vertical_fov_deg=24)


def room():
    """A closed room with a red thing on one side, labelled."""
    states = np.ones((8, 6, 10), np.uint16)
    states[1:7, 1:5, 1:9] = 0
    semantic = np.where(states > 0, 3, 0).astype(np.uint8)
    semantic[:, 0], semantic[:, 5] = 2, 1
    states[1:3, 1, 1:4], semantic[1:3, 1, 1:4] = 6, 7
    return volume_of(states, semantic, scale=2.0)


def test_a_room_is_opened_towards_the_camera():
    volume = room()
    assert has_ceiling(volume)
    build = OpenedBuild(volume)
    for shot in orbit_shots(build.whole, CAMERA, 8, elevation_deg=44):
        seen = build.seen_by(shot.camera_to_room)
        assert not (seen.semantic == 1).any()
        assert (seen.states == 6).sum() == 6
        walls = seen.states[:, 3] > 0
        toward = -shot.camera_to_room[:3, 2]  # Room x is block x, room y is minus block z.
        assert not walls[-1 if toward[0] > 0 else 0, 1:-1].any()
        assert not walls[1:-1, 0 if toward[1] > 0 else -1].any()


def test_the_circle_begins_where_the_furniture_is_seen():
    """The red thing lies low behind the walls at x = 0 and z = 0: one looks towards those."""
    build = OpenedBuild(room())
    start = build.best_start_deg(30.0)
    shot = orbit_shots(build.whole, CAMERA, 1, elevation_deg=30.0, start_deg=start)[0]
    assert (build.seen_by(shot.camera_to_room).states == 6).sum() == 6


def test_the_ground_is_darker_near_the_build_and_lit_far_away():
    volume = volume_of(np.ones((4, 3, 4), np.uint8))
    studio = studio_of(volume)
    assert studio.level == volume.corner[1]
    middle = np.array(volume.corner)[[0, 2]] + 2.0
    at = [studio._dark(middle[None] + [away, 0])[0] for away in (0.0, 2.2, 3.0, 50.0)]
    assert at[0] > at[1] > at[2] >= at[3] == 0


def test_the_middle_of_an_empty_ground_has_its_colour():
    volume = volume_of(np.zeros((4, 3, 4), np.uint8))
    pose = look_at(np.array([0.5, 0.5, 3.0]), np.array([0.5, 0.6, 0.0]))
    seen = studio_of(volume).seen_by(CAMERA, pose, np.ones((36, 48), bool)).reshape(36, 48, 3)
    np.testing.assert_allclose(seen[18, 24], GROUND, atol=0.1)
    assert (seen[0, 0] < seen[18, 24]).all()


def test_a_turntable_shows_the_build_from_all_sides():
    volume = room()
    pictures = list(turntable(volume, CAMERA, 4, options=DrawOptions(samples=2)))
    assert len(pictures) == 4
    for shot, colour in pictures:
        assert colour.shape == (36, 48, 3) and shot.camera == CAMERA
        grey = np.ptp(colour.astype(int), axis=2)
        assert (grey[0] < 12).all() and (colour[0, 0] > 180).all()
    assert any((np.ptp(colour.astype(int), axis=2) > 60).any() for _, colour in pictures)


def test_a_closed_turntable_hides_what_is_inside():
    for _, colour in turntable(room(), CAMERA, 4, opened=False):
        assert (np.ptp(colour.astype(int), axis=2) < 60).all()


def test_more_samples_change_nothing_but_edges():
    volume = room()
    ((_, coarse),) = turntable(volume, CAMERA, 1, options=DrawOptions(samples=1))
    ((_, fine),) = turntable(volume, CAMERA, 1, options=DrawOptions(samples=3))
    assert np.median(np.abs(coarse.astype(int) - fine)) <= 1

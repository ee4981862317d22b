"""Photos as a caller gets them: the same for any threads, told of, and ended by a budget."""

import numpy as np
import pytest
from scenes import random_pose, random_volume

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera
from world2minecraft.rendering import LightSettings, prepare_scene, render_volume
from world2minecraft.rendering.path_tracing import Photo, emitters_of, render_photo

SMALL = Camera(32, 24, 20.0, 20.0, 16.0, 12.0)


@pytest.fixture(scope="module")
def world():
    volume = random_volume(np.random.default_rng(3), (12, 9, 11))
    return prepare_scene(volume), random_pose(np.random.default_rng(4), volume)


def test_a_seed_gives_one_picture_whatever_the_threads(world):
    scene, pose = world
    one, again = (render_photo(scene, SMALL, pose, samples=4, threads=n) for n in (1, 3))
    other = render_photo(scene, SMALL, pose, samples=4, seed=1)
    assert np.array_equal(one.radiance, again.radiance)
    assert np.array_equal(one.colour, again.colour)
    assert not np.array_equal(one.radiance, other.radiance)


def test_ids_and_depth_are_those_of_any_picture(world):
    scene, pose = world
    photo, picture = render_photo(scene, SMALL, pose, samples=1), render_volume(scene, SMALL, pose)
    assert isinstance(photo, Photo)
    for name in ("depth_m", "block_index", "face", "semantic", "instance"):
        assert np.array_equal(getattr(photo, name), getattr(picture, name))
    assert photo.colour.dtype == np.uint8 and photo.radiance.dtype == np.float32
    assert photo.albedo.shape == photo.normal.shape == (24, 32, 3)


def test_passes_add_up_to_the_samples_and_are_told_of(world):
    told = []
    photo = render_photo(
        *[world[0], SMALL, world[1]], samples=10, progress=lambda *what: told.append(what)
    )
    assert [done for _, done, _, _ in told] == [4, 8, 10]
    assert {(stage, total) for stage, _, total, _ in told} == {("photo", 10)}
    assert told[-1][3] == "0 s left" and photo.samples == 10


def test_a_budget_ends_with_what_is_there(world):
    photo = render_photo(world[0], SMALL, world[1], samples=400, budget_s=0.0)
    assert photo.samples == 4
    whole = render_photo(world[0], SMALL, world[1], samples=4)
    assert np.array_equal(photo.colour, whole.colour)


def test_a_given_exposure_counts(world):
    scene, pose = world
    photos = [
        render_photo(scene, SMALL, pose, samples=1, light=LightSettings(exposure=value))
        for value in (0.5, 2.0)
    ]
    assert [photo.exposure for photo in photos] == [0.5, 2.0]
    assert photos[1].colour.mean() > photos[0].colour.mean()


def test_lamps_may_be_listed_once(world):
    scene, pose = world
    own = render_photo(scene, SMALL, pose, samples=1, emitters=emitters_of(scene))
    assert np.array_equal(own.colour, render_photo(scene, SMALL, pose, samples=1).colour)


def test_a_photo_from_outside_of_nothing_is_sky(world):
    away = look_at(np.array([50.0, 50.0, 50.0]), np.array([90.0, 90.0, 60.0]))
    photo = render_photo(world[0], SMALL, away, samples=1)
    assert photo.exposure == 1.0 and not photo.depth_m.any() and photo.colour.min() > 0


@pytest.mark.parametrize(
    ("asked", "text"),
    [
        ({"samples": 0}, "samples must be 1 to 4096, got 0"),
        ({"depth": 65}, "depth must be 1 to 64, got 65"),
    ],
)
def test_wrong_numbers_are_told(world, asked, text):
    with pytest.raises(ValueError, match=text):
        render_photo(world[0], SMALL, world[1], **asked)


def test_a_picture_too_large_is_told(world):
    huge = Camera(9000, 1000, 1.0, 1.0, 0.0, 0.0)
    with pytest.raises(
        ValueError, match="a photo may have at most 8,000,000 pixels, got 9000x1000"
    ):
        render_photo(world[0], huge, world[1])

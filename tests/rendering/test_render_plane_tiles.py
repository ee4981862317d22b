"""Tiles drawn as planes hold what pixels drawn one by one hold, to the last bit."""

import numpy as np
from benchmarks.render_scenes import camera_of, poses, scene_looks, storeys
from scenes import random_pose, random_volume

from world2minecraft.rendering import DAY, LightSettings, prepare_scene, render_volume

OUTPUTS = ("colour", "semantic", "instance")
FIELDS = ("colour", "depth_m", "range_m", "block_index", "face", "cube_index", *OUTPUTS[1:])


def assert_alike(scene, camera, pose, light=DAY) -> None:
    by_tile = render_volume(scene, camera, pose, outputs=OUTPUTS, light=light)
    by_pixel = render_volume(scene, camera, pose, outputs=(*OUTPUTS, "normal"), light=light)
    for field in FIELDS:
        assert np.array_equal(getattr(by_tile, field), getattr(by_pixel, field)), field


def test_rooms_are_the_same_by_tile_and_by_pixel():
    volume = storeys((26, 14, 26), ground=1, furnished=0.2, seed=2)
    scene = prepare_scene(volume, scene_looks())
    for pose in poses(volume, 6, 4):
        assert_alike(scene, camera_of(101, 77), pose)


def test_heaps_are_the_same_by_tile_and_by_pixel():
    rng = np.random.default_rng(8)
    for _ in range(4):
        volume = random_volume(rng, share=0.05)
        assert_alike(prepare_scene(volume), camera_of(160, 120), random_pose(rng, volume))


def test_the_sun_is_the_same_by_tile_and_by_pixel():
    rng = np.random.default_rng(9)
    light = LightSettings(hour=10.0, sun_shadow=True)
    for _ in range(4):
        volume = random_volume(rng, share=0.05)
        assert_alike(prepare_scene(volume), camera_of(160, 120), random_pose(rng, volume), light)

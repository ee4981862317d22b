"""Pictures by the compute shader equal those of the CPU's kernel."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.render_scenes import RandomLooks, random_models, storeys
from benchmarks.render_scenes import poses as poses_in
from block_models_for_tests import FewLooks
from gpu_for_tests import CAMERA, EVERYTHING, adapter_name, assert_alike
from scenes import random_pose, random_volume, volume_of
from test_render_display_entities import random_entity

from world2minecraft.core.coordinates import look_at
from world2minecraft.rendering import LightSettings, prepare_scene, render_parallel, render_volume
from world2minecraft.rendering.block_models import BuiltinModels
from world2minecraft.rendering.editable_scene import EditableScene
from world2minecraft.rendering.gpu import GpuRenderer
from world2minecraft.rendering.gpu import readback_buffers as slots
from world2minecraft.rendering.shading_parameters import NEUTRAL

LIGHTS = {
    "day": LightSettings(),
    "sun": LightSettings(sun_shadow=True, hour=9.0),
    "night": LightSettings(hour=22.0, brightness=1.0),
    "game": LightSettings(preset="game", hour=19.0),
    "neutral": NEUTRAL,
}
TRICKS = FewLooks({1: "glass", 2: "holes", 3: "no west", 4: "diagonal", 6: "tall"})


def gpu_of(scene) -> GpuRenderer:
    return GpuRenderer(scene, adapter=adapter_name())


def with_displays(rng, volume, count=6):
    return replace(volume, entities=tuple(random_entity(rng, volume, n) for n in range(count)))


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("looks", [None, TRICKS], ids=["plain", "glass, holes, turns"])
def test_every_output_equals_the_kernels(light, looks):
    rng = np.random.default_rng([len(light), looks is None])
    volume = with_displays(rng, random_volume(rng))
    scene = prepare_scene(volume, looks)
    gpu = gpu_of(scene)
    for _ in range(3):
        how = {"outputs": EVERYTHING, "light": LIGHTS[light]}
        pose = random_pose(rng, volume)
        assert_alike(gpu.render(CAMERA, pose, **how), render_volume(scene, CAMERA, pose, **how))


@pytest.mark.parametrize("seed", range(3))
def test_models_that_nobody_would_make_equal_the_kernels(seed):
    rng = np.random.default_rng(seed)
    volume = random_models(seed)
    scene = prepare_scene(volume, RandomLooks(seed))
    gpu = gpu_of(scene)
    for _ in range(2):
        pose = random_pose(rng, volume)
        how = {"outputs": EVERYTHING, "light": LIGHTS["sun"]}
        assert_alike(gpu.render(CAMERA, pose, **how), render_volume(scene, CAMERA, pose, **how))


@pytest.mark.parametrize("seed", range(2))
def test_panes_and_furniture_in_our_own_looks_equal_the_kernels(seed):
    volume = storeys((16, 8, 16), ground=0, furnished=0.2, seed=seed)
    scene = prepare_scene(volume, BuiltinModels(16))
    gpu = gpu_of(scene)
    for pose in poses_in(volume, 3, seed):
        how = {"outputs": EVERYTHING, "light": LIGHTS["sun"]}
        assert_alike(gpu.render(CAMERA, pose, **how), render_volume(scene, CAMERA, pose, **how))


def test_a_camera_outside_equals_the_kernels_near_and_far():
    rng = np.random.default_rng(7)
    volume = with_displays(rng, random_volume(rng, share=0.3))
    scene, target = prepare_scene(volume), np.array([1.0, 1.0, 0.8])
    gpu = gpu_of(scene)
    for metres in (4.0, 60.0):
        camera = replace(CAMERA, fx_px=12.0 * metres, fy_px=12.0 * metres)
        pose = look_at(target + metres * np.array([0.6, -0.5, 0.62]), target)
        how = {"outputs": EVERYTHING}
        assert_alike(gpu.render(camera, pose, **how), render_volume(scene, camera, pose, **how))


@pytest.mark.parametrize("away_m", [0.1, 5.0, 3000.0])
def test_parallel_rays_equal_the_kernels_however_far_they_begin(away_m):
    rng = np.random.default_rng(8)
    volume = with_displays(rng, random_volume(rng))
    scene, target = prepare_scene(volume, TRICKS), np.array([1.03, 1.07, 0.81])
    pose = look_at(target + away_m * np.array([0.52, -0.43, 0.7]), target)
    how = {"outputs": EVERYTHING, "background": ((250, 240, 230), (90, 100, 110))}
    ours = gpu_of(scene).render_parallel(13.7, (36, 48), pose, **how)
    assert_alike(ours, render_parallel(scene, 13.7, (36, 48), pose, **how))


def test_samples_are_means_of_the_same_rays():
    rng = np.random.default_rng(9)
    volume = random_volume(rng)
    scene, pose = prepare_scene(volume, TRICKS), random_pose(rng, volume)
    how = {"outputs": EVERYTHING, "samples": 3}
    ours = gpu_of(scene).render(CAMERA, pose, **how)
    assert_alike(ours, render_volume(scene, CAMERA, pose, **how))


def test_wide_worlds_are_as_exact_at_their_end():
    states = np.zeros((4000, 4, 4), np.int64)
    states[-6:, :, 0], states[-1], states[:, 0] = 2, 6, 1
    volume = with_displays(np.random.default_rng(3), volume_of(states), 0)
    entity = random_entity(np.random.default_rng(4), volume, 1)
    near_end = np.add(volume.corner, (3995.2, 2.0, 2.5))
    volume = replace(volume, entities=(replace(entity, position=tuple(near_end.tolist())),))
    scene = prepare_scene(volume, TRICKS)
    eye, target = (
        volume.block_to_room[:3, :3] @ (np.array(volume.corner) + place)
        + volume.block_to_room[:3, 3]
        for place in ([3990.3, 2.2, 2.1], [3998.0, 1.5, 1.4])
    )
    how, pose = {"outputs": EVERYTHING[:-1]}, look_at(eye, target)
    ours, truth = (
        gpu_of(scene).render(CAMERA, pose, **how),
        render_volume(scene, CAMERA, pose, **how),
    )
    assert (truth.cube_index >= 0).any()
    assert_alike(ours, truth)


def test_an_empty_world_is_sky():
    volume = volume_of(np.zeros((3, 3, 3), np.int64))
    scene, pose = prepare_scene(volume), look_at(np.zeros(3), np.array([1.0, 1.0, 0.2]))
    ours = gpu_of(scene).render(CAMERA, pose, outputs=EVERYTHING)
    assert_alike(ours, render_volume(scene, CAMERA, pose, outputs=EVERYTHING))
    assert (ours.face == 255).all()


def many(seed=11, count=7):
    rng = np.random.default_rng(seed)
    volume = random_volume(rng)
    return prepare_scene(volume), [random_pose(rng, volume) for _ in range(count)]


def test_many_poses_give_what_each_gives_alone_in_their_order():
    scene, poses = many()
    gpu = gpu_of(scene)
    alone = [gpu.render(CAMERA, pose) for pose in poses]
    for form in (poses, np.array(poses), iter(poses)):
        together = list(gpu.render_many(CAMERA, form))
        assert len(together) == len(alone)
        for one, other in zip(together, alone, strict=True):
            assert np.array_equal(one.colour, other.colour)
            assert np.array_equal(one.depth_m, other.depth_m)


@pytest.mark.parametrize("slot_bytes", [1, 5000, 100_000])
def test_bands_and_batches_of_any_size_change_nothing(slot_bytes, monkeypatch):
    scene, poses = many(count=3)
    gpu = gpu_of(scene)
    whole = list(gpu.render_many(CAMERA, poses, outputs=EVERYTHING))
    monkeypatch.setattr(slots, "SLOT_BYTES", slot_bytes)
    for one, other in zip(gpu.render_many(CAMERA, poses, outputs=EVERYTHING), whole, strict=True):
        assert np.array_equal(one.colour, other.colour)
        assert np.array_equal(one.opaque_depth_m, other.opaque_depth_m)
        assert np.array_equal(one.normal, other.normal)


def test_a_loop_that_is_left_disturbs_no_later_one():
    scene, poses = many()
    gpu = gpu_of(scene)
    for _ in range(6):
        next(gpu.render_many(CAMERA, poses))
    first, second = gpu.render_many(CAMERA, poses), gpu.render_many(CAMERA, poses[::-1])
    pairs = list(zip(first, second, strict=True))
    for (one, _), (_, other) in zip(pairs, pairs[::-1], strict=True):
        assert np.array_equal(one.block_index, other.block_index)


def test_an_update_shows_the_new_blocks():
    scene, poses = many()
    other, _ = many(seed=12)
    gpu = gpu_of(scene)
    gpu.render(CAMERA, poses[0])
    gpu.update(other)
    assert_alike(gpu.render(CAMERA, poses[0]), render_volume(other, CAMERA, poses[0]))
    gpu.close()


def test_blocks_set_in_a_live_scene_are_there_after_an_update():
    rng = np.random.default_rng(13)
    volume = random_volume(rng)
    live, pose = EditableScene(volume), random_pose(rng, volume)
    gpu = gpu_of(live.scene)
    cells = np.argwhere(volume.states == 0)[::3]
    live.set_blocks(cells, ["minecraft:sea_lantern"] * len(cells), semantic=7)
    gpu.update(live.scene)
    ours = gpu.render(CAMERA, pose, outputs=EVERYTHING)
    assert (ours.semantic == 7).any()
    assert_alike(ours, render_volume(live.scene, CAMERA, pose, outputs=EVERYTHING))


def test_a_lost_device_is_opened_anew_and_the_pictures_go_on():
    scene, poses = many()
    gpu = gpu_of(scene)
    whole = [gpu.render(CAMERA, pose).block_index for pose in poses]
    found = []
    for picture in gpu.render_many(CAMERA, iter(poses)):
        found.append(picture.block_index)
    gpu._engine.device.destroy()
    found += [picture.block_index for picture in gpu.render_many(CAMERA, poses)]
    assert np.array_equal(found, whole + whole)


def test_a_request_that_the_kernel_refuses_is_refused():
    scene, poses = many(count=1)
    gpu = gpu_of(scene)
    with pytest.raises(ValueError, match="unknown output '"):
        gpu.render(CAMERA, poses[0], outputs=("sound",))
    with pytest.raises(ValueError, match="samples must be 1 to 8, got 9"):
        gpu.render(CAMERA, poses[0], samples=9)
    with pytest.raises(ValueError, match="camera_to_room must contain only finite numbers"):
        gpu.render(CAMERA, np.full((4, 4), np.nan))

"""Batches: the same bytes as one picture after another, whatever the threads and the memory."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from scenes import CAMERA, random_pose, random_volume

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.rendering import LightSettings, prepare_scene, render_volume
from world2minecraft.rendering.batch import BATCH_OUTPUTS, batch_arrays, render_batch
from world2minecraft.rendering.batch import drawing as draw_module
from world2minecraft.rendering.editable_scene import EditableScene
from world2minecraft.rendering.picture import OUTPUTS
from world2minecraft.rendering.ray_caster.plane_tiles import FACE_NUMBERS
from world2minecraft.rendering.ray_caster.shading import CORNER_LIGHT_NUMBERS
from world2minecraft.rendering.shading_parameters import DAY, exposure_of

SMALL = Camera(32, 24, 20.0, 20.0, 16.0, 12.0)
FIXED = LightSettings(exposure=1.2)
COUNT = 9


@pytest.fixture(scope="module")
def volume():
    return random_volume(np.random.default_rng(3))


@pytest.fixture(scope="module")
def scene(volume):
    return prepare_scene(volume)


@pytest.fixture(scope="module")
def poses(volume):
    rng = np.random.default_rng(4)
    return np.stack([random_pose(rng, volume) for _ in range(COUNT)])


def same(batch, number, picture):
    for name, array in batch.named():
        assert np.array_equal(array[number], getattr(picture, name)), name


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("samples", [1, 2])
def test_a_batch_has_the_bytes_of_single_pictures(scene, poses, threads, samples):
    batch = render_batch(
        scene, SMALL, poses, outputs=BATCH_OUTPUTS, light=FIXED, samples=samples, threads=threads
    )
    assert {name for name, _ in batch.named()} == set(vars(batch))
    for number, pose in enumerate(poses):
        same(batch, number, render_volume(
            scene, SMALL, pose, outputs=OUTPUTS, light=FIXED, samples=samples
        ))  # fmt: skip


def test_cameras_may_differ_but_for_their_size(scene, poses):
    cameras = [Camera(32, 24, 15.0 + n, 20.0, 16.0, 12.0 - n) for n in range(COUNT)]
    batch = render_batch(scene, cameras, poses, outputs=("depth",), light=FIXED)
    for number, (camera, pose) in enumerate(zip(cameras, poses, strict=True)):
        same(batch, number, render_volume(scene, camera, pose, light=FIXED))


def test_the_kernel_has_memory_for_the_way_to_the_sun(scene, poses, monkeypatch):
    """Else it writes beyond its end, and no picture shows it."""
    given = []
    monkeypatch.setattr(draw_module, "draw_poses", lambda *words: given.append(words))
    sunny = LightSettings(exposure=1.2, sun_shadow=True)
    render_batch(scene, SMALL, poses, outputs=("colour",), light=sunny, threads=2)
    assert len(given) == 2
    for *_, memory, _ in given:
        assert (memory.cells.shape, memory.cells.dtype) == ((8, 3), np.int64)
        shapes = [array.shape for array in memory[1:]]
        assert shapes == [(4, 6), (CORNER_LIGHT_NUMBERS,), (FACE_NUMBERS,)]
    assert len({memory.cells.ctypes.data for *_, memory, _ in given}) == 2


def test_only_what_is_asked_for_is_there(scene, poses):
    batch = render_batch(scene, SMALL, poses, outputs=("face",))
    assert [name for name, _ in batch.named()] == ["face"]
    assert batch.picture(2).face.shape == (24, 32)
    assert batch.picture(2).depth_m.size == 0


def test_large_pictures_are_shared_by_rows(scene, poses, monkeypatch):
    monkeypatch.setattr("world2minecraft.rendering.batch.drawing.LARGE_PX", 1)
    outputs = ("colour", "normal")
    alone = render_batch(scene, SMALL, poses, outputs=outputs)
    shared = render_batch(scene, SMALL, poses, outputs=outputs, threads=2)
    assert np.array_equal(alone.colour, shared.colour)
    assert np.array_equal(alone.normal, shared.normal)


def test_a_batch_has_one_exposure_of_all_its_eyes(scene, poses):
    batch = render_batch(scene, SMALL, poses, outputs=("colour",))
    eyes = np.array([apply(scene.room_to_grid, pose[:3, 3]) for pose in poses])
    light = LightSettings(exposure=exposure_of(DAY, scene, eyes))
    for number, pose in enumerate(poses):
        same(batch, number, render_volume(scene, SMALL, pose, light=light))


def test_arrays_are_filled_again(scene, poses):
    out = batch_arrays(COUNT, (24, 32), ("colour", "normal"))
    for array in (out.colour, out.normal):
        array[...] = 77
    given = render_batch(scene, SMALL, poses, outputs=("colour", "normal"), out=out)
    fresh = render_batch(scene, SMALL, poses, outputs=("colour", "normal"))
    assert given is out
    assert np.array_equal(out.colour, fresh.colour)
    assert np.array_equal(out.normal, fresh.normal)


def test_no_poses_give_no_pictures(scene):
    batch = render_batch(scene, SMALL, [], outputs=("colour",))
    assert batch.colour is not None
    assert len(batch.colour) == 0


def test_calls_from_many_threads_at_once_do_not_meet(scene, poses):
    alone = render_batch(scene, SMALL, poses, outputs=("colour",)).colour

    def work(_):
        many = render_batch(scene, SMALL, poses, outputs=("colour",), threads=2).colour
        one = render_volume(scene, CAMERA, poses[0], threads=2, light=FIXED).colour
        return many, one

    with ThreadPoolExecutor(4) as executor:
        results = list(executor.map(work, range(12)))
    assert all(np.array_equal(many, alone) for many, _ in results)
    assert all(np.array_equal(one, results[0][1]) for _, one in results)


def test_an_edit_is_seen_by_the_next_batch(volume, poses):
    live = EditableScene(volume)
    before = render_batch(live.scene, SMALL, poses, outputs=("block",)).block_index
    cell = np.argwhere(volume.states)[0]
    live.set_blocks(np.argwhere(volume.states), ["minecraft:air"] * int((volume.states > 0).sum()))
    live.set_blocks(cell[None], ["minecraft:stone"])
    after = render_batch(live.scene, SMALL, poses, outputs=("block",)).block_index
    single = [render_volume(live.scene, SMALL, pose).block_index for pose in poses]
    assert not np.array_equal(before, after)
    assert np.array_equal(after, single)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ({"outputs": ("colour", "smell")}, "unknown output 'smell'; outputs: depth, range, "
         "block, face, cube, colour, semantic, instance, opaque, normal, free"),
        ({"samples": 9}, "samples must be 1 to 8, got 9"),
        ({"cameras": [SMALL] * 2}, "9 poses need one camera or 9 cameras, got 2"),
        ({"cameras": [SMALL] * 8 + [CAMERA]}, "all images of a batch must have the same size: "
         "camera 8 has 64x48, camera 0 has 32x24; use RenderPool for different sizes"),
        ({"cameras": Camera(9000, 9000, 1.0, 1.0, 1.0, 1.0)},
         "an image may have at most 64,000,000 samples, got 9000x9000"),
        ({"poses": np.eye(4)}, "poses must have shape [N, 4, 4], got [4, 4]"),
        ({"poses": np.full((9, 4, 4), np.nan)}, "pose 0 contains NaN or infinity"),
        ({"out": batch_arrays(8, (24, 32), ("colour",)), "outputs": ("colour",)},
         "out.colour must be uint8 [9, 24, 32, 3], got uint8 [8, 24, 32, 3]"),
        ({"out": batch_arrays(9, (24, 32), ()), "outputs": ("face",)},
         "out.face must be uint8 [9, 24, 32], got nothing"),
        ({"out": batch_arrays(9, (24, 32), ("face", "depth")), "outputs": ("face",)},
         "out.depth_m is given but not requested in outputs"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_told(scene, poses, words, text):
    words = {"cameras": SMALL, "poses": poses, **words}
    with pytest.raises(UsageError) as caught:
        render_batch(scene, words.pop("cameras"), words.pop("poses"), **words)
    assert str(caught.value) == text


def test_a_batch_too_large_is_refused_before_any_memory_is_taken():
    with pytest.raises(UsageError) as caught:
        batch_arrays(1_000_000, (224, 224), ("colour", "depth"))
    assert str(caught.value) == (
        "1,000,000 images of 224x224 need 327 GiB; use fewer poses per batch, or "
        "render_stream, which only keeps a few images in memory"
    )


def test_arrays_that_are_read_only_are_refused(scene, poses):
    out = batch_arrays(COUNT, (24, 32), ("face",))
    out.face.flags.writeable = False
    with pytest.raises(UsageError) as caught:
        render_batch(scene, SMALL, poses, outputs=("face",), out=out)
    assert str(caught.value) == "out.face must be C-contiguous and writable"

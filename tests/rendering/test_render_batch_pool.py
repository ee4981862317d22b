"""Pools: the bytes of batches, bounded memory, and nothing left behind, whatever goes wrong."""

import os
import signal
from functools import partial
from multiprocessing.shared_memory import SharedMemory

import numpy as np
import pytest
from scenes import random_pose, random_volume

from world2minecraft.core.errors import UsageError, WorkerError
from world2minecraft.core.types import Camera
from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering.batch import RenderPool, render_batch
from world2minecraft.rendering.batch.pool import split_into_tasks
from world2minecraft.rendering.editable_scene import EditableScene
from world2minecraft.rendering.picture import OUTPUTS

SMALL = Camera(32, 24, 20.0, 20.0, 16.0, 12.0)
WIDE = Camera(320, 240, 200.0, 200.0, 160.0, 120.0)  # So large that each is a task.
COUNT = 7


@pytest.fixture(scope="module")
def volume():
    return random_volume(np.random.default_rng(5))


@pytest.fixture(scope="module")
def poses(volume):
    rng = np.random.default_rng(6)
    return np.stack([random_pose(rng, volume) for _ in range(COUNT)])


@pytest.fixture(scope="module")
def pool(volume):
    with RenderPool(prepare_scene(volume), 2) as made:
        yield made


def mean_colour(offset, number, picture):
    return os.getpid(), number, float(picture.colour.mean()) + offset


def fail_at_two(number, picture):
    if number == 2:
        raise ValueError("no third picture")
    return number


def make_a_function(number, picture):
    return lambda: number


def names_of(pool):
    return [block.plan.name for block in pool._blocks]


def is_gone(name):
    try:
        memory = SharedMemory(name=name)
    except FileNotFoundError:
        return True
    memory.close()
    return False


@pytest.mark.parametrize("ordered", [True, False])
@pytest.mark.parametrize("camera", [SMALL, WIDE])
def test_a_pool_gives_the_bytes_of_a_batch(pool, volume, poses, camera, ordered):
    words = {"outputs": OUTPUTS, "samples": 2}
    batch = render_batch(prepare_scene(volume), camera, poses, **words)
    found = dict(pool.render(camera, poses, ordered=ordered, **words))
    assert sorted(found) == list(range(COUNT))
    for name, array in batch.named():
        assert all(np.array_equal(getattr(found[n], name), array[n]) for n in range(COUNT)), name


def test_order_is_kept_and_sizes_may_differ(pool, poses):
    cameras = [WIDE, SMALL, SMALL, WIDE, SMALL, WIDE, WIDE]
    found = list(pool.render(cameras, poses))
    assert [number for number, _ in found] == list(range(COUNT))
    assert [one.depth_m.shape[1] for _, one in found] == [one.width_px for one in cameras]


def test_poses_are_cut_into_tasks_of_one_size():
    cameras = [SMALL] * 70 + [WIDE] * 2 + [SMALL]
    assert list(split_into_tasks(cameras)) == [(0, 64), (64, 70), (70, 71), (71, 72), (72, 73)]
    assert list(split_into_tasks([])) == []


def test_jobs_may_be_shorter_than_a_worker_is_slow(volume, poses):
    """A worker hears of a job, and of a scene, whose memory is already gone."""
    scene = prepare_scene(volume)
    with RenderPool(scene, 2) as pool:
        for _ in range(20):
            pool.update(scene)
            assert len(list(pool.render(WIDE, poses[:1]))) == 1
        assert len(list(pool.render(WIDE, poses))) == COUNT


def test_what_is_made_of_pictures_is_made_by_the_workers(pool, poses):
    plain = [picture.colour.mean() for _, picture in pool.render(WIDE, poses)]
    made = list(pool.render(WIDE, poses, make=partial(mean_colour, 1.0)))
    assert [number for number, _ in made] == [number for _, (_, number, _) in made]
    assert [mean for _, (_, _, mean) in made] == pytest.approx([one + 1 for one in plain])
    assert os.getpid() not in {process for _, (process, _, _) in made}


def test_many_pictures_go_through_few_slots(pool, poses):
    many = np.concatenate([poses] * 3)
    stream = pool.render(WIDE, many, outputs=("colour",))
    next(stream)
    slot = WIDE.width_px * WIDE.height_px * (4 + 4 + 4 + 1 + 4 + 3)
    memory = SharedMemory(name=names_of(pool)[1])
    assert memory.size <= (2 * 2 + 1) * slot + (1 << 16)  # Whole pages.
    memory.close()
    assert len(list(stream)) == 3 * COUNT - 1


def test_a_stream_that_is_closed_early_leaves_the_pool_usable(pool, poses):
    stream = pool.render(WIDE, poses)
    next(stream)
    with pytest.raises(UsageError) as caught:
        next(pool.render(WIDE, poses))
    assert str(caught.value) == (
        "this RenderPool is still rendering; exhaust or close the iterator that render() returned"
    )
    slots = names_of(pool)[1]
    stream.close()
    assert is_gone(slots)
    assert len(list(pool.render(SMALL, poses))) == COUNT


def test_an_error_in_a_worker_comes_out_and_the_pool_goes_on(pool, poses):
    with pytest.raises(ValueError, match="^no third picture$"):
        list(pool.render(WIDE, poses, make=fail_at_two))
    with pytest.raises(WorkerError, match=r"^the result for image \d cannot be pickled: "):
        list(pool.render(WIDE, poses, make=make_a_function))
    with pytest.raises(UsageError, match="^make must be picklable: use a module-level function"):
        list(pool.render(WIDE, poses, make=lambda number, picture: number))
    assert len(list(pool.render(SMALL, poses))) == COUNT


def test_edits_are_seen_after_an_update(pool, volume, poses):
    live = EditableScene(volume)
    live.set_blocks(np.argwhere(volume.states)[:20], ["minecraft:glowstone"] * 20)
    before = names_of(pool)[0]
    pool.update(live.scene)
    found = [picture.colour for _, picture in pool.render(SMALL, poses)]
    assert is_gone(before)
    assert np.array_equal(found, render_batch(live.scene, SMALL, poses).colour)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ({"outputs": ("smell",)}, "unknown output 'smell'; outputs: depth, range, block, face, "
         "cube, colour, semantic, instance, opaque, normal, free"),
        ({"samples": 0}, "samples must be 1 to 8, got 0"),
        ({"cameras": [SMALL]}, "7 poses need one camera or 7 cameras, got 1"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_told_at_once(pool, poses, words, text):
    with pytest.raises(UsageError) as caught:
        pool.render(words.pop("cameras", SMALL), poses, **words)
    assert str(caught.value) == text


def test_a_killed_worker_is_told_and_nothing_is_left(volume, poses):
    pool = RenderPool(prepare_scene(volume), 2)
    stream = pool.render(WIDE, np.concatenate([poses] * 4))
    next(stream)
    names, processes = names_of(pool), [hand.process for hand in pool._hands]
    processes[1].kill()
    with pytest.raises(WorkerError) as caught:
        list(stream)
    assert str(caught.value).startswith("worker 2 of 2 exited with code ")
    if hasattr(signal, "SIGKILL"):
        assert " with code -9" in str(caught.value)
        assert str(caught.value).endswith(
            ": it was killed, probably because memory ran out; use fewer workers"
        )
    assert len(names) == 2
    assert all(is_gone(name) for name in names)
    assert not any(process.is_alive() for process in processes)
    with pytest.raises(UsageError, match="^this RenderPool is closed; create a new one$"):
        pool.render(SMALL, poses)


def test_an_interrupt_takes_everything_away(volume, poses):
    with pytest.raises(KeyboardInterrupt), RenderPool(prepare_scene(volume), 1) as pool:
        stream = pool.render(WIDE, poses)
        next(stream)
        names, process = names_of(pool), pool._hands[0].process
        raise KeyboardInterrupt
    stream.close()
    assert all(is_gone(name) for name in names)
    assert not process.is_alive()


def test_numbers_of_workers_are_checked(volume):
    with pytest.raises(UsageError, match="^workers must be 1 to 256, got 0$"):
        RenderPool(prepare_scene(volume), 0)

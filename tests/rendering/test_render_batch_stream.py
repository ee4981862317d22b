"""Streams: order, overlap, bounded queues, and errors that come out at once."""

import threading
from itertools import count

import numpy as np
import pytest
from scenes import random_pose, random_volume

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.rendering import prepare_scene, render_volume
from world2minecraft.rendering.batch import render_batch, render_stream
from world2minecraft.rendering.batch.streaming import ordered_map, prefetch
from world2minecraft.rendering.output import colour_bytes
from world2minecraft.rendering.views.cameras import Shot

SMALL = Camera(32, 24, 20.0, 20.0, 16.0, 12.0)
COUNT = 5


@pytest.fixture(scope="module")
def scene():
    return prepare_scene(random_volume(np.random.default_rng(7)))


@pytest.fixture(scope="module")
def shots():
    volume, rng = random_volume(np.random.default_rng(7)), np.random.default_rng(8)
    return [Shot(SMALL, random_pose(rng, volume), n / 24) for n in range(COUNT)]


@pytest.fixture(scope="module")
def truth(scene, shots):
    return render_batch(scene, SMALL, [shot.camera_to_room for shot in shots])


@pytest.mark.parametrize("words", [{}, {"threads": 2}, {"jobs": 2}])
def test_a_stream_has_the_bytes_of_a_batch(scene, shots, truth, words):
    found = list(render_stream(scene, shots, **words))
    assert np.array_equal([one.colour for one in found], truth.colour)
    assert np.array_equal([one.depth_m for one in found], truth.depth_m)


@pytest.mark.parametrize("jobs", [1, 2])
def test_pictures_are_written_in_order_with_progress(scene, shots, truth, tmp_path, jobs):
    told = []

    def write(number, shot, picture):
        path = tmp_path / f"{number}.jpg"
        path.write_bytes(colour_bytes(picture.colour, ".jpg"))
        return path.name, shot.t_s

    stream = render_stream(
        scene, shots, write=write, encode_threads=2, jobs=jobs,
        progress=lambda stage, done, total, note="": told.append((stage, done, total)),
    )  # fmt: skip
    assert list(stream) == [(f"{n}.jpg", n / 24) for n in range(COUNT)]
    assert told == [("render", n, COUNT) for n in range(COUNT + 1)]
    for number in range(COUNT):
        want = colour_bytes(truth.colour[number], ".jpg")
        assert (tmp_path / f"{number}.jpg").read_bytes() == want


def test_an_error_of_the_writer_ends_the_stream(scene, shots):
    def write(number, shot, picture):
        if number == 1:
            raise OSError("the disk is full")
        return number

    with pytest.raises(OSError, match="the disk is full"):
        list(render_stream(scene, shots, write=write))


def test_an_error_of_the_renderer_ends_the_stream(scene, shots):
    with pytest.raises(ValueError, match="unknown output"):
        list(render_stream(scene, shots, outputs=("smell",)))


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ({"jobs": 0}, "jobs must be 1 to 256, got 0"),
        ({"encode_threads": 0}, "encode_threads must be 1 to 256, got 0"),
    ],
)
def test_numbers_out_of_range_are_told_at_once(scene, shots, words, text):
    with pytest.raises(UsageError) as caught:
        render_stream(scene, shots, **words)
    assert str(caught.value) == text


def test_no_shots_give_nothing(scene):
    assert list(render_stream(scene, [])) == []
    assert list(render_stream(scene, [], write=lambda *_: 1, jobs=2)) == []


def test_the_exposure_of_the_scene_counts(scene, shots):
    from dataclasses import replace

    dark = replace(scene, exposure=0.7)
    first = next(iter(render_stream(dark, shots)))
    assert np.array_equal(first.colour, render_volume(dark, SMALL, shots[0].camera_to_room).colour)


def test_ahead_is_bounded_and_ends_with_its_user():
    taken, closed = [], threading.Event()

    def things():
        try:
            for n in count():
                taken.append(n)
                yield n
        finally:
            closed.set()

    stream = prefetch(things(), 2)
    assert [next(stream) for _ in range(3)] == [0, 1, 2]
    stream.close()
    assert closed.is_set()
    assert len(taken) <= 3 + 2 + 2  # Two wait, one is in hand, one was let through at the end.


def test_ahead_overlaps_with_its_user():
    """The second thing is made while the first is used, or this waits for ever."""
    second = threading.Event()

    def things():
        yield 0
        second.set()
        yield 1

    stream = prefetch(things())
    assert next(stream) == 0
    assert second.wait(30)
    assert list(stream) == [1]


def test_work_is_done_behind_in_order_and_bounded():
    taken = []

    def things():
        for n in range(20):
            taken.append(n)
            yield n

    stream = ordered_map(things(), lambda n: n * n, threads=3, most=5)
    assert next(stream) == 0
    assert len(taken) <= 5
    assert list(stream) == [n * n for n in range(1, 20)]


def test_a_failed_work_stops_the_taking():
    taken, failed = [], threading.Event()

    def things():
        for n in range(100):
            taken.append(n)
            yield n
            if n == 1:
                failed.wait(30)

    def work(n):
        if n == 1:
            failed.set()
            raise RuntimeError("broken")
        return n

    with pytest.raises(RuntimeError, match="broken"):
        list(ordered_map(things(), work, threads=1, most=50))
    assert len(taken) <= 5

"""A stream of pictures: those that come are drawn while those that went are written."""

from collections.abc import Callable, Collection, Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, silent
from world2minecraft.rendering.batch.ahead import SPARE, ahead_of, done_behind
from world2minecraft.rendering.batch.pool import MOST_WORKERS, RenderPool
from world2minecraft.rendering.light import LookLight
from world2minecraft.rendering.light_parameters import DAY, Paper, exposure_of
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS, Picture, render_volume
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.views.poses import Shot

Pictures = Generator[tuple[int, Picture], None, None]
Write = Callable[[int, Shot, Picture], Any]

MOST_WRITERS = 256


def render_stream(
    scene: BlockScene,
    shots: Sequence[Shot],
    *,
    outputs: Collection[str] = DEFAULT_OUTPUTS,
    light: LookLight = DAY,
    samples: int = 1,
    threads: int = 1,
    background: Paper | None = None,
    write: Write | None = None,
    encode_threads: int = 1,
    jobs: int = 1,
    progress: Progress = silent,
) -> Iterator[Any]:
    """Take the pictures of shots, and write each while the next ones are drawn.

    All share one exposure, that of all the eyes together, unless the light or the scene names one.
    Order is kept; memory holds a few pictures; the first error ends the stream.

    Args:
        scene: ``prepare_scene`` of a volume.
        shots: from where, through cameras of any sizes.
        outputs: as in ``render_volume``; depth, range, block and face always come.
        light: the hour, the exposure and the like.
        samples: a pixel's colour is the mean of so many by so many.
        threads: how many draw one picture; with several jobs each draws alone.
        background: sRGB colours of the first and last row behind all; None for the sky.
        write: called with the number, the shot and the picture, on one of ``encode_threads``;
            what it returns is given in the picture's place. Without it the pictures themselves
            are given, and drawn ahead of their user.
        encode_threads: how many pictures are written at once.
        jobs: how many processes draw; see ``RenderPool``.
        progress: told the pictures that are done, as stage ``render``.

    Raises:
        UsageError: what is asked for cannot be. WorkerError: a process died.
    """
    for name, value, most in (
        ("encode_threads", encode_threads, MOST_WRITERS),
        ("jobs", jobs, MOST_WORKERS),
    ):
        if not 1 <= value <= most:
            raise UsageError(f"{name} may be 1 to {most}, not {value}")
    eyes = [apply(scene.room_to_grid, shot.camera_to_room[:3, 3]) for shot in shots]
    if shots:
        scene = replace(scene, exposure=exposure_of(light, scene, np.array(eyes)))
    words: dict[str, Any] = {
        "outputs": outputs, "light": light, "samples": samples, "background": background
    }  # fmt: skip
    pictures = (
        _by_processes(scene, shots, jobs, words)
        if jobs > 1 and len(shots) > 1
        else _one_by_one(scene, shots, threads, words)
    )
    return _stream(pictures, shots, write, encode_threads, progress)


def _stream(
    pictures: Pictures,
    shots: Sequence[Shot],
    write: Write | None,
    encode_threads: int,
    progress: Progress,
) -> Iterator[Any]:
    progress("render", 0, len(shots))
    if write is None:
        results = ahead_of(pictures, SPARE)
    else:
        given = write

        def work(one: tuple[int, Picture]) -> Any:
            return given(one[0], shots[one[0]], one[1])

        results = done_behind(pictures, work, encode_threads, encode_threads + SPARE)
    with closing(pictures), closing(results):
        for done, result in enumerate(results, 1):
            progress("render", done, len(shots))
            yield result[1] if write is None else result


def _one_by_one(
    scene: BlockScene, shots: Sequence[Shot], threads: int, words: dict[str, Any]
) -> Pictures:
    for number, shot in enumerate(shots):
        camera, pose = shot.camera, shot.camera_to_room
        yield number, render_volume(scene, camera, pose, threads=threads, **words)


def _by_processes(
    scene: BlockScene, shots: Sequence[Shot], jobs: int, words: dict[str, Any]
) -> Pictures:
    cameras = [shot.camera for shot in shots]
    poses = [shot.camera_to_room for shot in shots]
    with RenderPool(scene, min(jobs, len(shots))) as pool:
        yield from pool.render(cameras, np.array(poses), **words)

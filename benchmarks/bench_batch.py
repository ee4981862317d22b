"""Batches, pools and the images of a data set: CPU time per image, memory and total hours.

``python -m benchmarks --only batch``. Small images are rendered in one call and in a loop of
``render_volume``, alternately. Then a slice of a data set is rendered and written as JPEG by as
many processes as there are cores: CPU time is counted in the processes themselves, rendering and
encoding separately, and extrapolated to 100,000 images on two cores. ``W2M_SLICE=500`` sets a
larger slice.
"""

import io
import os
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.render_scenes import camera_of, poses, room, small
from benchmarks.rows import Row
from world2minecraft.core.machine import usable_cores
from world2minecraft.rendering import BlockScene, Picture, prepare_scene, render_volume
from world2minecraft.rendering.batch import RenderPool, batch_arrays, render_batch
from world2minecraft.rendering.output import colour_bytes

SMALL_PX, POSES, ROUNDS = (64, 128, 224), 1000, 2  # Of the rounds the least counts.
LOOPED = 200  # Of the poses, in the loop: it is the slower.
WIDTH, HEIGHT, SLICE = 1920, 1129, 60
IMAGES, CORES, BUDGET_H, BUDGET_MS = 100_000, 2, 2.5, 180.0
QUALITY = 90


def run() -> list[Row]:
    """Measure all of it."""
    volume = room(4.0)
    scene = prepare_scene(volume)
    looks = np.array(poses(volume, POSES, 3))
    rows = [row for side in SMALL_PX for row in _small(scene, side, looks)]
    count = int(os.environ.get("W2M_SLICE", SLICE))
    looks = np.array(poses(volume, count, 11))
    rows += _encoders(scene, looks[:4])
    for workers in sorted({1, usable_cores()}):
        rows += _data_set("room", scene, looks, workers)
    flats = small()
    looks = np.array(poses(flats, count, 11))
    return rows + _data_set("flats", prepare_scene(flats), looks, usable_cores())


def _small(scene: BlockScene, side: int, looks: np.ndarray) -> list[Row]:
    """Return the CPU of a picture in one call and in a loop; the least of some rounds."""
    camera = camera_of(side, side)
    words = {"outputs": ("colour", "depth")}
    out = batch_arrays(len(looks), (side, side), words["outputs"])
    works: list[tuple[int, Callable[[], object]]] = [
        (len(looks), lambda: render_batch(scene, camera, looks, out=out, **words)),
        (LOOPED, lambda: [render_volume(scene, camera, one, **words) for one in looks[:LOOPED]]),
    ]
    least = [np.inf, np.inf]
    for _ in range(ROUNDS):
        for number, (count, work) in enumerate(works):
            start = time.process_time()
            work()
            least[number] = min(least[number], 1000 * (time.process_time() - start) / count)
    one_call, loop = least
    what = f"{side}x{side}, rgb and depth"
    return [
        Row(f"{what}: {len(looks):,} poses in one call", one_call, "ms a picture", None,
            "a loop of render_volume", loop / one_call),
        Row(f"{what}: a loop of render_volume", loop, "ms a picture"),
    ]  # fmt: skip


def _data_set(name: str, scene: BlockScene, looks: np.ndarray, workers: int) -> list[Row]:
    """Return what an image of a data set costs, drawn and written by processes."""
    camera, count = camera_of(WIDTH, HEIGHT), len(looks)
    cpu, wall, encode = np.inf, np.inf, np.inf
    with tempfile.TemporaryDirectory() as folder, RenderPool(scene, workers) as pool:
        make = partial(write_jpeg, folder)
        list(pool.render(camera, looks[: 2 * workers], make=make))
        for _ in range(ROUNDS):
            before, began = _spent(pool), time.perf_counter()
            made = [value for _, value in pool.render(camera, looks, make=make)]
            cpu = min(cpu, 1000 * (_spent(pool) - before) / count)
            wall = min(wall, 1000 * (time.perf_counter() - began) / count)
            encode = min(encode, 1000 * float(np.mean([seconds for seconds, _ in made])))
        peak_mb = sum(_peak_mb(hand.process.pid) for hand in pool._hands)
    kilobytes = float(np.mean([size for _, size in made])) / 1000
    hours = cpu / 1000 * IMAGES / CORES / 3600
    processes = "1 process" if workers == 1 else f"{workers} processes"
    head = f"{name}, {count} images {WIDTH}x{HEIGHT}, {processes}"
    return [
        Row(f"{head}: rgb, depth, ids, and JPEG", cpu, "ms an image", BUDGET_MS, peak_mb=peak_mb),
        Row(f"{head}: of that, the JPEG of {kilobytes:.0f} kB", encode, "ms an image"),
        Row(f"{head}: by the clock", wall, "ms an image"),
        Row(f"{head}: {IMAGES:,} on {CORES} cores, extrapolated", hours, "h", BUDGET_H),
    ]


def _encoders(scene: BlockScene, looks: np.ndarray) -> list[Row]:
    """Return what a JPEG costs by those who can make one; simplejpeg where it is installed."""
    camera = camera_of(WIDTH, HEIGHT)
    pictures = [render_volume(scene, camera, one, outputs=("colour",)).colour for one in looks]

    def pillow(picture: np.ndarray, subsampling: int) -> None:
        Image.fromarray(picture).save(
            io.BytesIO(), "JPEG", quality=QUALITY, subsampling=subsampling
        )

    works = {"Pillow, 4:4:4": partial(pillow, subsampling=0)}
    works["Pillow, 4:2:0"] = partial(pillow, subsampling=2)
    try:
        from simplejpeg import encode_jpeg

        for kind in ("444", "420"):
            name = f"simplejpeg, {':'.join(kind)}"
            works[name] = partial(encode_jpeg, quality=QUALITY, colorsubsampling=kind)
    except ImportError:
        pass
    rows = []
    for name, work in works.items():
        least = np.inf
        for _ in range(2 * ROUNDS):
            start = time.process_time()
            for picture in pictures:
                work(picture)
            least = min(least, 1000 * (time.process_time() - start) / len(pictures))
        rows.append(Row(f"JPEG {WIDTH}x{HEIGHT} by {name}", least, "ms an image"))
    return rows


def write_jpeg(folder: str, number: int, picture: Picture) -> tuple[float, int]:
    """Write a picture; return the seconds of CPU that it took, and its bytes."""
    start = time.thread_time()
    if picture.colour is None:
        raise ValueError("the picture has no colour")
    data = colour_bytes(picture.colour, ".jpg", QUALITY)
    Path(folder, f"{number:06d}.jpg").write_bytes(data)
    return time.thread_time() - start, len(data)


def _spent(pool: RenderPool) -> float:
    """Return the seconds of CPU of a pool's processes, and of this one, so far."""
    return time.process_time() + sum(_cpu_s(hand.process.pid) for hand in pool._hands)


def _cpu_s(process: int | None) -> float:
    """Return the seconds of CPU that a process has used, as the system counts them."""
    stat = Path(f"/proc/{process}/stat")
    if not stat.is_file():
        raise SystemExit("the CPU time of processes is read from /proc, which is on Linux alone")
    words = stat.read_text().rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def _peak_mb(process: int | None) -> float:
    """Return the most memory that a process has had of its own and shared."""
    status = Path(f"/proc/{process}/status").read_text()
    (line,) = [line for line in status.splitlines() if line.startswith("VmHWM")]
    return int(line.split()[1]) / 1000


if __name__ == "__main__":
    for row in run():
        print(row, file=sys.stdout)

"""The ray caster and the virtual scan: milliseconds of CPU a picture, seconds a capture."""

import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.rows import Row
from world2minecraft.coordinates import block_to_room, look_at
from world2minecraft.render import prepare_scene, preview, render_volume
from world2minecraft.rooms import generate_room, scan_room
from world2minecraft.rooms.room import Room
from world2minecraft.types import BlockVolume, Camera

ROUNDS = 12
PALETTE = (
    "minecraft:air",
    "minecraft:white_concrete",
    "minecraft:oak_planks",
    "minecraft:light_blue_stained_glass",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
)
STATE_OF_CLASS = np.array([0, 1, 2, 1, 3, 4, 1, 1, 2, 1, 2, 2], np.uint16)


def run() -> list[Row]:
    """Measure; CPU time of the least of some rounds, because the machine may be shared."""
    room = generate_room(1, kind="living")
    rows = []
    for blocks_per_metre in (4.0, 12.5):
        volume = volume_of_room(room, blocks_per_metre)
        rows += _pictures(volume, f"{blocks_per_metre:g} blocks a metre")
        seconds = _least(lambda volume=volume: preview(volume, 960, 720), 2)
        rows.append(Row(f"preview 960x720, {blocks_per_metre:g} blocks a metre", seconds, "s"))
    rows.append(_scan(room))
    return rows


def volume_of_room(room: Room, blocks_per_metre: float) -> BlockVolume:
    """Sample a generated room at the middle of each block."""
    step = 1 / blocks_per_metre / room.voxel_m
    picks = [np.arange(step / 2, side, step).astype(int) for side in room.labels.shape]
    labels = np.swapaxes(room.labels[np.ix_(*picks)][:, ::-1], 1, 2)
    states = np.ascontiguousarray(STATE_OF_CLASS[labels])
    return BlockVolume(
        states=states,
        palette=PALETTE,
        semantic=np.ascontiguousarray(labels),
        instance=np.zeros_like(states),
        corner=(-1, 63, -1),
        block_to_room=block_to_room(np.array([0.0, float(room.size_m[1])]), blocks_per_metre),
    )


def _pictures(volume: BlockVolume, name: str) -> list[Row]:
    scene = prepare_scene(volume)
    pose = look_at(np.array([0.6, 0.6, 1.6]), np.array([3.0, 2.4, 0.8]))
    rows = []
    for width, height, budget in ((640, 480, 15.0), (1920, 1129, 120.0)):
        camera = Camera(width, height, 0.6 * width, 0.6 * width, width / 2, height / 2)
        seconds = _least(lambda camera=camera: render_volume(scene, camera, pose), ROUNDS)
        what = f"render rgb, depth, ids {width}x{height}, {name}"
        rows.append(Row(what, 1000 * seconds, "ms", budget))
        seconds = _least(
            lambda camera=camera: render_volume(scene, camera, pose, outputs=()), ROUNDS
        )
        rows.append(Row(f"render depth, ids {width}x{height}, {name}", 1000 * seconds, "ms"))
    return rows


def _scan(room: Room) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        scan_room(room, Path(folder) / "warm", frames=1, width=320, height=240)
        start = time.process_time()
        scan_room(room, Path(folder) / "scan", frames=40)
        seconds = time.process_time() - start
    # Kilobytes on Linux, bytes on macOS.
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    peak_mb = peak / (1 << 20 if sys.platform == "darwin" else 1 << 10)
    return Row(
        "virtual scan, 40 frames 640x480, files and truth", seconds, "s", 6.0, peak_mb=peak_mb
    )


def _least(work: Callable[[], object], rounds: int) -> float:
    work()
    times = []
    for _ in range(rounds):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)

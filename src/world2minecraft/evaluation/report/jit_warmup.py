"""Compilation of the report's rendering kernels in a second process, parallel to the first stages.

Without this, a third of the first run after an installation would be spent waiting for these
kernels. The process, ``python -m world2minecraft.evaluation.report.jit_warmup``, renders a small
box of blocks with the functions of the report, and numba caches the kernels for the run. If the
process fails, the run compiles the kernels itself.
"""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.jit import is_compiled
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.types import BlockVolume, Camera, Scan, View
from world2minecraft.evaluation.report.comparison_pictures import make_pairs
from world2minecraft.rendering.preview import plan_view, preview
from world2minecraft.rendering.ray_caster.picture_kernel import draw_rows
from world2minecraft.rendering.scene import prepare_scene

# Cached last, when all that it calls is compiled.
LAST = f"{draw_rows.__module__.rpartition('.')[2]}.{draw_rows.__name__}"
PATIENCE_S = 120.0  # For the process to end by itself, once the run needs what it makes.


@contextmanager
def compile_pictures_meanwhile() -> Iterator[None]:
    """Compile the kernels of the report while the ``with`` block runs, once per installation.

    Nothing happens on a machine with a single core. If the block fails, the process is terminated.
    """
    if is_compiled(LAST) or usable_cores() < 2:
        yield
        return
    nowhere = subprocess.DEVNULL
    words = [sys.executable, "-m", "world2minecraft.evaluation.report.jit_warmup"]
    process = subprocess.Popen(words, stdin=nowhere, stdout=nowhere, stderr=nowhere)
    try:
        yield
        process.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        pass
    finally:
        process.kill()
        process.wait()


def draw_box() -> None:
    """Render a box of blocks with all functions that the report uses for a room."""
    volume = _box()
    make_pairs(_look_at_it(), prepare_scene(volume))
    plan_view(volume, px_per_block=2)
    preview(volume, width_px=64, height_px=48)


def _box() -> BlockVolume:
    """Return a room of 6 x 4 x 6 blocks with a stair, at one block per metre."""
    states = np.zeros((6, 4, 6), np.uint16)
    states[:, 0], states[0], states[:, :, 0] = 1, 1, 1
    states[3, 1, 3] = 2
    semantic = np.where(states > 0, np.uint8(3), np.uint8(0))
    semantic[:, 0], semantic[3, 1, 3] = 2, 5
    turned = np.array([[1, 0, 0, 0], [0, 0, -1, 6], [0, 1, 0, 0], [0, 0, 0, 1]], np.float64)
    palette = ("minecraft:air", "minecraft:stone", "minecraft:oak_stairs[facing=east]")
    return BlockVolume(states, palette, semantic, states // 2, (0, 0, 0), turned)


def _look_at_it() -> Scan:
    """Return a view of the box with colour and depth."""
    camera = Camera(64, 48, 40.0, 40.0, 31.5, 23.5)
    pose = look_at(np.array([5.0, 1.0, 3.0]), np.array([3.0, 3.0, 1.0]))
    colour, depth_m = np.zeros((48, 64, 3), np.uint8), np.ones((48, 64), np.float32)
    view = View("view", pose, colour, camera, depth_m, camera)
    return Scan((view,), np.eye(4), np.array([6.0, 6.0, 4.0]), ("view",))


if __name__ == "__main__":
    draw_box()

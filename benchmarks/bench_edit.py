"""Building into an existing world, undoing it and cleaning up: CPU time and peak memory."""

import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.render_scenes import room
from benchmarks.rows import Row
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.editing.build_into_world import build_into_world, remove_build
from world2minecraft.editing.cleanup.passes import repair_volume
from world2minecraft.editing.file_backups import list_steps, revert_step
from world2minecraft.minecraft.worlds.world_writer import write_world

SIZE = (256, 64, 256)
KINDS = tuple(
    f"minecraft:{colour}_{kind}"
    for colour in ("black", "blue", "green", "red", "white")
    for kind in ("concrete", "stained_glass", "terracotta", "wool")
)


def run() -> list[Row]:
    """Measure; the world is ground of stone, the build 1.76 million blocks of 20 kinds in it."""
    rng = np.random.default_rng(0)
    noise = (rng.random(SIZE) < 0.42) * rng.integers(1, len(KINDS) + 1, SIZE)
    ground = _volume(np.ones(SIZE), ("minecraft:stone",), (0, 0, 0))
    build = _volume(noise, KINDS, (0, 64, 0))
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "world"
        write_world(ground, world, name="Home", spawn=(0, 130, 0), spawn_yaw_deg=0)
        build_into_world(
            world, _volume(np.ones((2, 2, 2)), ("minecraft:stone",), (0, 70, 0))
        )  # Warm.
        rows = [
            _row("into a world, 1.76 M blocks", lambda: build_into_world(world, build)),
            _row("the same again: nothing changes", lambda: build_into_world(world, build)),
            _row("out again, block by block", lambda: remove_build(world)),
        ]
        build_into_world(world, build)
        rows.append(_row("undo, byte by byte", lambda: revert_step(list_steps(world)[-1])))
    built = room(4.0)
    repair_volume(built)
    rows.append(_row("clean-up, a room at 4 blocks a metre", lambda: repair_volume(built)))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    peak_mb = peak / (1 << 20 if sys.platform == "darwin" else 1 << 10)
    return [*rows[:-1], Row(rows[-1].what, rows[-1].value, "s", peak_mb=round(peak_mb, 1))]


def _row(what: str, act: Callable[[], Any]) -> Row:
    begun = time.process_time()
    act()
    return Row(what, round(time.process_time() - begun, 3), "s")


def _volume(
    states: np.ndarray, kinds: tuple[str, ...], corner: tuple[int, int, int]
) -> BlockVolume:
    zeros = np.zeros(states.shape, np.uint8)
    numbers = states.astype(np.uint16)
    return BlockVolume(numbers, (AIR, *kinds), zeros, zeros.astype(np.uint16), corner, np.eye(4))

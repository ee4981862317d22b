"""Connections, stability and light of a room of blocks, as the builder computes them."""

import time
from collections.abc import Callable

import numpy as np

from benchmarks.rows import Row
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.rules.light import block_light
from world2minecraft.minecraft.rules.stability import find_unstable_cells

SHAPE = (120, 80, 80)  # A room of 30 x 20 x 20 m at 4 blocks a metre: far more than most.
FILLED = 0.03
REPEATS = 5
PALETTE = (
    "minecraft:air", "minecraft:stone", "minecraft:glass_pane", "minecraft:oak_fence",
    "minecraft:cobblestone_wall", "minecraft:oak_stairs[facing=north]",
    "minecraft:oak_stairs[facing=east]", "minecraft:oak_fence_gate[facing=west]",
    "minecraft:torch", "minecraft:red_carpet", "minecraft:lantern[hanging=true]",
    "minecraft:oak_slab[type=top]", "minecraft:chest[facing=south]", "minecraft:iron_bars",
)  # fmt: skip


def run() -> list[Row]:
    """Measure each, the best of a few runs after one to fill the tables."""
    random = np.random.default_rng(0)
    states = random.integers(1, len(PALETTE), SHAPE).astype(np.uint16)
    states[random.random(SHAPE) > FILLED] = 0
    labels = np.zeros(SHAPE, np.uint8)
    volume = BlockVolume(states, PALETTE, labels, labels.astype(np.uint16), (0, 0, 0), np.eye(4))
    return [
        Row("connections of a room", best(lambda: update_connections(states, PALETTE)), "ms", 50.0),
        Row("what of it would not stay", best(lambda: find_unstable_cells(states, PALETTE)), "ms"),
        Row("its block light", best(lambda: block_light(volume)), "ms"),
    ]


def best(work: Callable[[], object]) -> float:
    """Return the milliseconds of the quickest of a few runs."""
    work()
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times) * 1000

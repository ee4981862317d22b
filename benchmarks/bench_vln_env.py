"""A step of the navigation environment, and of its physics alone.

The rival's figure is the one MineStudio documents for its environment: 38 to 45 frames per
second. Rates are per CPU second of one process, the median of ``RUNS`` runs of ``STEPS`` random
moves through a house of six rooms; the row "slowest" shows the spread.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks.rows import Row
from world2minecraft.navigation.environment.action_spaces import ContinuousActions
from world2minecraft.navigation.environment.env import VlnEnv
from world2minecraft.navigation.moves import apply_move
from world2minecraft.navigation.scene import VlnScene, open_scene
from world2minecraft.navigation.types import Move
from world2minecraft.procgen.worlds import generate_world, write_house

SEED, ROOMS = 700, 6
RUNS, STEPS, MOVES, TICKS = 5, 60, 4_000, 200
STEP_RATE, MOVE_RATE = 150.0, 20_000.0
RIVAL = "MineStudio, as documented (45/s at best)"
RIVAL_RATE = 45.0


def run() -> list[Row]:
    """Return the figures of a house of seed 700."""
    with tempfile.TemporaryDirectory() as folder:
        house = Path(folder) / "house"
        write_house(generate_world(SEED, rooms=ROOMS), house, name="house")
        scene = open_scene(house)
    everything = ("rgb", "depth", "semantic", "pose", "instruction")
    usual = _rates(_steps(VlnEnv(scene, observations=("rgb", "pose", "instruction"))))
    whole = median(_rates(_steps(VlnEnv(scene, observations=everything))))
    bodies = median(_rates(_bodies(scene)))
    rate, slowest = median(usual), min(usual)
    rows = [
        Row("steps, rgb 224x224, pose and instruction", rate, "/s", STEP_RATE, RIVAL,
            rate / RIVAL_RATE),
        Row("the slowest of 5 runs", slowest, "/s"),
        Row("steps, depth and classes too", whole, "/s"),
        Row("moves of the body alone", bodies, "/s", MOVE_RATE),
        Row("ticks of the game's physics alone", median(_rates(_ticks(scene))), "/s"),
        Row("reset, the oracle's way with it", 1000 / median(_rates(_resets(scene))), "ms"),
    ]  # fmt: skip
    return rows


def _rates(work: Callable[[], int]) -> list[float]:
    """Return how often a second of CPU some work was done, run by run; the first is not counted."""
    work()
    rates = []
    for _ in range(RUNS):
        begin = time.process_time()
        count = work()
        rates.append(count / (time.process_time() - begin))
    return rates


def _steps(env: VlnEnv) -> Callable[[], int]:
    rng = np.random.default_rng(SEED)
    env.reset(seed=SEED)

    def work() -> int:
        for move in rng.integers(Move.FORWARD, len(Move), STEPS):
            _, _, _, over, _ = env.step(int(move))
            if over:
                env.reset()
        return STEPS

    return work


def _resets(scene: VlnScene) -> Callable[[], int]:
    env = VlnEnv(scene, observations=["pose"])

    def work() -> int:
        for seed in range(10):
            env.reset(seed=seed)
        return 10

    return work


def _bodies(scene: VlnScene) -> Callable[[], int]:
    moves = [Move(n) for n in np.random.default_rng(SEED).integers(1, len(Move), MOVES).tolist()]

    def work() -> int:
        stance = scene.start
        for move in moves:
            stance, _ = apply_move(scene, stance, move)
        return MOVES

    return work


def _ticks(scene: VlnScene) -> Callable[[], int]:
    acting = ContinuousActions(scene)
    rng = np.random.default_rng(SEED)
    turns = rng.uniform(-0.3, 0.3, (TICKS, 2)).astype(np.float32)
    keys = np.array([1, 0, 0, 0, 0, 0, 0], np.int8)

    def work() -> int:
        acting.begin(scene.start)
        for turn in turns:
            acting.act({"keys": keys, "camera": turn, "stop": 0})
        return TICKS

    return work

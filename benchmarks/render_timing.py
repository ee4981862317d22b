"""How long a picture takes: the processor's time of all threads, and the clock's, over many poses.

The rounds of everything that is compared are taken in turn, so that a busy machine is busy for all
of them; the least round counts, and the most tells the spread.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

ROUNDS = 2


class Timing(NamedTuple):
    """Milliseconds a picture, the mean over the poses of a round."""

    cpu_ms: float  # the least round's
    most_cpu_ms: float
    wall_ms: float  # the least

    @property
    def spread(self) -> float:
        """How much more the slowest round took than the fastest, as a share."""
        return self.most_cpu_ms / self.cpu_ms - 1


def time_all(
    works: Mapping[str, Callable[[np.ndarray], object]],
    poses: Sequence[np.ndarray],
    rounds: int = ROUNDS,
) -> dict[str, Timing]:
    """Return the timing of each work, called once a pose and round; one call warms it up."""
    spent: dict[str, list[tuple[float, float]]] = {name: [] for name in works}
    for work in works.values():
        work(poses[0])
    for _ in range(rounds):
        for name, work in works.items():
            cpu, wall = time.process_time(), time.perf_counter()
            for pose in poses:
                work(pose)
            took = time.process_time() - cpu, time.perf_counter() - wall
            spent[name].append(took)
    return {name: _timing(rows, len(poses)) for name, rows in spent.items()}


def _timing(rows: list[tuple[float, float]], count: int) -> Timing:
    cpu, wall = 1000 * np.array(rows).T / count
    return Timing(float(cpu.min()), float(cpu.max()), float(wall.min()))

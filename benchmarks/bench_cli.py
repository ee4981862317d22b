"""Time of ``w2m --help``: the median of nine fresh processes."""

import statistics
import subprocess
import sys
import time

from benchmarks.rows import Row

RUNS = 9


def run() -> list[Row]:
    """Measure the help text and the version line."""
    return [
        Row("w2m --help", _median_s("--help"), "s", budget=0.25),
        Row("w2m convert --help", _median_s("convert", "--help"), "s"),
        Row("python -c pass, for comparison", _median_s(), "s"),
    ]


def _median_s(*words: str) -> float:
    code = ["-m", "world2minecraft", *words] if words else ["-c", "pass"]
    return statistics.median(_seconds([sys.executable, *code]) for _ in range(RUNS))


def _seconds(command: list[str]) -> float:
    began = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - began

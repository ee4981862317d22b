"""What a first start spends on compiling: ``python -m benchmarks.compile_times [demo --out OUT]``.

The words are those of one ``w2m`` command, which runs here with an empty folder of kernels. Told
are CPU seconds of the process: of all of it, of compiling by package, and of the costliest kernels.
A kernel that another one calls is counted for itself.
"""

import os
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterable
from typing import Any, NamedTuple

MOST = 12  # Kernels that are told by name.


class Compiled(NamedTuple):
    """One compilation: the function's full name and its own CPU seconds."""

    name: str
    seconds: float


def measured(words: list[str]) -> tuple[int, float, list[Compiled]]:
    """Run a command; return its exit code, its CPU seconds and what it compiled."""
    began = time.process_time()
    from world2minecraft import jit  # Before numba: it names the folder of kernels.
    from world2minecraft.cli import run

    event = jit.numba.core.event
    found: list[Compiled] = []
    open_ones: list[list[float]] = []  # Of each at work: its start, and what those it calls took.

    class Listener(event.Listener):
        def on_start(self, event: object) -> None:
            open_ones.append([time.process_time(), 0.0])

        def on_end(self, event: Any) -> None:
            start, called = open_ones.pop()
            whole = time.process_time() - start
            function = getattr(event.data["dispatcher"], "py_func", None)
            name = f"{function.__module__}.{function.__name__}" if function else "numba"
            found.append(Compiled(name, whole - called))
            if open_ones:
                open_ones[-1][1] += whole

    event.register("numba:compile", Listener())
    code = run(words)
    return code, time.process_time() - began, found


def by_key(found: Iterable[Compiled], depth: int | None) -> list[tuple[str, float, int]]:
    """Return name, CPU seconds and number of compilations, costliest first; by package for 1."""
    seconds: dict[str, float] = defaultdict(float)
    counts: dict[str, int] = defaultdict(int)
    for one in found:
        path = one.name.removeprefix("world2minecraft.").split(".")
        key = ".".join(path[:depth])
        seconds[key] += one.seconds
        counts[key] += 1
    ordered = sorted(seconds, key=lambda key: (-seconds[key], key))
    return [(key, seconds[key], counts[key]) for key in ordered]


def main() -> int:
    with tempfile.TemporaryDirectory() as folder:
        os.environ["W2M_CACHE_DIR"] = folder
        words = sys.argv[1:] or ["demo", "--out", os.path.join(folder, "OUT")]
        code, whole, found = measured(words)
    spent = sum(one.seconds for one in found)
    print(f"w2m {' '.join(words)}: {whole:.1f} s of CPU,")
    print(f"{spent:.1f} s of it for {len(found)} kernels")
    for title, depth, most in (("packages", 1, None), ("kernels", None, MOST)):
        print(title)
        for name, seconds, count in by_key(found, depth)[:most]:
            print(f"  {seconds:5.1f} s  {count:3}  {name}")
    return code


if __name__ == "__main__":
    raise SystemExit(main())

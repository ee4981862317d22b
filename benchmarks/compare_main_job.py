"""CPU time, wall time and memory of ``w2m reconstruct`` beside an earlier commit, in one run.

``python -m benchmarks.compare_main_job CAPTURE [--commit 1f340e9] [--repeats 3] [--json FILE]``
checks the commit out beside the repository, warms both, and then runs in turn: the earlier commit,
this one with the stages that the earlier one has (no recognition of images, no repair), this one as
shipped, and this one on one core. ``--repeat-frames N`` first writes a capture that shows the
frames of CAPTURE N times, for the cost of longer videos. Printed are the least of each and the
ratios.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.clean_runs import ROOT, earlier_sources, environment_of
from world2minecraft.core.files import write_json

CALL = "import sys; from world2minecraft.cli import run; sys.exit(run(sys.argv[1:]))"
FORMER = ("--semantics", "none", "--set", "repair.enabled=no")


@dataclass(frozen=True)
class Cost:
    """The cost of one run.

    Attributes:
        cpu_s: Seconds of CPU of the process and its children.
        wall_s: Seconds that passed.
        peak_mb: Largest resident memory.
    """

    cpu_s: float
    wall_s: float
    peak_mb: float


def measure(source: Path, cache: Path, capture: Path, options: tuple[str, ...], cores: int) -> Cost:
    """Run ``w2m reconstruct`` of a source tree apart, on so many cores."""
    allowed = sorted(os.sched_getaffinity(0))[:cores]
    with tempfile.TemporaryDirectory() as folder:
        words = ["reconstruct", str(capture), "--out", f"{folder}/run", *options]
        begun = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-c", CALL, *words],
            env=environment_of(source, cache),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.sched_setaffinity(process.pid, allowed)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"w2m {' '.join(words)} of {source} exits with {process.returncode}")
    cpu_s = usage.ru_utime + usage.ru_stime
    return Cost(cpu_s, time.perf_counter() - begun, usage.ru_maxrss / 1024)


def least(costs: list[Cost]) -> Cost:
    """Return the least of each figure."""
    return Cost(
        min(one.cpu_s for one in costs),
        min(one.wall_s for one in costs),
        min(one.peak_mb for one in costs),
    )


def lengthened(capture: Path, times: int, out: Path) -> Path:
    """Write a capture that shows the ``frame-NNNNNN.*`` files of another so many times."""
    frames = sorted({path.name.split(".")[0] for path in capture.glob("**/frame-*.*")})
    (place,) = {path.parent for path in capture.glob("**/frame-*.*")}
    shutil.copytree(capture, out, ignore=shutil.ignore_patterns("frame-*"))
    target = out / place.relative_to(capture)
    for turn in range(times):
        for number, frame in enumerate(frames):
            for path in place.glob(f"{frame}.*"):
                suffix = path.name.partition(".")[2]
                os.symlink(path, target / f"frame-{turn * len(frames) + number:06d}.{suffix}")
    return out


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.compare_main_job")
    parser.add_argument("capture", type=Path)
    parser.add_argument("--commit", default="1f340e9")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--repeat-frames", type=int, default=1)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        base, capture = Path(folder), options.capture.resolve()
        with earlier_sources(options.commit, base / "former") as former:
            long = capture
            if options.repeat_frames > 1:
                long = lengthened(capture, options.repeat_frames, base / "capture")
            now = ROOT / "src"
            cores = len(os.sched_getaffinity(0))
            rows = {
                options.commit: (former, base / "a", (), cores),
                "now, the same stages": (now, base / "b", FORMER, cores),
                "now": (now, base / "b", (), cores),
                "now, one core": (now, base / "b", (), 1),
            }
            for source, cache, *job in rows.values():  # The first run compiles the kernels.
                measure(source, cache, capture, *job)
            costs: dict[str, list[Cost]] = {name: [] for name in rows}
            for _ in range(options.repeats):
                for name, (source, cache, *job) in rows.items():
                    costs[name].append(measure(source, cache, long, *job))
    found = {name: least(of) for name, of in costs.items()}
    before, same, new, alone = found.values()
    for name, cost in found.items():
        print(f"{name:<22}{cost.cpu_s:8.1f} s CPU{cost.wall_s:8.1f} s{cost.peak_mb:8.0f} MB")
    ratios = {
        "cpu_ratio_same_stages": same.cpu_s / before.cpu_s,
        "cpu_ratio": new.cpu_s / before.cpu_s,
        "wall_ratio_of_cores": new.wall_s / alone.wall_s,
    }
    print(json.dumps({name: round(value, 3) for name, value in ratios.items()}))
    if options.json:
        write_json(options.json, {name: asdict(cost) for name, cost in found.items()} | ratios)


if __name__ == "__main__":
    main()

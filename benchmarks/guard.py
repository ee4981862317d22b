"""A guard against regressions of speed: this tree beside an earlier commit, in about three minutes.

``python -m benchmarks.guard [--commit HEAD~1] [--repeats 3] [--limit 1.15]``

Both trees do the same small jobs in turn, in processes of their own with warm kernels: importing,
reconstructing a generated scan of 12 frames, building it, rendering it, and walking in it. Printed
is the CPU time of each job and its ratio to the earlier commit. The exit code is 1 if a job takes
more than ``--limit`` times as long; jobs under ``MIN_S`` only print their ratio.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.clean_runs import ROOT, earlier_sources, environment_of
from world2minecraft.procgen import generate_room, scan_room

FRAMES, SIZE = 12, (320, 240)
MIN_S = 0.05  # Less is within the noise of the clock and of caches.
JOBS = """
import json, sys, time
from pathlib import Path

begun = time.process_time()
import world2minecraft as w2m
import world2minecraft.runs

found = {"import": time.process_time() - begun}


def cost(name, work, times=3):
    work()
    costs = []
    for _ in range(times):
        begun = time.process_time()
        work()
        costs.append(time.process_time() - begun)
    found[name] = min(costs)


def walk():
    environment.reset(seed=1)
    for step in range(40):
        _, _, ended, cut, _ = environment.step(1 + step % 3)
        if ended or cut:
            environment.reset(seed=1)


scan, out = Path(sys.argv[1]), Path(sys.argv[2])
folders = iter(["first", "run"])
cost("reconstruct", lambda: w2m.reconstruct(scan, out / next(folders)), 1)
run = w2m.load(out / "run")
cost("build", lambda: w2m.build(run, out / "world", force=True))
cost("render from outside", lambda: w2m.render(run))
cost("render from inside", lambda: w2m.render(run, view="inside"))
environment = w2m.make_env(run)
cost("walk 40 steps", walk)
print("FOUND", json.dumps(found))
"""


def costs_of(source: Path, cache: Path, scan: Path) -> dict[str, float]:
    """Return the CPU seconds of each job of a source tree."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run(
            [sys.executable, "-c", JOBS, str(scan), out],
            env=environment_of(source, cache),
            check=False,
            capture_output=True,
            text=True,
        )
    if done.returncode:
        raise SystemExit(f"the jobs fail in {source}:\n{done.stderr[-2000:]}")
    return json.loads(done.stdout.split("FOUND ")[-1])


def main() -> int:
    """Measure, print, and return 1 if a job became slower than allowed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.guard")
    parser.add_argument("--commit", default="HEAD~1")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--limit", type=float, default=1.15)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder)
        with earlier_sources(options.commit, base / "former") as former:
            room = generate_room(3, kind="dining")
            scan_room(room, base / "scan", frames=FRAMES, width=SIZE[0], height=SIZE[1])
            trees = {"before": former, "now": ROOT / "src"}
            rounds: dict[str, list[dict[str, float]]] = {name: [] for name in trees}
            for turn in range(options.repeats + 1):
                for name, source in trees.items():
                    found = costs_of(source, base / f"cache-{name}", base / "scan")
                    if turn:  # The first compiles the kernels.
                        rounds[name].append(found)
    return report(rounds["before"], rounds["now"], options.limit)


def report(before: list[dict[str, float]], now: list[dict[str, float]], limit: float) -> int:
    """Print the least costs and their ratios; return 1 if a ratio is above the limit."""
    slower = 0
    for job in now[0]:
        old, new = (min(one[job] for one in rounds) for rounds in (before, now))
        over = new > limit * old and new > MIN_S
        slower += over
        mark = f"  slower than {limit:g} times" if over else ""
        print(f"{job:<22}{old:8.3f} s{new:8.3f} s{new / old:7.2f}{mark}")
    return int(slower > 0)


if __name__ == "__main__":
    sys.exit(main())

"""The navigation quick start, timed: from a scan to a video of an agent that finds the table.

``python -m benchmarks.check_quickstart [CAPTURE] [--out FOLDER]`` runs the commands of the docs in
order, without a network; without a capture a generated room is scanned. The exit code is 1 if a
command fails, the agent does not stop at the table, or the total exceeds five minutes of one core.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MOST_S = 300.0
SEED, KIND = "7", "dining"


def main(words: list[str]) -> int:
    """Run the commands, print a line each, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("capture", nargs="?", type=Path)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--say", default="Go to the table")
    options = parser.parse_args(words)
    with tempfile.TemporaryDirectory() as scratch:
        return _path(options.capture, (options.out or Path(scratch)).resolve(), options.say)


def _path(capture: Path | None, out: Path, say: str) -> int:
    commands = []
    if capture is None:
        capture = out / "scan"
        commands.append(["rooms", "scan", "--seed", SEED, "--kind", KIND, "--out", str(capture)])
    commands.append(["reconstruct", str(capture), "--out", str(out / "ROOM")])
    commands.append(["vln", "run", str(out / "ROOM"), say, "--out", str(out / "RUN")])
    begin, before = time.monotonic(), _cpu_s()
    for command in commands:
        if not _timed(command, out):
            return 1
    wall_s, cpu_s = time.monotonic() - begin, _cpu_s() - before
    result = json.loads((out / "RUN" / "result.json").read_text())["episodes"][0]
    film = out / "RUN" / "walk.mp4"
    reached = result["end"] == "stopped" and result["score"]["success"][0]
    print(
        f"all: {wall_s:.0f} s, {cpu_s:.0f} s of CPU; stopped {result['score']['ne_m']:.2f} m from "
        f"the goal after {result['score']['steps']} steps; film of {film.stat().st_size:,} bytes"
    )
    return int(not reached or cpu_s > MOST_S)


def _timed(command: list[str], out: Path) -> bool:
    begin, before = time.monotonic(), _cpu_s()
    out.mkdir(parents=True, exist_ok=True)
    words = [sys.executable, "-m", "world2minecraft", *command]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    print(
        f"w2m {' '.join(command[:2])}: {time.monotonic() - begin:.0f} s, "
        f"{_cpu_s() - before:.0f} s of CPU"
    )
    if done.returncode:
        print(done.stdout[-2000:] + done.stderr[-2000:])
    return done.returncode == 0


def _cpu_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

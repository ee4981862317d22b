"""Reconstruct every real room of the shared inputs, and write what is right and what is not.

``python -m benchmarks.real_captures DATA --out DIR [--only NAME ...] [--nyu N] [--stability]
[--set KEY=VALUE] [--from STAGE] [--json FILE]``

A row per scene: whether it ran, or why not; the tilt and the height of its floor against a
reference; the share of labelled surface with its true class; the number of objects; the share of
wall surface labelled wall; stability; and CPU time. docs/results/real-captures.md explains the
columns.
``DIR/NAME`` holds the run of a scene and its contact sheet, ``sheet.png``; ``DIR/results.json`` and
``DIR/table.md`` hold all results; the last line of the latter is one of the table over time.

A scene that has a result of the same settings is not run again, so that an interrupted benchmark
continues. The program's code is not compared: use a new folder after it has changed, ``--again``,
or ``--from label`` to repeat later stages of the existing runs only.
"""

import argparse
import subprocess
import sys
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

import world2minecraft
from benchmarks.real_captures.running import Options, Row, run_scene, stored_result
from benchmarks.real_captures.scenes import Scene, list_scenes
from benchmarks.real_captures.tables import class_lines, markdown_table, overview, terminal_table
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.files import write_json, write_text
from world2minecraft.reconstruction.pipeline import STAGES


def main(words: Sequence[str]) -> int:
    """Run what ``words`` select and return the exit code."""
    chosen = _parser().parse_args(words)
    if not chosen.data.is_dir():
        print(f"{chosen.data} is not a folder of shared inputs", file=sys.stderr)
        return 2
    options = Options(
        chosen.data.resolve(),
        chosen.out,
        tuple(chosen.set or ()),
        chosen.stability,
        chosen.start or "",
    )
    every = list_scenes(chosen.data, chosen.nyu)
    scenes = selected(every, chosen.only)
    if not scenes:
        names = ", ".join(dict.fromkeys(scene.group for scene in every))
        print(f"no scene matches {' '.join(chosen.only)}; scenes: {names}", file=sys.stderr)
        return 2
    print(f"the program is {Path(world2minecraft.__file__).parent}", file=sys.stderr)
    try:
        run_scenes(needed(scenes, every), options)
        rows = run_scenes(scenes, options, again=chosen.again or bool(chosen.start))
    except World2MinecraftError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    console = Console(width=None if sys.stdout.isatty() else 150)
    console.print(terminal_table(rows))
    for line in class_lines(rows):
        console.print(line)
    write_json(chosen.json or options.out / "results.json", rows)
    line = overview(rows, f"{datetime.now(UTC):%Y-%m-%d}", git_commit())
    write_text(options.out / "table.md", f"{markdown_table(rows)}\n{line}\n")
    return 0


def git_commit() -> str:
    """Return the short name of the program's commit, or ``unknown`` outside a repository."""
    words = ["git", "-C", str(Path(__file__).parent), "rev-parse", "--short=8", "HEAD"]
    done = subprocess.run(words, check=False, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def selected(scenes: Sequence[Scene], names: Sequence[str] | None) -> list[Scene]:
    """Return the scenes with the given names or groups; all without names."""
    return [one for one in scenes if not names or one.name in names or one.group in names]


def needed(scenes: Sequence[Scene], every: Sequence[Scene]) -> list[Scene]:
    """Return further scenes whose results are the truth of some of the scenes."""
    names = {one.reference.classes_of for one in scenes} - {one.name for one in scenes}
    return [one for one in every if one.name in names]


def run_scenes(scenes: Sequence[Scene], options: Options, *, again: bool = False) -> list[Row]:
    """Return the results of scenes, running those without a stored result.

    Args:
        scenes: Scenes in the order in which they run.
        options: Options of the benchmark.
        again: Whether stored results are ignored.
    """
    stored = {scene.name: None if again else stored_result(scene, options) for scene in scenes}
    left = [scene for scene in scenes if stored[scene.name] is None]
    if len(left) < len(scenes):
        print(f"{len(scenes) - len(left)} of {len(scenes)} scenes are done", file=sys.stderr)
    begun = time.monotonic()
    for done, scene in enumerate(left):
        seconds = (time.monotonic() - begun) / max(done, 1) * (len(left) - done)
        rest = f", about {seconds / 60:.0f} min left" if done else ""
        print(f"{scene.name} ({done + 1} of {len(left)}{rest})", file=sys.stderr, flush=True)
        stored[scene.name] = run_scene(scene, options)
    return [row for scene in scenes if (row := stored[scene.name]) is not None]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.real_captures", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("data", type=Path, help="folder of shared inputs, such as ../shared/data")
    parser.add_argument("--out", type=Path, required=True, help="folder of runs and results")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="scenes or groups to run")
    parser.add_argument("--nyu", type=int, default=22, help="NYUv2 validation frames (default 22)")
    parser.add_argument("--stability", action="store_true", help="measure stability too")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter"
    )
    parser.add_argument(
        "--from", dest="start", default="", choices=STAGES, help="repeat runs from this stage"
    )
    parser.add_argument("--again", action="store_true", help="ignore stored results")
    parser.add_argument("--json", type=Path, help="write the results to this file")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

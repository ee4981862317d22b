"""Run benchmarks of speed and checks of quality, each in a process of its own.

``python -m benchmarks`` runs every speed benchmark (``bench_NAME.py``) and prints its figures, with
its peak memory, beside their budgets and the rival measured in the same run; ``--json FILE`` writes
the figures too. ``--checks`` runs every quality check (``check_NAME.py``) that needs no input of
its own, with its default options. ``--only NAME ...`` selects benchmarks and checks by name, and
``--list`` prints one line for each. The exit code is 1 if a budget is missed or one of them fails.

A check with options, or one that needs input, is run as ``python -m benchmarks.check_NAME``.
"""

import argparse
import ast
import importlib
import json
import os
import platform
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks.rows import Row

FOLDER = Path(__file__).resolve().parent
# Checks that cannot run without arguments, and what they are given.
INPUTS = {
    "check_forge_view": "Node and a Chromium",
    "check_fuzz": "block files",
    "check_layouts": "runs, or layouts of LayoutGPT",
    "check_photos": "a capture, or --seeds",
    "check_segmentation": "frames of NYUv2",
    "check_tsdf": "frames and a run folder",
    "check_vln_oracle": "world folders",
}


def main(words: Sequence[str]) -> int:
    """Run what ``words`` select and return the exit code."""
    options = _options(words)
    if options.child:
        return _child(options.child)
    if options.list:
        print(listing())
        return 0
    selected = options.only or (ready_checks() if options.checks else names())
    rows, failed = [], []
    for name in selected:
        if name in checks():
            failed += [] if check(name) else [name]
            continue
        found = measure(name)
        if found is None:
            failed.append(f"bench_{name}")
        else:
            rows += [(name, row) for row in found]
    console = Console(width=None if sys.stdout.isatty() else 140)
    console.print(f"{machine()}")
    if rows:
        console.print(table(rows))
    for name in failed:
        console.print(f"{name}.py failed; its output is above")
    if options.json:
        text = json.dumps([{"bench": name, **asdict(row)} for name, row in rows], indent=1)
        options.json.write_text(text + "\n")
    missed = any(row.is_within_budget is False for _, row in rows)
    return int(missed or bool(failed))


def names() -> list[str]:
    """Return the names of all speed benchmarks, sorted."""
    return sorted(path.stem.removeprefix("bench_") for path in FOLDER.glob("bench_*.py"))


def checks() -> list[str]:
    """Return the names of all quality checks, sorted."""
    return sorted(path.stem for path in FOLDER.glob("check_*.py"))


def ready_checks() -> list[str]:
    """Return the checks that run without arguments."""
    return [name for name in checks() if name not in INPUTS]


def listing() -> str:
    """Return one line for each benchmark and check: its name and what it measures."""
    lines = ["Speed: python -m benchmarks [--only NAME ...]"]
    lines += [f"  {name:24} {_summary(f'bench_{name}')}" for name in names()]
    lines += ["", "Quality: python -m benchmarks --only NAME, or python -m benchmarks.NAME --help"]
    for name in checks():
        needed = f" (needs {INPUTS[name]})" if name in INPUTS else ""
        lines.append(f"  {name:24} {_summary(name)}{needed}")
    return "\n".join(lines)


def _summary(module: str) -> str:
    """Return the first line of a module's docstring, without importing the module."""
    tree = ast.parse((FOLDER / f"{module}.py").read_text("utf-8"))
    return (ast.get_docstring(tree) or "").partition("\n")[0]


def check(name: str) -> bool:
    """Run one check with its default options; return whether it passed."""
    print(f"== {name}", flush=True)
    command = [sys.executable, "-m", f"benchmarks.{name}"]
    return subprocess.run(command, check=False, cwd=FOLDER.parent).returncode == 0


def measure(name: str) -> list[Row] | None:
    """Run one benchmark in its own process; return None if it failed."""
    command = [sys.executable, "-m", "benchmarks", "--child", name]
    child = subprocess.run(
        command, check=False, stdout=subprocess.PIPE, text=True, cwd=FOLDER.parent
    )
    lines = child.stdout.splitlines()
    if child.returncode or not lines:
        return None
    return [Row(**fields) for fields in json.loads(lines[-1])]


def table(rows: Sequence[tuple[str, Row]]) -> Table:
    """Return the figures as a table."""
    result = Table(box=None, header_style="bold", pad_edge=False)
    for heading in ("bench", "what", "value", "budget", "", "against", "peak"):
        result.add_column(heading, justify="right" if heading in ("value", "budget") else "left")
    for name, row in rows:
        budget = "" if row.budget is None else f"{row.budget:g} {row.unit}"
        verdict = {True: "[green]ok[/]", False: "[red]MISSED[/]", None: ""}[row.is_within_budget]
        against = f"{row.ratio:.1f} x {row.rival}" if row.rival and row.ratio else row.rival or ""
        peak = "" if row.peak_mb is None else f"{row.peak_mb:.0f} MB"
        value = f"{row.value:.4g} {row.unit}"
        result.add_row(name, row.what, value, budget, verdict, against, peak)
    return result


def machine() -> str:
    """Describe what the figures depend on: the machine's cores, its load and the interpreter."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    is_idle = load == "unknown" or float(load) < 0.5 * (cores or 1)
    note = "" if is_idle else " (busy: figures suffer)"
    return f"{cores} cores, load {load}{note}, Python {platform.python_version()}"


def _child(name: str) -> int:
    """Run one benchmark in this process; the last line printed holds its rows and peak memory."""
    rows = importlib.import_module(f"benchmarks.bench_{name}").run()
    peak_mb = _peak_mb()
    fields = [{**asdict(row), "peak_mb": row.peak_mb or peak_mb} for row in rows]
    print("\n" + json.dumps(fields))
    return 0


def _peak_mb() -> float | None:
    try:
        import resource
    except ImportError:  # Windows has none.
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1e6 if sys.platform == "darwin" else 1e3 / 1.024)


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    known = [*names(), *checks()]
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--only", nargs="+", metavar="NAME", choices=known, help="run these")
    which.add_argument("--checks", action="store_true", help="run the checks that need no input")
    which.add_argument("--list", action="store_true", help="list all benchmarks and checks")
    parser.add_argument("--json", type=Path, help="write the figures of speed to this file")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Run every benchmark and print its figures beside their budgets.

``python -m benchmarks [--only NAME ...]`` runs each ``bench_NAME.py`` in a process of its own,
which tells its peak memory. It leaves with 1 where a budget is missed or a benchmark breaks.
``--json FILE`` writes the figures too.
"""

import argparse
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


def main(words: Sequence[str]) -> int:
    """Run what ``words`` ask for and return the exit code."""
    options = _options(words)
    if options.child:
        return _child(options.child)
    rows, broken = [], []
    for name in options.only or names():
        found = measure(name)
        if found is None:
            broken.append(name)
        else:
            rows += [(name, row) for row in found]
    console = Console(width=None if sys.stdout.isatty() else 140)
    console.print(f"{machine()}")
    console.print(table(rows))
    for name in broken:
        console.print(f"bench_{name}.py broke; its error is above")
    if options.json:
        text = json.dumps([{"bench": name, **asdict(row)} for name, row in rows], indent=1)
        options.json.write_text(text + "\n")
    missed = any(row.is_within_budget is False for _, row in rows)
    return int(missed or bool(broken))


def names() -> list[str]:
    """Return the names of all benchmarks, sorted."""
    return sorted(path.stem.removeprefix("bench_") for path in FOLDER.glob("bench_*.py"))


def measure(name: str) -> list[Row] | None:
    """Run one benchmark in its own process; None where it broke."""
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
    """Say what the figures depend on: the machine's cores, its load and the interpreter."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    note = (
        "" if load == "unknown" or float(load) < 0.5 * (cores or 1) else " (busy: figures suffer)"
    )
    return f"{cores} cores, load {load}{note}, Python {platform.python_version()}"


def _child(name: str) -> int:
    """Run one benchmark here; the last line printed holds its rows and the peak memory."""
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
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--only", nargs="+", metavar="NAME", choices=names(), help="run these")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

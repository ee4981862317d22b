"""Put small faults into the code and say which of them no test notices.

``python -m tools.mutants [--only GROUP ...]`` runs the groups of ``plan.toml`` and prints a table
by module. Each outcome is a line of ``--log``; ``--again`` tries those that survived in it once
more. It leaves with 1 where a fault survives that ``explained.toml`` does not explain.
"""

import argparse
import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
LIBRARIES = ROOT / ".mutants"  # Where `make mutants` puts cosmic-ray.
NOTICED = ("killed", "killed by time")

Key = tuple[str, str]  # Module and change.


def main(words: Sequence[str]) -> int:
    """Run what ``words`` ask for and return the exit code."""
    options = _options(words)
    plan = tomllib.loads((FOLDER / "plan.toml").read_text())
    if options.child:
        return _child(plan[options.child], options)
    log = Path(options.log)
    if options.again:
        log.with_suffix(".again.json").write_text(json.dumps(_survivors_of(_rows(log))))
    log.write_text("")
    code = 0
    for name in options.only or plan:
        code |= _run(name, plan[name], options)
    rows = _rows(log)
    explained = {_key(row): row["why"] for row in _explanations()}
    console = Console(width=None if sys.stdout.isatty() else 160)
    console.print(_table(rows, explained))
    unexplained = [row for row in _survivors_of(rows) if _key(row) not in explained]
    for row in unexplained:
        console.print(f"{row['module']}:{row['line']}  {row['change']}", markup=False)
    for row in rows:
        if "left_out" in row:
            console.print(f"left out: {row['left_out']} {row['why']}", markup=False)
    return int(code or bool(unexplained))


def _run(name: str, group: dict[str, Any], options: argparse.Namespace) -> int:
    """Run a group in a process of its own; return its exit code."""
    words = ["--child", name, "--log", str(options.log), "--share", str(options.share)]
    words += ["--seed", str(options.seed), "--slow", str(options.slow)]
    words += ["--again"] if options.again else []
    environment = os.environ | {"PYTHONHASHSEED": "0", "OMP_NUM_THREADS": "1"}
    if group.get("interpreted"):
        environment["NUMBA_DISABLE_JIT"] = "1"
    command = [sys.executable, "-m", "tools.mutants", *words]
    return subprocess.run(command, check=False, cwd=ROOT, env=environment).returncode


def _child(group: dict[str, Any], options: argparse.Namespace) -> int:
    sys.path.append(str(LIBRARIES))
    from tools.mutants.running import Choice, run_group

    only = None
    log = Path(options.log)
    if options.again:
        rows = json.loads(log.with_suffix(".again.json").read_text())
        only = frozenset(map(_key, rows))
    choice = Choice(options.share, options.seed, only, options.slow)
    return run_group(group["modules"], group["tests"], choice, log)


def _table(rows: list[dict[str, Any]], explained: dict[Key, str]) -> Table:
    """Return the counts by module."""
    table = Table("module", "faults", "tried", "noticed", "explained", "unexplained")
    tried = [row for row in rows if "outcome" in row]
    for module in dict.fromkeys(row["module"] for row in tried):
        own = [row for row in tried if row["module"] == module]
        survivors = _survivors_of(own)
        known = sum(_key(row) in explained for row in survivors)
        counts = (own[0]["of"], len(own), len(own) - len(survivors), known, len(survivors) - known)
        table.add_row(module, *map(str, counts))
    survivors = _survivors_of(tried)
    known = sum(_key(row) in explained for row in survivors)
    counts = (len(tried), len(tried) - len(survivors), known, len(survivors) - known)
    table.add_section()
    table.add_row("all", "", *map(str, counts))
    return table


def _survivors_of(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [row for row in rows if "outcome" in row and row["outcome"] not in NOTICED]


def _explanations() -> list[dict[str, str]]:
    """Return module, change and why of each fault that no test need notice."""
    stated = tomllib.loads((FOLDER / "explained.toml").read_text())
    return [
        {"module": module, "change": change, "why": reason["why"]}
        for module, reasons in stated.items()
        for reason in reasons
        for change in reason["changes"]
    ]


def _key(row: dict[str, Any]) -> Key:
    return row["module"], row["change"]


def _rows(log: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in log.read_text().splitlines()]


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tools.mutants")
    parser.add_argument("--only", nargs="+", metavar="GROUP", help="groups of plan.toml")
    parser.add_argument("--share", type=float, default=1.0, help="try this share, by chance")
    parser.add_argument("--seed", type=int, default=0, help="of that chance")
    parser.add_argument("--slow", type=float, default=6.0, help="seconds of the slowest test")
    parser.add_argument("--log", default=str(ROOT / ".mutants" / "outcomes.jsonl"))
    parser.add_argument("--again", action="store_true", help="only what survived in the log")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    return parser.parse_args(words)


sys.exit(main(sys.argv[1:]))

"""Kept results: what a run found, when, on which commit; one JSON a run, and one of all.

The page is made of these and the table alone, so that every number of it was measured.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.report_table import Area, Line, lines_of
from world2minecraft.files import write_json

KEPT = Path(__file__).resolve().parent / "report_results.json"
FIELDS = {
    "run", "steps", "figures", "verdicts", "unread", "exits", "seconds", "cpu_seconds", "load",
    "cores", "python", "commit", "is_changed", "date", "last_words",
}  # fmt: skip
Result = dict[str, Any]


def verdict(line: Line, result: Mapping[str, Any] | None) -> str:
    """Return how a line stands.

    met, missed, measured (nothing is asked of its figures), seen (a person has to look), broke (the
    commands failed, or a figure could not be read), or, without a result, not run.
    """
    if result is None:
        return "not run"
    if line.look or not line.figures:
        word = "seen" if line.look else "measured"
        return "broke" if any(result["exits"]) else word
    figures = result["figures"].get(line.name, {})
    if any(figure.what not in figures for figure in line.figures):
        return "broke"
    said = [figure.is_met(figures[figure.what]) for figure in line.figures]
    if False in said:
        return "missed"
    return "met" if True in said else "measured"


def verdicts(result: Mapping[str, Any], areas: Sequence[Area]) -> dict[str, str]:
    """Return the verdict of each line that a result is of."""
    return {line.name: verdict(line, result) for line in lines_of(result["run"], areas)}


def read_results(path: Path = KEPT) -> dict[str, Result]:
    """Return kept results by run; none where the file is not there."""
    if not path.is_file():
        return {}
    found = {result["run"]: result for result in json.loads(path.read_text("utf-8"))}
    for name, result in found.items():
        if set(result) != FIELDS:
            wrong = ", ".join(sorted(set(result) ^ FIELDS))
            raise ValueError(f"{path.name}: the result of {name} lacks or has too much: {wrong}")
    return found


def results_in(folder: Path) -> dict[str, Result]:
    """Return the results that lie in a folder, one a file, by run."""
    found: dict[str, Result] = {}
    for path in sorted(folder.glob("*.json")):
        found |= {result["run"]: result for result in read_results(path).values()}
    return found


def collect(folder: Path, areas: Sequence[Area], path: Path = KEPT) -> dict[str, Result]:
    """Put the results of a folder among the kept ones, in place of older ones; return all.

    Results of runs that the table has no more are left out, and verdicts are told anew.
    """
    found = read_results(path) | results_in(folder)
    known = {name for area in areas for name in area.runs}
    kept = {name: found[name] for name in sorted(found) if name in known}
    for result in kept.values():
        result["verdicts"] = verdicts(result, areas)
    write_json(path, list(kept.values()))
    return kept


def keep(folder: Path, result: Result) -> Path:
    """Write the result of one run into a folder; return the file."""
    path = folder / f"{result['run']}.json"
    write_json(path, [result])
    return path

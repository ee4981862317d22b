"""The report of all targets, ``docs/results/how-good.md``: measure, store and write it.

``python -m benchmarks.report --out RESULTS`` measures. ``--list`` prints what would run, how long
it takes and what it requires, by area; ``--only NAME ...`` selects areas, lines or runs by name
(or a part of one), ``--max-minutes N`` the runs that take no longer. Runs are sequential, and
each writes a JSON to RESULTS; existing ones are repeated only with ``--again``, so that an
interrupted report continues. Runs that require an idle machine, Node, a browser or other data are
skipped, with the reason, where these are missing; ``--anyway`` runs them.

``--markdown`` merges the results of RESULTS into the stored ones (``report_results.json``) and
writes the page from these alone. The targets are in ``benchmarks/how_good/*.yaml``;
``report_lines.py`` describes the format. The exit code is 1 if a line that was run is missed.
"""

import argparse
import datetime
import json
import os
import platform
import re
import resource
import shlex
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.report_lines import (
    NEEDS,
    Area,
    Line,
    Run,
    Written,
    every_run,
    figures_of,
    lines_of,
    read_areas,
)
from world2minecraft.core.files import write_json

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

    Results of runs that the tables no longer contain are omitted, and verdicts are recomputed.
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


LONG_MIN = 5.0  # From here on the page says how long a run takes.
HEAD = """# How good it is

The targets of each part of the program, with their latest measurements. The figures come from
`benchmarks/report_results.json`, which also records commit, machine load and commands.

```
python -m benchmarks.report --list               all targets, with the commands that measure them
python -m benchmarks.report --out RESULTS        measure what RESULTS does not contain yet
python -m benchmarks.report --out RESULTS --markdown      update this page
```
"""
STANDS = {
    "met": "met",
    "missed": "missed",
    "broke": "with a failed command",
    "measured": "measured without a limit",
    "seen": "to be judged by a person",
    "not run": "not run here",
}
SHOWN = {"met": "met", "missed": "**missed**", "broke": "**failed**", "seen": "by a person"}
EMPTY = "Nothing that was run falls short."


def page_of(areas: Sequence[Area], results: Mapping[str, Result]) -> str:
    """Return the page as Markdown: what falls short first, then a table for each area."""
    runs = every_run(areas)
    parts = [HEAD, _counts(areas, results), "## What falls short\n", _short(areas, results)]
    parts += [_section(area, runs, results) for area in areas]
    return "\n".join(parts).rstrip() + "\n"


def measured_of(line: Line, result: Result | None) -> str:
    """Return the cell that says what was measured."""
    if result is None:
        return ""
    found = result["figures"].get(line.name, {})
    cells = []
    for figure in line.figures:
        if figure.what not in found:
            cells.append(f"{figure.what} not read")
        elif not (figure.is_silent and figure.is_met(found[figure.what])):
            value = f"{found[figure.what]:,.{figure.digits}f}"
            cells.append(f"{figure.what} {value}{f' {figure.unit}' if figure.unit else ''}")
    return _counted(", ".join(cells))


def reason_of(line: Line, run: Run | None) -> str:
    """Return why a line was not run here."""
    if run is None:
        return line.why
    reasons = [f"needs {NEEDS[need]}" for need in run.needs if need != "shared"]
    if run.minutes >= LONG_MIN:
        reasons.append(f"takes {run.minutes:g} minutes")
    return ", ".join(reasons) or "not yet"


def _typed(step: str) -> str:
    """Return a step as a person types it."""
    return step.replace("{work}/", "").replace("{shared}", "SHARED").replace("{root}", ".")


def _counted(text: str) -> str:
    """Say counts of tests the other way round: 12 tests pass, 1 is skipped."""
    text = re.sub(r"\b(tests pass|fail|are skipped) ([\d,]*\d)", r"\2 \1", text)
    for many, one in (("tests pass", "test passes"), ("fail", "fails"), ("are", "is")):
        text = re.sub(rf"(?<![\d,])1 {many}\b", f"1 {one}", text)
    return text


def _counts(areas: Sequence[Area], results: Mapping[str, Result]) -> str:
    words = [verdict(line, results.get(line.run)) for area in areas for line in area.lines]
    told = ", ".join(
        f"{words.count(name)} {said}" for name, said in STANDS.items() if words.count(name)
    )
    return f"Of {len(words)} targets: {told}.\n"


def _short(areas: Sequence[Area], results: Mapping[str, Result]) -> str:
    """List the targets that are missed, with the reasons, and those missed when last measured."""

    def rows(words: set[str]) -> list[str]:
        return [
            f"- **{line.name}**{f': {line.short}' if line.short else ''}"
            for area in areas
            for line in area.lines
            if verdict(line, results.get(line.run)) in words
            and (line.short or "not run" not in words)
        ]

    known = rows({"not run"})
    known = ["", "Missed when last measured, and not run here:", "", *known] if known else []
    return "\n".join([*(rows({"missed", "broke"}) or [EMPTY]), *known]) + "\n"


def _link(page: str) -> str:
    return f"[{page.rpartition('/')[2]}](../{page}.md)"


def _section(area: Area, runs: Mapping[str, Run], results: Mapping[str, Result]) -> str:
    """Return an area's table. Cells have no spaces around them: the page is counted in words."""
    dates = Counter(results[line.run]["date"] for line in area.lines if line.run in results)
    usual = dates.most_common(1)[0][0] if dates else ""
    when = [f"Measured on {usual}{' unless stated' if len(dates) > 1 else ''}.\n"] if usual else []
    rows = [f"## {area.title}\n", *when, "|target|measured|verdict|", "|---|---|---|"]
    tested = [line for line in area.lines if _is_tested(line, results.get(line.run))]
    rows += [
        _row(line, runs.get(line.run), results.get(line.run), usual)
        for line in area.lines
        if line not in tested
    ]
    if tested:
        rows += ["", f"Met, as tests show: {'; '.join(line.name for line in tested)}."]
    return "\n".join(rows) + "\n"


def _is_tested(line: Line, result: Result | None) -> bool:
    """Return whether a target is met and nothing but tests measures it."""
    is_counted = all(figure.read.source == "tests" for figure in line.figures)
    return bool(line.figures) and is_counted and verdict(line, result) == "met"


def _row(line: Line, run: Run | None, result: Result | None, usual_date: str) -> str:
    measured, word = measured_of(line, result), SHOWN.get(verdict(line, result), "")
    if line.look:
        measured = "; ".join(part for part in (f"look at {line.look}", measured) if part)
    if result is None:
        told = f"; see {_link(line.page)}" if line.page else ""
        measured = f"not run: {reason_of(line, run)}{told}"
    elif result["date"] != usual_date:
        word = f"{word}, {result['date']}".removeprefix(", ")
    cells = (f"**{line.name}**: {line.asked}", measured, word)
    return f"|{'|'.join(cell.replace('|', chr(92) + '|') for cell in cells)}|"


ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "results" / "how-good.md"
IDLE_LOAD = 0.5  # A core, as ``make bench`` asks.
LAST_CHARACTERS = 600  # Of what a run that broke has printed.
PROGRAMS = {
    "python": [sys.executable],
    "w2m": [sys.executable, "-m", "world2minecraft"],
    "git": ["git"],
    "make": ["make"],
}


def main(words: Sequence[str]) -> int:
    """Do what ``words`` ask for and return the exit code."""
    options = _options(words)
    areas = read_areas()
    chosen = chosen_runs(areas, options.only, options.max_minutes)
    if not chosen:
        print("no run is of that name; --list shows all", file=sys.stderr)
        return 2
    if options.list:
        print("\n".join(listed(areas, chosen, read_results() | results_in(options.out))))
        return 0
    missed = False
    if not options.markdown:
        missed = run_all(chosen, areas, options)
    if options.markdown:
        PAGE.write_text(page_of(areas, collect(options.out, areas)), "utf-8")
        print(f"written: {PAGE.relative_to(ROOT)}")
    return int(missed)


def chosen_runs(areas: Sequence[Area], only: Sequence[str], most_minutes: float) -> list[Run]:
    """Return the runs that are asked for: by name, or by a part of a line's, run's or area's."""
    exact = {name for area in areas for name in area.runs} & set(only)
    parts = [part.lower() for part in only if part not in exact]

    def is_meant(area: Area, run: Run) -> bool:
        names = [area.title, run.name, *(line.name for line in lines_of(run.name, areas))]
        is_like = any(part in name.lower() for part in parts for name in names)
        return not only or run.name in exact or is_like

    runs = [run for area in areas for run in area.runs.values() if is_meant(area, run)]
    return [run for run in runs if run.minutes <= most_minutes]


def run_all(runs: Iterable[Run], areas: Sequence[Area], options: argparse.Namespace) -> bool:
    """Run what has no result yet, keep each; return whether a line is missed."""
    options.out.mkdir(parents=True, exist_ok=True)
    done, missed = results_in(options.out), False
    for run in runs:
        lacking = [] if options.anyway else lacks(run)
        if run.name in done and not options.again:
            result = done[run.name]
            print(f"{run.name}: there already, of {result['date']}")
        elif lacking:
            print(f"{run.name}: left out, needs {', '.join(lacking)}")
            continue
        else:
            result = measured(run, areas, options.out)
            keep(options.out, result)
            print(f"{run.name}: {result['seconds']:.0f} s, {result['cpu_seconds']:.0f} s of CPU")
        for name, word in verdicts(result, areas).items():
            told = ", ".join(f"{k} {v:g}" for k, v in result["figures"].get(name, {}).items())
            print(f"  {word:8} {name}: {told}", flush=True)
            missed |= word in ("missed", "broke")
        print(*(f"  {sentence}" for sentence in result["unread"]), sep="\n", end="")
    return missed


def lacks(run: Run) -> list[str]:
    """Return what a run needs and this machine has not."""
    there = {
        "shared": shared_data().is_dir(),
        "idle": os.getloadavg()[0] < IDLE_LOAD * (os.cpu_count() or 1),
        "node": shutil.which("npm") is not None,
        "chromium": bool(shutil.which("chromium") or shutil.which("chromium-browser")),
    }
    return [need for need in run.needs if not there.get(need, True)]


def shared_data() -> Path:
    """Return the folder of the shared real inputs, whether it is there or not."""
    return Path(os.environ.get("W2M_SHARED_DATA", ROOT.parent / "shared" / "data"))


def measured(run: Run, areas: Sequence[Area], out: Path) -> Result:
    """Run the steps of a run in its folder and return its result."""
    work = (out / "work" / run.name).resolve()
    work.mkdir(parents=True, exist_ok=True)
    began, clock, before, load = time.time(), time.monotonic(), _cpu_s(), os.getloadavg()[0]
    commit, is_changed = _commit()
    exits, printed = [], []
    for number, step in enumerate(run.steps):
        code, text = _step(words_of(step, work, number), work / f"printed-{number}.txt")
        exits.append(code)
        printed.append(text)
        if code and number < len(run.steps) - 1:
            break
    seconds = round(time.monotonic() - clock, 1)
    written = Written(work, "\n".join(printed), tuple(exits), began, seconds)
    figures, unread = figures_of(lines_of(run.name, areas), written)
    result: Result = {
        "run": run.name,
        "steps": list(run.steps),
        "figures": figures,
        "unread": [_placeless(sentence, work) for sentence in unread],
        "exits": exits,
        "seconds": seconds,
        "cpu_seconds": round(_cpu_s() - before, 1),
        "load": [round(load, 2), round(os.getloadavg()[0], 2)],
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "commit": commit,
        "is_changed": is_changed,
        "date": datetime.date.today().isoformat(),
        "last_words": _placeless(written.printed[-LAST_CHARACTERS:], work) if unread else "",
    }
    return result | {"verdicts": verdicts(result, areas)}


def _placeless(text: str, work: Path) -> str:
    """Return a text without the places of this machine, since results are published."""
    places = {str(work): "{work}", str(shared_data()): "{shared}", str(ROOT): "{root}"}
    for place, mark in places.items():
        text = text.replace(place, mark)
    return text


def words_of(step: str, work: Path, number: int) -> list[str]:
    """Return the words of a step as they are run; ValueError for a program of another kind."""
    program, *words = shlex.split(step)
    if program not in PROGRAMS:
        raise ValueError(f"a step begins with {', '.join(PROGRAMS)}: {step}")
    places = {"{work}": str(work), "{shared}": str(shared_data()), "{root}": str(ROOT)}
    for mark, place in places.items():
        words = [word.replace(mark, place) for word in words]
    if program == "python" and words[:2] == ["-m", "pytest"]:
        words.append(f"--junitxml={work / f'tests-{number}.xml'}")
    return [*PROGRAMS[program], *words]


def _step(words: Sequence[str], log: Path) -> tuple[int, str]:
    """Run one command; what it prints goes to a file, which can be watched, and is returned."""
    environment = os.environ | {"W2M_SHARED_DATA": str(shared_data())}
    with log.open("w", encoding="utf-8") as stream:
        done = subprocess.run(
            words, check=False, cwd=ROOT, env=environment, stdout=stream, stderr=subprocess.STDOUT
        )
    return done.returncode, log.read_text("utf-8", errors="replace")


def _commit() -> tuple[str, bool]:
    """Return the last commit that changed the program, and whether the tree differs from HEAD.

    Not HEAD: docs, tests and the report itself change no figure.
    """

    def git(*words: str) -> str:
        told = subprocess.run(["git", *words], check=False, cwd=ROOT, capture_output=True)
        return told.stdout.decode().strip()

    commit = git("log", "-1", "--format=%h", "--abbrev=10", "--", "src")
    return commit, bool(git("diff", "HEAD", "--name-only", "--", "src", "tests", "benchmarks"))


def _cpu_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def listed(areas: Sequence[Area], chosen: Sequence[Run], kept: dict[str, Result]) -> list[str]:
    """Return the lines of ``--list``: minutes by area, then each run with its lines."""
    told, names = [], {run.name for run in chosen}
    for area in areas:
        runs = [run for run in area.runs.values() if run.name in names]
        if not runs:
            continue
        left = sum(run.minutes for run in runs if run.name not in kept)
        minutes = sum(run.minutes for run in runs)
        told.append(f"{area.title}: {minutes:.0f} minutes of one core, {left:.0f} of them not kept")
        for run in runs:
            needs = f", needs {', '.join(run.needs)}" if run.needs else ""
            when = f", kept of {kept[run.name]['date']}" if run.name in kept else ""
            told.append(f"  {run.name}: {run.minutes:g} min{needs}{when}")
            told += [f"      {line.name}: {line.asked}" for line in lines_of(run.name, areas)]
            told += [f"      $ {_typed(step)}" for step in run.steps]
    whole = sum(run.minutes for run in chosen)
    left = sum(run.minutes for run in chosen if run.name not in kept)
    return [*told, f"all: {whole / 60:.1f} hours of one core, {left / 60:.1f} of them not kept"]


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.report", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("--out", type=Path, default=Path("OUT-report"), help="keeps the results")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="areas, lines, runs")
    parser.add_argument("--max-minutes", type=float, default=float("inf"), metavar="N")
    parser.add_argument("--list", action="store_true", help="list targets, runs and commands")
    parser.add_argument("--again", action="store_true", help="run what has a result, too")
    parser.add_argument("--anyway", action="store_true", help="run what lacks something, too")
    parser.add_argument("--markdown", action="store_true", help="write the page; nothing is run")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

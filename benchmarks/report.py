"""Every line of "How good" measured again: ``python -m benchmarks.report --out RESULTS``.

``--list`` tells what would run, how long, and what it needs, by area; ``--only NAME ...`` takes
areas, lines or runs of these names (or a part of one), ``--max-minutes N`` the runs that take no
longer. One runs after another, and each leaves a JSON in RESULTS: what is there is not run again
but with ``--again``, so that it can be stopped and gone on with. What needs an idle machine, node,
a browser or other data is left out, with the reason, where they lack; ``--anyway`` runs it.

``--markdown`` puts the results of RESULTS among those that are kept (``report_results.json``) and
writes docs/how-good.md from these alone. The table is ``benchmarks/how_good/*.yaml``; how it is
written stands in ``report_table.py``. It leaves with 1 where a line that was run is missed.
"""

import argparse
import datetime
import os
import platform
import resource
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

from benchmarks.report_figures import Written, figures_of
from benchmarks.report_page import page_of
from benchmarks.report_results import Result, collect, keep, read_results, results_in, verdicts
from benchmarks.report_table import Area, Run, lines_of, read_areas

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "how-good.md"
IDLE_LOAD = 0.5  # A core, as ``make bench`` asks.
LAST_CHARACTERS = 600  # Of what a run that broke has printed.
PROGRAMS = {
    "python": [sys.executable],
    "w2m": [sys.executable, "-m", "world2minecraft.cli"],
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
        print(f"{PAGE.relative_to(ROOT)} says what is kept")
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
            told += [f"      {line.name}" for line in lines_of(run.name, areas)]
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
    parser.add_argument("--list", action="store_true", help="tell what would run, and how long")
    parser.add_argument("--again", action="store_true", help="run what has a result, too")
    parser.add_argument("--anyway", action="store_true", help="run what lacks something, too")
    parser.add_argument("--markdown", action="store_true", help="write the page; nothing is run")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""The lines of "How good": what is asked, which command measures it, how its figures are read.

In: the YAML files of ``benchmarks/how_good``, one an area. Out: frozen values, checked. A run is a
command, or several in a row; a line is what is asked of one of its figures or more::

    area: Faithful rooms
    runs:
      fidelity:
        steps: ["python -m benchmarks.check_faithful --keep {work}/trials --json {work}/rows.json"]
        minutes: 40
        needs: [shared]
    lines:
      - name: exact cells
        asked: exact IoU at least 0.80
        run: fidelity
        figures: [{what: IoU, file: rows.json, at: ["*", occupancy, iou], take: mean, least: 0.8}]

Steps hold ``{work}``, a folder of the run's own that stays, ``{shared}``, the real inputs, and
``{root}``, the repository. A line may be measured by a run of another area; one of tests without
``figures`` asks that all pass and none is skipped.
"""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import yaml

FOLDER = Path(__file__).resolve().parent / "how_good"
TAKES = ("only", "first", "last", "least", "most", "mean", "sum")
COUNTS = ("passed", "failed", "skipped")  # Of tests.
# What a run may need, and how a page says it.
NEEDS = {
    "shared": "real inputs (`W2M_SHARED_DATA`)",
    "idle": "an idle machine",
    "node": "Node and npm",
    "chromium": "a chromium",
    "network": "the network",
    "rivals": "other packages",
}


@dataclass(frozen=True)
class Read:
    """Where a figure stands in what a run has written.

    ``source`` is json (a file of the work folder, ``at`` a way into it), text (``at`` a regular
    expression with one group, over all that was printed), tests (``at`` one of ``COUNTS``), exit
    (the largest exit code) or seconds (of the whole run, by the clock). ``take`` says what is taken
    where several are found. Of JSON a second figure of the same file, ``other``, may be taken away
    or divided by: ``by`` is minus or over.
    """

    source: str
    at: Any
    file: str = ""
    take: str = "only"
    by: str = ""
    other: Any = None


@dataclass(frozen=True)
class Figure:
    """One figure, and the limits between which it has to lie; None is no limit."""

    what: str
    read: Read
    least: float | None = None
    most: float | None = None
    digits: int = 3
    unit: str = ""
    is_silent: bool = False  # Nothing is said of it where it is met.

    def is_met(self, value: float) -> bool | None:
        """Say whether a value is as good as asked; None where nothing is asked."""
        if self.least is None and self.most is None:
            return None
        is_enough = self.least is None or value >= self.least
        return is_enough and (self.most is None or value <= self.most)


@dataclass(frozen=True)
class Run:
    """Commands that measure something, one after another, and about how long they take."""

    name: str
    steps: tuple[str, ...]
    minutes: float  # Of one free core.
    needs: tuple[str, ...] = ()


@dataclass(frozen=True)
class Line:
    """What is asked, and what measures it: a run, or (``why``) what stands in the way.

    ``look`` says what a person has to see in what the run makes. ``short`` says in plain words,
    without a number, why it is missed; ``page`` is where earlier figures stand.
    """

    name: str
    asked: str
    figures: tuple[Figure, ...]
    run: str = ""
    look: str = ""
    why: str = ""
    short: str = ""
    page: str = ""


@dataclass(frozen=True)
class Area:
    """A part of the program: its lines and its runs, by name."""

    title: str
    runs: Mapping[str, Run]
    lines: tuple[Line, ...]


def read_areas(folder: Path = FOLDER) -> list[Area]:
    """Return all areas in the order of their files; ValueError where one is written wrongly."""
    told = [yaml.safe_load(path.read_text("utf-8")) for path in paths(folder)]
    return areas_of(told)


def areas_of(told: Sequence[Mapping[str, Any]]) -> list[Area]:
    """Return the areas that files say; a line may be measured by a run of another area."""
    runs = {name: _run(name, facts) for one in told for name, facts in one["runs"].items()}
    areas = [_area(one, runs) for one in told]
    idle = set(runs) - {line.run for area in areas for line in area.lines}
    if idle:
        raise ValueError(f"no line is measured by {', '.join(sorted(idle))}")
    for what, names in (
        ("run", [name for one in told for name in one["runs"]]),
        ("line", [line.name for area in areas for line in area.lines]),
    ):
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"each {what} has a name of its own; twice: {', '.join(twice)}")
    return areas


def paths(folder: Path = FOLDER) -> list[Path]:
    """Return the files of the areas, in order."""
    return sorted(folder.glob("*.yaml"))


def every_run(areas: Sequence[Area]) -> dict[str, Run]:
    """Return all runs by name."""
    return {name: run for area in areas for name, run in area.runs.items()}


def lines_of(run: str, areas: Sequence[Area]) -> list[Line]:
    """Return the lines that a run measures."""
    return [line for area in areas for line in area.lines if line.run == run]


def _area(told: Mapping[str, Any], runs: Mapping[str, Run]) -> Area:
    _known("area", told, {"area", "runs", "lines"})
    lines = tuple(_line(facts, runs) for facts in told["lines"])
    return Area(told["area"], {name: runs[name] for name in told["runs"]}, lines)


def _run(name: str, told: Mapping[str, Any]) -> Run:
    _known(name, told, {"steps", "minutes", "needs"})
    needs = tuple(told.get("needs", ()))
    unknown = [need for need in needs if need not in NEEDS]
    if unknown:
        raise ValueError(f"{name}: needs are of {', '.join(NEEDS)}, not {', '.join(unknown)}")
    return Run(name, tuple(told["steps"]), float(told["minutes"]), needs)


def _line(told: Mapping[str, Any], runs: Mapping[str, Run]) -> Line:
    fields = dict(told)
    name = fields["name"]
    _known(name, fields, {"name", "asked", "figures", "run", "look", "why", "short", "page"})
    run = fields.get("run", "")
    if bool(run) == bool(fields.get("why")):
        raise ValueError(f"{name}: give either a run or why there is none")
    if run and run not in runs:
        raise ValueError(f"{name}: there is no run {run}; there are {', '.join(runs)}")
    if re.search(r"\d", fields.get("short", "")):
        raise ValueError(f"{name}: `short` holds no number; numbers come from kept results alone")
    given = fields.pop("figures", None)
    if given is not None:
        figures = tuple(_figure(name, each) for each in given)
    elif not run or fields.get("look"):
        figures = ()
    else:
        figures = _usual_figures(runs[run])
    return Line(figures=figures, **fields)


def _usual_figures(run: Run) -> tuple[Figure, ...]:
    """Return what is asked of a run of which the line says nothing: that it ends well."""
    if not any(step.startswith("python -m pytest") for step in run.steps):
        return (Figure("exit code", Read("exit", ""), most=0, digits=0),)
    return (
        Figure("tests pass", Read("tests", "passed"), least=1, digits=0),
        Figure("fail", Read("tests", "failed"), most=0, digits=0, is_silent=True),
        Figure("are skipped", Read("tests", "skipped"), most=0, digits=0, is_silent=True),
    )


def _figure(line: str, told: Mapping[str, Any]) -> Figure:
    _known(
        line,
        told,
        {"what", "file", "at", "text", "tests", "exit", "seconds", "take"}
        | {"least", "most", "digits", "unit", "silent", "minus", "over"},
    )
    read = _read(line, told)
    return Figure(
        told["what"], read, told.get("least"), told.get("most"),
        told.get("digits", 3), told.get("unit", ""), told.get("silent", False),
    )  # fmt: skip


def _read(line: str, told: Mapping[str, Any]) -> Read:
    take = told.get("take", "only")
    if take not in TAKES:
        raise ValueError(f"{line}: take is one of {', '.join(TAKES)}, not {take}")
    ways = [way for way in ("file", "text", "tests", "exit", "seconds") if way in told]
    if len(ways) != 1:
        raise ValueError(f"{line}: a figure is read from file, text, tests, exit or seconds")
    match ways[0]:
        case "file":
            by = next((word for word in ("minus", "over") if word in told), "")
            return Read("json", told["at"], told["file"], take, by, told.get(by))
        case "text":
            if re.compile(told["text"]).groups != 1:
                raise ValueError(f"{line}: the expression has one group: {told['text']}")
            return Read("text", told["text"], take=take)
        case "tests":
            if told["tests"] not in COUNTS:
                raise ValueError(f"{line}: tests is one of {', '.join(COUNTS)}")
            return Read("tests", told["tests"], take="sum")
        case way:
            return Read(way, "")


def _known(name: str, told: Mapping[str, Any], keys: set[str]) -> None:
    unknown = sorted(set(told) - keys)
    if unknown:
        raise ValueError(f"{name}: unknown {', '.join(unknown)}; known are {', '.join(keys)}")


SLACK_S = 2.0  # A file system may tell times in whole seconds.


@dataclass(frozen=True)
class Written:
    """What a run left: its folder, what it printed, its exit codes.

    ``began`` is the time since the epoch, ``seconds`` what it took by the clock.
    """

    work: Path
    printed: str
    exits: tuple[int, ...]
    began: float
    seconds: float


def figures_of(lines: Sequence[Line], written: Written) -> tuple[dict[str, Any], list[str]]:
    """Return the figures by line and name, and a sentence for each that could not be read."""
    found: dict[str, dict[str, float]] = {}
    unread = []
    for line in lines:
        mine = found.setdefault(line.name, {})
        for figure in line.figures:
            try:
                mine[figure.what] = read_figure(figure.read, written)
            except (LookupError, ValueError, OSError, TypeError, ArithmeticError) as error:
                unread.append(f"{line.name}, {figure.what}: {error}")
    return found, unread


def read_figure(read: Read, written: Written) -> float:
    """Return one figure; ValueError where there is none, or several and no word which."""
    if read.source == "exit":
        return float(max(map(abs, written.exits)))
    if read.source == "seconds":
        return written.seconds
    if read.source == "tests":
        return float(sum(counts[read.at] for counts in _tests(written)))
    if read.source == "text":
        texts = re.findall(read.at, written.printed, re.MULTILINE)
        return taken([float(text.replace(",", "")) for text in texts], read.take)
    path = written.work / read.file
    if path.stat().st_mtime < written.began - SLACK_S:
        raise ValueError(f"{read.file} is of an earlier run")
    whole = json.loads(path.read_text("utf-8"))
    value = _found(whole, read.at, read.take)
    if not read.by:
        return value
    other = _found(whole, read.other, read.take)
    return value - other if read.by == "minus" else value / other


def _found(whole: Any, way: Sequence[Any], take: str) -> float:
    return taken([float(value) for value in walked(whole, way) if value is not None], take)


def walked(value: Any, way: Sequence[Any]) -> Iterator[Any]:
    """Yield what lies at the end of a way into JSON.

    A step is a name, a place in a list, ``*`` (all of a list or dict), or names with values that
    those of a list's items have that are meant: ``[{labels: none}, score, iou]``.
    """
    if not way:
        yield value
        return
    step, rest = way[0], way[1:]
    if isinstance(step, Mapping):
        inside = [one for one in value if all(one.get(k) == v for k, v in step.items())]
    elif step == "*":
        inside = list(value.values()) if isinstance(value, Mapping) else list(value)
    else:
        inside = [value[step]]
    for one in inside:
        yield from walked(one, rest)


def taken(values: Sequence[float], take: str) -> float:
    """Return the one of several values, or the figure over them, that is asked for."""
    if not values:
        raise ValueError("nothing is found")
    match take:
        case "least":
            return min(values)
        case "most":
            return max(values)
        case "mean":
            return sum(values) / len(values)
        case "sum":
            return sum(values)
        case "first":
            return values[0]
        case "last":
            return values[-1]
    if len(values) > 1:
        raise ValueError(f"{len(values)} are found where one is expected; say which to take")
    return values[0]


def _tests(written: Written) -> Iterator[dict[str, int]]:
    """Yield the counts of each run of tests, from the reports that pytest leaves."""
    reports = sorted(written.work.glob("tests-*.xml"))
    reports = [one for one in reports if one.stat().st_mtime >= written.began - SLACK_S]
    if not reports:
        raise ValueError("no test left a report")
    for report in reports:
        suites = list(ElementTree.parse(report).getroot().iter("testsuite"))
        sums = {
            key: sum(int(suite.get(key, 0)) for suite in suites)
            for key in ("tests", "failures", "errors", "skipped")
        }
        failed = sums["failures"] + sums["errors"]
        told = (sums["tests"] - failed - sums["skipped"], failed, sums["skipped"])
        yield dict(zip(COUNTS, told, strict=True))

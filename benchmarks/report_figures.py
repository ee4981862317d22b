"""Figures from what a run has written: JSON, printed text, counts of tests, exit codes."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from benchmarks.report_table import COUNTS, Line, Read

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

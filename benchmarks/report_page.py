"""docs/how-good.md, from the table of lines and the kept results, and from nothing else."""

import re
from collections.abc import Mapping, Sequence

from benchmarks.report_results import Result, verdict
from benchmarks.report_table import NEEDS, Area, Line, Run, every_run

LONG_MIN = 5.0  # From here on the page says how long a run takes.
HEAD = """# How good it is, line by line

Each part of the program was asked to be so good before it was written. This page holds every line
of that, what was measured of it, and with which command. The numbers come from kept results
(`benchmarks/report_results.json`), each with its date and the last commit that had changed the
program then; the page is written by

```
python -m benchmarks.report --list                 every line, how long it takes, what it needs
python -m benchmarks.report --out RESULTS          measure what is not in RESULTS yet
python -m benchmarks.report --out RESULTS --markdown
```

What was not run here says why, and where earlier figures stand.
"""
STANDS = {
    "met": "met",
    "missed": "missed",
    "broke": "whose command broke",
    "measured": "measured, with no limit asked",
    "seen": "to be looked at by a person",
    "not run": "not run here",
}
SHOWN = {"met": "met", "missed": "**missed**", "broke": "**broke**", "seen": "to be looked at"}
EMPTY = "Nothing that was run falls short."


def page_of(areas: Sequence[Area], results: Mapping[str, Result]) -> str:
    """Return the page as Markdown: what falls short first, then a table an area."""
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
        reasons.append(f"takes {run.minutes:g} minutes of a free core")
    return " and ".join(reasons) or "no time yet"


def command_of(run: Run | None) -> str:
    """Return the commands of a run, as one types them."""
    return "<br>".join(f"`{_typed(step)}`" for step in (run.steps if run else ()))


def _typed(step: str) -> str:
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
    return f"Of {len(words)} lines: {told}.\n"


def _short(areas: Sequence[Area], results: Mapping[str, Result]) -> str:
    rows = []
    for area in areas:
        for line in area.lines:
            result = results.get(line.run)
            if verdict(line, result) in ("missed", "broke"):
                why = f" {line.short}" if line.short else ""
                measured = measured_of(line, result) or "the command broke"
                rows.append(
                    f"- **{line.name}** ({area.title}): asked is {line.asked}; measured:"
                    f" {measured}.{why}"
                )
    return "\n".join([*(rows or [EMPTY]), *_known(areas, results)]) + "\n"


def _known(areas: Sequence[Area], results: Mapping[str, Result]) -> list[str]:
    """Name lines that fell short when they were measured before, and were not run here."""
    rows = [
        f"- **{line.name}** ({area.title}): {line.short}{_earlier(line)}"
        for area in areas
        for line in area.lines
        if line.short and verdict(line, results.get(line.run)) == "not run"
    ]
    return ["", "Fell short when last measured, and was not run here:", "", *rows] if rows else []


def _earlier(line: Line) -> str:
    return f" Earlier figures: [{line.page}]({line.page}.md)." if line.page else ""


def _section(area: Area, runs: Mapping[str, Run], results: Mapping[str, Result]) -> str:
    rows = [
        f"## {area.title}\n",
        "| asked | measured | | command | commit, date |",
        "|---|---|---|---|---|",
    ]
    rows += [_row(line, runs.get(line.run), results.get(line.run)) for line in area.lines]
    return "\n".join(rows) + "\n"


def _row(line: Line, run: Run | None, result: Result | None) -> str:
    word = verdict(line, result)
    measured, when = measured_of(line, result), ""
    if line.look:
        measured = f"a person looks: {line.look}" + (f"; {measured}" if measured else "")
    if result is None:
        why = f"not run here: {reason_of(line, run)}"
        told = f"; earlier figures: [{line.page}]({line.page}.md)" if line.page else ""
        measured, word = (f"{measured}; {why}" if measured else why) + told, ""
    else:
        changed = " with changes" if result["is_changed"] else ""
        when = f"{result['commit']}{changed}, {result['date']}"
    asked = f"**{line.name}**: {line.asked}"
    cells = (asked, measured, SHOWN.get(word, ""), command_of(run), when)
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"

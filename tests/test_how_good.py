"""The report of every line of "How good": its table, its reading, its page, its kept results."""

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from benchmarks import __main__ as bench
from benchmarks import report
from benchmarks.report import collect, page_of, read_results, results_in, verdict, verdicts
from benchmarks.report_lines import (
    Figure,
    Line,
    Read,
    Written,
    areas_of,
    every_run,
    read_areas,
    read_figure,
    taken,
    walked,
)

from world2minecraft.cli.verbs import VERBS

ROOT = Path(__file__).resolve().parents[1]
AREAS = read_areas()
STEPS = sorted({step for run in every_run(AREAS).values() for step in run.steps})
CLI = "".join(path.read_text("utf-8") for path in (ROOT / "src/world2minecraft/cli").rglob("*.py"))


def options_of(words):
    return {word.partition("=")[0] for word in words if re.match(r"--[a-z]", word)}


@pytest.mark.parametrize("step", STEPS)
def test_every_command_exists(step):
    program, *words = shlex.split(step)
    if program == "make":
        assert re.search(rf"^{words[-1]}:", (ROOT / "Makefile").read_text(), re.MULTILINE)
    elif program == "w2m":
        verb = next(v for v in (" ".join(words[:2]), words[0]) if v in VERBS)
        assert verb
        assert not [option for option in options_of(words) if f'"{option}' not in CLI]
    elif words[:2] == ["-m", "pytest"]:
        places = [word for word in words if word.startswith("tests/")]
        assert places and all((ROOT / place).exists() for place in places)
    elif words[:2] == ["-m", "benchmarks"]:
        names = words[3 : words.index("--json")]
        assert words[2] == "--only" and set(names) <= set(bench.names())
    elif program == "python":
        module = ROOT / words[1].replace(".", "/")
        main = module / "__main__.py" if module.is_dir() else module.with_suffix(".py")
        source = main.read_text("utf-8")
        assert not [option for option in options_of(words) if f'"{option}"' not in source]
    else:
        assert program == "git"


def test_lines_name_pages_that_are_there():
    pages = {line.page for area in AREAS for line in area.lines if line.page}
    missing = [page for page in pages if not (ROOT / "docs" / f"{page}.md").is_file()]
    assert missing in ([], ["contributing"])  # That one is made of CONTRIBUTING.md.


def test_what_is_asked_of_a_line_can_be_missed():
    def can_be_missed(line):
        return any(figure.least is not None or figure.most is not None for figure in line.figures)

    lines = [line for area in AREAS for line in area.lines if line.run and not line.look]
    assert sum(map(can_be_missed, lines)) > 0.9 * len(lines)


def small(**line):
    told = {
        "area": "Rooms",
        "runs": {"cells": {"steps": ["python -m benchmarks.check_x"], "minutes": 7}},
        "lines": [{"name": "exact", "asked": "IoU 0.8", "run": "cells", **line}],
    }
    return areas_of([told])


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ({"run": "other"}, "there is no run other; there are cells"),
        ({"why": "no data"}, "give either a run or why there is none"),
        ({"short": "0.3 too low"}, "`short` holds no number"),
        ({"figures": [{"what": "IoU"}]}, "is read from file, text, tests, exit or seconds"),
        ({"figures": [{"what": "IoU", "text": "a.b"}]}, "the expression has one group"),
        ({"figures": [{"what": "IoU", "exit": True, "minimum": 1}]}, "unknown minimum"),
        ({"figures": [{"what": "IoU", "exit": True, "take": "best"}]}, "take is one of only"),
    ],
)
def test_a_line_that_is_written_wrongly_is_told(line, says):
    with pytest.raises(ValueError, match=re.escape(says)):
        small(**line)


def test_names_are_given_once_and_every_run_has_a_line():
    told = yaml.safe_load("{area: A, runs: {one: {steps: [make demo], minutes: 1}}, lines: []}")
    with pytest.raises(ValueError, match="no line is measured by one"):
        areas_of([told])
    told["lines"] = [{"name": "a", "asked": "b", "run": "one"}] * 2
    with pytest.raises(ValueError, match="each line has a name of its own; twice: a"):
        areas_of([told])


ROWS = [
    {"labels": "none", "score": {"iou": 0.5}, "ratio": None},
    {"labels": "both", "score": {"iou": 0.75}, "ratio": 6},
]


@pytest.mark.parametrize(
    ("way", "found"),
    [
        (["*", "score", "iou"], [0.5, 0.75]),
        ([{"labels": "none"}, "score", "iou"], [0.5]),
        ([1, "ratio"], [6]),
        ([{"labels": "other"}, "ratio"], []),
        ([0, "score", "*"], [0.5]),
    ],
)
def test_ways_into_json(way, found):
    assert list(walked(ROWS, way)) == found


@pytest.mark.parametrize(
    ("take", "value"),
    [("least", 1), ("most", 4), ("first", 4), ("last", 3), ("sum", 8), ("mean", 8 / 3)],
)
def test_what_is_taken_of_several(take, value):
    assert taken([4, 1, 3], take) == pytest.approx(value)
    assert taken([2], "only") == 2
    with pytest.raises(ValueError, match="3 are found where one is expected"):
        taken([4, 1, 3], "only")
    with pytest.raises(ValueError, match="nothing is found"):
        taken([], take)


def test_figures_of_each_kind(tmp_path):
    (tmp_path / "rows.json").write_text(json.dumps(ROWS))
    (tmp_path / "tests-0.xml").write_text(
        '<testsuites><testsuite tests="9" failures="1" errors="1" skipped="2"/></testsuites>'
    )
    written = Written(tmp_path, "a: 1,204 items\nb: 3 items\n", (0, 2), 0.0, 12.5)

    def read(*words, **more):
        return read_figure(Read(*words, **more), written)

    assert read("json", ["*", "ratio"], "rows.json") == 6, "null is no figure"
    way, other = [1, "score", "iou"], [0, "score", "iou"]
    assert read("json", way, "rows.json", by="over", other=other) == 1.5
    assert read("json", way, "rows.json", by="minus", other=other) == 0.25
    assert read("text", r"^\w: ([\d,]+) items", take="most") == 1204
    assert [read("tests", name) for name in ("passed", "failed", "skipped")] == [5, 2, 2]
    assert (read("exit", ""), read("seconds", "")) == (2, 12.5)
    with pytest.raises(ValueError, match=r"rows.json is of an earlier run"):
        read_figure(Read("json", way, "rows.json"), replace(written, began=4e9))
    with pytest.raises(ValueError, match="no test left a report"):
        read_figure(Read("tests", "passed"), replace(written, began=4e9))


def result(run="cells", figures=None, exits=(0,), **more):
    return {
        "run": run, "steps": ["python -m benchmarks.check_x"], "figures": figures or {},
        "verdicts": {}, "unread": [], "exits": list(exits), "seconds": 2.0, "cpu_seconds": 1.0,
        "load": [0.1, 0.2], "cores": 2, "python": "3.11.2", "commit": "0123456789",
        "is_changed": False, "date": "2030-01-02", "last_words": "", **more,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("value", "exits", "word"),
    [(0.8, (0,), "met"), (0.79, (0,), "missed"), (0.9, (1,), "met"), (None, (1,), "broke")],
)
def test_a_line_is_met_missed_or_broke(value, exits, word):
    line = Line("exact", "", (Figure("IoU", Read("exit", ""), least=0.8),), run="cells")
    figures = {} if value is None else {"exact": {"IoU": value}}
    assert verdict(line, result(figures=figures, exits=exits)) == word
    assert verdict(line, None) == "not run"
    free = replace(line, figures=(Figure("IoU", Read("exit", "")),))
    assert verdict(free, result(figures={"exact": {"IoU": 1.0}})) == "measured"
    looked = replace(line, look="a picture")
    assert verdict(looked, result(exits=exits)) == ("broke" if any(exits) else "seen")


TWO_AREAS = """
- area: Rooms
  runs:
    cells: {steps: ["python -m benchmarks.check_x --json {work}/a.json"], minutes: 7}
    tests: {steps: [python -m pytest tests/x], minutes: 1}
  lines:
    - {name: exact, asked: IoU 0.8, run: cells, short: Thin things are lost.,
       figures: [{what: IoU, file: a.json, at: [iou], least: 0.8},
                 {what: cells, file: a.json, at: [cells], digits: 0}]}
    - {name: laws, asked: they hold, run: tests}
    - {name: looks, asked: well, run: cells, look: OUT/a.png}
- area: Speed
  runs:
    fast: {steps: [make bench], minutes: 9, needs: [shared, idle]}
    quick: {steps: [w2m demo], minutes: 1}
  lines:
    - {name: fast, asked: 15 ms, run: fast, page: render-speed}
    - {name: demo, asked: works, run: quick}
    - {name: real data, asked: IoU 52, why: it is not at hand}
"""
PAGE = """## What falls short

- **exact**: Thin things are lost.

## Rooms

Measured on 2030-01-02 unless stated.

|target|measured|verdict|
|---|---|---|
|**exact**: IoU 0.8|IoU 0.790, cells 1,234|**missed**|
|**looks**: well|look at OUT/a.png|by a person|

Met, as tests show: laws.

## Speed

|target|measured|verdict|
|---|---|---|
|**fast**: 15 ms|not run: needs an idle machine, takes 9 minutes; see [render-speed](../render-speed.md)||
|**demo**: works|not run: not yet||
|**real data**: IoU 52|not run: it is not at hand||
"""  # noqa: E501


def test_the_page_says_what_is_kept_and_nothing_else():
    areas = areas_of(yaml.safe_load(TWO_AREAS))
    passed = {"tests pass": 12, "fail": 0, "are skipped": 0}
    kept = {
        "cells": result(figures={"exact": {"IoU": 0.79, "cells": 1234}}),
        "tests": result("tests", figures={"laws": passed}, date="2030-01-03"),
    }
    page = page_of(areas, kept)
    assert page[page.index("## What") :] == PAGE
    told = "Of 6 targets: 1 met, 1 missed, 1 to be judged by a person, 3 not run here."
    assert told in page
    kept["tests"]["figures"]["laws"] |= {"tests pass": 11, "fail": 1}
    page = page_of(areas, kept)
    assert "- **laws**\n" in page and "|11 tests pass, 1 fails|**missed**, 2030" in page
    none = page_of(areas, {})
    assert "Nothing that was run falls short." in none
    known = "and not run here:\n\n- **exact**: Thin things are lost."
    assert known in none and known not in page


def test_the_page_of_the_docs_is_made_of_the_kept_results():
    assert report.PAGE.read_text("utf-8") == page_of(AREAS, read_results())


def test_kept_results_are_of_the_commands_of_the_table():
    runs, kept = every_run(AREAS), read_results()
    assert set(kept) <= set(runs)
    for name, one in kept.items():
        assert tuple(one["steps"]) == runs[name].steps
        assert one["verdicts"] == verdicts(one, AREAS)
        assert re.fullmatch(r"[0-9a-f]{7,40}", one["commit"])


RUNS = r"""
- area: Rooms
  runs:
    good: {steps: ['python -c "import sys; print(sys.argv[1:])" {work}',
                   'python -c "print(''IoU 0.9'')"'], minutes: 1}
    bad: {steps: ['python -c "raise SystemExit(3)"', 'python -c "print(''IoU 0.9'')"'], minutes: 2}
    none: {steps: ['python -c "import sys; sys.exit(sys.argv[1])" {work}'], minutes: 1}
    large: {steps: ['make demo'], minutes: 90}
    other: {steps: ['make demo'], minutes: 1, needs: [idle]}
  lines:
    - {name: exact, asked: a, run: good, figures: [{what: IoU, text: 'IoU (\S+)', least: 0.8}]}
    - {name: wrong, asked: a, run: bad, figures: [{what: IoU, text: 'IoU (\S+)', least: 0.8}]}
    - {name: lost, asked: a, run: none, figures: [{what: IoU, file: a.json, at: [0]}]}
    - {name: long, asked: a, run: large}
    - {name: timed, asked: a, run: other}
"""


@pytest.fixture
def few(monkeypatch):
    areas = areas_of(yaml.safe_load(RUNS))
    monkeypatch.setattr(report, "read_areas", lambda: areas)
    monkeypatch.setattr(report, "lacks", lambda run: list(run.needs))
    return areas


def test_runs_are_kept_and_gone_on_with(few, tmp_path, capsys):
    words = ["--out", str(tmp_path), "--max-minutes", "5"]
    assert report.main(words) == 1, "a line broke"
    told = capsys.readouterr().out
    assert "met      exact: IoU 0.9" in told and "broke    wrong" in told
    assert "other: left out, needs idle" in told and "large" not in told
    kept = results_in(tmp_path)
    assert sorted(kept) == ["bad", "good", "none"]
    assert kept["good"]["figures"] == {"exact": {"IoU": 0.9}}
    assert kept["bad"]["exits"] == [3], "what comes after a step that fails is not run"
    assert kept["bad"]["unread"] == ["wrong, IoU: nothing is found"]
    assert "No such file" in kept["none"]["unread"][0]
    assert kept["none"]["last_words"] == "{work}\n", "no place of this machine is kept"
    assert str(tmp_path) not in (tmp_path / "none.json").read_text()
    assert str(tmp_path / "work" / "good") in (tmp_path / "work/good/printed-0.txt").read_text()

    before = (tmp_path / "good.json").stat().st_mtime_ns
    assert report.main([*words, "--only", "exact"]) == 0
    assert "good: there already, of 20" in capsys.readouterr().out
    assert (tmp_path / "good.json").stat().st_mtime_ns == before
    report.main([*words, "--only", "exact", "--again"])
    assert (tmp_path / "good.json").stat().st_mtime_ns > before


def test_the_list_tells_minutes_by_area_and_what_is_kept(few, tmp_path, capsys, monkeypatch):
    none_of_the_repository = lambda *path: read_results(*path) if path else {}  # noqa: E731
    monkeypatch.setattr(report, "read_results", none_of_the_repository)
    report.keep(tmp_path, result("large", date="2030-01-02"))
    assert report.main(["--list", "--out", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "Rooms: 95 minutes of one core, 5 of them not kept"
    assert "  large: 90 min, kept of 2030-01-02" in lines
    assert "  other: 1 min, needs idle" in lines
    assert lines[-1] == "all: 1.6 hours of one core, 0.1 of them not kept"
    assert report.main(["--list", "--only", "sofa"]) == 2


def test_runs_are_chosen_by_name_or_by_a_part_of_one():
    areas = areas_of(yaml.safe_load(TWO_AREAS))

    def names(*only, most=100.0):
        return [run.name for run in report.chosen_runs(areas, only, most)]

    assert names() == ["cells", "tests", "fast", "quick"]
    assert names("exact") == ["cells"], "by its line"
    assert names("SPEED") == ["fast", "quick"], "by its area"
    assert names("t") == ["cells", "tests", "fast"]
    assert names("fast", "laws") == ["tests", "fast"]
    assert names(most=7) == ["cells", "tests", "quick"]


def test_newer_results_replace_stored_ones(few, tmp_path):
    file = tmp_path / "kept.json"
    for name in ("large", "gone"):
        report.keep(tmp_path / "old", result(name))
    assert sorted(collect(tmp_path / "old", few, file)) == ["large"]
    report.keep(tmp_path / "new", result("good", figures={"exact": {"IoU": 0.1}}))
    kept = collect(tmp_path / "new", few, file)
    assert kept == read_results(file) and sorted(kept) == ["good", "large"]
    assert kept["good"]["verdicts"] == {"exact": "missed"}


def test_a_step_is_of_a_program_that_is_known(tmp_path):
    words = report.words_of('python -m pytest tests/a -k "b or c"', tmp_path, 2)
    assert words[1:] == ["-m", "pytest", "tests/a", "-k", "b or c",
                         f"--junitxml={tmp_path / 'tests-2.xml'}"]  # fmt: skip
    with pytest.raises(ValueError, match="a step begins with python, w2m, git, make: curl"):
        report.words_of("curl x", tmp_path, 0)

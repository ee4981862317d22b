"""The table of benchmarks: verdicts, and a benchmark that breaks. What they measure is not here."""

import ast
import io

import pytest
from benchmarks import __main__ as bench
from benchmarks.rows import Row
from rich.console import Console


@pytest.mark.parametrize(
    ("value", "unit", "budget", "verdict"),
    [
        (0.2, "s", 0.25, True),
        (0.3, "s", 0.25, False),
        (0.3, "s", None, None),
        (21, "Mcell/s", 20, True),
        (19, "Mcell/s", 20, False),
    ],
)
def test_smaller_is_better_but_for_rates(value, unit, budget, verdict):
    assert Row("x", value, unit, budget).is_within_budget is verdict


def test_the_table_shows_verdict_rival_and_peak():
    rows = [("a", Row("x", 9, "s", 1, "other", 2.5, 100.0)), ("b", Row("y", 1, "s", 2))]
    console = Console(file=io.StringIO(), width=120)
    console.print(bench.table(rows))
    text = console.file.getvalue()
    for word in ("MISSED", "2.5 x other", "100 MB", "ok"):
        assert word in text


def test_a_benchmark_that_breaks_fails_the_run(monkeypatch, capsys):
    monkeypatch.setattr(bench, "measure", lambda name: None)
    assert bench.main(["--only", "cli"]) == 1
    assert "bench_cli.py failed" in capsys.readouterr().out


@pytest.mark.parametrize(("value", "code"), [(1.0, 0), (3.0, 1)])
def test_a_missed_budget_fails_the_run(monkeypatch, tmp_path, value, code):
    monkeypatch.setattr(bench, "measure", lambda name: [Row("x", value, "s", 2.0)])
    assert bench.main(["--only", "cli", "--json", str(tmp_path / "rows.json")]) == code
    assert '"value"' in (tmp_path / "rows.json").read_text()


def test_the_list_has_a_line_for_every_benchmark_and_check(capsys):
    assert bench.main(["--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for name in (*bench.names(), *bench.checks()):
        (line,) = [line for line in lines if line.split()[:1] == [name]]
        assert len(line.split()) > 3, "the summary of its docstring"


def test_every_check_can_be_run_by_its_name(monkeypatch, capsys):
    asked = []
    monkeypatch.setattr(bench, "check", lambda name: asked.append(name) or name != "check_render")
    assert bench.main(["--only", "check_scale"]) == 0
    assert bench.main(["--checks"]) == 1
    assert asked == ["check_scale", *bench.ready_checks()]
    assert "check_render.py failed" in capsys.readouterr().out
    assert set(bench.INPUTS) <= set(bench.checks())


def names_of(tree):
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Assign):
            inside = [one for target in node.targets for one in ast.walk(target)]
            yield from (one.id for one in inside if isinstance(one, ast.Name))


def test_what_benchmarks_import_from_each_other_exists():
    files = {path.relative_to(bench.FOLDER): path for path in bench.FOLDER.rglob("*.py")}
    trees = {
        ".".join(place.with_suffix("").parts): ast.parse(path.read_text("utf-8"))
        for place, path in files.items()
    }
    defined = {name: set(names_of(tree)) for name, tree in trees.items()}
    for name, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("benchmarks."):
                source = node.module.removeprefix("benchmarks.")
                assert {alias.name for alias in node.names} <= defined[source], name

"""The leaderboard: its file and its page agree, rows are checked, scores become a row."""

import shutil
from dataclasses import replace

import pytest
import yaml
from benchmarks import leaderboard
from benchmarks.leaderboard import BEGIN, END, entry_text, read_entries, tables, with_tables

from test_faithful_table import row as scores_row
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import write_json
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, list_trials

ADD = ["--method", "Other", "--version", "2", "--link", "https://example.org/other",
       "--command", "other run"]  # fmt: skip


@pytest.fixture
def copied(tmp_path):
    """Words that work on copies of the file and the page, and the two."""
    file, page = tmp_path / "leaderboard.yaml", tmp_path / "page.md"
    shutil.copy(leaderboard.FILE, file)
    shutil.copy(leaderboard.PAGE, page)
    return ["--file", str(file), "--page", str(page)], file, page


@pytest.fixture
def scores(tmp_path):
    """What scan_benchmark writes of the fifty scans, their IoU rising from scan to scan."""

    def write(change=lambda rows: rows):
        rows = [
            scores_row(trial.difficulty, iou=0.5 + 0.01 * n)
            | {"trial": trial.name, "labels": "given"}
            for n, trial in enumerate(list_trials("test"))
        ]
        write_json(tmp_path / "scores.json", change(rows))
        return str(tmp_path / "scores.json")

    return write


def test_the_page_holds_what_the_file_says():
    assert (
        with_tables(leaderboard.PAGE, read_entries(leaderboard.FILE))
        == leaderboard.PAGE.read_text()
    )


def test_our_rows_are_the_figures_of_the_page_of_fidelity():
    page = (leaderboard.DOCS / "results" / "fidelity.md").read_text()
    cells = [
        [cell.strip().split(" (")[0] for cell in line.strip("|").split("|")]
        for line in page.splitlines()
        if line.startswith("|")
    ]
    # The page shows the newest version: later rows replace earlier ones.
    entries = read_entries(leaderboard.FILE)
    ours = {e.input: e.figures for e in entries if e.method == "World2Minecraft"}
    for name in DIFFICULTIES:
        given, alone = (
            next(row for row in cells if row[0] == name and len(row) == width) for width in (4, 3)
        )
        found = [float(cell.split(",")[0]) for cell in given[1:]]
        assert found == [ours["depth+labels"][name][key] for key in ("iou", "miou", "f1")]
        assert [float(cell) for cell in alone[1:]] == [
            ours["depth"][name][key] for key in ("miou", "f1")
        ]


def test_one_command_makes_a_row_of_scores(copied, scores, capsys):
    words, file, page = copied
    before = read_entries(file)
    assert leaderboard.main([*words, "add", scores(), "--input", "depth", *ADD]) == 0
    assert "commit leaderboard.yaml and page.md" in capsys.readouterr().out
    entries = read_entries(file)
    assert entries[:-1] == before, "what stood there stands there still"
    new = entries[-1]
    assert new.key == ("Other", "2", "depth")
    # Ten scans each: 0.50 to 0.59, 0.60 to 0.69 ...
    assert [new.figures[name]["iou"] for name in DIFFICULTIES] == [
        0.545,
        0.645,
        0.745,
        0.845,
        0.945,
    ]
    assert new.figures["noise"]["precision"] == 1.0 and new.figures["noise"]["calibration"] == 0.04
    assert "| Other 2 | depth |" in page.read_text()
    assert page.read_text() == with_tables(page, entries)


def test_of_two_ways_in_a_file_the_input_says_which(copied, scores):
    words, file, _ = copied

    def both(rows):
        return [r | {"labels": "none"} for r in rows] + [
            r | {"labels": "labels", "occupancy": {"iou": 0.9, "miou": 0.5}} for r in rows
        ]

    path = scores(both)
    for source, wanted in (("depth", 0.545), ("depth+labels", 0.9)):
        assert leaderboard.main([*words, "add", path, "--input", source, *ADD]) == 0
        assert read_entries(file)[-1].figures["noise"]["iou"] == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: rows[:-1], "scores 49 of the 50 test scans (all-1049 is lacking)"),
        (lambda rows: [r | {"trial": r["trial"].replace("10", "5")} for r in rows], "scores 0 of"),
        (lambda rows: rows + rows[:1], "some twice; a row needs each once"),
        (lambda rows: [r | {"voxel_m": 0.1} for r in rows], "scores cells of 0.1 m"),
        (lambda rows: {"a": 1}, "holds no scores"),
        (lambda rows: [{"labels": "given"}], "take the file of scan_benchmark score --json"),
        (lambda rows: rows + [r | {"labels": "b"} for r in rows], "no rows labelled 'none'"),
    ],
)
def test_scores_that_are_not_of_the_whole_benchmark_make_no_row(
    copied, scores, capsys, change, message
):
    words, file, page = copied
    before = file.read_bytes(), page.read_bytes()
    assert leaderboard.main([*words, "add", scores(change), "--input", "depth", *ADD]) == 3
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
    assert (file.read_bytes(), page.read_bytes()) == before


def test_a_method_is_there_once_a_version_and_input(copied, scores, capsys):
    words, file, _ = copied
    path = scores()
    assert leaderboard.main([*words, "add", path, "--input", "depth", *ADD]) == 0
    before = file.read_bytes()
    assert leaderboard.main([*words, "add", path, "--input", "depth", *ADD]) == 3
    assert "Other 2 depth is there already; say the version" in capsys.readouterr().err
    assert file.read_bytes() == before


def good() -> dict:
    return yaml.safe_load(leaderboard.FILE.read_text())[0]


def without(name):
    return {key: value for key, value in good().items() if key != name}


def with_figure(value):
    return good() | {"figures": good()["figures"] | {"noise": value}}


@pytest.mark.parametrize(
    ("row", "message"),
    [
        (3, "row 1 must be a mapping, not '3'"),
        (without("link"), "row 1: link is missing"),
        (good() | {"methods": "x"}, "row 1: no field is named 'methods'; did you mean 'method'?"),
        (good() | {"input": "rgb"}, "input must be depth, depth+labels, photos, not 'rgb'"),
        (good() | {"date": "2026-13-01"}, "date must be year-month-day, such as 2026-11-22, not"),
        (good() | {"date": "today"}, "date must be year-month-day"),
        (good() | {"link": "see paper"}, "link must be an https:// address or a commit, not"),
        (
            good() | {"method": "a | b"},
            "method must be one line of at most 300 letters without | <",
        ),
        (good() | {"command": ""}, "command must not be empty"),
        (good() | {"figures": {"noise": {"iou": 1}}}, "figures must be of each of noise, coverage"),
        (with_figure({}), "noise must map figures to numbers, such as {iou: 0.94}"),
        (with_figure({"iuo": 0.9}), "no figure of noise is named 'iuo'; did you mean 'iou'?"),
        (with_figure({"iou": 94.4}), "iou of noise must be from 0 to 1, not 94.4"),
        (with_figure({"iou": "0.9"}), "iou of noise must be from 0 to 1, not '0.9'"),
        (with_figure({"iou": float("nan")}), "iou of noise must be from 0 to 1, not nan"),
    ],
)
def test_a_wrong_row_is_told_with_what_is_right(tmp_path, row, message):
    file = tmp_path / "board.yaml"
    file.write_text(yaml.safe_dump([row]))
    with pytest.raises(DamagedFileError) as caught:
        read_entries(file)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["", "a: b", "- [", "[]"])
def test_a_file_that_is_no_list_of_rows_is_refused(tmp_path, text):
    file = tmp_path / "board.yaml"
    file.write_text(text)
    with pytest.raises(DamagedFileError, match="must be a list of rows|is no YAML"):
        read_entries(file)


def test_a_row_reads_back_as_it_was_written(tmp_path):
    entries = read_entries(leaderboard.FILE)
    file = tmp_path / "board.yaml"
    file.write_text("\n".join(entry_text(entry) for entry in entries))
    assert read_entries(file) == entries


def test_missing_figures_are_dashes_and_marks_are_required(tmp_path):
    alone = [entry for entry in read_entries(leaderboard.FILE) if entry.input == "depth"]
    text = tables([*alone])
    assert "precision and recall" not in text, "a table that nobody has figures for"
    both = read_entries(leaderboard.FILE)
    figures = {name: {"precision": 0.5} for name in DIFFICULTIES}
    line = "| Half 1 | depth |" + " 0.500, -, - |" * len(DIFFICULTIES)
    assert line in tables([*both, replace(both[1], method="Half", version="1", figures=figures)])
    page = tmp_path / "page.md"
    page.write_text(f"{END}\n{BEGIN}\n")
    with pytest.raises(DamagedFileError, match="must hold the lines"):
        with_tables(page, alone)

"""The paper's tables: as the code knows them, with notes that hold and figures that docs hold."""

import re
from pathlib import Path

import pytest
from tests.evaluation.metrics.paper_occupancy import MINECRAFTOCC, NYU

from world2minecraft.cli.verbs import VERBS, load
from world2minecraft.evaluation.metrics.editing_effort import PAPER_REFINED, PAPER_SCRATCH
from world2minecraft.minecraftocc.statistics.published_figures import (
    PUBLISHED_QUALITY,
    PUBLISHED_SETS,
)
from world2minecraft.navigation.data.statistics import PAPER_LENGTHS
from world2minecraft.paper import fill_table, read_table, table_names
from world2minecraft.paper.table_reader import measured

ROOT = Path(__file__).resolve().parents[2]
NAMES = list(table_names())
MEASURED = [(table, row, ours) for table, rows in measured().items() for row, ours in rows.items()]
TESTED = {
    "base-next-view": 41,
    "base-next-action": 175,
    "extend-next-view": 230,
    "extend-next-action": 309,
    "combined-next-view": 271,
    "combined-next-action": 484,
}


def printed(name):
    """The numbers of a table as printed, by row and column."""
    table = read_table(name)
    return {
        row.key: dict(zip(table.columns, row.cells, strict=True))
        for row in table.rows
        if row.is_printed
    }


def numbers(cells):
    return [float(text.replace(",", "").strip("~%x")) for text in cells]


def test_the_eleven_tables_are_in_the_papers_order():
    assert list(table_names().values()) == list(range(1, 12))
    assert all(read_table(number).name == name for name, number in table_names().items())


@pytest.mark.parametrize("name", NAMES)
def test_a_table_is_whole(name):
    table = read_table(name)
    keys = [row.key for row in table.rows]
    assert len(set(keys)) == len(keys)
    assert not set(table.columns) & set(table.our_columns)
    assert all(len(row.cells) == len(table.columns) for row in table.rows)
    assert all(set(row.notes) <= set(table.columns) for row in table.rows)
    for lack in table.lacks:
        assert set(lack.rows) <= set(keys)
        assert set(lack.columns) <= set(table.fillable)


@pytest.mark.parametrize("name", NAMES)
def test_no_cell_is_both_measured_and_told_to_be_lacking_for_all(name):
    """Each row of ours says what it was measured on and how; and only known rows have one."""
    table, ours = fill_table(read_table(name))
    assert set(ours) <= {row.key for row in table.rows}
    for told in ours.values():
        assert told.data and told.command
        assert set(told.cells) <= set(table.fillable)


@pytest.mark.parametrize(("table", "row", "ours"), MEASURED, ids=lambda one: str(one)[:30])
def test_what_we_measured_stands_in_the_docs(table, row, ours):
    page = " ".join((ROOT / ours.page).read_text().replace("\n#", "\n").split())
    line = " ".join(ours.line.split())
    assert line in page, f"{ours.page} no longer says {line!r}"
    held = set(re.findall(r"[\d,.]*\d[\w]*", line))
    for value in ours.cells.values():
        assert set(re.findall(r"[\d,.]*\d[\w]*", value)) <= held, value


def commands():
    yield from (ours.command for _, _, ours in MEASURED)
    for name in NAMES:
        table, ours = fill_table(read_table(name))
        yield from (told.command for told in ours.values())
        yield from (lack.command for lack in table.lacks)
    for page in ("reproduce-the-paper", "print-the-papers-tables"):
        text = (ROOT / "docs" / "how-to" / f"{page}.md").read_text()
        for line in re.findall(r"(?:w2m|python -m) [^`\n]*", text):
            yield re.split(r"\s{3,}| \|", line)[0]


@pytest.mark.parametrize("command", sorted(set(commands())))
def test_a_command_exists_with_its_options(command):
    words = command.split()
    if words[0] == "python":
        place = ROOT / f"{words[2].replace('.', '/')}.py"
        stated = place.read_text()
    else:
        verb = max((v for v in VERBS if words[1 : 1 + len(v.split())] == v.split()), key=len)
        stated = [option for one in load(verb).params for option in one.opts]
    for word in words:
        if word.startswith("--"):
            assert word in stated, f"{command} has no {word}"


def test_data_sets_are_those_that_statistics_show():
    for row, one in zip(printed("datasets").values(), PUBLISHED_SETS, strict=True):
        scenes = row["scenes"].split()[0]
        told = numbers([row["images"], scenes, row["classes"], row["voxels"]])
        assert told == [one.pictures, one.scenes, one.classes, one.voxels]
        assert row["resolution"] == one.resolution
    for row, one in zip(printed("image-quality").values(), PUBLISHED_QUALITY, strict=True):
        assert numbers(list(row.values())[1:]) == [one.niqe, one.piqe, one.laplacian]


def test_occupancy_is_what_the_metrics_are_held_to():
    for row, text in zip(printed("occupancy").values(), MINECRAFTOCC.values(), strict=True):
        assert list(row.values())[2:] == text.split()
    for row, text in zip(printed("joint-training").values(), NYU.values(), strict=True):
        assert list(row.values())[1:] == text.split()


def test_lengths_and_effort_are_those_of_the_program():
    rows = printed("instructions")
    for (task, part), told in PAPER_LENGTHS.items():
        row = list(rows[f"{task.replace('_', '-')}-{part}"].values())[2:]
        assert numbers(row) == list(told)
    for column, told in (("scratch", PAPER_SCRATCH), ("refined", PAPER_REFINED)):
        cells = [row[column] for row in printed("refinement").values()]
        assert [None if cell == "--" else float(cell) for cell in cells] == list(told.values())


def shares(name):
    rows = printed("vln")[name]
    return {key: float(text) for key, text in rows.items() if key not in ("composition", "task")}


def test_accuracies_are_shares_of_the_right_split_but_one():
    """So the rows of the table of sizes are swapped, as its notes say."""
    odd = [
        (name, key)
        for name, count in TESTED.items()
        for key, share in shares(name).items()
        if min(abs(share - k / count) for k in range(count + 1)) > 0.00005001
    ]
    assert odd == [("base-next-view", "7b-none")]
    sizes = printed("dataset-sizes")
    assert sizes["base-next-view"]["test"] == str(TESTED["extend-next-view"])
    assert sizes["extend-next-action"]["test"] == str(TESTED["base-next-action"])
    ours = fill_table(read_table("dataset-sizes"))[1]
    assert {key: int(ours[key].cells["test"]) for key in TESTED} == TESTED


def test_notes_on_navigation_hold():
    k = {name: round(shares(name)["3b-none"] * count) for name, count in TESTED.items()}
    assert (k["base-next-view"], k["extend-next-view"], k["combined-next-view"]) == (9, 52, 62)
    combined = shares("combined-next-action")
    assert combined["7b-rft"] < combined["7b-sft"]
    assert combined["3b-sft"] < min(
        shares(f"{part}-next-action")["3b-sft"] for part in ("base", "extend")
    )


def test_notes_on_occupancy_hold():
    for name, first in (("occupancy", 7), ("joint-training", 3)):
        table = read_table(name)
        for row in table.rows:
            if not row.is_printed:
                continue
            cells = dict(zip(table.columns, row.cells, strict=True))
            mean = sum(numbers(row.cells[first:])) / 11
            wrong = abs(mean - float(cells["miou"])) > 0.0056  # The paper cuts, or rounds.
            assert wrong == (f"mean {mean:.2f}" in row.notes.get("miou", ""))
            if "precision" in cells:
                p, r = float(cells["precision"]) / 100, float(cells["recall"]) / 100
                iou = 100 / (1 / p + 1 / r - 1)
                wrong = abs(iou - float(cells["iou"])) > 0.02
                assert wrong == (f"give {iou:.2f}" in row.notes.get("iou", ""))
    rows = printed("occupancy")
    for method in ("monoscene", "ndc", "iso", "symphonies"):
        assert all(
            min(("8k", "50k", "100k"), key=lambda n: float(rows[f"{n}-{method}"][figure])) == "100k"
            for figure in ("iou", "miou")
        )
    nyu = printed("joint-training")
    for label in ("floor", "bed"):
        best = max(nyu, key=lambda key: float(nyu[key][label]))
        assert best == "ndc" and nyu[best][label] in _note(
            "joint-training", "symphonies-joint", label
        )


def _note(name, key, column):
    (row,) = [one for one in read_table(name).rows if one.key == key]
    return row.notes[column]


def test_classes_and_hyperparameters_are_the_programs_own():
    table, ours = fill_table(read_table("classes"))
    assert all(ours[row.key].cells["map"] == row.cells[0] for row in table.rows)
    told = fill_table(read_table("hyperparameters"))[1]
    same = (
        "learning-rate",
        "epochs",
        "global-batch",
        "kl",
        "rollouts",
        "temperature",
        "accumulation",
    )
    for key in same:
        row = printed("hyperparameters")[key]
        assert (told[key].cells["our-rft"], told[key].cells["our-sft"]) == (row["rft"], row["sft"])

"""The table of the fidelity benchmark: means, targets and verdicts. Its trials are not run here."""

import io
import math

import pytest
from benchmarks import check_faithful as bench
from benchmarks.check_faithful import COLUMNS, mean, rows_table, stages_table, verdicts
from rich.console import Console


def row(difficulty="noise", iou=0.9, floor_m=0.01, asked=2) -> dict:
    return {
        "trial": f"{difficulty}-500",
        "difficulty": difficulty,
        "surface_within_one_voxel": {"precision": 1.0, "recall": 0.9},
        "free_recall": 1.0,
        "occupancy": {"iou": iou, "miou": 0.5},
        "objects": {"f1": 0.9, "orientation_right": 1.0, "orientation_asked": asked},
        "frame_error": {"floor_m": floor_m, "tilt_deg": 0.1, "yaw_deg": 0.1, "walls_x_m": -0.03},
        "layout": {"collisions": 0, "out_of_bounds": 1, "semantic_integrity": 1.0},
        "calibration": {"all": {"error": 0.04}, "occupied": {"error": 0.06}},
        "world": {},
    }


def column(name):
    return next(column for column in COLUMNS if column.name == name)


def printed(table) -> str:
    console = Console(file=io.StringIO(), width=200)
    console.print(table)
    return console.file.getvalue()


def test_means_leave_out_trials_without_a_value():
    rows = [row(asked=0), row()]
    assert mean(column("turned"), rows) == 1.0
    assert math.isnan(mean(column("openings"), rows))
    assert mean(column("IoU"), [row(iou=0.8), row(iou=0.9)]) == pytest.approx(0.85)


def test_the_frame_is_as_good_as_its_worst_side():
    assert column("frame cm").read(row(floor_m=-0.01)) == pytest.approx(3.0)


def test_targets_are_met_or_missed_by_difficulty():
    rows = [row(iou=0.8), row(iou=0.78), row("clean", iou=0.96), row("all")]
    text = "\n".join(verdicts("labels", rows))
    assert "IoU >= 0.8: noise 0.790 (worst 0.780) [red]missed[/]" in text
    assert "IoU >= 0.95: clean 0.960 (worst 0.960) [green]met[/]" in text
    assert "all 0.900 (worst 0.900) [green]met[/]" in text
    assert "outside <= 0: noise 1.00 (worst 1.00) [red]missed[/]" in text
    assert "mIoU" not in text, "that target is the other labeller's"
    assert "mIoU >= 0.25" in "\n".join(verdicts("none", [row()]))


def test_a_row_for_each_difficulty_and_each_trial_on_request():
    rows = [row(), row(), row("all")]
    text = printed(rows_table("labels", rows))
    assert "noise (2)" in text and "all (1)" in text and "noise-500" not in text
    assert printed(rows_table("labels", rows, verbose=True)).count("noise-500") == 2


def test_stages_stand_under_the_run_itself():
    better = row(iou=0.97)
    text = printed(
        stages_table("labels", [row() | {"stages": {"labels": better, "fusion": better}}])
    )
    lines = [line.split() for line in text.splitlines()[2:]]
    assert [line[:2] for line in lines] == [
        ["noise", "none"], ["noise", "fusion"], ["noise", "labels"],
    ]  # fmt: skip
    assert "0.970" in lines[1]


def test_trials_are_the_first_of_each_difficulty():
    chosen = bench.chosen_trials("tune", ("noise", "clean"), 2)
    assert [trial.name for trial in chosen] == [
        "noise-500", "noise-501", "noise-500-clean", "noise-501-clean",
    ]  # fmt: skip
    assert [bench.group(trial) for trial in chosen] == ["noise", "noise", "clean", "clean"]
    assert all(500 <= trial.seed < 550 for trial in chosen)

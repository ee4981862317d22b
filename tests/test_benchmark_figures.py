"""What checks write as JSON for the report: the same figures as in the tables that they print."""

import io

import numpy as np
import pytest
from benchmarks import check_completion, check_fitting, check_forge_view
from benchmarks.check_faithful import TARGETS, figures_of, name_of
from benchmarks.check_fitting import Score
from rich.console import Console

from world2minecraft.networks.completion.samples import Sample
from world2minecraft.reconstruction.semantics.completion_channels import Sight


def row(difficulty="noise", labels="labels", iou=0.9, f1=0.9, outside=0):
    return {
        "difficulty": difficulty, "labels": labels, "share_of_allowed": 0.9,
        "surface_within_one_voxel": {"precision": 1.0, "recall": 0.9},
        "free_recall": 1.0,
        "occupancy": {"iou": iou, "miou": 0.5},
        "objects": {"f1": f1, "orientation_right": 1.0, "orientation_asked": 2},
        "frame_error": {"floor_m": 0.01, "tilt_deg": 0.1, "yaw_deg": 0.1, "walls_x_m": -0.03},
        "layout": {"collisions": 0, "out_of_bounds": outside, "semantic_integrity": 1.0},
        "calibration": {"all": {"error": 0.04}, "occupied": {"error": 0.06}},
    }  # fmt: skip


def test_a_fidelity_target_takes_the_worst_difficulty():
    rows = [row(f1=0.8), row(f1=1.0), row("all", f1=0.7), row("all", f1=0.9), row("clean", f1=0.1)]
    rows += [row(labels="none", f1=0.4, outside=2), row("all", "none", f1=0.6, iou=0.3)]
    found = figures_of(rows)
    assert sorted(found) == sorted(name_of(target) for target in TARGETS)
    assert found["labels F1"] == pytest.approx(0.8), "the mean of the home, not its worst"
    assert found["none F1"] == pytest.approx(0.4)
    assert found["noise IoU"] == pytest.approx(0.9), "the home's is not asked"
    assert found["clean IoU"] == pytest.approx(0.9)
    assert found["outside"] == 2, "of what may be at most so much the largest"
    with pytest.raises(ValueError, match="no trial of clean IoU is among the rows"):
        figures_of([one for one in rows if one["difficulty"] != "clean"])


def test_fitting_means_over_rooms_and_sums_what_is_counted():
    scores = [Score(0.5, 0.1, 1, 0, 2.0), Score(0.7, 0.3, 2, 0, 4.0)]
    (told,) = check_fitting.figures({(4.0, "room from 2 cm"): scores})
    assert told == {
        "scale": 4.0, "what": "room from 2 cm", "iou": pytest.approx(0.6),
        "thin": pytest.approx(0.2), "unstable": 3, "loose": 0, "seconds": pytest.approx(3.0),
    }  # fmt: skip


def test_frames_of_the_editor_are_told_as_they_are_printed():
    rows = [{"scene": "demo", "by": "SceneForge", "cells": 12_345, "first": 0.614, "moving": 33.2}]
    console = Console(file=io.StringIO(), width=120)
    console.print(check_forge_view.table_of(rows))
    text = console.file.getvalue()
    assert all(word in text for word in ("demo", "12,345", "0.61", "33"))


def test_completion_is_told_by_scans_cells_and_who_answers():
    log_odds = np.zeros((4, 4, 4), np.int8)
    log_odds[0] = 1
    truth = np.zeros((4, 4, 4), np.uint8)
    truth[0], truth[1] = 3, 7  # A wall that was seen, a sofa that was not.
    sight = Sight(log_odds, np.flatnonzero(log_odds).astype(np.int32), np.ones(16, np.uint8), 0.08)
    sample = Sample(sight, truth, "tour", True, 0.0)
    scores = check_completion.Scores()
    scores.add("completion", "multi", np.where(log_odds > 0, np.uint8(3), np.uint8(0)), sample)
    told = check_completion.figures_told([scores, scores])
    found = told["scores"]["multi"]["completion"]
    assert found["all"] == {"iou": 50.0, "miou": pytest.approx(100 / 11)}
    assert found["observed"]["iou"] == 100.0
    assert told["observed classes"]["wall"] == 100.0

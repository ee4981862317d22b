"""What checks write as JSON for the report: the same figures as in the tables that they print."""

import io
from pathlib import Path

import numpy as np
import pytest
from benchmarks import check_completion, check_fitting, check_forge_view, check_single_frames
from benchmarks.check_faithful import TARGETS, figures_of, name_of
from benchmarks.check_fitting import Score
from rich.console import Console

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.types import Camera, Layout
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts
from world2minecraft.evaluation.metrics.protocols import ProtocolCounts
from world2minecraft.evaluation.scoring.truth_files import Truth
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


def test_a_view_without_its_floor_ends_above_it():
    camera = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)
    pose = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 1.0], [0, 0, 0, 1]], np.float64)
    slope = (np.arange(48) + 0.5 - camera.cy_px) / camera.fy_px
    depth_m = np.repeat(np.minimum(1.0 / np.maximum(slope, 1e-6), 3.0)[:, None], 64, axis=1)
    view = check_single_frames.View(
        depth_m.astype(np.float32), np.zeros((48, 64, 3), np.uint8), camera, pose, np.eye(3)
    )
    cut = check_single_frames.without_floor(view)
    rows = len(cut.depth_m)
    assert cut.camera.height_px == cut.colour.shape[0] == rows
    assert (1.0 - slope[rows - 1] * 3.0 >= 0.15) and (1.0 - slope[rows] * 3.0 < 0.15)


def test_behind_thin_walls_nothing_is_known():
    square = np.array([[0.1, 0.1], [0.5, 0.1], [0.5, 0.5], [0.1, 0.5]])
    labels = np.full((30, 30, 30), 3, np.uint8)
    layout = Layout(square, 0.4)
    truth = Truth(Path(), labels, 0.02, np.array([0.0, 0.0, -0.1]), np.eye(4), (), (layout,))
    known = check_single_frames.open_truth(truth) != UNKNOWN
    x, y, z = (np.flatnonzero(known.any(axis=axes)) for axes in ((1, 2), (0, 2), (0, 1)))
    assert [x[0], x[-1]] == [y[0], y[-1]] == [3, 26], "two cells around those from 5 to 24"
    assert [z[0], z[-1]] == [3, 26]


def test_single_frames_are_pooled_but_for_present_classes():
    truth = np.array([3, 3, 2, 0], np.uint8).reshape(1, 2, 2)
    said = np.array([3, 0, 2, 2], np.uint8).reshape(1, 2, 2)
    counts = check_single_frames.count_occupancy(said, truth)
    one = check_single_frames.Scores(ProtocolCounts(counts, counts), OccupancyCounts(), 4)
    found = check_single_frames.figures([one, one])
    assert found["iou"] == pytest.approx(50.0)
    assert found["miou_present"] == pytest.approx(50.0)
    assert found["miou"] == pytest.approx(100 / 11, abs=0.01)
    assert (found["beyond"], found["frames"]) == (4, 2)
    console = Console(file=io.StringIO(), width=150)
    console.print(check_single_frames.figures_table({"all": found}))
    assert "50.0" in console.file.getvalue()

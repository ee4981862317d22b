"""Calibrated confidence: what it may depend on, what it must not touch, and its table."""

import json

import numpy as np
import pytest

from world2minecraft.errors import DamagedFileError
from world2minecraft.fuse import ConfidenceTable, calibrate, confidence, confidence_table
from world2minecraft.fuse.confidence import _neighbours
from world2minecraft.types import FusedEvidence, OccupancyGrid

TABLE = ConfidenceTable(
    occupied=(2.0, 1.0, 0.5, 1.0, 1.0, 2.0, 0.0, 0.7),
    classes=tuple(-0.1 * n for n in range(12)),
    free=(3.0, -2.0, -1.0, -1.5, -0.5, -0.5),
    completed=(0.5,) * 12,
    uses_votes=True,
    uses_said=True,
)


def scene(seed: int = 0) -> tuple[OccupancyGrid, FusedEvidence]:
    random = np.random.default_rng(seed)
    shape = (7, 6, 5)
    log_odds = random.normal(0, 3, shape).astype(np.float16)
    labels = np.where(log_odds > 0, random.integers(1, 12, shape), 0).astype(np.uint8)
    labels[0] = 255
    source = np.where(labels == 255, 0, 1).astype(np.uint8)
    source[1], labels[1] = 2, 3
    evidence = FusedEvidence(
        log_odds=log_odds,
        votes=random.integers(0, 9, (*shape, 12)).astype(np.float16),
        colour_sum=np.zeros((*shape, 3), np.float32),
        offset_sum=np.zeros((*shape, 3), np.float32),
        hits=random.integers(0, 500, shape).astype(np.uint16),
        voxel_m=0.08,
        origin_m=np.zeros(3),
        scan_to_room=np.eye(4),
    )
    grid = OccupancyGrid(
        labels=labels,
        confidence=random.uniform(0, 1, shape).astype(np.float16),
        colour=np.zeros((*shape, 3), np.uint8),
        source=source,
        instance=np.zeros(shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )
    return grid, evidence


def test_only_confidence_changes_and_each_kind_of_cell_has_its_own():
    grid, evidence = scene()
    found = calibrate(grid, evidence, TABLE)
    for name in ("labels", "source", "colour", "instance"):
        assert np.array_equal(getattr(found, name), getattr(grid, name))
    assert (found.confidence[grid.source == 0] == 0).all()
    assert (found.confidence[grid.source == 2] == 0.5).all()
    observed = found.confidence[grid.source == 1].astype(float)
    assert observed.min() >= 0.01 - 1e-3 and observed.max() <= 0.995 + 1e-3
    assert len(np.unique(observed)) > 20


def test_the_chance_is_the_logistic_of_the_features_read_cell_by_cell():
    grid, evidence = scene(3)
    found = calibrate(grid, evidence, TABLE)
    padded = np.pad(grid.labels, 1, constant_values=255)
    for i, j, k in np.argwhere(grid.occupied & (grid.source == 1))[::5]:
        box = padded[i : i + 3, j : j + 3, k : k + 3]
        label = grid.labels[i, j, k]
        same = ((box == label).sum() - 1) / 26
        around = (((box > 0) & (box != 255)).sum() - 1) / 26
        votes = evidence.votes[i, j, k].astype(float)
        share = votes[label] / votes.sum()
        own = np.clip(float(grid.confidence[i, j, k]), 0.01, 0.995)
        row = [
            np.clip(float(evidence.log_odds[i, j, k]), -6, 6) / 6,
            np.log1p(float(evidence.hits[i, j, k])) / 8,
            1, share, share**2, same, around, np.log(own / (1 - own)),
        ]  # fmt: skip
        value = np.dot(row, TABLE.occupied) + TABLE.classes[label]
        expected = np.clip(1 / (1 + np.exp(-value)), 0.01, 0.995)
        assert abs(float(found.confidence[i, j, k]) - expected) < 2e-3


def test_a_labeller_that_uses_no_votes_is_deaf_to_them():
    grid, evidence = scene(1)
    deaf = ConfidenceTable(TABLE.occupied, TABLE.classes, TABLE.free, TABLE.completed, False)
    silent = FusedEvidence(
        evidence.log_odds, np.zeros_like(evidence.votes), evidence.colour_sum,
        evidence.offset_sum, evidence.hits, 0.08, np.zeros(3), np.eye(4),
    )  # fmt: skip
    a, b = calibrate(grid, evidence, deaf), calibrate(grid, silent, deaf)
    assert np.array_equal(a.confidence, b.confidence)
    assert not np.array_equal(a.confidence, calibrate(grid, evidence, TABLE).confidence)


def test_without_a_table_nothing_changes():
    grid, evidence = scene()
    assert calibrate(grid, evidence, None) is grid
    assert confidence_table("somebody's own") is None


def test_the_package_has_a_table_for_both_of_its_labellers():
    votes, geometric = confidence_table("votes"), confidence_table("geometric")
    assert votes is not None and votes.uses_votes
    assert geometric is not None and not geometric.uses_votes
    assert votes.occupied[3] + votes.occupied[4] > 0, "a clear vote makes surer"


def test_neighbours_are_counted_without_the_cell_itself():
    mask = np.zeros((5, 5, 5), bool)
    mask[1:4, 1:4, 1:4] = True
    assert _neighbours(mask)[2, 2, 2] == 1.0
    assert _neighbours(mask)[0, 0, 0] == 1 / 26
    assert _neighbours(np.ones((3, 3, 3), bool))[0, 0, 0] == 7 / 26


def test_grid_and_evidence_of_two_rooms_are_refused():
    grid, evidence = scene()
    small = FusedEvidence(
        evidence.log_odds[:3], evidence.votes[:3], evidence.colour_sum[:3],
        evidence.offset_sum[:3], evidence.hits[:3], 0.08, np.zeros(3), np.eye(4),
    )  # fmt: skip
    with pytest.raises(ValueError, match="differ"):
        calibrate(grid, small, TABLE)


def test_a_damaged_table_says_which_file(tmp_path, monkeypatch):
    path = tmp_path / "confidence.json"
    path.write_text(json.dumps({"labellers": {"votes": {"occupied": [1, 2]}}}))
    monkeypatch.setattr(confidence, "TABLES", path)
    confidence._tables.cache_clear()
    with pytest.raises(DamagedFileError, match="holds no confidence tables"):
        confidence_table("votes")
    confidence._tables.cache_clear()


def test_a_table_of_the_wrong_size_is_refused():
    with pytest.raises(ValueError, match="occupied must be 8 finite numbers"):
        ConfidenceTable((1.0,), TABLE.classes, TABLE.free, TABLE.completed, True)

"""Calibrated confidence: what it may depend on, what it must not touch, and its table."""

import json
from dataclasses import replace

import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.fusion import ConfidenceTable, calibrate, confidence_table
from world2minecraft.reconstruction.fusion import confidence_calibration as confidence
from world2minecraft.reconstruction.fusion.confidence_calibration import (
    _neighbours,
    free_features,
    occupied_features,
)

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


def test_calibration_changes_confidence_only_by_cell_kind():
    grid, evidence = scene()
    found = calibrate(grid, evidence, TABLE)
    for name in ("labels", "source", "colour", "instance"):
        assert np.array_equal(getattr(found, name), getattr(grid, name))
    assert (found.confidence[grid.source == 0] == 0).all()
    assert (found.confidence[grid.source == 2] == 0.5).all()
    observed = found.confidence[grid.source == 1].astype(float)
    assert observed.min() >= 0.01 - 1e-3 and observed.max() <= 0.995 + 1e-3
    assert len(np.unique(observed)) > 20


def test_confidence_is_the_logistic_of_cell_features():
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


def sparse_scene(seed: int) -> tuple[OccupancyGrid, FusedEvidence]:
    """Free cells mostly, few of them beside something, of any hits and log-odds."""
    random = np.random.default_rng(seed)
    grid, evidence = scene(seed)
    labels = np.zeros(grid.shape, np.uint8)
    kinds = random.random(grid.shape)
    labels[kinds < 0.02], labels[kinds > 0.98] = 5, 255
    grid = replace(grid, labels=labels, source=(labels != 255).astype(np.uint8))
    log_odds = random.uniform(-10, 0, grid.shape).astype(np.float16)
    hits = random.integers(0, 3, grid.shape).astype(np.uint16)
    return grid, replace(evidence, log_odds=log_odds, hits=hits)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_chance_of_a_free_cell_is_read_cell_by_cell(seed):
    """What it is beside, what lies two cells off, and whether the unknown begins beside it."""
    grid, evidence = sparse_scene(seed)
    found = calibrate(grid, evidence, TABLE)
    occupied, unknown = np.pad(grid.labels == 5, 2), np.pad(grid.labels == 255, 2)
    kinds = set()
    for i, j, k in np.argwhere(grid.labels == 0):
        near = tuple(slice(n + 1, n + 4) for n in (i, j, k))
        wide = tuple(slice(n, n + 5) for n in (i, j, k))
        beside, two_off = occupied[near].any(), occupied[wide].any() and not occupied[near].any()
        log_odds, hits = float(evidence.log_odds[i, j, k]), evidence.hits[i, j, k]
        row = [1, max(log_odds, -6) / 6, hits > 0, beside, two_off, unknown[near].any()]
        expected = np.clip(1 / (1 + np.exp(-np.dot(row, TABLE.free))), 0.01, 0.995)
        assert abs(float(found.confidence[i, j, k]) - expected) < 2e-3
        kinds.add((bool(beside), bool(two_off)))
    assert len(kinds) == 3


def test_unvoted_labels_have_no_share_and_log_odds_a_bound():
    grid, evidence = scene(2)
    votes = np.zeros_like(evidence.votes)
    votes[::2, ..., :] = 0.02  # Twelve of them are less than one vote.
    log_odds = np.where(np.arange(6)[:, None] % 2, 9, -9) * np.ones(grid.shape)
    evidence = replace(evidence, votes=votes, log_odds=log_odds.astype(np.float16))
    rows = occupied_features(grid, evidence, np.ones(grid.shape, bool) & grid.occupied, True)
    voted = np.argwhere(grid.occupied)[:, 0] % 2 == 0
    np.testing.assert_array_equal(rows[:, 2], voted)
    np.testing.assert_allclose(rows[:, 3], voted / 12, rtol=1e-3)
    assert set(rows[:, 0]) == {-1.0, 1.0}
    assert not rows[:, 7].any(), "what the labeller said is no feature unless it is asked for"


def test_labeller_confidence_counts_if_its_table_says_so():
    grid, evidence = scene(1)
    unsure = replace(grid, confidence=np.full(grid.shape, 0.5, np.float16))
    silent = ConfidenceTable(TABLE.occupied, TABLE.classes, TABLE.free, TABLE.completed, True)
    a, b = calibrate(grid, evidence, silent), calibrate(unsure, evidence, silent)
    np.testing.assert_array_equal(a.confidence, b.confidence)
    c, d = calibrate(grid, evidence, TABLE), calibrate(unsure, evidence, TABLE)
    assert not np.array_equal(c.confidence, d.confidence)


def test_a_completed_cell_has_what_was_right_of_its_class():
    grid, evidence = scene(0)
    labels = grid.labels.copy()
    labels[1] = np.arange(30).reshape(6, 5) % 11 + 1
    shares = tuple(n / 20 for n in range(12))
    found = calibrate(replace(grid, labels=labels), evidence, replace(TABLE, completed=shares))
    np.testing.assert_allclose(found.confidence[1], labels[1] / 20, atol=1e-3)


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
    with pytest.raises(ValueError, match="does not match grid shape"):
        calibrate(grid, small, TABLE)


def test_a_damaged_table_says_which_file(tmp_path, monkeypatch):
    path = tmp_path / "confidence.json"
    path.write_text(json.dumps({"labellers": {"votes": {"occupied": [1, 2]}}}))
    monkeypatch.setattr(confidence, "TABLES", path)
    confidence._tables.cache_clear()
    with pytest.raises(DamagedFileError, match="is not a valid confidence table file"):
        confidence_table("votes")
    confidence._tables.cache_clear()


def test_a_table_of_the_wrong_size_is_refused():
    with pytest.raises(ValueError, match="occupied must be 8 finite numbers"):
        ConfidenceTable((1.0,), TABLE.classes, TABLE.free, TABLE.completed, True)


def test_log_odds_of_a_free_cell_count_up_to_six_either_way():
    grid, evidence = scene(3)
    log_odds = np.resize([-9.0, -6.0, 5.5, 8.0], grid.shape).astype(np.float16)
    rows = free_features(grid, replace(evidence, log_odds=log_odds), np.ones(grid.shape, bool))
    expected = np.resize([-1.0, -1.0, 5.5 / 6, 1.0], grid.shape).ravel()
    np.testing.assert_allclose(rows[:, 1], expected, rtol=1e-6)

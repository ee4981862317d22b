"""SSCMetrics' maths: by hand, against a slow reading, and against the paper's own figures."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.evaluation.metrics.occupancy import (
    OccupancyCounts,
    count_occupancy,
    iou_of_precision_recall,
)

LABELS = st.sampled_from([0, 1, 2, 3, 5, 9, 11, 255])


def grids(shape=(3, 4, 2)):
    return stn.arrays(np.uint8, shape, elements=LABELS)


def slow_figures(predicted, truth):
    """Each figure from its definition, cell by cell."""
    cells = [
        (0 if p == 255 else int(p), int(t))
        for p, t in zip(predicted.reshape(-1), truth.reshape(-1), strict=True)
        if t != 255
    ]
    hit = sum(p > 0 and t > 0 for p, t in cells)
    extra = sum(p > 0 and t == 0 for p, t in cells)
    missed = sum(p == 0 and t > 0 for p, t in cells)
    ious = []
    for c in range(1, 12):
        both = sum(p == c and t == c for p, t in cells)
        either = sum(p == c or t == c for p, t in cells)
        ious.append(both / either if either else 0.0)
    return (
        hit / (hit + extra + missed) if hit + extra + missed else 0.0,
        hit / (hit + extra) if hit + extra else 0.0,
        hit / (hit + missed) if hit + missed else 0.0,
        sum(ious) / 11,
    )


def test_a_confusion_by_hand():
    truth = np.array([2, 2, 2, 3, 0, 0, 255, 5], np.uint8)
    predicted = np.array([2, 2, 3, 3, 2, 0, 2, 0], np.uint8)
    counts = count_occupancy(predicted, truth)
    # Occupied in both: 4; called occupied and empty: 1; missed: 1 (the chair).
    assert (counts.true_positives, counts.false_positives, counts.false_negatives) == (4, 1, 1)
    assert counts.cells == 7
    assert counts.iou == pytest.approx(4 / 6)
    assert counts.precision == counts.recall == pytest.approx(4 / 5)
    # Floor: 2 right, 1 missed, 1 too many; wall: 1 right, 1 too many; chair: none right.
    assert counts.class_iou[[2, 3, 5]].tolist() == pytest.approx([2 / 4, 1 / 2, 0])
    assert counts.miou == pytest.approx((2 / 4 + 1 / 2) / 11)
    assert counts.miou_present == pytest.approx((2 / 4 + 1 / 2 + 0) / 3)
    assert counts.label_accuracy == pytest.approx(3 / 4)


def test_every_class_but_empty_counts_for_right_labels():
    labels = np.array([1, 11, 0, 0], np.uint8)
    assert count_occupancy(labels, labels).label_accuracy == 1.0
    assert count_occupancy(labels, np.array([1, 5, 0, 7], np.uint8)).label_accuracy == 0.5


@pytest.mark.parametrize(("precision", "recall"), [(0.0, 0.5), (0.5, 0.0), (0.0, 0.0)])
def test_without_a_hit_there_is_no_iou(precision, recall):
    assert iou_of_precision_recall(precision, recall) == 0.0


@pytest.mark.parametrize("table", [np.zeros((11, 12), int), np.full((12, 12), -1), np.zeros(144)])
def test_what_is_no_table_of_counts_is_refused(table):
    with pytest.raises(ValueError, match="table must contain 12 x 12 counts"):
        OccupancyCounts(table)


@given(grids(), grids())
def test_figures_follow_their_definitions(predicted, truth):
    counts = count_occupancy(predicted, truth)
    expected = slow_figures(predicted, truth)
    found = (counts.iou, counts.precision, counts.recall, counts.miou)
    assert found == pytest.approx(expected)


@given(grids(), grids(), grids(), grids())
def test_counts_of_two_scenes_are_the_counts_of_both_together(a, b, c, d):
    apart = count_occupancy(a, b) + count_occupancy(c, d)
    together = count_occupancy(np.concatenate([a, c]), np.concatenate([b, d]))
    assert np.array_equal(apart.table, together.table)


@given(grids())
def test_a_grid_scores_full_against_itself(labels):
    counts = count_occupancy(labels, labels)
    present = {int(c) for c in np.unique(labels)} - {0, 255}
    assert counts.iou == counts.miou_present == (1.0 if present else 0.0)
    assert counts.miou == pytest.approx(len(present) / 11)


@given(grids(), grids())
def test_iou_follows_from_precision_and_recall(predicted, truth):
    counts = count_occupancy(predicted, truth)
    assert counts.iou == pytest.approx(iou_of_precision_recall(counts.precision, counts.recall))


@given(grids(), grids(), stn.arrays(np.bool_, (3, 4, 2)))
def test_a_mask_leaves_cells_out_as_unknown_truth_does(predicted, truth, mask):
    masked = count_occupancy(predicted, truth, mask)
    hidden = count_occupancy(predicted, np.where(mask, truth, np.uint8(255)))
    assert np.array_equal(masked.table, hidden.table)


# The paper's row of MonoScene trained on 8k, in percent, ceiling to objs.
MONOSCENE_8K = (54.28, 78.68, 32.14, 0.00, 11.20, 12.56, 13.15, 8.67, 1.94, 10.86, 6.74)


def test_the_papers_figures_agree_with_each_other():
    assert round(100 * iou_of_precision_recall(0.4854, 0.7146), 2) == 40.66
    right = np.round(100 * np.array(MONOSCENE_8K)).astype(int)
    table = np.zeros((12, 12), int)
    table[range(1, 12), range(1, 12)] = right
    table[1:, 0] = 10_000 - right
    counts = OccupancyCounts(table)
    assert 100 * counts.class_iou[1:] == pytest.approx(np.array(MONOSCENE_8K))
    assert round(100 * counts.miou, 2) == 20.93


def test_mean_over_eleven_classes_counts_absent_ones_as_zero():
    table = np.zeros((12, 12), int)
    table[2, 2] = 10
    counts = OccupancyCounts(table)
    assert counts.miou == pytest.approx(1 / 11)
    assert counts.miou_present == 1.0


def test_unknown_predictions_are_empty_or_occupied_as_asked():
    truth = np.array([0, 2], np.uint8)
    predicted = np.array([255, 255], np.uint8)
    assert count_occupancy(predicted, truth).recall == 0
    occupied = count_occupancy(predicted, truth, unknown_as="occupied")
    assert (occupied.recall, occupied.precision) == (1.0, 0.5)


def test_figures_name_all_classes_but_empty():
    figures = count_occupancy(np.zeros(3, np.uint8), np.zeros(3, np.uint8)).figures()
    assert tuple(figures["class_iou"]) == CLASS_NAMES[1:]
    assert figures["iou"] == 0.0


@pytest.mark.parametrize(
    ("predicted", "truth", "mask"),
    [
        (np.zeros((2, 2), np.uint8), np.zeros((2, 3), np.uint8), None),
        (np.zeros((2, 2), np.int64), np.zeros((2, 2), np.uint8), None),
        (np.full((2, 2), 12, np.uint8), np.zeros((2, 2), np.uint8), None),
        (np.zeros((2, 2), np.uint8), np.zeros((2, 2), np.uint8), np.ones((3, 2), bool)),
    ],
)
def test_wrong_shapes_types_and_ids_are_refused(predicted, truth, mask):
    with pytest.raises(ValueError, match="must (have|be|contain)"):
        count_occupancy(predicted, truth, mask)

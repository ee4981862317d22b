"""Calibration against cases that were counted by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from world2minecraft.evaluation.metrics.calibration import CalibrationCounts, count_calibration


def test_a_case_counted_by_hand():
    """Ten of 0.95 of which eight are right, five of 0.55 of which four are."""
    confidence = np.array([0.95] * 10 + [0.55] * 5)
    right = np.array([True] * 8 + [False] * 2 + [True] * 4 + [False])
    counts = count_calibration(confidence, right)
    assert counts.error == pytest.approx((10 * 0.15 + 5 * 0.25) / 15)
    assert counts.rows() == [
        {"from": 0.5, "to": 0.6, "cells": 5, "confidence": 0.55, "right": 0.8},
        {"from": 0.9, "to": 1.0, "cells": 10, "confidence": 0.95, "right": 0.8},
    ]


def test_calibration_table_is_rounded():
    counts = count_calibration(np.array([0.41, 0.45, 0.493]), np.array([True, False, False]))
    row = {"from": 0.4, "to": 0.5, "cells": 3, "confidence": 0.451, "right": 0.3333}
    assert counts.rows() == [row]


def test_edges_belong_to_the_bin_above_and_one_to_the_last():
    counts = count_calibration(np.array([0.0, 0.1, 0.2, 0.3, 1.0]), np.ones(5, bool))
    assert counts.cells.tolist() == [1, 1, 1, 1, 0, 0, 0, 0, 0, 1]


def test_half_precision_falls_into_the_bin_that_was_meant():
    values = np.arange(11).astype(np.float16) / np.float16(10)
    assert count_calibration(values, np.ones(11, bool)).cells.tolist() == [1] * 9 + [2]


def test_no_cells_have_no_error():
    assert count_calibration(np.zeros(0), np.zeros(0, bool)).error == 0.0
    assert CalibrationCounts().rows() == []


@given(arrays.arrays(np.float64, 40, elements=st.floats(0, 1)), st.integers(0, 40))
def test_scenes_add_up_to_the_whole(confidence, cut):
    right = confidence > 0.37
    whole = count_calibration(confidence, right)
    parts = count_calibration(confidence[:cut], right[:cut]) + count_calibration(
        confidence[cut:], right[cut:]
    )
    assert parts.error == pytest.approx(whole.error)
    assert 0 <= whole.error <= 1


@given(arrays.arrays(np.float64, 40, elements=st.floats(0.5, 1)))
def test_sure_and_always_right_is_off_by_what_is_missing_to_one(confidence):
    error = count_calibration(confidence, np.ones(40, bool)).error
    assert error == pytest.approx(1 - confidence.mean())


def test_what_is_no_confidence_is_refused():
    with pytest.raises(ValueError, match="confidence must be between 0 and 1"):
        count_calibration(np.array([1.5]), np.array([True]))
    with pytest.raises(ValueError, match=r"must have the same shape, got \(1,\) and \(2,\)"):
        count_calibration(np.array([0.5]), np.array([True, False]))

"""The comparison with VoxelBlockGrid: its choice of frames and its figures."""

import itertools

import pytest
from benchmarks.compare_fusion import Cost, every_nth, summary
from hypothesis import given
from hypothesis import strategies as st


@given(st.integers(0, 60), st.integers(1, 70))
def test_frames_are_spread_evenly(length, count):
    chosen = every_nth(range(length), count)
    assert len(chosen) == min(length, count)
    steps = {b - a for a, b in itertools.pairwise(chosen)}
    assert len(steps) <= 1 and (not chosen or chosen[0] == 0)


def test_the_summary_has_least_medians_and_ratios():
    ours = [Cost(0.010, 0.3), Cost(0.008, 0.2), Cost(0.009, 0.4)]
    rival = [Cost(0.016, 0.01), Cost(0.024, 0.02), Cost(0.018, 0.03)]
    assert summary(ours, rival) == pytest.approx(
        {
            "ours_frame_ms": 8, "ours_frame_median_ms": 9, "ours_extraction_ms": 200,
            "open3d_frame_ms": 16, "open3d_frame_median_ms": 18, "open3d_extraction_ms": 10,
            "ratio": 2, "ratio_of_medians": 2,
        }
    )  # fmt: skip


def test_the_summary_without_a_rival_has_no_ratio():
    figures = summary([Cost(0.01, 0.1)], [])
    assert set(figures) == {"ours_frame_ms", "ours_frame_median_ms", "ours_extraction_ms"}

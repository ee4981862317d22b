"""The time left of a run, by a clock that the test sets."""

import pytest

from world2minecraft.api.time_left import COSTS, DEMO, FROM_PHOTOS, RECONSTRUCTION, TimeLeft

# Seconds of each stage in recorded runs on two cores.
KITCHEN_S = (3.2, 4.3, 7.7, 0.8, 0.3, 2.1, 3.5, 1.2, 5.5)  # With votes of the segmentation network.
KITCHEN_COMPILING_S = (5.11, 8.33, 3.61, 0.27, 2.35, 0.83, 3.5, 2.37, 2.75)
DEMO_S = (0.61, 3.65, 0.62, 0.81, 1.65, 0.37, 0.11, 0.28, 3.5, 0.19, 3.69)
DEMO_160_S = (1.71, 20.07, 1.52, 4.72, 6.81, 0.70, 0.16, 0.32, 3.5, 0.75, 10.37)
RUNS = [
    pytest.param(RECONSTRUCTION, KITCHEN_S, 40, id="kitchen"),
    pytest.param(RECONSTRUCTION, KITCHEN_COMPILING_S, 40, id="kitchen, compiling"),
    pytest.param(DEMO, DEMO_S, 40, id="demo"),
    pytest.param(DEMO, DEMO_160_S, 160, id="demo of 160 frames"),
]


def left_s(estimate, now_s):
    left = estimate.left_s(now_s)
    assert left is not None
    return left


def begin(estimate, stage, frames, now_s):
    estimate.report(stage, 0, frames if COSTS[stage].has_frames else 1, now_s)


@pytest.mark.parametrize(("stages", "seconds", "frames"), RUNS)
def test_the_first_estimate_is_within_a_factor_of_two(stages, seconds, frames):
    estimate = TimeLeft(stages)
    begin(estimate, stages[0], frames, 0.0)
    begin(estimate, stages[1], frames, seconds[0])
    assert 0.5 < left_s(estimate, seconds[0]) / sum(seconds[1:]) < 2


def test_a_run_as_expected_is_estimated_exactly():
    estimate, now = TimeLeft(FROM_PHOTOS), 0.0
    total = sum(COSTS[stage].seconds(40) for stage in FROM_PHOTOS)
    for stage in FROM_PHOTOS:
        begin(estimate, stage, 40, now)
        assert now == 0.0 or estimate.left_s(now) == pytest.approx(total - now)
        now += COSTS[stage].seconds(40)


def test_nothing_is_estimated_in_the_first_stage():
    estimate = TimeLeft(RECONSTRUCTION)
    assert estimate.left_s(0.0) is None
    estimate.report("scan", 1, 2, 5.0)
    assert estimate.left_s(6.0) is None


def test_a_slow_machine_has_more_time_left():
    def left(seconds):
        estimate = TimeLeft(RECONSTRUCTION)
        begin(estimate, "scan", 40, 0.0)
        begin(estimate, "register", 40, seconds)
        return left_s(estimate, seconds)

    assert left(1.0) < left(10.0) < left(100.0)


def test_the_speed_of_a_stage_outweighs_its_expected_cost():
    estimate = TimeLeft(("scan", "fuse"))
    begin(estimate, "scan", 40, 0.0)
    begin(estimate, "fuse", 40, 1.0)
    estimate.report("fuse", 39, 40, 1.0 + 390.0)
    assert estimate.left_s(391.0) == pytest.approx(10.0, rel=0.05)


def test_stages_that_a_resumed_run_skips_cost_nothing():
    estimate = TimeLeft(RECONSTRUCTION)
    begin(estimate, "scan", 40, 0.0)
    begin(estimate, "report", 40, COSTS["scan"].seconds(40))
    assert estimate.left_s(COSTS["scan"].seconds(40)) == pytest.approx(COSTS["report"].seconds(40))


def test_a_stage_that_is_not_of_the_run_is_ignored():
    estimate = TimeLeft(RECONSTRUCTION)
    begin(estimate, "scan", 40, 0.0)
    estimate.report("compile", 1, 2, 1.0)
    assert estimate.left_s(1.0) is None

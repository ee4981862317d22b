"""A network's depth fills holes: laws, with networks that are made up."""

import numpy as np
import pytest

from world2minecraft.capture.stereo.monocular_depth import (
    DEPTH_MODELS,
    FILLED_TRUST,
    _fit_inverse_depth,
    fill_holes,
    load_depth_model,
)
from world2minecraft.core.errors import UnknownNameError, UsageError

NO_PX, NO_M = np.zeros((0, 2)), np.zeros(0)


def slanted(high=60, wide=80):
    """A wall seen at a slant, 1.5 to 4 m: float32 [high, wide]."""
    v, u = np.mgrid[:high, :wide]
    return (1 / (0.25 + 0.4 * u / wide + 0.02 * v / high)).astype(np.float32)


def with_hole(true_m):
    """Depth and trust with a hole of 20x24 pixels."""
    depth_m, trust = true_m.copy(), np.full(true_m.shape, 255, np.uint8)
    depth_m[20:40, 30:54] = 0
    trust[20:40, 30:54] = 0
    return depth_m, trust


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("metric", lambda z: z * 0.37),
        ("metric", lambda z: z),
        ("inverse", lambda z: 40 / z + 7),
        ("inverse", lambda z: 0.01 / z - 0.004),
    ],
)
def test_an_exact_network_is_fitted_exactly(kind, said):
    true_m = slanted()
    depth_m, trust = with_hole(true_m)
    got_m, got = fill_holes(depth_m, trust, said(true_m).astype(np.float32), kind, NO_PX, NO_M)
    np.testing.assert_allclose(got_m, true_m, rtol=1e-3)
    assert (got == np.where(depth_m == 0, FILLED_TRUST, 255)).all()


def test_sparse_points_do_where_stereo_found_nothing():
    true_m = slanted()
    rng = np.random.default_rng(3)
    at = rng.uniform([0, 0], [80, 60], (60, 2))
    guide_m = true_m[at[:, 1].astype(int), at[:, 0].astype(int)].astype(np.float64)
    nothing = np.zeros_like(true_m)
    got_m, got = fill_holes(nothing, nothing.astype(np.uint8), true_m * 3, "metric", at, guide_m)
    assert (got == FILLED_TRUST).mean() > 0.9
    np.testing.assert_allclose(got_m[got > 0], true_m[got > 0], rtol=1e-4)


def test_a_third_of_wrong_points_does_not_move_it():
    true_m = slanted()
    rng = np.random.default_rng(4)
    guess = 3 / true_m.ravel().astype(np.float64) + 1
    wrong = true_m.ravel() * np.where(rng.random(true_m.size) < 0.3, 1.9, 1.0)
    by, plus = _fit_inverse_depth(guess, wrong, np.ones(len(guess)))
    np.testing.assert_allclose(guess * by + plus, 1 / true_m.ravel(), rtol=0.01)


@pytest.mark.parametrize("kind", ["metric", "inverse"])
@pytest.mark.parametrize(
    "said",
    [
        lambda z: np.random.default_rng(0).uniform(0.1, 5, z.shape),
        lambda z: z[:, ::-1],
        lambda z: np.full(z.shape, np.nan),
        lambda z: np.zeros(z.shape),
        lambda z: -z,
    ],
)
def test_a_wrong_network_fills_nothing(kind, said):
    true_m = slanted()
    depth_m, trust = with_hole(true_m)
    predicted = said(true_m if kind == "metric" else 1 / true_m).astype(np.float32)
    got_m, got = fill_holes(depth_m, trust, predicted, kind, NO_PX, NO_M)
    assert (got_m == depth_m).all()
    assert (got == trust).all()


def test_a_network_that_errs_here_fills_there():
    """The left third is right, the right one scattered."""
    true_m = slanted(60, 160)
    depth_m, trust = true_m.copy(), np.full(true_m.shape, 255, np.uint8)
    depth_m[20:40, 20:40] = depth_m[20:40, 120:140] = 0
    trust[depth_m == 0] = 0
    predicted = true_m.copy()
    predicted[:, 100:] *= np.random.default_rng(2).choice([0.8, 1.25], (60, 60))
    _, got = fill_holes(depth_m, trust, predicted, "metric", NO_PX, NO_M)
    assert (got[20:40, 20:40] == FILLED_TRUST).all()
    assert (got[20:40, 120:140] == 0).all()


def test_stereo_is_never_overwritten():
    rng = np.random.default_rng(1)
    true_m = slanted()
    depth_m = (true_m * (rng.random(true_m.shape) > 0.4)).astype(np.float32)
    trust = np.where(depth_m > 0, rng.choice([40, 255], true_m.shape), 0).astype(np.uint8)
    got_m, got = fill_holes(depth_m, trust, true_m * 2, "metric", NO_PX, NO_M)
    had = depth_m > 0
    assert (got_m[had] == depth_m[had]).all()
    assert (got[had] == trust[had]).all()
    assert (got[~had] == FILLED_TRUST).all()


def test_nothing_measured_fills_nothing():
    nothing = np.zeros((60, 80), np.float32)
    got_m, got = fill_holes(nothing, nothing.astype(np.uint8), slanted(), "metric", NO_PX, NO_M)
    assert not got_m.any()
    assert not got.any()


def test_what_is_no_map_is_refused():
    depth_m, trust = with_hole(slanted())
    with pytest.raises(ValueError, match="the same size"):
        fill_holes(depth_m, trust, depth_m[1:], "metric", NO_PX, NO_M)
    with pytest.raises(ValueError, match="'metric' or 'inverse'"):
        fill_holes(depth_m, trust, depth_m, "relative", NO_PX, NO_M)


def test_names_are_checked_in_one_line():
    assert DEPTH_MODELS.names()[0] == "hf"
    with pytest.raises(UnknownNameError, match="no depth_model is named 'hg'; known: hf"):
        load_depth_model("hg:a/b")
    with pytest.raises(UsageError, match="use hf:ORG/NAME"):
        load_depth_model("hf")

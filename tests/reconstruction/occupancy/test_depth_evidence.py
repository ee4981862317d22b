"""Depth as evidence: colour and votes from the right pixel, whatever the two cameras."""

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Camera, Scan, View
from world2minecraft.reconstruction.occupancy import PREDICTORS, predictor
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor

DEPTH = Camera(32, 24, 30.0, 30.0, 16.0, 12.0)


def ramp(camera: Camera) -> np.ndarray:
    """An image whose red and green channels say the pixel's place."""
    v, u = np.mgrid[: camera.height_px, : camera.width_px]
    return np.stack([u, v, np.zeros_like(u)], axis=2).astype(np.uint8)


def lift(depth_m, colour_camera, depth_to_colour=None, labels=None):
    place = np.eye(4) if depth_to_colour is None else depth_to_colour
    shown = View("v", np.eye(4), ramp(colour_camera), colour_camera, depth_m, DEPTH, place, labels)
    return DepthPredictor().lift(shown)


def test_one_camera_for_both_takes_the_very_pixel():
    evidence = lift(np.full((24, 32), 2, np.float32), DEPTH)
    assert np.array_equal(evidence.colour, ramp(DEPTH).reshape(-1, 3))


def test_a_colour_camera_of_another_size_is_looked_up_by_ray():
    large = Camera(64, 48, 60.0, 60.0, 32.0, 24.0)
    evidence = lift(np.full((24, 32), 2, np.float32), large)
    expected = ramp(DEPTH).reshape(-1, 3).astype(int) * 2 + [1, 1, 0]
    assert np.abs(evidence.colour - expected).max() <= 1


def test_a_colour_camera_beside_moves_the_look_up_by_parallax():
    beside = np.eye(4)
    beside[0, 3] = 0.1  # The depth camera stands 10 cm to the right of the colour camera.
    evidence = lift(np.full((24, 32), 1, np.float32), DEPTH, beside)
    shift = evidence.colour[:, 0].astype(int) - ramp(DEPTH).reshape(-1, 3)[:, 0]
    middle = ramp(DEPTH).reshape(-1, 3)[:, 0] < 28
    assert set(shift[middle]) == {3}


def test_labels_are_carried_as_they_are():
    labels = np.full((24, 32), 255, np.uint8)
    labels[:, :16] = 8
    evidence = lift(np.full((24, 32), 2, np.float32), DEPTH, labels=labels)
    assert evidence.labels.dtype == np.uint8
    assert np.array_equal(evidence.labels, labels.reshape(-1))


def test_weight_is_the_area_of_a_pixel():
    evidence = lift(np.full((24, 32), 3, np.float32), DEPTH)
    assert np.allclose(evidence.weight, 9 / 900)


def test_far_points_holes_and_views_without_depth_are_skipped():
    depth_m = np.full((24, 32), 2, np.float32)
    depth_m[:5], depth_m[5:9] = 0, 9
    assert len(lift(depth_m, DEPTH).points_m) == 15 * 32
    blind = View("b", np.eye(4), ramp(DEPTH), DEPTH)
    scan = Scan([blind], np.eye(4), np.ones(3), ("b",))
    assert list(DepthPredictor().predict(scan)) == []


def test_a_single_view_is_used_up_to_ten_metres():
    depth_m = np.full((24, 32), 2, np.float32)
    depth_m[:5], depth_m[5:9] = 11, 9
    one = View("v", np.eye(4), ramp(DEPTH), DEPTH, depth_m, DEPTH, np.eye(4))

    def found(kind, *views):
        scan = Scan(views, np.eye(4), np.ones(3), ("v",), depth_kind=kind)
        return [len(evidence.points_m) for evidence in DepthPredictor().predict(scan)]

    assert found("sensor", one) == [19 * 32]
    assert found("sensor", one, one) == [15 * 32, 15 * 32]
    assert found("network", one) == [15 * 32]


def test_predictors_are_found_by_name():
    assert isinstance(predictor("depth"), DepthPredictor)
    with pytest.raises(UnknownNameError, match="did you mean 'depth'"):
        PREDICTORS.load("deptj")


def test_depth_takes_no_file():
    with pytest.raises(UsageError, match="the predictor depth accepts no file, got 'depth:3'; for"):
        predictor("depth:3")

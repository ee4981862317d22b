"""Depth that was stored in coarse steps is smoothed within its steps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.capture.depth_steps import _links, depth_step_m, smooth_depth_steps
from world2minecraft.core.types import Camera
from world2minecraft.geometry.planar_patches import extract_patches

CAMERA = Camera(320, 240, 260.0, 260.0, 160.0, 120.0)
STEP_M = 10 / 255


def plane_depth(normal: tuple[float, float, float], distance_m: float) -> np.ndarray:
    """Return the depth of a plane, float64 [240, 320]."""
    v, u = np.mgrid[0:240, 0:320]
    rays = np.stack([(u - CAMERA.cx_px) / 260, (v - CAMERA.cy_px) / 260, np.ones(u.shape)], -1)
    return distance_m / (rays @ (np.array(normal) / np.linalg.norm(normal)))


def stepped(depth_m: np.ndarray) -> np.ndarray:
    return (np.round(depth_m / STEP_M) * STEP_M).astype(np.float32)


@pytest.mark.parametrize("normal", [(0.3, 0.1, 0.95), (-0.2, 0.3, 0.9), (0.5, 0.0, 0.8)])
def test_a_plane_keeps_its_direction(normal: tuple[float, float, float]) -> None:
    exact = plane_depth(normal, 2.5)
    coarse = stepped(exact)
    smooth = smooth_depth_steps(coarse, depth_step_m(coarse))
    assert np.sqrt(np.mean((smooth - exact) ** 2)) < 0.25 * np.sqrt(np.mean((coarse - exact) ** 2))
    unit = np.array(normal) / np.linalg.norm(normal)
    off = np.degrees(
        np.arccos(np.clip(np.abs(extract_patches(smooth, CAMERA).normals @ unit), 0, 1))
    )
    assert np.median(off) < 0.6


def test_depth_stays_within_its_step_and_holes_stay() -> None:
    coarse = stepped(np.where(np.arange(320) < 150, 1.2, plane_depth((0.2, 0.2, 1.0), 3.0)))
    coarse[40:60, 200:230] = 0
    smooth = smooth_depth_steps(coarse, STEP_M)
    assert np.array_equal(smooth == 0, coarse == 0)
    assert np.abs(smooth - coarse).max() <= STEP_M / 2 + 1e-4
    assert np.ptp(smooth[:, :148]) < 1e-3, "an edge must not bend the surface beside it"


def test_steps_are_found_only_where_they_are_coarse() -> None:
    exact = plane_depth((0.3, 0.1, 0.95), 2.5)
    assert depth_step_m(stepped(exact)) == pytest.approx(STEP_M, abs=1e-4)
    assert depth_step_m(np.round(exact, 3).astype(np.float32)) == 0
    assert depth_step_m(exact.astype(np.float32)) == 0
    assert depth_step_m(np.zeros((10, 10), np.float32)) == 0
    assert depth_step_m(np.array([[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]], np.float32)) == 0


@given(st.integers(0, 10**6), st.floats(0.5, 3))
def test_pixels_are_linked_up_to_edges_and_holes(seed, edge_m):
    stored = np.random.default_rng(seed).integers(0, 5, (5, 6)).astype(np.float64)
    links = _links(stored, edge_m)

    def joined(one, other):
        inside = all(0 <= at < size for at, size in zip(other, stored.shape, strict=True))
        return (
            inside
            and stored[one] > 0
            and stored[other] > 0
            and abs(stored[one] - stored[other]) <= edge_m
        )

    for i, j in np.ndindex(stored.shape):
        expected = 0
        for axis, (down, right) in enumerate([(1, 0), (0, 1)]):
            for way, near, far in ((-1, 1, 0), (1, 2, 3)):
                middle = (i + way * down, j + way * right)
                if joined((i, j), middle):
                    expected |= 1 << (4 * axis + near)
                    if joined(middle, (i + 2 * way * down, j + 2 * way * right)):
                        expected |= 1 << (4 * axis + far)
        assert links[i, j] == expected

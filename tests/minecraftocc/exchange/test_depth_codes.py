"""Depth in the codes of the data sets' PNGs."""

import io

import numpy as np
import pytest
from PIL import Image

from world2minecraft.minecraftocc.formats.image_conventions import decode_depth, encode_depth

DEPTH_M = np.array([[0, 0.5, 1.2345], [8.191, 8.192, np.inf]], np.float32)


def raw_of(data):
    return np.array(Image.open(io.BytesIO(data)))


def test_nyu_depth_is_millimetres_times_eight():
    assert raw_of(encode_depth(DEPTH_M, "nyu")).tolist() == [[0, 4000, 9872], [65528, 0, 0]]


def test_occscannet_depth_is_millimetres():
    assert raw_of(encode_depth(DEPTH_M, "mm")).tolist() == [[0, 500, 1234], [8191, 8192, 0]]


@pytest.mark.parametrize("code", ["nyu", "mm"])
def test_depth_comes_back_within_half_a_millimetre(code):
    depth_m = np.random.default_rng(1).uniform(0.3, 8.1, (40, 50)).astype(np.float32)
    back = decode_depth(raw_of(encode_depth(depth_m, code)), code)
    assert back.dtype == np.float32
    assert np.abs(back - depth_m).max() < 0.00051


def test_turned_millimetres_beyond_eight_metres_are_read():
    """A Kinect's 9.5 m wraps around in NYU's PNGs."""
    millimetres = np.full((10, 10), 9500, np.uint16)
    turned = (millimetres << 3) | (millimetres >> 13)
    assert decode_depth(turned.astype(np.uint16), "nyu")[0, 0] == pytest.approx(9.5)


def test_true_eighths_of_millimetres_are_recognised():
    depth_m = np.random.default_rng(1).uniform(0.3, 8.1, (40, 50))
    raw = np.round(depth_m * 8000).astype(np.uint16)
    assert np.abs(decode_depth(raw, "nyu") - depth_m).max() < 1e-4


def test_a_real_nyu_frame_is_read(shared_data):
    path = shared_data / "open3d_rgbd_samples" / "RGBD" / "other_formats" / "SUN_depth.png"
    if not path.is_file():
        pytest.skip(f"there is no {path}")
    metres = decode_depth(np.array(Image.open(path)), "nyu")  # SUN turns the bits the same way.
    seen = metres[metres > 0]
    assert 0.5 < np.median(seen) < 5
    assert seen.max() < 12

"""Depth encodings, against values worked out by hand and against each other."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from PIL import Image

from world2minecraft.capture.depth_images import (
    DEPTH_UNITS,
    DepthEncoding,
    find_encoding,
    read_depth,
)
from world2minecraft.core.errors import CaptureError, UnknownNameError


@pytest.mark.parametrize(
    ("unit", "raw", "metres"),
    [
        ("mm", 1234, 1.234),
        ("5000", 5000, 1.0),
        ("rotated", 1234 << 3, 1.234),
        ("rotated", ((10_000 << 3) | (10_000 >> 13)) & 0xFFFF, 10.0),
        ("0.00025", 4000, 1.0),
        ("m", 3, 3.0),
    ],
)
def test_a_stored_value_in_metres(unit, raw, metres):
    read = DepthEncoding(unit).to_metres(np.array([[raw]], np.uint16))
    assert read.dtype == np.float32
    assert read[0, 0] == pytest.approx(metres, rel=1e-6)


@given(hnp.arrays(np.uint16, (4, 5)), st.sampled_from(sorted(DEPTH_UNITS)))
def test_integers_become_finite_depth_or_holes(raw, unit):
    metres = DepthEncoding(unit).to_metres(raw)
    assert np.isfinite(metres).all()
    assert (metres >= 0).all()
    assert not metres[(raw == 0) | (raw == 65535)].any()


@given(hnp.arrays(np.float32, (3, 3)))
def test_floats_keep_what_is_depth_and_drop_the_rest(raw):
    metres = DepthEncoding("m").to_metres(raw)
    good = np.isfinite(raw) & (raw > 0)
    np.testing.assert_array_equal(metres, np.where(good, raw, 0))


def test_rotation_is_undone_for_every_value():
    millimetres = np.arange(1, 65535, dtype=np.uint16)
    stored = ((millimetres << 3) | (millimetres >> 13)).astype(np.uint16)
    kept = stored != 65535
    read = DepthEncoding("rotated").to_metres(stored)
    np.testing.assert_allclose(read[kept], millimetres[kept] / 1000, rtol=1e-6)


def _write(path, metres, unit):
    millimetres = np.round(metres * 1000).astype(np.uint16)
    stored = {
        "mm": lambda: millimetres,
        "5000": lambda: millimetres * 5,
        "rotated": lambda: (millimetres << 3) | (millimetres >> 13),
        "m": lambda: metres.astype(np.float32),
    }[unit]()
    if unit == "m":
        np.save(path.with_suffix(".npy"), stored)
        return path.with_suffix(".npy")
    Image.fromarray(stored.astype(np.uint16)).save(path)
    return path


@pytest.mark.parametrize("unit", ["mm", "5000", "rotated", "m"])
@pytest.mark.parametrize("far_m", [1.2, 3.0, 7.0])
def test_the_unit_is_inferred_from_the_values(tmp_path, unit, far_m):
    metres = np.linspace(0.5, far_m, 60 * 80).reshape(60, 80)
    path = _write(tmp_path / "depth.png", metres, unit)
    found = find_encoding([path], None)
    assert (found.unit, found.guessed) == (unit, True)
    np.testing.assert_allclose(read_depth(path, found), metres, atol=6e-4)


def test_a_stated_unit_wins(tmp_path):
    path = _write(tmp_path / "depth.png", np.full((9, 9), 2.0), "mm")
    assert find_encoding([path], "0.002") == DepthEncoding("0.002")
    with pytest.raises(UnknownNameError, match="no depth unit is named 'feet'"):
        find_encoding([path], "feet")
    with pytest.raises(CaptureError, match="a median depth of 2e\\+03 m"):
        find_encoding([path], "m")


def test_sixteen_and_thirty_two_bit_tiff(tmp_path):
    metres = np.linspace(0.5, 3, 48).reshape(6, 8).astype(np.float32)
    Image.fromarray(metres).save(tmp_path / "a.tiff")
    np.testing.assert_array_equal(read_depth(tmp_path / "a.tiff", DepthEncoding("m")), metres)


@pytest.mark.parametrize(
    ("name", "unit", "middle_m"),
    [("TUM_depth.png", "5000", (1.5, 4.0)), ("SUN_depth.png", "rotated", (1.0, 5.0))],
)
def test_encodings_of_real_frames_are_detected(shared_data, name, unit, middle_m):
    path = shared_data / "open3d_rgbd_samples" / "RGBD" / "other_formats" / name
    found = find_encoding([path], None)
    assert found.unit == unit
    depth = read_depth(path, found)
    assert middle_m[0] < np.median(depth[depth > 0]) < middle_m[1]


def test_a_raw_nyu_frame_is_a_room(shared_data):
    path = shared_data / "open3d_rgbd_samples" / "RGBD" / "other_formats" / "NYU_depth.pgm"
    depth = read_depth(path, DepthEncoding("nyu_raw"))
    low, middle, high = np.quantile(depth[depth > 0], [0.05, 0.5, 0.95])
    assert 0.4 < low < middle < high < 8

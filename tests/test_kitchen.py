"""The shared real kitchen, the whole way: heights, an independent TSDF, red cupboards, wood."""

import colorsys
import json

import numpy as np
import pytest
from benchmarks.check_tsdf import compare, read_frames

from world2minecraft.cli import run as w2m
from world2minecraft.minecraft.colours import colours_of
from world2minecraft.report.scene import read_built


@pytest.fixture(scope="module")
def kitchen(shared_data):
    """The folder of the capture."""
    folder = shared_data / "redkitchen_rgbd"
    if not folder.is_dir():
        pytest.skip(f"the shared kitchen is not at {folder}")
    return folder


@pytest.fixture(scope="module")
def half(kitchen, tmp_path_factory):
    """A reconstruction from every second frame; the others stay apart for the reference."""
    out = tmp_path_factory.mktemp("kitchen") / "OUT"
    words = ["reconstruct", str(kitchen), "--out", str(out), "--set", "capture.every=2"]
    assert w2m(words) == 0
    return out


def test_within_one_voxel_of_a_tsdf_of_frames_kept_apart(kitchen, half):
    figures = compare(read_frames(kitchen / "frames", 2, 1), half / "room.npz")
    assert figures["precision"] >= 0.99
    assert figures["recall"] >= 0.98
    assert figures["free recall"] >= 0.90


def test_real_heights(half):
    planes = json.loads((half / "report.json").read_text())["planes"]

    def nearest(name: str, height_m: float) -> float:
        heights = [plane["height_m"] for plane in planes if plane["class"] == name]
        return min(heights, key=lambda value: abs(value - height_m))

    assert abs(nearest("floor", 0)) <= 0.02
    assert abs(nearest("table", 0.72) - 0.72) <= 0.03
    assert abs(nearest("furn", 0.90) - 0.90) <= 0.04


def test_the_two_cameras_are_told_apart(half):
    notes = " ".join(json.loads((half / "scan.json").read_text())["notes"])
    assert "the colour camera is estimated from edges" in notes


def test_cupboards_are_red_and_the_table_is_wood(half):
    volume = read_built(half / "build")
    colour = colours_of(volume.palette)[volume.states] / 255.0
    furn, table = colour[volume.semantic == 10], colour[volume.semantic == 8]
    assert np.mean([is_red(*rgb) for rgb in furn]) > 0.25
    assert np.mean([is_wooden(*rgb) for rgb in table]) > 0.5


def is_red(red: float, green: float, blue: float) -> bool:
    hue, saturation, _ = colorsys.rgb_to_hsv(red, green, blue)
    return saturation > 0.5 and (hue < 0.05 or hue > 0.95)


def is_wooden(red: float, green: float, blue: float) -> bool:
    hue, saturation, _ = colorsys.rgb_to_hsv(red, green, blue)
    return saturation > 0.2 and 0.05 < hue < 0.16

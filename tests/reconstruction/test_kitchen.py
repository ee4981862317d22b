"""The shared real kitchen, the whole way: heights, an independent TSDF, red cupboards, wood."""

import colorsys
import json
import shutil

import numpy as np
import pytest
from benchmarks.check_photos import best_similarity, poses_of
from benchmarks.check_photos import compare as compare_rooms
from benchmarks.check_tsdf import compare, read_frames

from world2minecraft.cli import run as w2m
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.minecraft.block_colours import colours_of


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


@pytest.fixture(scope="module")
def from_photos(kitchen, tmp_path_factory):
    """A reconstruction from three of four colour images alone: no poses, no depth, no lens."""
    folder = tmp_path_factory.mktemp("photos")
    images = sorted((kitchen / "frames").glob("*.color.*"))
    for path in (path for number, path in enumerate(images) if number % 4 != 3):
        shutil.copy(path, folder / f"{path.name.split('.')[0]}{path.suffix}")
    out = tmp_path_factory.mktemp("from_photos") / "OUT"
    assert w2m(["reconstruct", str(folder), "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def photos_to_depth(kitchen, from_photos):
    """The similarity that lays the photos' frame on the depth camera's."""
    found = poses_of(from_photos / "capture" / "capture.json")
    stated = {name: np.loadtxt(kitchen / "frames" / f"{name}.pose.txt") for name in found}
    return best_similarity(found, stated)


def test_photos_alone_give_the_room_that_depth_gives(half, from_photos, photos_to_depth):
    figures = compare_rooms(half, from_photos, photos_to_depth)
    assert figures["precision where known"] >= 0.95
    assert figures["recall"] >= 0.87
    assert figures["free found"] >= 0.70
    assert figures["wrong free"] <= 0.21


def test_the_scale_of_photos_is_judged_within_15_percent(from_photos, photos_to_depth):
    scale = np.linalg.det(photos_to_depth[:3, :3]) ** (1 / 3)
    assert 0.85 <= scale <= 1.15
    told = json.loads((from_photos / "scan.json").read_text())
    assert told["scale"] == "estimated"
    assert 0.01 <= told["scale_sigma"] <= 0.20


def test_cupboards_of_photos_are_red_too(from_photos):
    volume = read_built(from_photos / "build")
    colour = colours_of(volume.palette)[volume.states] / 255.0
    red = [is_red(*rgb) for rgb in colour[np.isin(volume.semantic, (8, 10))]]
    assert np.mean(red) > 0.10

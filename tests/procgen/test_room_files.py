"""A generated room on disk: it comes back as it was, and damaged folders are refused by name."""

import json
from functools import cache

import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_npz, write_json, write_npz
from world2minecraft.procgen import generate_room, read_generated, room_picture, write_generated
from world2minecraft.procgen import room_files as stored
from world2minecraft.procgen.room_files import ARRAYS

room = cache(lambda: generate_room(2, kind="hall", clutter=0.5))


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stored")
    write_generated(room(), folder)
    return folder


def copy_of(written, tmp_path, *, arrays=None, stated=None):
    """The folder once more, with some arrays or the words of layout.json replaced."""
    held = read_npz(written / "truth.npz", ARRAYS)
    write_npz(tmp_path / "truth.npz", {**held, **(arrays or {})})
    told = json.loads((written / "layout.json").read_text())
    if stated:
        stated(told)
    write_json(tmp_path / "layout.json", told)
    return tmp_path


def test_a_room_comes_back_as_it_was(written):
    back, made = read_generated(written), room()
    for name in ("labels", "instance", "colour", "origin_m"):
        assert np.array_equal(getattr(back, name), getattr(made, name)), name
    assert (back.kind, back.seed, back.voxel_m) == (made.kind, made.seed, made.voxel_m)
    assert len(back.layouts) == len(made.layouts)
    for a, b in zip(back.objects, made.objects, strict=True):
        assert (a.class_id, a.name) == (b.class_id, b.name)
        assert np.abs(a.center_m - b.center_m).max() < 1e-4
        assert a.yaw_deg == pytest.approx(b.yaw_deg, abs=1e-4)
    for a, b in zip(back.layout.openings, made.layout.openings, strict=True):
        assert a.kind == b.kind
        assert np.allclose([*a.start_m, *a.end_m], [*b.start_m, *b.end_m], atol=1e-4)


def test_the_same_room_gives_the_same_files(written, tmp_path):
    write_generated(room(), tmp_path)
    for name in ("layout.json", "truth.npz"):
        assert (tmp_path / name).read_bytes() == (written / name).read_bytes()


def test_an_empty_folder_says_what_writes_one(tmp_path):
    with pytest.raises(
        InputError,
        match=r"layout\.json: not found; create the folder with `w2m rooms generate --out",
    ):
        read_generated(tmp_path)


@pytest.mark.parametrize(
    "change",
    [
        lambda told: told.pop("kind"),
        lambda told: told.update(seed="x"),
        lambda told: told.update(layouts=[]),
        lambda told: told.update(layouts=3),
        lambda told: told.update(layouts=told["layouts"] * 65),
        lambda told: told["layouts"][0].update(floor_polygon_m=[[0, 0], [1, 0]]),
        lambda told: told["layouts"][0].update(wall_height_m=-1),
        lambda told: told["layouts"][0].update(floor_z_m="high"),
        lambda told: told["layouts"][0]["openings"][0].update(kind="hole"),
        lambda told: told["layouts"][0]["objects"][0].update({"class": "cheese"}),
        lambda told: told["layouts"][0]["objects"][0].update(size_m=[0, 1, 1]),
        lambda told: told["layouts"][0]["objects"][0].update(center_m="far"),
        lambda told: told["layouts"][0].update(objects=None),
    ],
)
def test_a_layout_that_is_none_is_refused(written, tmp_path, change):
    folder = copy_of(written, tmp_path, stated=change)
    with pytest.raises(DamagedFileError, match=r"layout\.json: is not a valid room layout \("):
        read_generated(folder)


def test_layouts_that_are_no_object_are_refused(written, tmp_path):
    folder = copy_of(written, tmp_path)
    write_json(folder / "layout.json", [1, 2])
    with pytest.raises(DamagedFileError, match="is not a valid room layout"):
        read_generated(folder)


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        (
            {"labels": np.zeros((3, 3), np.uint8)},
            r"array labels has an invalid dtype or shape: uint8 \(3, 3\)",
        ),
        (
            {"labels": np.full((2, 2, 2), 1.0)},
            "array labels has an invalid dtype or shape: float64",
        ),
        (
            {"instance": np.zeros((2, 2, 2), np.uint16)},
            "array instance has an invalid dtype or shape: uint16",
        ),
        (
            {"colour": np.zeros((2, 2, 2, 3), np.uint8)},
            "array colour has an invalid dtype or shape: uint8",
        ),
        ({"origin_m": np.full(3, np.nan)}, "origin_m must be finite"),
        ({"voxel_m": np.array(0.0)}, "voxel_m must be from 0.005 to 0.5, got 0.0"),
        ({"voxel_m": np.array([0.02])}, "array voxel_m has an invalid dtype or shape: float64"),
    ],
)
def test_arrays_that_are_no_room_are_refused(written, tmp_path, arrays, message):
    with pytest.raises(DamagedFileError, match=rf"truth\.npz: {message}"):
        read_generated(copy_of(written, tmp_path, arrays=arrays))


def test_values_that_mean_nothing_are_refused(written, tmp_path):
    held = read_npz(written / "truth.npz", ARRAYS)
    labels, instance = held["labels"].copy(), held["instance"].copy()
    labels[0, 0, 0], instance[0, 0, 0] = 12, 60_000
    with pytest.raises(DamagedFileError, match="labels must be below 12, got 12"):
        read_generated(copy_of(written, tmp_path, arrays={"labels": labels}))
    with pytest.raises(DamagedFileError, match="instance must be at most .* got 60000"):
        read_generated(copy_of(written, tmp_path, arrays={"instance": instance}))


def test_a_file_that_says_it_is_huge_is_not_read(written, monkeypatch):
    monkeypatch.setattr(stored, "MAX_CELLS", 1000)
    with pytest.raises(
        LimitError, match=r"truth\.npz: has [\d,]+ bytes, which exceeds the limit of 1,000 cells"
    ):
        read_generated(written)


def test_bytes_that_are_no_archive_are_refused(written, tmp_path):
    folder = copy_of(written, tmp_path)
    (folder / "truth.npz").write_bytes(b"not a zip")
    with pytest.raises(DamagedFileError, match=r"truth\.npz: is not a valid .npz file"):
        read_generated(folder)
    (folder / "truth.npz").unlink()
    with pytest.raises(
        InputError, match=r"truth\.npz: not found; it must be in the same folder as layout\.json"
    ):
        read_generated(folder)


def test_a_picture_shows_the_floor_and_has_empty_corners():
    picture = room_picture(room(), 200, 150)
    assert picture.shape == (150, 200, 3) and picture.dtype == np.uint8
    assert (picture[[0, 0, -1, -1], [0, -1, 0, -1]] == picture[0, 0]).all()
    assert (picture != picture[0, 0]).any(axis=2).mean() > 0.15

"""Georeferenced rooms: their shift is stored, and what they are built of is what a near one is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.cli import run as w2m
from world2minecraft.core import files
from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.types import OBSERVED, OccupancyGrid
from world2minecraft.formats.occupancy_files import to_room_frame
from world2minecraft.formats.run_arrays import read_room, write_room
from world2minecraft.reconstruction.build_without_capture import blocks_of, rebuild
from world2minecraft.reconstruction.parameters import Parameters

SURVEY = np.array([450_000.0, 5_400_000.0, 100.0])
VOXEL_M = 0.1


def box_grid(origin_m=(-0.1, -0.1, -0.1)) -> OccupancyGrid:
    """A room of 3 x 2.4 x 2.4 m with a table in it; the top of its floor is a cell above origin."""
    labels = np.zeros((32, 26, 26), np.uint8)
    labels[0] = labels[-1] = labels[:, 0] = labels[:, -1] = 3
    labels[:, :, -1], labels[:, :, 0] = 1, 2
    labels[10:20, 8:14, 7] = 8
    labels[10, 8, 1:7] = labels[19, 13, 1:7] = 8
    shape = labels.shape
    return OccupancyGrid(
        labels=labels,
        confidence=np.ones(shape, np.float16),
        colour=np.full((*shape, 3), 150, np.uint8),
        source=np.full(shape, OBSERVED, np.uint8),
        instance=np.zeros(shape, np.uint16),
        voxel_m=VOXEL_M,
        origin_m=np.asarray(origin_m, np.float64),
    )


@given(st.tuples(*[st.integers(-20_000_000, 20_000_000)] * 2), st.integers(-9_000, 9_000))
def test_a_grid_anywhere_comes_into_the_room(xy_m, z_m):
    grid = box_grid([*xy_m, z_m])
    moved, grid_to_room = to_room_frame(grid)
    assert np.allclose(apply(grid_to_room, grid.origin_m), moved.origin_m, atol=1e-6)
    assert np.array_equal(moved.labels, grid.labels)
    assert np.abs(moved.origin_m[:2]).max() <= 1000
    assert abs(moved.origin_m[2] + VOXEL_M) <= 3.0
    assert to_room_frame(moved)[0] is moved


@pytest.fixture(scope="module")
def near(tmp_path_factory):
    folder = tmp_path_factory.mktemp("near")
    write_room(folder / "room.npz", box_grid(), np.eye(4))
    return blocks_of(folder / "room.npz", Parameters())


def test_a_surveyed_room_has_the_blocks_of_a_near_one(near, tmp_path):
    write_room(tmp_path / "room.npz", box_grid(SURVEY), np.eye(4))
    far = blocks_of(tmp_path / "room.npz", Parameters())
    assert far.palette == near.palette
    assert np.array_equal(far.states, near.states)
    assert far.corner == near.corner


def test_the_shift_of_a_surveyed_room_is_stored(tmp_path):
    turn = np.array([[0.0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]])
    (tmp_path / "in").mkdir()
    write_room(tmp_path / "in" / "room.npz", box_grid(SURVEY), turn)
    rebuild(tmp_path / "in" / "room.npz", tmp_path / "out", Parameters())
    grid, scan_to_room = read_room(tmp_path / "out" / "room.npz")
    to_file = turn @ np.linalg.inv(scan_to_room)
    assert np.allclose(apply(to_file, grid.origin_m), SURVEY, atol=1e-6)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"origin_m": np.full(3, 1e30)}, "origin_m is up to 1e\\+30 m"),
        ({"voxel_m": np.array(1e-9)}, "voxel_m must be 0.001 to 10 m, got 1e-09; check the unit"),
        ({"voxel_m": np.array(1e6)}, "give it in metres, not millimetres"),
        ({"scan_to_room": np.diag([-1.0, 1, 1, 1])}, "is mirrored"),
        ({"scan_to_room": np.diag([1e3, 1e3, 1e3, 1])}, "is scaled by 1000; divide"),
    ],
)
def test_nonsense_in_a_room_is_refused_with_its_reason(tmp_path, change, words):
    path = tmp_path / "room.npz"
    write_room(path, box_grid(), np.eye(4))
    with np.load(path) as held:
        arrays = dict(held)
    np.savez(path, **(arrays | change))
    with pytest.raises(DamagedFileError, match=words):
        read_room(path)


@pytest.mark.parametrize(
    "change",
    [{"origin_m": np.full(3, 1e30)}, {"voxel_m": np.array(1e-9)}, {"voxel_m": np.array(1e6)}],
)
def test_a_build_of_nonsense_ends_in_one_line_and_code_3(tmp_path, capsys, change):
    path = tmp_path / "room.npz"
    write_room(path, box_grid(), np.eye(4))
    with np.load(path) as held:
        arrays = dict(held)
    np.savez(path, **(arrays | change))
    assert w2m(["build", str(path), "--out", str(tmp_path / "out")]) == 3
    said = capsys.readouterr().err.strip().splitlines()
    assert len(said) == 1
    assert "room.npz: does not contain a valid room" in said[0]
    assert not (tmp_path / "out").exists()


def test_arrays_of_too_much_memory_are_refused_together(tmp_path, monkeypatch):
    write_room(tmp_path / "room.npz", box_grid(), np.eye(4))
    monkeypatch.setattr(files, "MAX_ARRAYS_BYTES", 100_000)
    with pytest.raises(LimitError, match="bytes of arrays; the limit is 100,000"):
        read_room(tmp_path / "room.npz")

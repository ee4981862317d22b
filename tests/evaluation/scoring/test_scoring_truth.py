"""The truth that is read, and the frame's error told apart from occupancy."""

from zipfile import ZipFile

import numpy as np
import pytest
from true_rooms import write_capture

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.evaluation.scoring import read_truth
from world2minecraft.evaluation.scoring.pose_errors import frame_error
from world2minecraft.evaluation.scoring.truth_files import read_instances
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.runs import run_capture


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_frame_error_forgives_quarter_turns_only(turns):
    exact = rotation_about_z(90 * turns)
    exact[:3, 3] = [3, -2, 0.004]
    error = frame_error(exact)
    assert error["yaw_deg"] < 1e-6 and error["tilt_deg"] < 1e-4
    assert error["floor_m"] == pytest.approx(0.004)
    assert frame_error(exact @ rotation_about_z(-1.5))["yaw_deg"] == pytest.approx(1.5)
    tilt = np.eye(4)
    tilt[1:3, 1:3] = [[np.cos(0.01), -np.sin(0.01)], [np.sin(0.01), np.cos(0.01)]]
    assert frame_error(exact @ tilt)["tilt_deg"] == pytest.approx(np.degrees(0.01), rel=1e-3)


def test_a_damaged_truth_is_named(tmp_path):
    np.savez(
        tmp_path / "truth.npz",
        labels=np.zeros((2, 2, 2), np.uint8),
        voxel_m=0.02,
        origin_m=np.zeros(3),
        truth_room_to_scan=np.eye(4),
    )
    (tmp_path / "truth.json").write_text('{"objects": [{"class": "chair"}]}')
    with pytest.raises(DamagedFileError, match="not a valid ground truth"):
        read_truth(tmp_path)


def test_a_truth_without_objects_says_what_is_missing(tmp_path):
    np.savez(tmp_path / "truth.npz", labels=np.zeros((2, 2, 2), np.uint8))
    (tmp_path / "truth.json").write_text('{"layouts": []}')
    with pytest.raises(DamagedFileError, match="'objects' is missing; see docs/reference/metrics"):
        read_truth(tmp_path)


@pytest.mark.parametrize("name", ["truth.json", "truth.npz"])
def test_a_run_says_that_the_truth_is_damaged_before_any_work(name, tmp_path):
    room = write_capture(tmp_path / "capture")
    (room / name).write_bytes((room / name).read_bytes()[:-40])
    with pytest.raises(DamagedFileError, match=name):
        run_capture(room, tmp_path / "OUT", Parameters())
    assert not (tmp_path / "OUT").exists()


@pytest.mark.parametrize("change", [np.float64, np.ravel])
def test_true_instances_of_another_kind_are_refused(change, tmp_path):
    room = write_capture(tmp_path / "capture")
    with np.load(room / "truth.npz") as archive:
        arrays = dict(archive)
    np.savez(room / "truth.npz", **(arrays | {"instance": change(arrays["instance"])}))
    with pytest.raises(DamagedFileError, match="instance must be uint16 of the shape"):
        read_instances(read_truth(room))


@pytest.mark.parametrize("array", ["labels", "instance", "colour"])
def test_each_array_of_the_truth_is_read_before_any_work(array, tmp_path):
    room = write_capture(tmp_path / "capture")
    path = room / "truth.npz"
    with np.load(path) as archive:
        arrays = dict(archive)
    arrays["colour"] = np.full((*arrays["labels"].shape, 3), 200, np.uint8)
    np.savez(path, **arrays)
    with ZipFile(path) as archive:
        info = archive.getinfo(f"{array}.npy")
    content = bytearray(path.read_bytes())
    content[info.header_offset + info.compress_size // 2 + 200] ^= 0xFF  # Beyond the header.
    path.write_bytes(content)
    with pytest.raises(DamagedFileError, match=r"truth\.npz"):
        run_capture(room, tmp_path / "OUT", Parameters())
    assert not (tmp_path / "OUT").exists()


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("origin_m", [1e30, 0, 0], "check the unit"),
        ("voxel_m", 1e-9, "check the unit"),
        ("voxel_m", 2e5, "not millimetres"),
        ("camera_to_truth", "scaled", "is scaled by 1000"),
        ("camera_to_truth", "far", "moves by 1e"),
        ("depth_scale", -1.0, "must be above 0"),
    ],
)
def test_a_truth_with_impossible_numbers_is_refused(name, value, told, tmp_path):
    folder = write_capture(tmp_path / "capture")
    with np.load(folder / "truth.npz") as archive:
        arrays = dict(archive)
    if name == "camera_to_truth":
        value = arrays[name].copy()
        value[0, :3, :3] *= 1e3 if told.startswith("is") else 1
        value[0, :3, 3] = 1e30 if told.startswith("moves") else 0
    elif name == "depth_scale":
        value = np.full(len(arrays["frame_names"]), value)
    np.savez(folder / "truth.npz", **(arrays | {name: np.array(value)}))
    with pytest.raises(DamagedFileError, match=told):
        read_truth(folder)

"""The true room is drawn from the pose of the preview, however the run's frame is turned."""

import numpy as np
import pytest

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.files import npz_array_names, read_npz, write_npz
from world2minecraft.core.types import Camera, OccupancyGrid
from world2minecraft.evaluation.report.truth_picture import truth_picture
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.procgen import generate_room, room_view, scan_room
from world2minecraft.rendering.preview import PreviewView

CAMERA = Camera(64, 48, 70.0, 70.0, 32.0, 24.0)


@pytest.fixture(scope="module")
def room():
    return generate_room(7, kind="study")


@pytest.fixture(scope="module")
def truth(room, tmp_path_factory):
    folder = tmp_path_factory.mktemp("truth") / "scan"
    scan_room(room, folder, frames=2, width=64, height=48)
    return folder


def turned(quarters: int) -> np.ndarray:
    """Return a turn about z and a shift, float64 [4, 4]."""
    cosine, sine = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarters]
    result = np.eye(4)
    result[:2, :2] = [[cosine, -sine], [sine, cosine]]
    result[:3, 3] = [0.5, -1.25, 0.25]
    return result


def run_in_frame(folder, truth, truth_to_room: np.ndarray) -> None:
    """Write the grid of a run whose frame is turned against the truth."""
    scan_to_room = truth_to_room @ np.linalg.inv(read_truth(truth).truth_to_scan)
    shape = (2, 2, 2)
    grid = OccupancyGrid(
        labels=np.zeros(shape, np.uint8),
        confidence=np.zeros(shape, np.float16),
        colour=np.zeros((*shape, 3), np.uint8),
        source=np.ones(shape, np.uint8),
        instance=np.zeros(shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )
    write_room(folder / "room.npz", grid, scan_to_room)


def view_of(pose: np.ndarray, near: tuple[int, int], storeys: int = 1) -> PreviewView:
    return PreviewView(None, near, storeys, CAMERA, pose)


@pytest.mark.parametrize("quarters", range(4))
def test_the_true_room_is_drawn_from_the_pose(quarters, room, truth, tmp_path):
    pose, near = look_at(np.array([6.0, 5.0, 5.0]), np.array([2.0, 2.0, 1.0])), (1, 1)
    turn = turned(quarters)
    run_in_frame(tmp_path, truth, turn)
    sides = np.round(turn[:2, :2] @ near).astype(int).tolist()
    found = truth_picture(tmp_path, truth, view_of(turn @ pose, (sides[0], sides[1])))
    assert found is not None
    wanted = room_view(room, CAMERA, pose, near)
    # Only pixels on edges may differ, by rounding.
    assert (np.abs(found.astype(int) - wanted).max(axis=2) > 8).mean() < 0.01
    assert wanted.reshape(-1, 3).std(axis=0).min() > 10


def test_there_is_none_of_several_storeys_or_without_colours(truth, tmp_path):
    run_in_frame(tmp_path, truth, np.eye(4))
    pose = look_at(np.array([6.0, 5.0, 5.0]), np.array([2.0, 2.0, 1.0]))
    assert truth_picture(tmp_path, truth, view_of(pose, (1, 1), storeys=2)) is None
    plain = tmp_path / "plain"
    plain.mkdir()
    for name in ("truth.json", "truth.npz"):
        (plain / name).write_bytes((truth / name).read_bytes())
    names = tuple(name for name in npz_array_names(truth / "truth.npz") if name != "colour")
    write_npz(plain / "truth.npz", read_npz(truth / "truth.npz", names))
    assert truth_picture(tmp_path, plain, view_of(pose, (1, 1))) is None

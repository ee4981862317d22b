"""SSCNet's protocol for one frame: an image, saved labels or a run against a ``.bin`` file."""

import json

import numpy as np
import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.formats.sscnet import encode_bin
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA, encode_depth
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.networks.frame_scoring import frame_scores

EYE_M, WALL_M = 1.2, 4.0
# x right, y forward, z up: the camera looks along +y, level, over a floor at z = 0.
POSE = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, EYE_M], [0, 0, 0, 1]], np.float64)
ORIGIN_M = np.array([-2.4, 0.0, -0.08])


@pytest.fixture(scope="module")
def truth():
    """The cells of a floor, a wall ahead and a box on the floor; beyond is unknown."""
    labels = np.zeros((60, 60, 36), np.uint8)
    labels[:, :, 0] = 2
    labels[:, 50] = 3
    labels[:, 51:] = 255
    labels[20:26, 36:42, 1:7] = 10
    return labels


@pytest.fixture(scope="module")
def frame(tmp_path_factory, truth):
    """The folder of NYU0001_0000.bin and its depth."""
    folder = tmp_path_factory.mktemp("NYUtest")
    down = (np.arange(480) + 0.5 - NYU_CAMERA.cy_px)[:, None] / NYU_CAMERA.fy_px
    across = (np.arange(640) + 0.5 - NYU_CAMERA.cx_px)[None] / NYU_CAMERA.fx_px
    depth_m = np.minimum(EYE_M / np.maximum(down, 1e-6), WALL_M) + 0 * across
    front_m = 36 * 0.08
    x, z = across * front_m - ORIGIN_M[0], EYE_M - down * front_m - ORIGIN_M[2]
    on_box = (x > 20 * 0.08) & (x < 26 * 0.08) & (z > 0.08) & (z < 7 * 0.08)
    depth_m = np.where(on_box, front_m, depth_m).astype(np.float32)
    (folder / "NYU0001_0000.png").write_bytes(encode_depth(depth_m, "nyu"))
    stored = np.ascontiguousarray(truth.transpose(0, 2, 1))
    (folder / "NYU0001_0000.bin").write_bytes(encode_bin(stored, ORIGIN_M, POSE))
    return folder / "NYU0001_0000.bin"


def scores_of(labels, frame, tmp_path):
    np.savez(tmp_path / "pred.npz", labels=labels.transpose(0, 2, 1))
    return frame_scores(tmp_path / "pred.npz", open_occupancy(frame))


def test_the_truth_is_right_everywhere(frame, truth, tmp_path):
    scores = scores_of(np.where(truth == 255, 0, truth).astype(np.uint8), frame, tmp_path)
    assert scores["completion"]["iou"] == scores["completion_hidden"]["iou"] == 1
    assert scores["miou_present_classes"] == 1
    assert scores["miou"] == pytest.approx(3 / 11)
    assert scores["miou_with_empty"] == pytest.approx(4 / 12)


def test_what_lies_beyond_the_room_or_the_image_is_not_scored(frame, truth, tmp_path):
    labels = np.where(truth == 255, 11, truth).astype(np.uint8)
    labels[0, :20] = 11
    assert scores_of(labels, frame, tmp_path)["completion"]["iou"] == 1


def test_a_filled_hidden_cell_costs_and_a_free_one_does_not(frame, truth, tmp_path):
    labels = np.where(truth == 255, 0, truth).astype(np.uint8)
    labels[20:26, 44:48, 1:4] = 10  # In the shadow of the box.
    scores = scores_of(labels, frame, tmp_path)
    assert scores["completion"]["precision"] < 1
    assert scores["completion_hidden"]["precision"] < scores["completion"]["precision"]
    assert scores["completion"]["recall"] == 1


@pytest.mark.parametrize("posed", [True, False])
def test_a_run_is_placed_in_the_world_or_at_the_camera(frame, truth, tmp_path, posed):
    shape = truth.shape
    grid = OccupancyGrid(
        labels=truth,
        confidence=np.ones(shape, np.float16),
        colour=np.zeros((*shape, 3), np.uint8),
        source=(truth != 255).astype(np.uint8),
        instance=np.zeros(shape, np.uint16),
        voxel_m=0.08,
        origin_m=ORIGIN_M,
    )
    write_room(tmp_path / "room.npz", grid, np.eye(4) if posed else POSE)
    scores = frame_scores(tmp_path, open_occupancy(frame))
    assert scores["completion"]["iou"] > 0.99
    far = invert_rigid(POSE)
    far[:3, 3] += 40
    write_room(tmp_path / "room.npz", grid, far)
    with pytest.raises(InputError, match="no part of the frame"):
        frame_scores(tmp_path, open_occupancy(frame))


def test_the_verb_completes_a_depth_image(frame, tmp_path, capsys):
    picture, out = frame.with_suffix(".png"), tmp_path / "scores.json"
    assert w2m(["evaluate", "sscnet", str(picture), str(frame), "--json", str(out)]) == 0
    assert "hidden and surface cells" in capsys.readouterr().out
    scores = json.loads(out.read_text())
    assert scores["frame"] == "NYU0001_0000"
    assert scores["completion"]["iou"] > 0.75
    assert scores["miou_present_classes"] > 0.5


def test_a_frame_without_depth_has_no_hidden_cells(frame, truth, tmp_path):
    alone = tmp_path / frame.name
    alone.write_bytes(frame.read_bytes())
    with pytest.raises(UsageError, match="depth"):
        scores_of(np.zeros_like(truth), alone, tmp_path)

"""One depth picture in its frame's grid: where its cells lie, what is read, what is refused."""

import numpy as np
import pytest
from PIL import Image

from world2minecraft.cli import run as w2m
from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.errors import CaptureError, DamagedFileError, InputError, UnknownNameError
from world2minecraft.core.types import View
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA, encode_depth
from world2minecraft.minecraftocc.scene_completion import (
    FILE_AXES,
    GridPlace,
    complete_frame,
    depth_of_png,
    floor_of,
    read_grid_place,
    yaw_of_walls,
)
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor
from world2minecraft.reconstruction.semantics.completion_channels import Sight
from world2minecraft.reconstruction.semantics.completion_labeller import CompletionModel

EYE_M, WALL_M = 1.2, 4.0
# x right, y forward, z up: the camera looks along +y, level, over a floor at z = 0.
POSE = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, EYE_M], [0, 0, 0, 1]], np.float64)
PLACE = GridPlace(np.array([-2.4, 0.0, -0.08]), POSE)


class Empty:
    """Stands for a network that finds every cell empty, and of what is solid a table."""

    def __init__(self):
        self.sight: Sight | None = None

    def chances(self, sight: Sight):
        self.sight = sight
        chance = np.full((12, *sight.log_odds.shape), 0.02, np.float32)
        chance[0], chance[8] = 0.7, 0.1
        return chance


class Solid(Empty):
    """Stands for a network that finds every unseen cell to be a table."""

    def chances(self, sight: Sight):
        chance = np.full((12, *sight.log_odds.shape), 0.01, np.float32)
        chance[8] = 0.89
        return chance


@pytest.fixture(scope="module")
def depth_m():
    """A floor and a wall ahead."""
    rows = (np.arange(480) + 0.5 - NYU_CAMERA.cy_px) / NYU_CAMERA.fy_px
    floor = EYE_M / np.maximum(rows, 1e-6)
    return np.repeat(np.minimum(floor, WALL_M)[:, None], 640, axis=1).astype(np.float32)


def header(tmp_path, runs=b"these are no runs of labels"):
    path = tmp_path / "frame.bin"
    head = np.concatenate([PLACE.origin_m, POSE.ravel()]).astype("<f4")
    path.write_bytes(head.tobytes() + runs)
    return path


def test_only_the_head_of_a_bin_is_read(tmp_path):
    place = read_grid_place(header(tmp_path))
    assert place.origin_m == pytest.approx(PLACE.origin_m, abs=1e-6)
    assert place.camera_to_world == pytest.approx(POSE, abs=1e-6)


@pytest.mark.parametrize("names", [("origin_m", "camera_to_world"), ("voxel_origin", "cam_pose")])
def test_an_npz_may_state_the_grid(tmp_path, names):
    np.savez(tmp_path / "grid.npz", **dict(zip(names, (PLACE.origin_m, POSE), strict=True)))
    place = read_grid_place(tmp_path / "grid.npz")
    assert place.camera_to_world == pytest.approx(POSE)


def test_what_is_no_grid_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"SSCNet \.bin"):
        read_grid_place(tmp_path / "none.bin")
    (tmp_path / "short.bin").write_bytes(b"1234")
    with pytest.raises(DamagedFileError, match="does not contain an origin"):
        read_grid_place(tmp_path / "short.bin")
    head = np.concatenate([np.zeros(3), np.full(16, 7)]).astype("<f4")
    (tmp_path / "bent.bin").write_bytes(head.tobytes())
    with pytest.raises(DamagedFileError):
        read_grid_place(tmp_path / "bent.bin")


def test_cells_lie_where_the_picture_shows_them(depth_m):
    model = Empty()
    frame = complete_frame(depth_m, PLACE, model=model)  # type: ignore[arg-type]
    assert frame.labels.shape == (60, 60, 36)
    solid = frame.labels > 0
    assert (frame.labels[solid & frame.observed] == 8).all()
    assert (frame.labels[solid & ~frame.observed] == 2).all()
    wall = int(WALL_M / 0.08)
    assert solid[25:35, wall, 10:20].all()
    assert solid[25:35, 36:46, 0].all()
    assert not solid[25:35, 10:48, 5:20].any()
    assert frame.observed[25:35, 15:45, 13:17].all()
    assert not frame.observed[:, wall + 2 :].any()
    assert model.sight is not None
    assert model.sight.bottom_m == pytest.approx(-0.08, abs=0.02)


def test_the_floor_is_found_though_the_world_says_otherwise(depth_m):
    view = View(name="frame", camera_to_scan=POSE, depth_m=depth_m, depth_camera=NYU_CAMERA)
    world_to_grid = np.eye(4)
    world_to_grid[2, 3] = 0.4
    points = DepthPredictor().lift(view)
    assert floor_of(points, world_to_grid) == pytest.approx(0.4, abs=0.02)
    wall_alone = DepthPredictor().lift(
        View(
            name="wall",
            camera_to_scan=POSE,
            depth_m=np.full((480, 640), WALL_M, np.float32),
            depth_camera=NYU_CAMERA,
        )
    )
    assert floor_of(wall_alone, world_to_grid) == pytest.approx(0.4)


def test_nothing_is_filled_beyond_the_wall(depth_m):
    frame = complete_frame(depth_m, PLACE, model=Solid())  # type: ignore[arg-type]
    wall = int(WALL_M / 0.08)
    assert (frame.labels[25:35, wall, 10:20] > 0).all()
    assert not frame.labels[:, wall + 2 :].any()


@pytest.mark.parametrize("turned_deg", [20.0, -40.0])
def test_nothing_is_filled_beyond_a_wall_oblique_to_the_grid(depth_m, turned_deg):
    turn = rotation_about_z(turned_deg)
    place = GridPlace(PLACE.origin_m - [0, 0.8, 0], turn @ POSE)
    frame = complete_frame(depth_m, place, model=Solid())  # type: ignore[arg-type]
    centers_m = (np.moveaxis(np.indices((60, 60, 36)), 0, -1) + 0.5) * 0.08 + place.origin_m
    ahead_m = apply(turn.T, centers_m)[..., 1]
    assert not frame.labels[ahead_m > WALL_M + 0.16].any()
    solid = frame.labels > 0
    assert solid[frame.observed & (np.abs(ahead_m - WALL_M) < 0.04)].mean() > 0.4


@pytest.mark.parametrize("turned_deg", [0.0, 20.0, -40.0])
def test_the_yaw_of_walls_is_that_of_the_grid(depth_m, turned_deg):
    turned = rotation_about_z(turned_deg)
    view = View(
        name="frame", camera_to_scan=turned @ POSE, depth_m=depth_m, depth_camera=NYU_CAMERA
    )
    found = yaw_of_walls(DepthPredictor().lift(view), np.eye(4))
    assert found == pytest.approx(turned_deg, abs=0.5)


def test_without_a_floor_in_view_the_ground_is_not_filled(depth_m):
    """The image ends above the foot of the wall, and the shipped network completes it."""
    seen = np.where(np.arange(480)[:, None] < 360, depth_m, 0).astype(np.float32)
    frame = complete_frame(seen, PLACE)
    in_front = frame.labels[:, 5:46]
    assert (in_front[:, :, 2:9] > 0).mean() < 0.02


def test_depth_codes_tell_themselves(depth_m, tmp_path):
    millimetres = np.round(depth_m * 1000).astype(np.uint16)
    turned = (millimetres << 3) | (millimetres >> 13)
    for raw in (turned, millimetres, (depth_m * 8000 + 3).astype(np.uint16)):
        assert depth_of_png(tmp_path, raw) == pytest.approx(depth_m, abs=2e-3)
    far = np.full((4, 4), 9000, np.uint16)
    assert depth_of_png(tmp_path, (far << 3) | (far >> 13), "rotated") == pytest.approx(9.0)


def test_what_is_no_depth_is_refused(depth_m, tmp_path):
    with pytest.raises(UnknownNameError):
        depth_of_png(tmp_path, np.ones((4, 4), np.uint16), "feet")
    with pytest.raises(CaptureError, match="16 bits"):
        depth_of_png(tmp_path, np.zeros((4, 4), np.uint16))
    with pytest.raises(CaptureError, match="try the depth code"):
        depth_of_png(tmp_path, np.full((4, 4), 30_000, np.uint16), "mm")
    away = GridPlace(np.array([50.0, 0.0, 0.0]), POSE)
    with pytest.raises(CaptureError, match="no part of the grid"):
        complete_frame(depth_m, away, model=Empty())  # type: ignore[arg-type]


def test_the_verb_writes_the_files_own_axes(depth_m, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(CompletionModel, "chances", Empty.chances)
    (tmp_path / "depth.png").write_bytes(encode_depth(depth_m, "nyu"))
    Image.fromarray(np.full((480, 640, 3), 90, np.uint8)).save(tmp_path / "colour.png")
    out = tmp_path / "pred.npz"
    words = ["occupy", str(tmp_path / "depth.png"), "--grid", str(header(tmp_path))]
    assert w2m([*words, "--out", str(out), "--colour", str(tmp_path / "colour.png")]) == 0
    with np.load(out) as held:
        labels, observed = held["labels"], held["observed"]
        assert held["axes"] == "xzy"
        assert held["origin_m"] == pytest.approx(PLACE.origin_m, abs=1e-6)
    assert labels.shape == (60, 36, 60)
    assert labels.dtype == np.uint8
    straight = complete_frame(depth_m, PLACE, model=Empty())  # type: ignore[arg-type]
    assert (labels == straight.labels.transpose(FILE_AXES)).mean() > 0.999
    assert observed.any()
    assert "table" in capsys.readouterr().out

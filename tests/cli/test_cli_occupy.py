"""``w2m occupy`` of photos and of whole captures: the cells, their frames, and what is refused."""

import numpy as np
import pytest
from PIL import Image
from tests.exact_room import CAMERA, BoxRoom
from tests.reconstruction.occupancy.tiny_network import FACTS, sized, write_network

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.cli import run as w2m
from world2minecraft.core.coordinates import apply, invert_rigid, look_at, rotation_about_z
from world2minecraft.core.errors import InputError
from world2minecraft.core.files import write_npz
from world2minecraft.core.types import View
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.minecraftocc.cell_predictions import PredictedCells, resample_to_grid
from world2minecraft.minecraftocc.formats.image_conventions import encode_depth
from world2minecraft.minecraftocc.scene_completion import GridPlace

POSE = look_at(np.array([2.2, 0.5, 1.5]), np.array([2.2, 3.0, 1.2]))
ORIGIN_M = np.array([-0.2, 0.48, -0.08])
CHAIR, TABLE = 5, 8


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    """A bare box room in eight frames of depth and colour."""
    folder = tmp_path_factory.mktemp("capture")
    room, eye = BoxRoom((3.2, 2.8, 2.6)), np.array([1.6, 1.4, 1.4])
    views = []
    for n in range(8):
        turn = np.deg2rad(45 * n)
        pose = look_at(eye, eye + np.array([np.cos(turn), np.sin(turn), (-0.8, 0.4)[n % 2]]))
        depth_m, colour = room.render(pose)
        views.append(View(f"{n:04d}", pose, colour, CAMERA, depth_m, CAMERA))
    write_plain(folder, views)
    return folder


@pytest.fixture
def grid(tmp_path):
    write_npz(tmp_path / "grid.npz", {"origin_m": ORIGIN_M, "camera_to_world": POSE})
    return tmp_path / "grid.npz"


@pytest.fixture
def photo(tmp_path):
    _, colour = BoxRoom((4.4, 4.0, 2.6)).render(POSE)
    Image.fromarray(colour).save(tmp_path / "photo.png")
    return tmp_path / "photo.png"


def biased(path, facts):
    """A network that says chair of one cell, table of its neighbour in x, empty of all else."""
    bias = np.zeros((12, *facts.grid_shape))
    bias[0] = 9
    bias[CHAIR, 3, 4, 5] = bias[TABLE, 4, 4, 5] = 30
    return write_network(path, facts, bias=bias)


def test_a_grid_takes_the_cell_that_each_of_its_centres_lies_in():
    rng = np.random.default_rng(0)
    shape, origin_m = (40, 30, 25), np.array([-1.2, 0.4, -0.16])
    room = PredictedCells(
        rng.integers(0, 12, shape).astype(np.uint8),
        rng.random(shape, np.float32),
        rng.random(shape) < 0.5,
        0.08,
        origin_m,
    )
    scan_to_room = rotation_about_z(30.0)
    scan_to_room[:3, 3] = [0.3, -0.2, 0.1]
    place = GridPlace(np.array([-1.0, -1.0, -0.2]), np.eye(4))
    found = resample_to_grid(room, scan_to_room, place)
    assert found.labels.shape == (60, 60, 36) and (found.labels == 255).any()
    for cell in rng.integers(0, (60, 60, 36), (300, 3)):
        at_m = apply(scan_to_room, place.origin_m + (cell + 0.5) * 0.08)
        held = np.floor((at_m - origin_m) / 0.08).astype(int)
        inside = ((held >= 0) & (held < shape)).all()
        wanted = room.labels[tuple(held)] if inside else 255
        assert found.labels[tuple(cell)] == wanted
        assert found.observed[tuple(cell)] == (inside and room.observed[tuple(held)])


def test_a_grid_of_another_world_is_refused():
    room = PredictedCells(
        *(np.zeros((4, 4, 4), kind) for kind in ("u1", "f4", "?")), 0.08, np.zeros(3)
    )
    with pytest.raises(InputError, match="does not overlap the captured area"):
        resample_to_grid(room, np.eye(4), GridPlace(np.array([50.0, 0, 0]), np.eye(4)))


@pytest.mark.parametrize("facts", [FACTS, sized((60, 60, 36), 0.08)])
def test_a_photo_s_cells_lie_in_the_grids_own_axes(facts, photo, grid, tmp_path, capsys):
    net, out = biased(tmp_path / "net.onnx", facts), tmp_path / "pred.npz"
    words = ["occupy", str(photo), "--grid", str(grid), "--out", str(out)]
    assert w2m([*words, "--predictor", f"mono:{net}", "--focal-px", str(CAMERA.fx_px)]) == 0
    times = 60 // facts.grid_shape[0]
    with np.load(out) as held:
        labels = held["labels"]
        assert held["axes"] == "xzy" and not held["observed"].any()
        np.testing.assert_allclose(held["camera_to_world"], POSE)
    assert labels.shape == (60, 36, 60) and labels.dtype == np.uint8
    wanted = np.zeros((60, 36, 60), np.uint8)
    x, y, z = (slice(n * times, (n + 1) * times) for n in (3, 4, 5))
    wanted[x, z, y] = CHAIR
    wanted[4 * times : 5 * times, z, y] = TABLE
    np.testing.assert_array_equal(labels, wanted)
    assert "chair" in capsys.readouterr().out


def test_a_capture_becomes_the_cells_of_its_room(capture, tmp_path, capsys):
    out, keep = tmp_path / "room.npz", tmp_path / "RUN"
    assert w2m(["occupy", str(capture), "--out", str(out), "--keep", str(keep)]) == 0
    room, scan_to_room = read_room(keep / "room.npz")
    assert not (keep / "build").exists()
    with np.load(out) as held:
        assert held["axes"] == "xyz" and held["voxel_m"] == 0.08
        np.testing.assert_array_equal(held["labels"], room.labels)
        np.testing.assert_array_equal(held["origin_m"], room.origin_m)
        np.testing.assert_array_equal(held["scan_to_room"], scan_to_room)
        np.testing.assert_array_equal(held["observed"], room.source == 1)
    said = capsys.readouterr().out
    assert "floor" in said and "wall" in said
    # The same in a grid of the capture's own world.
    place = tmp_path / "grid.npz"
    write_npz(place, {"origin_m": ORIGIN_M, "camera_to_world": POSE})
    framed = tmp_path / "framed.npz"
    words = ["occupy", str(capture), "--grid", str(place), "--out", str(framed)]
    assert w2m([*words, "--keep", str(keep)]) == 0
    with np.load(framed) as held:
        labels = held["labels"].transpose(0, 2, 1)
    cells = np.argwhere(labels == 2)
    heights = apply(scan_to_room, ORIGIN_M + (cells + 0.5) * 0.08)[:, 2]
    assert len(cells) > 50 and np.abs(heights).max() < 0.1
    assert np.allclose(apply(invert_rigid(scan_to_room), [0, 0, 0])[2], 0, atol=0.1)


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["nowhere", "--grid", "GRID"], 3, "not found; give a depth PNG, a photo or a capture"),
        (["DEPTH"], 2, "is a depth image; add a grid (--grid FILE), which defines the position"),
        (["PHOTO", "--grid", "GRID"], 3, "this is a photo, expected a depth image"),
        (["DEPTH", "--grid", "GRID", "--predictor", "mono:NET"], 3, "mono needs a photo"),
        (["PHOTO", "--grid", "GRID", "--predictor", "mano:NET"], 2, "did you mean 'mono'"),
        (
            ["PHOTO", "--grid", "GRID", "--predictor", "mono:SMALL"],
            2,
            "grid of 8x8x8 cells",
        ),
        (
            ["PHOTO", "--grid", "GRID", "--predictor", "mono:DEEP"],
            2,
            "requires depth; choose a",
        ),
        (["CAPTURE", "--colour", "PHOTO"], 2, "colour requires a single depth image"),
        (["PHOTO"], 3, "--predictor mono"),
        (["EMPTY"], 3, "EMPTY"),
    ],
)
def test_what_cannot_be_is_said(words, code, text, photo, grid, capture, tmp_path, capsys):
    depth_m, _ = BoxRoom((4.4, 4.0, 2.6)).render(POSE)
    (tmp_path / "depth.png").write_bytes(encode_depth(depth_m.astype(np.float32), "mm"))
    (tmp_path / "EMPTY").mkdir()
    facts = {"NET": FACTS, "SMALL": sized((8, 8, 8), 0.16)}
    named = {"PHOTO": photo, "GRID": grid, "DEPTH": tmp_path / "depth.png", "CAPTURE": capture}
    named |= {"EMPTY": tmp_path / "EMPTY"}
    for name, fact in facts.items():
        named[name] = write_network(tmp_path / f"{name}.onnx", fact)
    deep = type(FACTS)(**{**vars(FACTS), "wants_depth": True})
    named["DEEP"] = write_network(tmp_path / "DEEP.onnx", deep)
    given = [
        str(named.get(word, word))
        if ":" not in word
        else f"{word.partition(':')[0]}:{named.get(word.partition(':')[2], 'x')}"
        for word in words
    ]
    assert w2m(["occupy", *given, "--out", str(tmp_path / "p.npz")]) == code
    assert text in " ".join(capsys.readouterr().err.split())
    assert not (tmp_path / "p.npz").exists()

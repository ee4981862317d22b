"""``w2m segment``: the label images of a capture, what it prints, and what it refuses."""

import json

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture import write_plain
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view
from world2minecraft.cli import run as w2m
from world2minecraft.core.types import Camera, View
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.reconstruction.recognition import segmentation
from world2minecraft.reconstruction.recognition.label_folder import write_label_images

WALL, FLOOR = 1, 2
LENS = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)
CUBE = """v 0 0 0
v 4 0 0
v 4 3 0
v 0 3 0
v 0 0 2.5
f 1 2 3
f 1 3 4
f 1 2 5
"""


class Halves:
    """A network that takes the left half for wall and the right one for floor."""

    def __init__(self, weights=None):
        self.shown = []

    def predict(self, colour, depth_m, camera, up=None, camera_height_m=None):
        self.shown.append((depth_m, camera, up, camera_height_m))
        found = np.zeros((10, 20, 40), np.float32)
        found[:, :10, WALL - 1] = found[:, 10:, FLOOR - 1] = 0.7
        found[:, :10, FLOOR - 1] = found[:, 10:, WALL - 1] = 0.3
        return found


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    """A virtual scan of three small frames."""
    folder = tmp_path_factory.mktemp("segment") / "cap"
    scan_room(generate_room(3, kind="study"), folder, frames=3, width=160, height=120)
    return folder


@pytest.fixture
def halves(monkeypatch):
    monkeypatch.setattr(segmentation, "SegmentationModel", Halves)


@pytest.fixture
def photos(tmp_path):
    """A folder of four photos without poses or lens."""
    folder = tmp_path / "photos"
    folder.mkdir()
    rng = np.random.default_rng(0)
    for name in "abcd":
        pixels = rng.integers(0, 255, (180, 240, 3)).astype(np.uint8)
        Image.fromarray(pixels).save(folder / f"{name}.jpg")
    return folder


def ids_of(path):
    image = Image.open(path)
    assert image.mode == "L"
    return np.asarray(image)


def test_a_capture_becomes_label_images(capture, tmp_path, capsys):
    """By the real network, with overlays; a reconstruction reads them as its own classes."""
    out = tmp_path / "labels"
    assert w2m(["segment", str(capture), "--out", str(out), "--overlay"]) == 0
    said = capsys.readouterr()
    lines = said.out.splitlines()
    assert lines[0].startswith(f"{out}: 3 label images; ") and "wall" in lines[0]
    assert lines[1] == f"next: w2m reconstruct {capture} --out OUT --labels {out}"
    assert "Segmenting images: done in" in said.err
    names = [f"frame-00000{n}" for n in range(3)]
    wanted = {f"{name}{end}" for name in names for end in (".png", ".overlay.jpg")}
    assert {path.name for path in out.iterdir()} == wanted | {"labels.json"}
    found = np.concatenate([ids_of(out / f"{name}.png") for name in names])
    assert found.shape == (3 * 120, 160) and found.min() >= 1 and found.max() <= 40
    assert {1, 2} < set(np.unique(found)) and found.max() > 11
    judged = validate_capture(capture, ScanOptions(), out)
    view = read_view(judged.frames[0], judged.encoding)
    ids = ids_of(out / f"{names[0]}.png")
    assert (view.labels[ids == WALL] == 3).all() and (view.labels[ids == FLOOR] == 2).all()


def test_photos_without_poses_are_segmented(photos, halves, tmp_path, capsys):
    out = tmp_path / "labels"
    words = ["segment", str(photos), "--out", str(out), "--min-probability", "0.6", "--json"]
    assert w2m(words) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["frames"] == ["a", "b", "c", "d"] and told["skipped"] == []
    assert told["shares"]["wall"] == told["shares"]["floor"] < 0.5
    ids = ids_of(out / "a.png")
    assert ids.shape == (180, 240)
    assert (ids[:, :114] == WALL).all() and (ids[:, 126:] == FLOOR).all()
    assert not ids[:, 119:121].any()  # As likely one as the other.


def test_gravity_and_height_are_shown_to_the_network(capture, tmp_path):
    model = Halves()
    made = write_label_images(capture, tmp_path / "labels", model)
    assert made.names == ("frame-000000", "frame-000001", "frame-000002")
    for depth_m, camera, up, height_m in model.shown:
        assert depth_m is not None and camera.width_px == 160
        assert up[1] < -0.7 and 0.8 < height_m < 2.2


def test_labels_lie_as_the_images_are_stored(tmp_path):
    """The images of a phone held upright are stored sideways; the network sees them upright."""
    sideways = np.array([[0, 0, 1.0, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
    turn = np.array([[0, -1.0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    colour = np.zeros((48, 64, 3), np.uint8)
    views = [View(f"{n}", sideways @ turn, colour, LENS) for n in range(3)]
    write_plain(tmp_path / "cap", views, stated={"world_up": [0, 0, 1]})
    model, out = Halves(), tmp_path / "labels"
    write_label_images(tmp_path / "cap", out, model)
    _, camera, up, _ = model.shown[0]
    assert (camera.width_px, camera.height_px) == (48, 64)
    assert up == pytest.approx([0, -1, 0], abs=1e-6)
    ids = ids_of(out / "0.png")
    assert ids.shape == (48, 64)
    assert {len(np.unique(row)) for row in ids} == {1}
    assert {ids[0, 0], ids[-1, 0]} == {WALL, FLOOR}


def test_a_folder_with_files_needs_force(photos, halves, tmp_path, capsys):
    out = tmp_path / "labels"
    out.mkdir()
    (out / "a.png").write_bytes(b"mine")
    assert w2m(["segment", str(photos), "--out", str(out)]) == 2
    line = (
        f"error: {out} contains other files (a.png); choose another folder, or use --force "
        "to replace a.png there\n"
    )
    assert capsys.readouterr().err == line
    assert (out / "a.png").read_bytes() == b"mine"
    assert w2m(["segment", str(photos), "--out", str(out), "--force"]) == 0
    assert ids_of(out / "a.png").shape == (180, 240)


def test_damaged_photos_are_skipped_and_listed(photos, halves, tmp_path, capsys):
    whole = (photos / "b.jpg").read_bytes()
    (photos / "b.jpg").write_bytes(whole[: len(whole) // 2])
    assert w2m(["segment", str(photos), "--out", str(tmp_path / "labels")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("skipped b: ") and "3 label images" in lines[1]


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["nowhere"], 3, "not found"),
        (["MESH"], 3, "is a mesh or point cloud, which has no pictures to segment"),
        (["PLAN"], 3, "is a RoomPlan without frames, which has no pictures to segment"),
        (["DEPTH"], 3, "contains no colour images; depth alone is not segmented"),
        (["PHOTOS", "--semantics", "hf:a/b"], 2, "no network is named 'hf:a/b'; known: generated"),
        (["PHOTOS", "--min-probability", "1.5"], 2, "must be from 0 to 1, got 1.5"),
        (["PHOTOS", "--set", "capture.evrey=2"], 2, "did you mean"),
        (["PHOTOS", "--out", "PHOTOS/labels"], 2, "is inside the capture; choose another"),
        (["PHOTOS", "--out", "PHOTOS/a.jpg"], 3, "is a file; the output must be a folder"),
    ],
)
def test_what_cannot_be_segmented_is_told(words, code, text, photos, halves, tmp_path, capsys):
    (tmp_path / "mesh.obj").write_text(CUBE)
    (tmp_path / "Room.json").write_text(json.dumps({"walls": [], "objects": []}))
    depth = np.full((48, 64), 2, np.float32)
    pose = np.array([[1, 0, 0, 0], [0, 0, 1.0, 0], [0, -1, 0, 1.5], [0, 0, 0, 1]])
    views = [View(f"{n}", pose, depth_m=depth, depth_camera=LENS) for n in range(3)]
    write_plain(tmp_path / "depth", views)
    named = {"PHOTOS": "photos", "MESH": "mesh.obj", "PLAN": "Room.json", "DEPTH": "depth"}
    for name, file in named.items():
        words = [word.replace(name, str(tmp_path / file)) for word in words]
    if "--out" not in words:
        words += ["--out", str(tmp_path / "labels")]
    assert w2m(["segment", *words]) == code
    err = capsys.readouterr().err.splitlines()
    assert err[-1].startswith("error: ") and text in err[-1]
    assert not (tmp_path / "labels").exists()

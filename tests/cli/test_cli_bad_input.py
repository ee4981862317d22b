"""Bad input: one line that names file and reason, exit code 3, and nothing written."""

import json
import re
import shutil
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from world2minecraft.cli import run as w2m
from world2minecraft.procgen import generate_room, scan_room

FRAMES = 6


@pytest.fixture(scope="module")
def good(tmp_path_factory) -> Path:
    """A small capture that works."""
    folder = tmp_path_factory.mktemp("good")
    room = generate_room(1, kind="study")
    scan_room(room, folder, sensor="clean", frames=FRAMES, seed=1, width=160, height=120)
    return folder


def images(folder: Path, kind: str) -> list[Path]:
    return sorted((folder / kind).iterdir())


def truncated(folder: Path) -> None:
    for path in images(folder, "depth"):
        path.write_bytes(path.read_bytes()[:200])


def other_sizes(folder: Path) -> None:
    for number, path in enumerate(images(folder, "depth")):
        if number % 2:
            Image.fromarray(np.full((60, 80), 2000, np.uint16)).save(path)


def no_uniform_scale(folder: Path) -> None:
    for path in images(folder, "depth"):
        Image.fromarray(np.full((120, 120), 2000, np.uint16)).save(path)


def eight_bit(folder: Path) -> None:
    for path in images(folder, "depth"):
        Image.fromarray(np.full((120, 160), 200, np.uint8)).save(path)


def all_zero(folder: Path) -> None:
    for path in images(folder, "depth"):
        Image.fromarray(np.zeros((120, 160), np.uint16)).save(path)


def changed(folder: Path, change) -> None:
    path = folder / "capture.json"
    value = json.loads(path.read_text())
    change(value)
    path.write_text(json.dumps(value))


def no_poses(folder: Path) -> None:
    changed(folder, lambda value: [frame.pop("camera_to_world") for frame in value["frames"]])


def no_intrinsics(folder: Path) -> None:
    def drop(value):
        for holder in (value, *value["frames"]):
            for key in ("camera", "depth_camera", "colour_camera"):
                holder.pop(key, None)

    changed(folder, drop)


def mirrored(folder: Path) -> None:
    def mirror(value):
        for frame in value["frames"]:
            pose = np.array(frame["camera_to_world"])
            pose[:3, 0] *= -1
            frame["camera_to_world"] = pose.tolist()

    changed(folder, mirror)


def in_millimetres(folder: Path) -> None:
    def scale(value):
        for frame in value["frames"]:
            pose = np.array(frame["camera_to_world"])
            pose[:3, 3] *= 1000
            frame["camera_to_world"] = pose.tolist()

    changed(folder, scale)


def empty(folder: Path) -> None:
    shutil.rmtree(folder)
    folder.mkdir()


def another_kind(folder: Path) -> None:
    empty(folder)
    (folder / "song.mp3").write_bytes(b"ID3")


def huge_image(folder: Path) -> None:
    """A PNG header that says 20,000 x 20,000 pixels, and hardly any data."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", 20_000, 20_000, 16, 0, 0, 0, 0))
    body = chunk(b"IDAT", zlib.compress(b"\0" * 1000)) + chunk(b"IEND", b"")
    for path in images(folder, "depth"):
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + head + body)


CASES = [
    (truncated, "is damaged"),
    (other_sizes, "size|80x60"),
    (no_uniform_scale, "aspect ratio"),
    (eight_bit, "8"),
    (all_zero, "depth"),
    (no_poses, "pose|camera_to_world"),
    (no_intrinsics, "camera"),
    (mirrored, "mirror"),
    (in_millimetres, "millimetre|metre"),
    (empty, "empty|no "),
    (another_kind, "plain layout"),
    (huge_image, "pixel"),
]


# A capture without poses is one that scan describes.
REFUSALS = [
    pytest.param(*case, verb, id=f"{verb}-{case[0].__name__}")
    for verb in ("scan", "reconstruct")
    for case in CASES
    if (verb, case[0]) != ("scan", no_poses)
]


@pytest.mark.parametrize(("damage", "says", "verb"), REFUSALS)
def test_one_line_exit_code_3_and_nothing_written(good, tmp_path, capsys, damage, says, verb):
    capture, out = tmp_path / "capture", tmp_path / "OUT"
    shutil.copytree(good, capture)
    damage(capture)
    words = [verb, str(capture)] + (["--out", str(out)] if verb == "reconstruct" else [])
    assert w2m(words) == 3
    lines = [line for line in capsys.readouterr().err.splitlines() if line.startswith("error:")]
    assert len(lines) == 1 and str(capture) in lines[0]
    assert re.search(says, lines[0]), lines[0]
    assert not out.exists()


def test_one_bad_frame_among_many_is_skipped_and_listed(good, tmp_path):
    capture, out = tmp_path / "capture", tmp_path / "OUT"
    shutil.copytree(good, capture)
    victim = images(capture, "depth")[2]
    whole = bytearray(victim.read_bytes())
    whole[len(whole) // 2] ^= 0xFF  # The header is whole: only decoding tells.
    victim.write_bytes(whole)
    assert w2m(["reconstruct", str(capture), "--out", str(out)]) == 0
    skipped = json.loads((out / "scan.json").read_text())["frames_skipped"]
    assert [row["frame"] for row in skipped] == [victim.stem]
    assert json.loads((out / "report.json").read_text())["scan"]["frames_skipped"] == skipped


def test_an_out_that_is_a_file_is_refused(good, tmp_path, capsys):
    out = tmp_path / "OUT"
    out.write_text("mine")
    assert w2m(["reconstruct", str(good), "--out", str(out)]) == 3
    assert "is a file; the output must be a folder" in capsys.readouterr().err
    assert out.read_text() == "mine"


def test_a_full_disk_is_said(good, tmp_path, capsys, monkeypatch):
    usage = type("Usage", (), {"free": 1 << 20})()
    monkeypatch.setattr("shutil.disk_usage", lambda _: usage)
    assert w2m(["reconstruct", str(good), "--out", str(tmp_path / "OUT")]) == 3
    assert "MB free" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["reconstruct"], "CAPTURE|argument"),
        (["reconstruct", "x", "--out", "o", "--voxel", "9"], "voxel_m must be 0.01 to 0.5"),
        (["reconstruct", "x", "--out", "o", "--set", "find.cluster_radus=1"], "did you mean"),
        (["reconstruct", "x", "--out", "o", "--set", "find"], "--set must be KEY=VALUE"),
        (
            ["reconstruct", "x", "--out", "o", "--set", "fuse.min_points=two"],
            "must be a whole number",
        ),
        (["reconstruct", "x", "--out", "o", "--from", "fusse"], "did you mean 'fuse'"),
        (["reconstruct", "x", "--out", "o", "--mc-version", "1.99"], "1.99"),
        (["reconstruct", "x", "--out", "o", "--labeller", "best"], "best"),
        (["recontsruct"], "did you mean 'reconstruct'"),
    ],
)
def test_wrong_usage_is_exit_code_2(words, says, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert w2m(words) == 2
    assert re.search(says, capsys.readouterr().err)
    assert not list(tmp_path.iterdir())

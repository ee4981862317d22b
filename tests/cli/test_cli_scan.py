"""``w2m scan``: its lines, its picture, its JSON, and what it says when it cannot."""

import json

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture import write_plain
from world2minecraft.cli import run as w2m
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera, View

CAMERA = Camera(80, 60, 60.0, 60.0, 40.0, 30.0)


@pytest.fixture
def capture(tmp_path, monkeypatch):
    """Twelve pictures with poses and no depth, and a folder of one's own to stand in."""
    rng = np.random.default_rng(1)
    views = []
    for index in range(12):
        eye = np.array([np.cos(index), np.sin(index), 1.5])
        colour = rng.integers(0, 255, (60, 80, 3)).astype(np.uint8)
        views.append(View(f"{index:03d}", look_at(eye, eye * [2, 2, 0.9]), colour, CAMERA))
    write_plain(tmp_path / "den", views)
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path / "den"


def test_text_and_picture(capture, tmp_path, capsys):
    assert w2m(["scan", str(capture)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == (
        f"{capture}: images with poses, without depth (plain), 12 of 12 frames usable"
    )
    assert lines[-2] == "image: den-scan.png"
    assert lines[-1] == f"next: w2m reconstruct {capture} --out OUT"
    assert Image.open(tmp_path / "here" / "den-scan.png").size == (1600, 1040)
    assert w2m(["scan", str(capture)]) == 0  # One of ours is replaced.


def test_another_s_file_is_left_alone(capture, tmp_path, capsys):
    (tmp_path / "here" / "den-scan.png").write_bytes(b"mine")
    assert w2m(["scan", str(capture)]) == 0
    assert (
        "image: not written; den-scan.png: already exists and was not written by w2m scan; "
        in capsys.readouterr().out
    )
    assert (tmp_path / "here" / "den-scan.png").read_bytes() == b"mine"


def test_a_place_of_one_s_own_and_none(capture, tmp_path, capsys):
    assert w2m(["scan", str(capture), "--picture", str(tmp_path / "look.png")]) == 0
    assert (tmp_path / "look.png").is_file()
    assert w2m(["scan", str(capture), "--no-picture"]) == 0
    assert list((tmp_path / "here").iterdir()) == []
    capsys.readouterr()
    assert w2m(["scan", str(capture), "--no-picture", "-o", "a.png"]) == 2
    assert "omit --no-picture" in capsys.readouterr().err
    (tmp_path / "file").write_text("")
    assert w2m(["scan", str(capture), "--picture", str(tmp_path / "file" / "a.png")]) == 3


def test_json(capture, tmp_path, capsys):
    assert w2m(["scan", str(capture), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["route"]["kind"] == "posed photos"
    assert data["usable"] == 12
    assert {doubt["level"] for doubt in data["doubts"]} <= {"ok", "warn", "stop"}
    assert list((tmp_path / "here").iterdir()) == []


def test_a_stop_is_told_and_is_no_failure(capture, capsys, monkeypatch):
    monkeypatch.setattr(
        "world2minecraft.capture.quality.diagnostics.is_installed", lambda module: False
    )
    assert w2m(["scan", str(capture), "--no-picture"]) == 0
    assert "  stop      pose estimation needs an extra" in capsys.readouterr().out


def test_a_room_plan(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    from world2minecraft.formats import roomplan

    plan = roomplan.CapturedPlan((roomplan.PlanRoom("den", (), (), ()),))
    monkeypatch.setattr(roomplan, "find_roomplan", lambda path: path)
    monkeypatch.setattr(roomplan, "read_roomplan", lambda path: plan)
    assert w2m(["scan", "Room.json"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("Room.json: a RoomPlan capture with 1 room, 0 walls")
    assert lines[-1] == "next: w2m reconstruct Room.json --out OUT"


def test_frames_with_a_plan_beside_them_are_frames(capture, capsys):
    (capture / "Room.json").write_text('{"walls": [], "doors": []}')
    assert w2m(["scan", str(capture), "--no-picture"]) == 0
    assert "images with poses, without depth (plain)" in capsys.readouterr().out


def test_a_place_that_cannot_be_read_is_bad_input(capsys):
    assert w2m(["scan", "a" * 400]) == 3
    assert "please report" not in capsys.readouterr().err

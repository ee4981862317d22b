"""``w2m rooms scan``: what it takes, what it writes, what it refuses and in which words."""

import json

import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.core.files import read_npz
from world2minecraft.procgen import benchmark_trials as trials
from world2minecraft.procgen import generate_room, write_generated
from world2minecraft.procgen import virtual_scan as capture


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    """Pictures of 64 x 48: the verb has no option for their size."""
    scan = capture.scan_room

    def small(*args, **named):
        scan(*args, **named, width=64, height=48)

    monkeypatch.setattr("world2minecraft.procgen.scan_room", small)
    monkeypatch.setattr(trials, "scan_room", small)


def test_a_seed_becomes_a_capture_with_its_truth(tmp_path, capsys):
    out = tmp_path / "cap"
    words = [
        "--seed",
        "3",
        "--kind",
        "study",
        "--frames",
        "5",
        "--coverage",
        "0.6",
        "--depth-scale-sigma",
        "0.03",
    ]
    assert w2m(["rooms", "scan", *words, "--label-error", "0.1", "--out", str(out)]) == 0
    said = capsys.readouterr()
    assert said.out == (
        f"next: w2m reconstruct {out} --out OUT\nthen: w2m evaluate reconstruction OUT {out}\n"
    )
    assert "Scanning the room virtually: done in" in said.err
    truth = read_npz(out / "truth.npz", ("frame_names", "depth_scale"))
    assert truth["frame_names"].tolist() == ["frame-000000", "frame-000001", "frame-000002"]
    assert len(set(truth["depth_scale"].tolist())) == 3
    assert json.loads((out / "truth.json").read_text())["kind"] == "study"
    assert len(list((out / "labels").iterdir())) == 3


def test_labels_are_written_where_they_are_asked_for(tmp_path):
    for name, words in (("plain", []), ("labelled", ["--labels"])):
        base = ["rooms", "scan", "--seed", "3", "--kind", "study", "--frames", "1"]
        assert w2m([*base, *words, "--out", str(tmp_path / name)]) == 0
    assert not (tmp_path / "plain" / "labels").exists()
    assert (tmp_path / "labelled" / "labels" / "frame-000000.png").is_file()


def test_a_trial_is_scanned_by_name(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(trials, "write_trial", lambda trial, out, progress: asked.append(trial))
    out = str(tmp_path / "cap")
    assert w2m(["rooms", "scan", "--trial", "noise-503-clean", "--out", out]) == 0
    assert asked == [trials.find_trial("noise-503").clean()]


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ([], "nothing to scan; give a room folder, --seed or --trial"),
        (["--seed", "-1"], "seed must be 0 or more, got -1"),
        (["--seed", "1", "--kind", "barn"], "no room kind is named 'barn'; known:"),
        (["--seed", "1", "--sensor", "rgb"], "no sensor is named 'rgb'; did you mean 'rgbd'"),
        (["--seed", "1", "--frames", "0"], "frames must be 1 or more, got 0"),
        (
            ["--seed", "1", "--coverage", "0"],
            "coverage must be above 0 and at most 1, got 0.0",
        ),
        (
            ["--seed", "1", "--depth-scale-sigma", "3"],
            "depth_scale_sigma must be from 0 to 0.2, got 3.0",
        ),
        (
            ["--seed", "1", "--label-error", "2"],
            "label_error must be from 0 to 1, got 2.0",
        ),
        (["room", "--kind", "study"], "the type of room is fixed; omit --kind"),
        (
            ["--trial", "noise-500", "--frames", "9"],
            "--trial has a fixed room and settings; combine it only with --out",
        ),
        (["--trial", "noise-5000"], "no trial is named 'noise-5000'; did you mean"),
    ],
)
def test_wrong_words_are_told_in_one_line(words, text, tmp_path, capsys):
    assert w2m(["rooms", "scan", *words, "--out", str(tmp_path / "cap")]) == 2
    err = capsys.readouterr().err
    assert err.splitlines()[-1].startswith(f"error: {text}")
    assert not (tmp_path / "cap" / "capture.json").exists()


def test_a_folder_with_a_capture_is_refused(tmp_path, capsys):
    (tmp_path / "capture.json").write_text("{}")
    assert w2m(["rooms", "scan", "--seed", "1", "--out", str(tmp_path)]) == 2
    advice = "delete it or choose another output folder"
    line = f"error: {tmp_path} already contains a capture; {advice}\n"
    assert capsys.readouterr().err == line


def test_a_generated_room_is_scanned_from_its_folder(tmp_path):
    room = generate_room(3, kind="study")
    write_generated(room, tmp_path / "room")
    out = tmp_path / "cap"
    assert w2m(["rooms", "scan", str(tmp_path / "room"), "--frames", "2", "--out", str(out)]) == 0
    again = tmp_path / "again"
    base = ["rooms", "scan", "--seed", "3", "--kind", "study", "--frames", "2"]
    assert w2m([*base, "--out", str(again)]) == 0
    for name in ("capture.json", "depth/frame-000001.png", "colour/frame-000001.png"):
        assert (out / name).read_bytes() == (again / name).read_bytes()


def test_a_generated_room_is_not_written_over(tmp_path, capsys):
    write_generated(generate_room(3, kind="study"), tmp_path)
    before = (tmp_path / "truth.npz").read_bytes()
    assert w2m(["rooms", "scan", str(tmp_path), "--out", str(tmp_path)]) == 2
    line = f"error: {tmp_path} already contains a generated room; choose another output folder\n"
    assert capsys.readouterr().err == line
    assert (tmp_path / "truth.npz").read_bytes() == before


def test_a_folder_that_is_no_room_is_refused(tmp_path, capsys):
    assert w2m(["rooms", "scan", str(tmp_path), "--out", str(tmp_path / "cap")]) == 3
    assert "layout.json: not found" in capsys.readouterr().err

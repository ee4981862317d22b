"""Online mode: a map at any time, nothing half done, and the end is the batch's."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.capture import write_plain
from world2minecraft.cli import run as w2m
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.procgen import generate_room
from world2minecraft.procgen.virtual_scan import room_views
from world2minecraft.reconstruction import online as live_module
from world2minecraft.reconstruction.online import Follower, LiveRoom, follow
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct

FRAMES = 12


@pytest.fixture(scope="module")
def views():
    """Twelve small views of a bedroom."""
    room = generate_room(4, kind="bed")
    return list(room_views(room, frames=FRAMES, seed=4, width=160, height=120))


@pytest.fixture(scope="module")
def batch(views, tmp_path_factory) -> Path:
    """The capture of those views in exact depth, and its reconstruction beside it."""
    folder = tmp_path_factory.mktemp("batch")
    write_plain(folder / "capture", views, depth_unit="m")
    reconstruct(folder / "capture", folder / "OUT")
    return folder


def grown(source: Path, target: Path, count: int) -> None:
    """Make ``target`` what ``source`` was when so many frames were written."""
    stated = json.loads((source / "capture.json").read_text())
    stated["frames"] = stated["frames"][:count]
    for entry in stated["frames"]:
        for kind, suffix in (("colour", "png"), ("depth", "npy")):
            (target / kind).mkdir(parents=True, exist_ok=True)
            shutil.copy(source / kind / f"{entry['name']}.{suffix}", target / kind)
    (target / "capture.json").write_text(json.dumps(stated))


def test_a_live_room_ends_with_the_bytes_of_the_batch(views, batch, tmp_path):
    room = LiveRoom(tmp_path / "OUT")
    sizes = []
    for view in views:
        room.add(view)
        sizes.append(int((room.fused().log_odds != 0).sum()))
    assert sizes[0] > 0, "the map is there from the first view"
    assert sizes[-1] > sizes[0]
    assert not (tmp_path / "OUT" / "room.npz").exists(), "nothing is written unasked"
    room.finish()
    for name in ("evidence.npz", "room.npz", "poses.npz", "objects.json", "build/room.schem"):
        ours, theirs = tmp_path / "OUT" / name, batch / "OUT" / name
        assert ours.read_bytes() == theirs.read_bytes(), name


def test_placing_costs_linear_time_in_frames(views, tmp_path, monkeypatch):
    placed = []
    monkeypatch.setattr(
        live_module.LiveMap,
        "place",
        lambda self, capture, labels=None: (
            placed.append(self.frames),
            setattr(self, "_next", 2 * self.frames),
        ),
    )
    room = LiveRoom(tmp_path / "OUT")
    for view in views:
        room.add(view)
    assert placed == [4, 8]


def test_before_a_view_there_is_no_map_and_no_view_comes_twice(views, tmp_path):
    room = LiveRoom(tmp_path / "OUT")
    with pytest.raises(CaptureError, match="no view contains usable depth"):
        room.fused()
    room.add(views[0])
    with pytest.raises(UsageError, match="was already added"):
        room.add(views[0])
    with pytest.raises(UsageError, match="contains frames of another run"):
        LiveRoom(tmp_path / "OUT")


def test_the_room_of_the_moment_can_be_shown(views, tmp_path):
    room = LiveRoom(tmp_path / "OUT")
    for view in views[:8]:
        room.add(view)
    room.show()
    grid, scan_to_room = read_room(tmp_path / "OUT" / "room.npz")
    assert grid.occupied.sum() > 500
    assert abs(np.linalg.det(scan_to_room[:3, :3]) - 1) < 1e-6
    assert (tmp_path / "OUT" / "preview.png").read_bytes().startswith(b"\x89PNG")
    assert not [path for path in (tmp_path / "OUT").rglob(".*")], "nothing is left half written"


def test_following_reads_each_frame_once_as_it_comes(batch, tmp_path):
    capture = tmp_path / "capture"
    follower = Follower(capture, Parameters())
    assert follower.poll() == 0, "the folder is not there yet"
    counts = []
    for count in (2, 5, 5, 7, FRAMES):
        grown(batch / "capture", capture, count)
        counts.append(follower.poll())
    assert counts == [2, 3, 0, 2, FRAMES - 7]
    assert follower.live.scan is not None
    assert (follower.live.fused().log_odds > 0).sum() > 500


def test_a_frame_that_is_being_written_is_tried_again(batch, tmp_path):
    capture = tmp_path / "capture"
    grown(batch / "capture", capture, 6)
    follower = Follower(capture, Parameters())
    assert follower.poll() == 6
    grown(batch / "capture", capture, 7)
    name = json.loads((capture / "capture.json").read_text())["frames"][6]["name"]
    path = capture / "depth" / f"{name}.npy"
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert follower.poll() == 0
    path.write_bytes(whole)
    assert follower.poll() == 1


class Hours:
    """A clock that moves only while one waits, and a capture that grows meanwhile."""

    def __init__(self, source: Path, target: Path, counts: list[int]):
        self.now, self.source, self.target, self.counts = 0.0, source, target, counts

    def wait(self, seconds: float) -> None:
        self.now += seconds
        if self.counts:
            grown(self.source, self.target, self.counts.pop(0))

    def clock(self) -> float:
        return self.now


@pytest.mark.parametrize("ending", ["idle", "done", "ctrl-c"])
def test_following_ends_as_it_says_and_has_shown_the_room(batch, tmp_path, ending, monkeypatch):
    hours = Hours(batch / "capture", tmp_path / "capture", [3, 6, 6, 8])
    shown = []
    monkeypatch.setattr(
        live_module, "show", lambda live, out: shown.append((hours.now, live.frames))
    )

    def wait(seconds: float) -> None:
        hours.wait(seconds)
        if not hours.counts and ending == "done":
            (tmp_path / "capture" / "done").touch()
        if not hours.counts and ending == "ctrl-c":
            raise KeyboardInterrupt

    frames = follow(
        tmp_path / "capture",
        tmp_path / "OUT",
        idle_s=30,
        poll_s=2,
        show_s=4,
        wait=wait,
        clock=hours.clock,
    )
    assert frames == (6 if ending == "ctrl-c" else 8)
    assert hours.now == {"idle": 8 + 30, "done": 8, "ctrl-c": 8}[ending]
    assert shown == [(4, 6), (8, 8)][: 1 if ending == "ctrl-c" else 2]


def test_follow_and_from_exclude_each_other(tmp_path, capsys):
    words = ["reconstruct", str(tmp_path), "--out", str(tmp_path / "OUT")]
    assert w2m([*words, "--follow", "--from", "build"]) == 2
    assert "follow cannot be combined with a start stage (--from)" in capsys.readouterr().err

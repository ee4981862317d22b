"""Moving pictures: whole or not at all, frames in their places, a clear word without ffmpeg."""

import shutil
import sys

import numpy as np
import pytest
from PIL import Image, ImageSequence

from world2minecraft.core.errors import LimitError, MissingExtraError, OutputError, UsageError
from world2minecraft.rendering.output import animation as moving
from world2minecraft.rendering.output import animation_writer

TONES = (20, 120, 220)


def frame(tone):
    return np.full((36, 48, 3), tone, np.uint8)


def write(path, tones=TONES, rate_hz=10.0):
    with animation_writer(path, rate_hz) as take:
        for tone in tones:
            take(frame(tone))


@pytest.mark.parametrize("suffix", [".gif", ".apng", ".webp"])
def test_frames_come_back_in_their_order(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    write(path)
    with Image.open(path) as image:
        assert image.n_frames == 3
        for still, tone in zip(ImageSequence.Iterator(image), TONES, strict=True):
            colour = np.asarray(still.convert("RGB")).astype(int)
            assert np.abs(colour - tone).max() <= 4
            assert still.info["duration"] == 100
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_a_gif_frame_lasts_at_least_a_hundredth_of_a_second(tmp_path):
    write(tmp_path / "a.gif", rate_hz=240.0)
    with Image.open(tmp_path / "a.gif") as image:
        assert image.info["duration"] == 10


def test_the_same_frames_give_the_same_bytes(tmp_path):
    for name in ("a.gif", "b.gif"):
        write(tmp_path / name)
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()


@pytest.mark.parametrize("suffix", [".mp4", ".webm"])
def test_videos_are_written_and_their_frames_come_back(tmp_path, suffix):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    path = tmp_path / f"a{suffix}"
    write(path)
    reader = ffmpeg.read_frames(str(path))
    assert next(reader)["size"] == (48, 36)
    stills = [np.frombuffer(data, np.uint8) for data in reader]
    assert [abs(still.mean() - tone) < 6 for still, tone in zip(stills, TONES, strict=True)]
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def test_odd_sizes_lose_a_row_and_a_column(tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    with animation_writer(tmp_path / "a.mp4", 10) as take:
        take(np.zeros((37, 49, 3), np.uint8))
    assert next(ffmpeg.read_frames(str(tmp_path / "a.mp4")))["size"] == (48, 36)


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_what_goes_wrong_midway_leaves_what_was_there(tmp_path, suffix):
    if suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg")
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"old")
    with pytest.raises(KeyError), animation_writer(path, 10) as take:
        take(frame(1))
        raise KeyError
    assert path.read_bytes() == b"old"
    assert [one.name for one in tmp_path.iterdir()] == [path.name]


def without_ffmpeg(monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)


def test_without_ffmpeg_the_extra_is_named(tmp_path, monkeypatch):
    without_ffmpeg(monkeypatch)
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(MissingExtraError) as told:
        write(tmp_path / "a.mp4")
    assert str(told.value) == (
        "writing MP4 or WebM (GIF works without it) needs an extra: pip install "
        "'world2minecraft[video]'"
    )
    assert not list(tmp_path.iterdir())


def test_an_ffmpeg_on_the_path_serves_too(monkeypatch):
    without_ffmpeg(monkeypatch)
    monkeypatch.setattr(shutil, "which", lambda name: f"/bin/{name}")
    assert moving.ffmpeg_program() == "/bin/ffmpeg"


@pytest.mark.skipif(sys.platform == "win32", reason="needs a program that is a script")
@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("cat >/dev/null; echo no such codec >&2; exit 1", "no such codec"),
        ("cat >/dev/null; exit 3", "no error message"),
    ],
)
def test_what_ffmpeg_says_is_told(tmp_path, monkeypatch, script, reason):
    program = tmp_path / "ffmpeg"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setattr(moving, "ffmpeg_program", lambda: str(program))
    path = tmp_path / "out" / "a.mp4"
    with pytest.raises(OutputError) as told:
        write(path)
    assert str(told.value) == f"{path}: ffmpeg cannot write the file: {reason}"
    assert not list(path.parent.iterdir())


def test_no_frame_and_other_suffixes_are_told(tmp_path):
    with pytest.raises(UsageError, match="an animation needs at least one frame"):
        write(tmp_path / "a.gif", tones=())
    with pytest.raises(UsageError, match="an animation must end in .gif, .apng, .webp, .mp4"):
        write(tmp_path / "a.avi")


def test_too_many_frames_are_told_before_memory_ends(tmp_path, monkeypatch):
    monkeypatch.setattr(moving, "MAX_BUFFERED_BYTES", 2 * 36 * 48 * 3)
    with pytest.raises(LimitError, match="too many frames for memory .more than 2.; use fewer"):
        write(tmp_path / "a.gif")

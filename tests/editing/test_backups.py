"""Files exchanged with a backup: cut off at any moment, every byte comes back."""

import contextlib
import os
import random
import signal
import subprocess
import sys
import time

import pytest
from worlds import room, tree, write_ground

from world2minecraft.core.errors import ConflictError, DamagedFileError, OutputError
from world2minecraft.editing import file_backups as backups
from world2minecraft.editing.build_into_world import build_into_world
from world2minecraft.editing.file_backups import (
    changed_since,
    commit_step,
    list_steps,
    recover,
    revert_step,
)

FILES = {
    "region/r.0.0.mca": b"new ground",
    "region/r.0.1.mca": b"a region that was not there",
    "region/c.5.5.mcc": None,
    "entities/r.0.0.mca": b"cows",
    "datapacks/player_size.zip": b"the same",
}


class Killed(BaseException):
    """Stands for the end of the program: nothing may catch it."""


@pytest.fixture
def world(tmp_path):
    for name, data in (
        ("level.dat", b"level"),
        ("region/r.0.0.mca", b"old ground"),
        ("region/c.5.5.mcc", b"large"),
        ("datapacks/player_size.zip", b"the same"),
    ):
        path = tmp_path / "world" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    os.chmod(tmp_path / "world" / "region" / "r.0.0.mca", 0o600)
    os.utime(tmp_path / "world" / "region" / "r.0.0.mca", ns=(10**18, 10**18))
    return tmp_path / "world"


def test_files_are_exchanged_and_brought_back_with_mode_and_time(world):
    before = tree(world)
    step = commit_step(world, FILES, "a test")
    assert [entry.path for entry in step.files] == sorted(
        set(FILES) - {"datapacks/player_size.zip"}
    )
    assert (world / "entities/r.0.0.mca").read_bytes() == b"cows"
    assert not (world / "region/c.5.5.mcc").exists()
    stat = (world / "region/r.0.0.mca").stat()
    assert stat.st_mode & 0o777 == 0o600
    assert list_steps(world) == [step]
    revert_step(step)
    assert tree(world) == before
    stat = (world / "region/r.0.0.mca").stat()
    assert (stat.st_mode & 0o777, stat.st_mtime_ns) == (0o600, 10**18)


def test_nothing_to_change_leaves_nothing_behind(world):
    before = tree(world)
    assert commit_step(world, {"region/r.0.0.mca": b"old ground"}, "a test") is None
    assert tree(world) == before


def calls(monkeypatch, number, error):
    """Raise at the ``number``-th exchange of files on disk, and count them."""
    count = 0

    def counting(act):
        def counted(*words, **options):
            nonlocal count
            count += 1
            if count == number:
                raise error
            return act(*words, **options)

        return counted

    monkeypatch.setattr(os, "replace", counting(os.replace))
    monkeypatch.setattr(backups.Path, "unlink", counting(backups.Path.unlink))
    return lambda: count


def every_moment(monkeypatch, act):
    with monkeypatch.context() as patch:
        total = calls(patch, 0, Killed)
        act()
        return range(1, total() + 1)


def test_a_kill_at_any_moment_of_a_step_is_brought_back(tmp_path, world, monkeypatch):
    before = tree(world)
    moments = every_moment(monkeypatch, lambda: commit_step(world, FILES, "a test"))
    revert_step(list_steps(world)[-1])
    assert len(moments) > 8
    for moment in moments:
        with monkeypatch.context() as patch, contextlib.suppress(Killed):
            calls(patch, moment, Killed)
            commit_step(world, FILES, "a test")
        recover(world)
        assert tree(world) == before


def test_a_kill_at_any_moment_of_an_undo_is_gone_on_with(world, monkeypatch):
    before = tree(world)

    def undo():
        commit_step(world, FILES, "a test")
        revert_step(list_steps(world)[-1])

    for moment in every_moment(monkeypatch, undo):
        commit_step(world, FILES, "a test")
        with monkeypatch.context() as patch, contextlib.suppress(Killed):
            calls(patch, moment, Killed)
            revert_step(list_steps(world)[-1])
        recover(world)
        if list_steps(world):  # Killed before the undo was begun.
            revert_step(list_steps(world)[-1])
        assert tree(world) == before


def test_a_kill_while_bringing_back_is_brought_back(world, monkeypatch):
    before = tree(world)
    for first in range(4, 11):
        for second in range(1, 9):
            with monkeypatch.context() as patch, contextlib.suppress(Killed):
                calls(patch, first, Killed)
                commit_step(world, FILES, "a test")
            with monkeypatch.context() as patch, contextlib.suppress(Killed):
                calls(patch, second, Killed)
                recover(world)
            recover(world)
            for step in list_steps(world):
                revert_step(step)
            assert tree(world) == before


def test_a_full_disk_leaves_the_world_as_it_was(world, monkeypatch):
    before = tree(world)
    for moment in every_moment(monkeypatch, lambda: commit_step(world, FILES, "a test"))[:-1]:
        for step in list_steps(world):
            revert_step(step)
        with monkeypatch.context() as patch:
            calls(patch, moment, OSError(28, "No space left on device"))
            with contextlib.suppress(OutputError):
                commit_step(world, FILES, "a test")
        recover(world)
        for step in list_steps(world):
            revert_step(step)
        assert tree(world) == before


def test_too_little_disk_space_is_reported_first(world, monkeypatch):
    before = tree(world)
    monkeypatch.setattr(backups.shutil, "disk_usage", lambda _: type("", (), {"free": 5 << 20})())
    with pytest.raises(OutputError) as raised:
        commit_step(world, FILES, "a test")
    assert str(raised.value) == f"{world}: the disk has 5 MB free; 16 MB are needed for the backup"
    assert tree(world) == before


def test_a_file_that_was_saved_since_is_seen(world):
    step = commit_step(world, FILES, "a test")
    assert changed_since(step) == []
    (world / "region/r.0.1.mca").write_bytes(b"the game saved")
    assert changed_since(step) == ["region/r.0.1.mca"]


def test_later_changes_are_kept_after_an_interrupted_step(world, monkeypatch):
    with monkeypatch.context() as patch, contextlib.suppress(Killed):
        calls(patch, 9, Killed)
        commit_step(world, FILES, "a test")
    assert list_steps(world)[-1].state == "prepared"
    (world / "region/r.0.0.mca").write_bytes(b"the game saved")
    with pytest.raises(ConflictError, match="has changed since a build was interrupted"):
        recover(world)
    assert (world / "region/r.0.0.mca").read_bytes() == b"the game saved"


def test_a_damaged_backup_changes_nothing(world):
    step = commit_step(world, FILES, "a test")
    after = tree(world)
    (step.folder / "old" / "1").write_bytes(b"rotten")
    number = [entry.path for entry in step.files].index("region/c.5.5.mcc")
    assert number == 1
    with pytest.raises(
        DamagedFileError, match="does not match the recorded checksum of region/c.5.5.mcc"
    ):
        revert_step(step)
    assert {k: v for k, v in tree(world).items() if "old/1" not in k} == {
        k: v for k, v in after.items() if "old/1" not in k
    }


@pytest.mark.parametrize(
    "name",
    [
        "../../.bashrc",
        "/etc/passwd",
        "region/../../r.0.0.mca",
        "level.dat",
        "region/r.0.0.mca\x00",
        "region/r.99999999999.0.mca",
        7,
    ],
)
def test_a_manifest_from_elsewhere_names_no_other_file(world, name):
    commit_step(world, FILES, "a test")
    path = world / "w2m_undo/0001/manifest.json"
    raw = backups.read_json(path)
    raw["files"][0]["path"] = name
    backups.write_json(path, raw)
    with pytest.raises(DamagedFileError, match="contains the unexpected file name"):
        list_steps(world)


@pytest.mark.parametrize("field", [{"mode": "x"}, {"mode": 0o4755}, {"time_ns": 1 << 70}])
def test_a_manifest_has_no_other_modes_and_times(world, field):
    commit_step(world, FILES, "a test")
    path = world / "w2m_undo/0001/manifest.json"
    raw = backups.read_json(path)
    raw["files"][0] |= field
    backups.write_json(path, raw)
    with pytest.raises(DamagedFileError, match="is not a valid manifest"):
        list_steps(world)


def test_a_link_out_of_the_world_is_not_followed(world, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (world / "entities").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(DamagedFileError, match="is a link to outside the world"):
        commit_step(world, FILES, "a test")
    assert not list((tmp_path / "elsewhere").iterdir())


@pytest.mark.parametrize("content", ["[]", "{}", '{"files": [{"path": 3}]}', "no json"])
def test_a_broken_manifest_is_one_line(world, content):
    commit_step(world, FILES, "a test")
    (world / "w2m_undo/0001/manifest.json").write_text(content)
    with pytest.raises(DamagedFileError):
        list_steps(world)


BUILD = """
import sys
sys.path.insert(0, sys.argv[2])
from pathlib import Path
from worlds import room
from world2minecraft.editing.build_into_world import build_into
print("ready", flush=True)
while True:
    for corner in [(-8, 60, -20), (-20, 62, -10), (0, 60, 0)]:
        build_into(Path(sys.argv[1]), room(corner))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_killed_process_leaves_a_recoverable_world(tmp_path):
    world = write_ground(tmp_path / "world")
    before = tree(world)
    chance = random.Random(5)
    for _ in range(2):
        words = [sys.executable, "-c", BUILD, str(world), os.path.dirname(__file__)]
        with subprocess.Popen(words, stdout=subprocess.PIPE) as process:
            process.stdout.readline()
            time.sleep(0.05 + chance.random() * 0.3)
            process.send_signal(signal.SIGKILL)
        recover(world)
        for step in reversed(list_steps(world)):
            revert_step(step)
        assert tree(world) == before
    assert build_into_world(world, room()).blocks > 0

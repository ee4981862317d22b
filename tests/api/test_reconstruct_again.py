"""What a second ``reconstruct`` into the same folder refuses to lose without ``force``."""

import os
import shutil
from contextlib import closing
from pathlib import Path

import pytest

import world2minecraft as w2m
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.sceneforge.editor import Editor


@pytest.fixture
def run(example_run, tmp_path) -> Path:
    """A copy of a finished run."""
    return Path(shutil.copytree(example_run.folder, tmp_path / "OUT"))


@pytest.fixture
def calls(monkeypatch) -> list[Path]:
    """The captures that would be reconstructed; nothing is computed."""
    done: list[Path] = []
    monkeypatch.setattr(
        "world2minecraft.runs.run_capture", lambda capture, *_: done.append(capture)
    )
    return done


@pytest.fixture
def other(example_scan, tmp_path) -> Path:
    """The capture with another file."""
    folder = Path(shutil.copytree(example_scan, tmp_path / "other"))
    (folder / "notes.txt").write_text("Another day.\n")
    return folder


def test_a_run_of_another_capture_is_kept(run, other, calls):
    with pytest.raises(UsageError, match=r"OUT contains the reconstruction of another capture"):
        w2m.reconstruct(other, run)
    assert not calls


def test_force_replaces_it_with_its_copied_capture(run, other, calls):
    (run / "capture").mkdir()
    w2m.reconstruct(other, run, force=True)
    assert calls == [other] and not (run / "capture").exists()


def test_the_same_capture_is_reconstructed_again(run, example_scan, calls):
    (run / "capture").mkdir()
    w2m.reconstruct(example_scan, run)
    assert calls == [example_scan] and (run / "capture").exists()


def test_a_missing_capture_is_reported_as_such(run, tmp_path):
    with pytest.raises(CaptureError, match="absent"):
        w2m.reconstruct(tmp_path / "absent", run)


def rename_an_object(run: Path, *, save: bool) -> None:
    with closing(Editor.open(run)) as editor:
        editor.do("rename_objects", ids=[min(editor.draft.objects)], name="desk")
        if save:
            editor.save()


@pytest.mark.parametrize("start", [None, "find", "furnish"])
def test_saved_edits_are_kept(run, example_scan, calls, start):
    rename_an_object(run, save=True)
    with pytest.raises(UsageError, match=r"OUT contains edits saved in SceneForge"):
        w2m.reconstruct(example_scan, run, start=start)
    assert not calls
    w2m.reconstruct(example_scan, run, start=start, force=True)
    w2m.reconstruct(example_scan, run, start="build")
    assert len(calls) == 2


def test_edits_that_were_not_saved_are_no_obstacle(run, example_scan, calls):
    rename_an_object(run, save=False)
    w2m.reconstruct(example_scan, run)
    assert calls == [example_scan]


def test_installing_a_world_tells_of_edits_that_are_not_in_it(run, tmp_path):
    saves = tmp_path / "saves"
    assert w2m.install_world(run, saves=saves).note == ""
    rename_an_object(run, save=True)
    built_s = (run / "build" / "world" / "level.dat").stat().st_mtime
    os.utime(run / "placements.json", (built_s + 60, built_s + 60))
    assert w2m.install_world(run, saves=saves).note == (
        "edits were saved after this world was built and are not in it; "
        f"w2m build {run} --out EDITED builds them, then w2m install EDITED"
    )
    os.utime(run / "placements.json", (built_s - 60, built_s - 60))
    assert w2m.install_world(run, saves=saves).note == ""

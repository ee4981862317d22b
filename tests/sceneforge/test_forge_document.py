"""A document on the disk: whatever happens to the program or the files, edits are not lost."""

import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from forge_documents import SHAPE, Clock, edit, held, same_files, write_run

from world2minecraft.core.errors import ConflictError, DamagedFileError, OutputError, UsageError
from world2minecraft.core.locks import Lock
from world2minecraft.sceneforge.document import document as document_module
from world2minecraft.sceneforge.document.snapshots import read_state
from world2minecraft.sceneforge.editor import Editor


@pytest.fixture(scope="module")
def pattern(tmp_path_factory):
    return write_run(tmp_path_factory.mktemp("pattern") / "den")


@pytest.fixture
def run(tmp_path, pattern):
    shutil.copytree(pattern, tmp_path / "den")
    return tmp_path / "den"


@pytest.fixture
def forge(run):
    return run.with_name("den.forge")


def edited(run, count, clock=None):
    """The states of a scene before and after each of some edits, and its editor."""
    editor = Editor.open(run, clock=clock or Clock())
    states = [held(editor)]
    for number in range(count):
        edit(editor, number)
        states.append(held(editor))
    return editor, states


def test_what_was_done_is_there_again_and_can_all_be_undone(run):
    editor, states = edited(run, 21)
    editor.close()
    again = Editor.open(run)
    assert held(again) == states[-1] and again.rev == 21
    assert again.notes == ["Recovered 21 unsaved edits."]
    while again.undo_kind:
        again.undo()
    assert held(again) == states[0]
    while again.redo_kind:
        again.redo()
    assert held(again) == states[-1]
    again.close()


def test_no_file_outside_is_written_before_it_is_saved(run):
    before = same_files(run.parent)
    editor, _ = edited(run, 12)
    editor.close()
    assert same_files(run.parent) == before
    assert {path.name for path in run.parent.iterdir()} == {"den", "den.forge"}


def test_the_base_is_never_written_again(run, forge):
    editor, states = edited(run, 12)
    editor.save()
    editor.close()
    state = read_state(forge / "base.npz")
    assert state.grid.labels.tobytes() == states[0][0] and state.rev == 0


@pytest.mark.parametrize("cut", [1, 7, 40])
def test_a_torn_tail_is_left_out_and_told(run, forge, cut):
    editor, states = edited(run, 10)
    abandon(editor)
    journal = forge / "journal.bin"
    journal.write_bytes(journal.read_bytes()[:-cut])
    again = Editor.open(run)
    assert held(again) == states[9] and again.rev == 9
    assert again.notes[-1] == "The last edit was incomplete and was discarded."
    edit(again, 3)
    after = held(again)
    again.close()
    last = Editor.open(run)
    assert held(last) == after
    last.close()


def abandon(editor):
    """End an editor as a kill does: nothing is written, the lock falls."""
    editor.document.wait()
    editor.document._lock.leave()  # The file still tells of the holder.
    editor.document._target.leave()
    editor.document._lock = None


def test_a_cut_at_any_byte_gives_the_edits_before_it(run, forge, tmp_path):
    editor, states = edited(run, 6)
    abandon(editor)
    data = (forge / "journal.bin").read_bytes()
    ends = [editor.document._journal.steps[n].record.end for n in range(6)]
    for cut in sorted({*range(0, len(data), 37), *ends, *(end - 1 for end in ends)}):
        (forge / "journal.bin").write_bytes(data[:cut])
        again = Editor.open(run)
        whole = sum(cut >= end for end in ends)
        assert held(again) == states[whole] and again.rev == whole
        abandon(again)


def damaged(path, at):
    data = bytearray(path.read_bytes())
    data[at] ^= 0x55
    path.write_bytes(data)


def test_damage_before_a_snapshot_loses_only_old_undo(run, forge, monkeypatch):
    monkeypatch.setattr(document_module, "SNAPSHOT_STEPS", 10)
    editor, states = edited(run, 24)
    steps = editor.document._journal.steps
    abandon(editor)
    damaged(forge / "journal.bin", steps[4].record.at + 12)
    again = Editor.open(run)
    assert held(again) == states[-1]
    assert any(
        "journal.bin is damaged at byte" in note and "lost" not in note for note in again.notes
    )
    assert again.notes[-1] == "The damaged journal was moved to journal-damaged-1.bin."
    assert again.rev > 24
    count = 0
    while again.undo_kind:
        again.undo()
        count += 1
    assert count >= 10
    while again.redo_kind:
        again.redo()
    assert held(again) == states[-1]
    again.close()
    last = Editor.open(run)
    assert held(last) == states[-1] and len(last.notes) == 1
    last.close()


def test_damage_after_the_last_snapshot_keeps_earlier_edits(run, forge):
    editor, states = edited(run, 10)
    steps = editor.document._journal.steps
    abandon(editor)
    damaged(forge / "journal.bin", steps[6].record.at + 12)
    again = Editor.open(run)
    assert held(again) == states[6]
    assert any("; 4 edits are lost" in note for note in again.notes)
    assert (forge / "journal-damaged-1.bin").exists()
    again.close()
    last = Editor.open(run)
    assert held(last) == states[6]
    last.close()


@pytest.mark.parametrize("record", [0, 4])
def test_a_damaged_length_is_no_torn_tail(run, forge, record):
    editor, states = edited(run, 10)
    steps = editor.document._journal.steps
    abandon(editor)
    before = (forge / "journal.bin").read_bytes()
    at = len(b"w2m scene 1\n") if record == 0 else steps[record].record.at
    damaged(forge / "journal.bin", at)
    again = Editor.open(run)
    # The first record holds no edit, so all that follow are there.
    assert held(again) == states[10 if record == 0 else record]
    assert any(f"journal.bin is damaged at byte {at}" in note for note in again.notes)
    assert len((forge / "journal-damaged-1.bin").read_bytes()) == len(before)
    again.close()


@pytest.mark.parametrize("name", ["journal.bin", "snapshot", "base.npz"])
@pytest.mark.parametrize("how", ["gone", "noise", "empty"])
def test_a_closed_document_opens_with_any_one_file_damaged(run, forge, name, how):
    editor, states = edited(run, 10)
    editor.close()
    (path,) = forge.glob(f"{name}*")
    if how == "gone":
        path.unlink()
    else:
        path.write_bytes(b"" if how == "empty" else np.random.default_rng(0).bytes(5000))
    again = Editor.open(run)
    assert held(again) == states[-1]
    edit(again, 3)
    after = held(again)
    again.close()
    last = Editor.open(run)
    assert held(last) == after
    last.close()


def test_snapshots_come_after_so_many_steps_or_seconds(run, forge, monkeypatch):
    clock = Clock()
    editor, _ = edited(run, 4, clock)
    editor.document.wait()
    assert not [*forge.glob("snapshot-*")]
    clock.now += 59.9
    edit(editor, 7)
    editor.document.wait()
    assert not [*forge.glob("snapshot-*")]
    clock.now += 0.2
    edit(editor, 8)
    editor.document.wait()
    assert [path.name.split("-")[1] for path in forge.glob("snapshot-*")] == ["000000006"]
    monkeypatch.setattr(document_module, "SNAPSHOT_STEPS", 5)
    for number in range(9, 30):
        edit(editor, number)
    editor.document.wait()
    revs = sorted(path.name.split("-")[1] for path in forge.glob("snapshot-*"))
    assert revs == ["000000006", "000000021", "000000026"]
    editor.close()


def test_the_history_forgets_its_oldest_edits_and_says_so(run, forge):
    editor, states = edited(run, 2)
    editor.document.history_bytes = 1500
    for number in range(2, 60):
        edit(editor, number)
        states.append(held(editor))
    assert (forge / "journal.bin").stat().st_size < 4000
    assert any(
        note.endswith("oldest edits cannot be undone: the history limit is 0 MB.")
        for note in editor.notes
    )
    assert editor.rev == 60
    edit(editor, 5)
    before, line = held(editor), editor.document.history.line
    editor.close()
    again = Editor.open(run)
    assert held(again) == before and again.rev == 61 and len(again.notes) == 1
    assert again.document.history.line == line
    while again.undo_kind:
        again.undo()
    assert held(again) in states[1:]
    while again.redo_kind:
        again.redo()
    again.close()


def test_a_second_process_may_look_and_not_edit(run, forge):
    editor, states = edited(run, 3)
    other = Editor.open(run)
    who = Lock(forge / "lock").holder()
    assert who.startswith(f"process {os.getpid()} since ")
    reason = f"it is being edited by {who}; close the scene there, then open it again"
    assert other.read_only == reason
    assert held(other) == states[-1] and other.scene_json()["read_only"] == other.read_only
    before = {path.name: path.read_bytes() for path in forge.iterdir()}
    for step in (
        lambda: edit(other, 0),
        other.undo,
        other.redo,
        other.save,
    ):
        with pytest.raises(UsageError, match="^den is open read-only: it is being edited by"):
            step()
    other.active()
    other.close()
    assert {path.name: path.read_bytes() for path in forge.iterdir()} == before
    editor.close()
    third = Editor.open(run)
    assert not third.read_only
    third.close()


def test_the_lock_of_a_dead_process_is_taken_over(run, forge):
    code = (
        "import os, sys; from pathlib import Path\n"
        "from world2minecraft.sceneforge.editor import Editor\n"
        "editor = Editor.open(Path(sys.argv[1]))\n"
        "editor.do('set_cells', cells=[[1, 2]], class_id=0)\n"
        "print('done', flush=True); os.kill(os.getpid(), 9)\n"
    )
    command = [sys.executable, "-c", code, run]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.stdout == "done\n" and ended.returncode == -9
    assert json.loads((forge / "lock").read_text())["pid"] > 0
    editor = Editor.open(run)
    assert not editor.read_only and editor.rev == 1
    assert editor.draft.labels.ravel()[1:3].tolist() == [0, 0]
    editor.close()


class Full:
    """A disk that is full after so many more bytes."""

    def __init__(self, monkeypatch, left=0):
        self.left = left
        self.write = os.fsync
        monkeypatch.setattr("world2minecraft.editing.record_log.os.fsync", self.fsync)

    def fsync(self, handle):
        if self.left <= 0:
            raise OSError(28, "No space left on device")
        self.left -= 1
        self.write(handle)


def test_a_full_disk_is_told_and_nothing_changes(run, forge, monkeypatch):
    editor, states = edited(run, 6)
    size = (forge / "journal.bin").stat().st_size
    with monkeypatch.context() as context:
        Full(context)
        for step in (lambda: edit(editor, 7), editor.undo):
            with pytest.raises(
                OutputError, match=r"journal.bin: cannot be written: No space left on device$"
            ):
                step()
            assert held(editor) == states[-1] and editor.rev == 6
    assert (forge / "journal.bin").stat().st_size == size
    edit(editor, 7)  # Room was made.
    states.append(held(editor))
    editor.close()
    again = Editor.open(run)
    assert held(again) == states[-1] and again.rev == 7
    again.close()


def test_a_snapshot_that_does_not_fit_is_told_and_loses_nothing(run, forge, monkeypatch):
    editor, states = edited(run, 6)

    def full(path, arrays):
        raise OutputError(path, "cannot be written: No space left on device")

    monkeypatch.setattr("world2minecraft.sceneforge.document.snapshots.write_npz", full)
    editor.close()
    assert "No snapshot was written" in editor.notes[-1]
    monkeypatch.undo()
    again = Editor.open(run)
    assert held(again) == states[-1]
    again.close()


def test_a_scene_that_was_made_anew_sets_saved_edits_aside(run, forge):
    editor, _ = edited(run, 6)
    editor.save()
    editor.close()
    (run / "objects.json").write_text("[]\n")
    again = Editor.open(run)
    assert again.notes == ["objects.json was replaced; its previous edits are in old-1."]
    assert not again.draft.objects and again.rev == 0
    assert (forge / "old-1" / "journal.bin").exists()
    again.close()


def test_a_rewritten_scene_never_drops_unsaved_edits(run, forge):
    editor, states = edited(run, 6)
    editor.close()
    (run / "objects.json").write_text("[]\n")
    with pytest.raises(ConflictError) as refused:
        Editor.open(run)
    assert str(refused.value) == (
        f"{run / 'objects.json'}: the file has changed since it was edited, and den.forge has 6 "
        f"unsaved edits; open {forge} to continue with them, or move it away to start over"
    )
    again = Editor.open(forge)
    assert held(again) == states[-1]
    with pytest.raises(ConflictError, match="objects.json: was changed by another program"):
        again.save()
    assert (run / "objects.json").read_text() == "[]\n"
    again.close()


def test_a_folder_that_cannot_be_made_is_told(tmp_path, pattern):
    (tmp_path / "out.forge").write_text("a file")
    with pytest.raises(OutputError, match="out.forge: cannot be created"):
        Editor.open(pattern, out=tmp_path / "out")


def test_placements_of_another_class_are_refused(run):
    place = run / "placements.json"
    rows = json.loads(place.read_text())
    rows[0]["class"] = "sofa" if rows[0]["class"] != "sofa" else "bed"
    place.write_text(json.dumps(rows))
    with pytest.raises(DamagedFileError, match="placements.json: does not match objects.json"):
        Editor.open(run)


def test_the_shape_of_the_scene_is_kept(run):
    editor = Editor.open(run)
    assert editor.draft.shape == SHAPE
    editor.close()

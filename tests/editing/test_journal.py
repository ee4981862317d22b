"""The journal: whatever the moment of a kill, the whole records before it are there."""

import contextlib
import os
import signal
import subprocess
import sys

import pytest
from edit_volumes import random_edits, seen, small_volume
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import ConflictError, DamagedFileError, OutputError, UsageError
from world2minecraft.editing.journal import Journal, pack_edit, write_journal
from world2minecraft.editing.volume_draft import History, apply_edits


def filled(path, count=4):
    volume = small_volume()
    history = History(volume, Journal(path))
    for edit in random_edits(volume, count, 1):
        history.do(edit)
    return history


def test_a_journal_is_read_as_it_was_written(tmp_path):
    history = filled(tmp_path / "j")
    history.undo()
    again = Journal(tmp_path / "j")
    assert [pack_edit(e) for e in again.edits] == [pack_edit(e) for e in history.journal.edits]
    assert again.is_done == [True, True, True, False]
    assert again.steps == [(True, 0), (True, 1), (True, 2), (True, 3), (False, 3)]


def test_a_file_cut_at_any_byte_holds_the_whole_records_before(tmp_path):
    filled(tmp_path / "j", 3)
    data, ends = (tmp_path / "j").read_bytes(), []
    for count in range(4):
        write_journal(tmp_path / "part", Journal(tmp_path / "j").edits[:count])
        ends.append((tmp_path / "part").stat().st_size)
    assert ends[-1] == len(data)
    for cut in sorted({*range(0, len(data), 3), *ends, *(end - 1 for end in ends)} - {len(data)}):
        (tmp_path / "cut").write_bytes(data[:cut])
        whole = max(0, sum(cut >= end for end in ends) - 1)
        assert len(Journal(tmp_path / "cut").edits) == whole
    # What is torn is cut off before more is written.
    journal = Journal(tmp_path / "cut")
    journal.undo(1)
    assert Journal(tmp_path / "cut").steps == [(True, 0), (True, 1), (False, 1)]


@given(st.integers(12, 200), st.integers(1, 255))
def test_a_changed_byte_is_seen(tmp_path_factory, place, change):
    path = tmp_path_factory.mktemp("journal") / "j"
    filled(path, 3)
    data = bytearray(path.read_bytes())
    data[place] ^= change
    path.write_bytes(bytes(data))
    with contextlib.suppress(DamagedFileError):
        assert len(Journal(path).edits) < 3  # A wrong length may reach over the end.


def test_another_file_is_no_journal(tmp_path):
    (tmp_path / "j").write_text("my shopping list")
    with pytest.raises(DamagedFileError, match="j: is not a journal of edits$"):
        Journal(tmp_path / "j")
    assert (tmp_path / "j").read_text() == "my shopping list"


def test_what_cannot_be_written_is_not_done(tmp_path):
    (tmp_path / "file").write_text("")
    volume = small_volume()
    history = History(volume, Journal(tmp_path / "file" / "j"))
    with pytest.raises(OutputError):
        history.do(random_edits(volume, 1, 1)[0])
    assert history.volume is volume
    assert not history.journal.edits


def test_edits_without_later_overlap_can_be_undone_and_redone(tmp_path):
    volume = small_volume(shape=(30, 20, 30))
    edits = random_edits(volume, 4, 2)
    history = History(volume, Journal(tmp_path / "j"))
    for edit in edits:
        history.do(edit)
    whole = seen(history.volume)
    assert [history.undo(1), history.undo(), history.undo()] == [1, 3, 2]
    assert seen(history.volume) == seen(apply_edits(volume, edits[0]))
    assert [history.redo(), history.redo(), history.redo()] == [2, 3, 1]
    assert seen(history.volume) == whole
    with pytest.raises(UsageError, match="there is nothing to redo"):
        history.redo()
    history.undo()
    for number in (-1, len(edits)):
        with pytest.raises(UsageError, match=f"edit {number + 1} has not been undone"):
            history.redo(number)


def test_what_a_later_edit_covers_is_not_undone_before_it(tmp_path):
    volume = small_volume()
    first = random_edits(volume, 1, 5)[0]
    second = random_edits(apply_edits(volume, first), 60, 5)
    history = History(volume, Journal(tmp_path / "j"))
    for edit in (first, *second):
        history.do(edit)
    with pytest.raises(ConflictError):
        history.undo(0)
    with pytest.raises(UsageError, match=r"^edit 99 is not applied; applied edits: 1, 2"):
        history.undo(98)
    assert all(history.journal.is_done)


@pytest.mark.parametrize("behind", range(4))
def test_blocks_that_lie_behind_the_journal_catch_up(tmp_path, behind):
    volume = small_volume()
    edits = random_edits(volume, 4, 7)
    write_journal(tmp_path / "j", edits)
    on_disk = apply_edits(volume, *edits[: 4 - behind])
    assert seen(History(on_disk, Journal(tmp_path / "j")).volume) == seen(
        apply_edits(volume, *edits)
    )


def test_another_volume_is_refused(tmp_path):
    write_journal(tmp_path / "j", random_edits(small_volume(), 4, 7))
    with pytest.raises(ConflictError):
        History(small_volume(seed=9), Journal(tmp_path / "j"))


KILLED = """
import sys
sys.path.insert(0, sys.argv[2])
from edit_volumes import random_edits, small_volume
from world2minecraft.editing.journal import Journal
journal = Journal(sys.argv[1])
for number, edit in enumerate(random_edits(small_volume(), 200, 1)):
    journal.do(edit)
    print(number, flush=True)
"""


def test_a_killed_program_leaves_every_reported_edit(tmp_path):
    words = [sys.executable, "-c", KILLED, str(tmp_path / "j"), os.path.dirname(__file__)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        for _ in range(5):
            told = int(process.stdout.readline())
        process.send_signal(signal.SIGKILL)
    journal = Journal(tmp_path / "j")
    expected = random_edits(small_volume(), len(journal.edits), 1)
    assert len(journal.edits) > told
    assert [pack_edit(e) for e in journal.edits] == [pack_edit(e) for e in expected]

"""A lock is one process's alone, ends with it, and leaves no file where none is wanted."""

import json
import subprocess
import sys
import threading
import time

import pytest

from world2minecraft.core.errors import ConflictError
from world2minecraft.core.locks import Lock, folder_lock, wait_for_locks

HOLD = """
import sys
from pathlib import Path
from world2minecraft.core.locks import Lock
Lock(Path(sys.argv[1])).acquire()
print("held", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def other(tmp_path):
    """Another process that holds the lock until its input ends."""
    words = [sys.executable, "-c", HOLD, str(tmp_path / "lock")]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    yield process
    process.kill()
    process.communicate()


def conflict_of(place, work="built"):
    with pytest.raises(ConflictError) as caught:
        Lock(place, work).acquire()
    return str(caught.value)


def set_since(place, since):
    """Change since when the holder states to hold the lock; the lock is on the file, not on it."""
    place.write_text(json.dumps(json.loads(place.read_text()) | {"since": since}))


def test_who_has_it_is_told_in_one_line(tmp_path, other):
    now = time.localtime()
    set_since(tmp_path / "lock", time.mktime((*now[:3], 14, 2, 0, 0, 0, -1)))
    text = f"{tmp_path}: is being edited by process {other.pid} since 14:02"
    assert conflict_of(tmp_path / "lock") == text


def test_another_day_is_told_with_its_date(tmp_path, other):
    set_since(tmp_path / "lock", time.mktime((2026, 1, 5, 9, 30, 0, 0, 0, -1)))
    text = f"{tmp_path}: is being edited by process {other.pid} since 2026-01-05 09:30"
    assert conflict_of(tmp_path / "lock") == text


@pytest.mark.parametrize("since", [None, "soon", -(10**30)])
def test_a_lock_of_a_former_version_has_no_time(tmp_path, other, since):
    holder = {"pid": other.pid, "host": "", "since": since}
    (tmp_path / "lock").write_text(json.dumps(holder))
    assert conflict_of(tmp_path / "lock") == f"{tmp_path}: is being built by process {other.pid}"


@pytest.mark.parametrize("content", ["", "[]", "{", '{"pid": "x", "host": ""}'])
def test_a_file_that_names_nobody_is_no_error(tmp_path, other, content):
    (tmp_path / "lock").write_text(content)
    assert conflict_of(tmp_path / "lock") == f"{tmp_path}: is being built by another process"


def test_a_killed_process_holds_nothing(tmp_path, other):
    other.kill()
    other.wait()
    lock = Lock(tmp_path / "lock")
    lock.acquire()
    lock.release()


def test_a_removed_lock_leaves_no_file_and_can_be_taken_again(tmp_path):
    for _ in range(2):
        lock = Lock(tmp_path / "lock")
        lock.acquire()
        lock.remove()
        assert not list(tmp_path.iterdir())


def test_a_file_without_a_process_holds_nothing(tmp_path):
    (tmp_path / ".lock").write_text('{"pid": 1, "host": "elsewhere", "since": 0, "work": "built"}')
    with folder_lock(tmp_path, "built"):
        assert json.loads((tmp_path / ".lock").read_text())["host"] != "elsewhere"
    assert not list(tmp_path.iterdir())


def test_the_holder_may_lock_again_but_no_other_thread(tmp_path):
    refused = []

    def other():
        try:
            with folder_lock(tmp_path, "built"):
                pass
        except ConflictError as error:
            refused.append(error.reason)

    with folder_lock(tmp_path, "joined"):
        with folder_lock(tmp_path / ".", "built") as again:
            assert again is None
        assert (tmp_path / ".lock").exists()
        thread = threading.Thread(target=other)
        thread.start()
        thread.join()
    assert len(refused) == 1 and refused[0].startswith("is being joined by process ")


def test_waiting_goes_on_when_the_other_process_ends(tmp_path):
    words = [sys.executable, "-c", HOLD, str(tmp_path / ".lock")]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    told = []

    def tell(holder):
        told.append(holder)
        process.communicate("")

    with wait_for_locks(tell), folder_lock(tmp_path, "built"):
        assert process.returncode == 0
    assert len(told) == 1 and told[0].startswith(f"process {process.pid} since ")


def test_waiting_survives_that_the_folder_is_removed(tmp_path):
    folder, told = tmp_path / "out", []
    folder.mkdir()
    first = Lock(folder / ".lock")
    first.acquire()

    def tell(holder):
        told.append(holder)
        first.remove()
        folder.rmdir()

    with wait_for_locks(tell), folder_lock(folder, "built"):
        assert (folder / ".lock").exists()
    assert told and not list(folder.iterdir())

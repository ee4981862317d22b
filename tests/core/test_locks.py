"""A lock is one process's alone, ends with it, and leaves no file where none is wanted."""

import subprocess
import sys

import pytest

from world2minecraft.core.errors import ConflictError
from world2minecraft.core.locks import Lock

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


def test_who_has_it_is_told_in_one_line(tmp_path, other):
    with pytest.raises(ConflictError) as caught:
        Lock(tmp_path / "lock", "built").acquire()
    assert str(caught.value) == f"{tmp_path}: is being built by process {other.pid}"


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

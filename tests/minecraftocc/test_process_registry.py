"""A run that takes a folder over waits until nobody of an earlier run writes there any more."""

import os
import pickle
import subprocess
import sys
import time
from dataclasses import dataclass

import pytest

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.minecraftocc.building.process_registry import (
    register_process,
    registered_task,
    wait_for_others,
)
from world2minecraft.minecraftocc.engine import process_pool as worker

AT_WORK = """
import sys
from pathlib import Path
from world2minecraft.minecraftocc.building.process_registry import register_process
with register_process(Path(sys.argv[1])):
    print("at work", flush=True)
    sys.stdin.read()
"""


@dataclass(frozen=True)
class Item:
    folder: str


@registered_task
def written(item, tick):
    """Write a file."""
    with open(os.path.join(item.folder, "mark"), "w") as stream:
        stream.write("here")
    return 7


@pytest.fixture
def straggler(tmp_path):
    """A process that is at work in the folder until its input ends."""
    words = [sys.executable, "-c", AT_WORK, str(tmp_path)]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "at work\n"
    yield process
    process.kill()
    process.communicate()


def test_a_straggler_is_waited_for(tmp_path, straggler):
    subprocess.Popen(["sh", "-c", f"sleep 0.5; kill -9 {straggler.pid}"])
    began = time.monotonic()
    wait_for_others(tmp_path)
    assert time.monotonic() - began >= 0.4


def test_a_process_that_does_not_end_is_reported(tmp_path, straggler):
    with pytest.raises(ConflictError) as caught:
        wait_for_others(tmp_path, patience_s=0.1)
    assert str(caught.value) == (
        f"{tmp_path}: in use by a process of an earlier run; stop that process and try again"
    )


def test_several_processes_register_at_once(tmp_path, straggler):
    with register_process(tmp_path), register_process(tmp_path):
        pass
    straggler.kill()
    straggler.wait()
    wait_for_others(tmp_path, patience_s=0)


def test_a_worker_without_a_parent_does_nothing(tmp_path, monkeypatch):
    class Gone:
        def is_alive(self):
            return False

    assert written(Item(str(tmp_path)), print) == 7
    (tmp_path / "mark").unlink()
    monkeypatch.setattr(worker, "parent_process", Gone)
    with pytest.raises(BaseException, match="^$") as caught:
        written(Item(str(tmp_path)), print)
    assert not isinstance(caught.value, Exception), "an engine would send it as a failure"
    assert not (tmp_path / "mark").exists()


def test_a_registered_task_can_be_pickled():
    assert pickle.loads(pickle.dumps(written)) is written
    assert written.__doc__ == "Write a file."


def test_a_missing_folder_is_reported(tmp_path):
    with pytest.raises(OutputError, match=r"\.crew: cannot be written: No such file"):
        wait_for_others(tmp_path / "none")

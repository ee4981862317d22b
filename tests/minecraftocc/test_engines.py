"""Engines: all items once, the same results; a worker that dies is replaced, an error comes out."""

import os
import subprocess
import sys
import time
from pathlib import Path

import engine_tasks as tasks
import pytest

from world2minecraft.core.errors import OutputError, UnknownNameError, UsageError, WorkerError
from world2minecraft.minecraftocc.engine import open_engine

HERE = str(Path(__file__).parent)


@pytest.fixture(autouse=True)
def findable(monkeypatch):
    """Workers are new interpreters: they find the tasks by the path."""
    told = [HERE, *filter(None, [os.environ.get("PYTHONPATH")])]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(told))


@pytest.mark.parametrize("jobs", [1, 2])
def test_each_item_is_done_once(jobs):
    ticks = []
    with open_engine("pool", jobs) as engine:
        found = dict(engine.run(tasks.square, list(range(9)), ticks.append))
        again = dict(engine.run(tasks.square, [5], ticks.append))
    assert found == {n: n * n for n in range(9)}
    assert again == {0: 25}
    assert sum(ticks) == 10
    assert not engine.notes


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_comes_out_as_it_is(jobs):
    with open_engine("pool", jobs) as engine, pytest.raises(OutputError) as caught:
        list(engine.run(tasks.fail, list(range(5)), print))
    assert str(caught.value) == "DATA: the disk is full"


def test_an_error_that_cannot_be_pickled_is_reported():
    with open_engine("pool", 2) as engine, pytest.raises(WorkerError, match="Local: odd"):
        list(engine.run(tasks.fail_strangely, [1], print))


def test_a_killed_worker_is_replaced_and_reported(tmp_path):
    with open_engine("pool", 2) as engine:
        found = dict(engine.run(tasks.die_once, [tmp_path / "mark"], lambda _: None))
    assert found == {0: "went on"}
    assert engine.notes == ["A worker exited by signal 9; another worker resumed its task."]


def test_an_item_that_kills_every_worker_is_reported():
    with open_engine("pool", 2) as engine, pytest.raises(WorkerError) as caught:
        list(engine.run(tasks.die, [1], print))
    assert str(caught.value) == (
        "3 workers in a row exited with code 7 on part 1 of 1, possibly for lack of memory; "
        "run the same command with fewer jobs (--jobs) to resume"
    )


PARENT = """
import sys
import engine_tasks
from world2minecraft.minecraftocc.engine import open_engine
if __name__ == "__main__":
    with open_engine("pool", 2) as engine:
        list(engine.run(getattr(engine_tasks, sys.argv[1]), sys.argv[2:], lambda _: None))
"""


def test_a_script_without_a_guard_is_told_what_it_lacks(tmp_path):
    script = tmp_path / "unguarded.py"
    script.write_text(PARENT.replace('if __name__ == "__main__":', "if True:"))
    words = [sys.executable, str(script), "square", "1"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    assert last.endswith('call the function under if __name__ == "__main__":')


@pytest.mark.parametrize("task", ["tick_for_ever", "say_nothing"])
def test_workers_end_with_a_parent_that_is_killed(tmp_path, task):
    script, places = tmp_path / "parent.py", [tmp_path / name for name in "ab"]
    script.write_text(PARENT)
    process = subprocess.Popen([sys.executable, str(script), task, *map(str, places)])
    until = time.monotonic() + 60
    while not all(place.exists() and place.read_text() for place in places):
        assert time.monotonic() < until
        time.sleep(0.02)
    process.kill()
    process.wait()
    for place in places:
        while is_alive(int(place.read_text())):
            assert time.monotonic() < until
            time.sleep(0.02)


def is_alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    state = Path(f"/proc/{pid}/stat")
    return not (state.exists() and state.read_text().split()[2] == "Z")


def test_invalid_engine_options():
    with pytest.raises(UnknownNameError, match="did you mean 'pool'"):
        open_engine("poll", 2)
    with pytest.raises(UsageError, match="jobs must be from 1 to 1024, got 0"):
        open_engine("pool", 0)

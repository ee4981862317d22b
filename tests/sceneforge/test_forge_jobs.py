"""Jobs: every one ends, says how far it is, can be cancelled, and fails with one line."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import ConflictError, InputError, UnknownNameError
from world2minecraft.core.progress import no_progress
from world2minecraft.sceneforge.jobs.jobs import MAX_RUNNING, CancelledError, Jobs
from world2minecraft.sceneforge.jobs.subprocess_job import run_in_subprocess
from world2minecraft.sceneforge.jobs.time_left import TimeLeft
from world2minecraft.sceneforge.jobs.worker import run_task


class Clock:
    """Seconds that a test moves."""

    def __init__(self):
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def told():
    return []


@pytest.fixture
def jobs(told):
    made = Jobs(told.append)
    yield made
    made.close()


def test_a_job_reports_its_stages_and_its_result(jobs, told):
    def work(report):
        report("scan", 1, 2, "first")
        report("scan", 2, 2)
        return {"answer": 42}

    state = jobs.wait(jobs.start("Look", work))
    assert (state.state, state.result, state.share, state.left_s) == ("done", {"answer": 42}, 1, 0)
    assert [message["state"] for message in told][:1] == ["running"]
    assert [(m["stage"], m["done"], m["note"]) for m in told if m["state"] == "running"] == [
        ("", 0, ""),
        ("scan", 1, "first"),
        ("scan", 2, ""),
    ]
    assert told[-1] == state.message()


def test_ten_states_a_second_are_told_at_most(told):
    clock = Clock()
    jobs = Jobs(told.append, clock)

    def work(report):
        for step in range(1, 1000):  # 10 s of work in steps of 10 ms.
            clock.now += 0.01
            report("fuse", step, 1000)

    jobs.wait(jobs.start("Fuse", work))
    steps = [message for message in told if message["stage"] == "fuse"]
    assert 90 <= len(steps) <= 102


def test_a_failed_job_says_one_line(jobs):
    def work(report):
        raise InputError("room.npz", "is\nno room")

    state = jobs.wait(jobs.start("Look", work))
    assert (state.state, state.note) == ("failed", "room.npz: is no room")


def test_what_nobody_foresaw_is_one_line_too(jobs):
    state = jobs.wait(jobs.start("Look", lambda report: 1 / 0))
    assert state.state == "failed"
    assert state.note == "unexpected ZeroDivisionError: division by zero (please report it)"


def test_an_end_that_fails_fails_the_job(jobs):
    def ended(state):
        raise InputError("OUT", "is gone")

    state = jobs.wait(jobs.start("Look", lambda report: None, ended=ended))
    assert (state.state, state.note) == ("failed", "OUT: is gone")


def test_work_that_is_cancelled_ends_at_its_next_report(jobs):
    began, go_on = threading.Event(), threading.Event()
    reached = []

    def work(report):
        report("fuse", 0, 2)
        began.set()
        go_on.wait(20)
        report("fuse", 1, 2)
        reached.append("further")

    number = jobs.start("Fuse", work)
    assert began.wait(20)
    jobs.cancel(number)
    go_on.set()
    state = jobs.wait(number)
    assert (state.state, state.note, reached) == ("cancelled", "", [])


def test_cancelling_calls_the_stop_function_once_it_is_known(jobs):
    calls = []
    began, go_on = threading.Event(), threading.Event()

    def work(report):
        began.set()
        go_on.wait(20)
        report.on_cancel(lambda: calls.append("stop"))
        raise CancelledError

    number = jobs.start("Fuse", work)
    assert began.wait(20)
    jobs.cancel(number)
    go_on.set()
    jobs.wait(number)
    assert calls == ["stop"]


def test_an_ended_job_stays_as_it_ended(jobs):
    number = jobs.start("Look", lambda report: 7)
    jobs.wait(number)
    jobs.cancel(number)
    assert jobs.state(number).state == "done"
    assert [message["result"] for message in jobs.states()] == [7]


def test_only_so_many_run_at_once(jobs):
    go_on = threading.Event()
    numbers = [jobs.start("Wait", lambda report: go_on.wait(20)) for _ in range(MAX_RUNNING)]
    with pytest.raises(ConflictError, match="Look: 4 jobs are (already )?running"):
        jobs.start("Look", lambda report: None)
    go_on.set()
    assert {jobs.wait(number).state for number in numbers} == {"done"}


def test_a_job_that_is_not_there_is_named(jobs):
    with pytest.raises(UnknownNameError, match="no job is named 'job9'"):
        jobs.cancel("job9")


@given(
    st.lists(st.tuples(st.sampled_from("abcx"), st.integers(0, 5), st.integers(0, 5)), max_size=30)
)
def test_shares_never_fall_and_times_are_never_negative(steps):
    left = TimeLeft({"a": 1.0, "b": 5.0, "c": 2.0})
    shares = [0.0]
    for second, (stage, done, total) in enumerate(steps):
        share, left_s = left.report(stage, done, total, float(second))
        assert share >= shares[-1] and 0 <= share <= 1 and left_s >= 0
        shares.append(share)


def test_a_slow_machine_is_believed():
    left = TimeLeft({"scan": 10.0, "fuse": 10.0})
    assert left.report("fuse", 0, 4, elapsed_s=10.0)[1] == 10.0
    assert left.report("fuse", 0, 4, elapsed_s=100.0)[1] == pytest.approx(74.3)


def test_nothing_is_said_of_what_is_not_known():
    assert TimeLeft({}).report("scan", 1, 2, 5.0) == (None, None)


def test_a_process_fails_with_its_one_line(jobs, tmp_path):
    work = run_in_subprocess("survey", capture=str(tmp_path / "none"), folder=str(tmp_path))
    state = jobs.wait(jobs.start("Look", work))
    assert (state.state, state.note) == ("failed", f"{tmp_path / 'none'}: not found")


def test_a_process_is_cut_off(jobs, tmp_path):
    began = threading.Event()
    work = run_in_subprocess("demo", out=str(tmp_path / "OUT"))
    watched = Jobs(lambda message: began.set() if message["stage"] == "capture" else None)
    number = watched.start("Demo", work)
    assert began.wait(120)
    watched.cancel(number)
    assert watched.wait(number, 30).state == "cancelled"
    assert not (tmp_path / "OUT" / "manifest.json").exists()


def test_a_task_that_is_not_there_is_named():
    assert run_task("erase", {}, no_progress)["error"].startswith("no forge_task is named 'erase'")

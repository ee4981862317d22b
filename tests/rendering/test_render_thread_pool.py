"""One set of threads for all: bands cover the rows, errors come out when all have ended."""

import os
import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.rendering.thread_pool import bands, run_parallel


@given(st.integers(0, 400), st.integers(1, 20), st.integers(1, 16))
def test_bands_cover_the_rows_and_begin_with_whole_steps(rows, parts, step):
    found = bands(rows, parts, step)
    assert [row for first, last in found for row in range(first, last)] == list(range(rows))
    assert all(first % step == 0 and last > first for first, last in found)
    assert len(found) <= parts


def test_all_items_are_at_work_at_once():
    """Each waits for all the others."""
    barrier, done = threading.Barrier(5), []

    def work(item):
        barrier.wait(30)
        done.append((item, threading.get_ident()))

    run_parallel(work, range(5))
    assert sorted(item for item, _ in done) == [0, 1, 2, 3, 4]
    assert dict(done)[0] == threading.get_ident()


def test_nothing_is_done_for_no_items():
    run_parallel(lambda item: pytest.fail("called"), [])


@pytest.mark.parametrize("bad", [0, 2])
def test_an_error_comes_out_when_all_have_ended(bad):
    ended = []

    def work(item):
        if item == bad:
            raise ValueError(f"item {item}")
        ended.append(item)

    with pytest.raises(ValueError, match=f"^item {bad}$"):
        run_parallel(work, range(4))
    assert sorted(ended) == sorted({0, 1, 2, 3} - {bad})


def test_works_may_be_called_from_works():
    """A work that waits for others holds no thread that they need."""
    found = []
    run_parallel(lambda a: run_parallel(lambda b: found.append((a, b)), range(3)), range(3))
    assert sorted(found) == [(a, b) for a in range(3) for b in range(3)]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
@pytest.mark.filterwarnings("ignore:This process")  # It has threads: that is what is tested.
def test_a_forked_process_has_threads_of_its_own():
    run_parallel(lambda item: None, range(3))
    child = os.fork()
    if child == 0:
        found = []
        run_parallel(found.append, range(3))
        os._exit(0 if sorted(found) == [0, 1, 2] else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0

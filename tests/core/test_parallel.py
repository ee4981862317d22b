"""Work in threads gives what a plain loop gives, in its order, and ends with its consumer."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core import parallel
from world2minecraft.core.parallel import map_parallel, read_ahead


@pytest.fixture(params=[1, 2, 5])
def cores(request, monkeypatch):
    monkeypatch.setattr(parallel, "usable_cores", lambda: request.param)
    return request.param


@given(items=st.lists(st.integers()), count=st.integers(1, 4))
def test_items_come_in_order(items, count):
    assert list(read_ahead(iter(items), count)) == items
    assert map_parallel(lambda item: -item, items) == [-item for item in items]


def test_results_do_not_depend_on_the_cores(cores):
    assert list(read_ahead(range(20))) == list(range(20))
    assert map_parallel(str, range(20)) == [str(n) for n in range(20)]


def test_an_error_comes_at_its_place(cores):
    def items():
        yield 1
        yield 2
        raise ValueError("third")

    seen = []
    with pytest.raises(ValueError, match="third"):
        for item in read_ahead(items()):
            seen.append(item)
    assert seen == [1, 2]


def test_the_error_of_the_first_item_is_raised(cores):
    def work(item):
        raise ValueError(str(item))

    with pytest.raises(ValueError, match="7"):
        map_parallel(work, [7, 8, 9])


def test_a_consumer_that_stops_closes_its_source(cores):
    closed = threading.Event()

    def items():
        try:
            yield from range(100)
        finally:
            closed.set()

    ahead = read_ahead(items())
    assert next(ahead) == 0
    ahead.close()
    assert closed.is_set()


def test_no_more_than_asked_is_computed_ahead(monkeypatch):
    monkeypatch.setattr(parallel, "usable_cores", lambda: 2)
    made = []

    def items():
        for n in range(50):
            made.append(n)
            yield n

    ahead = read_ahead(items(), count=3)
    next(ahead)
    ahead.close()
    assert len(made) <= 4

"""Compilation before the first use: each kernel once, after those it calls."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba import types

from world2minecraft.core import precompile
from world2minecraft.core.kernel_cache import called_kernels
from world2minecraft.core.precompile import KernelCall, read_kernel_calls


def tuple_of(parts):
    return types.BaseTuple.from_types(tuple(parts))


scalars = st.sampled_from(
    [types.int8, types.uint8, types.int64, types.float32, types.float64, types.boolean]
)
arrays = st.builds(
    types.Array, scalars, st.integers(0, 4), st.sampled_from("CFA"), readonly=st.booleans()
)
kinds = st.recursive(
    scalars | arrays, lambda inner: st.lists(inner, min_size=1, max_size=3).map(tuple_of)
)


@given(kinds)
def test_types_come_back_from_their_text(kind):
    assert precompile.type_from_text(precompile.type_text(kind)) == kind


def test_types_without_a_text_are_refused():
    for kind in (types.unicode_type, types.literal(3), types.none):
        with pytest.raises(ValueError, match="cannot be listed"):
            precompile.type_text(kind)


def test_the_list_names_kernels_with_what_they_call():
    import importlib

    calls = read_kernel_calls()
    assert {work for call in calls for work in call.work} == set(precompile.WORK)
    for call in calls:
        module, name = call.kernel.split(":")
        kernel = getattr(importlib.import_module(f"world2minecraft.{module}"), name)
        decoded = [precompile.type_from_text(kind) for kind in call.types]
        assert [precompile.type_text(kind) for kind in decoded] == list(call.types)
        assert len(decoded) <= kernel.py_func.__code__.co_argcount
        called = {one.__name__ for one in called_kernels(kernel.py_func)} - {name}
        assert {one.partition(":")[2] for one in call.calls} == called, call.kernel


def calls_of(**called: str) -> list[KernelCall]:
    return [
        KernelCall(name, (), tuple(others.split()), ("room",), len(name))
        for name, others in called.items()
    ]


@pytest.fixture
def asked(monkeypatch):
    """Return the kernels in the order in which processes were asked and had finished."""
    events, lock = [], threading.Lock()

    def ask(process, call):
        with lock:
            events.append(("start", call.kernel))
        answer = b"" if call.kernel == "crash" else b"compiled\n"
        with lock:
            events.append(("end", call.kernel))
        return answer

    class Process:
        def __init__(self, *words, **places):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

        def kill(self):
            pass

    monkeypatch.setattr(precompile, "_ask", ask)
    monkeypatch.setattr(precompile.subprocess, "Popen", Process)
    return events


@pytest.mark.parametrize("cores", [1, 2, 5])
def test_a_kernel_waits_for_those_it_calls(asked, cores):
    called = {"a": "b c d", "b": "c d", "c": "d", "d": "", "e": "d", "f": "", "g": "f"}
    steps = []
    work = precompile._Compilation(calls_of(**called), lambda *step: steps.append(step[1:3]))
    work.run(cores)
    assert work.compiled == len(called) and not work.unfinished
    for kernel, others in called.items():
        for other in others.split():
            assert asked.index(("end", other)) < asked.index(("start", kernel))
    done = [step[0] for step in steps]
    assert done == sorted(done) and steps[-1] == (7, 7) and done[-2] < 7


@pytest.mark.parametrize("cores", [1, 3])
def test_kernels_in_a_circle_do_not_wait_for_ever(asked, cores):
    work = precompile._Compilation(calls_of(a="b", b="a", c="a"), lambda *step: None)
    work.run(cores)
    assert not work.unfinished


def test_a_crash_ends_one_process_and_no_more(asked):
    work = precompile._Compilation(calls_of(crash="", a="", b="a"), lambda *step: None)
    work.run(2)
    assert not work.unfinished and work.compiled == 2
    alone = precompile._Compilation(calls_of(crash="", a="", b="a"), lambda *step: None)
    alone.run(1)
    assert alone.unfinished == {"a", "b"}


@pytest.fixture
def cache(monkeypatch, tmp_path, asked):
    monkeypatch.setattr(precompile, "KERNEL_CACHE", tmp_path)
    monkeypatch.setattr(precompile, "CACHE_IS_KEPT", True)
    monkeypatch.setattr(precompile, "read_kernel_calls", lambda: tuple(calls_of(a="b", b="")))
    return tmp_path


def test_kernels_are_compiled_once_and_at_the_first_report(cache, asked):
    steps = []
    for _ in range(2):
        progress = precompile.compile_first(lambda *step: steps.append(step[0]))
        progress("fuse", 0, 2)
        progress("fuse", 2, 2)
    assert asked == [("start", "b"), ("end", "b"), ("start", "a"), ("end", "a")]
    assert steps[:2] == ["compile", "compile"]
    assert steps[-4:] == ["fuse"] * 4 and "compile" not in steps[steps.index("fuse") :]
    assert not precompile.needs_compiling("room") and precompile.needs_compiling("photos")


def test_callbacks_that_compile_do_not_wait_for_themselves(cache, asked, monkeypatch):
    monkeypatch.setattr(precompile.time, "sleep", lambda seconds: pytest.fail("waits for itself"))
    steps = []
    inner = precompile.compile_first(lambda *step: steps.append(step[0]))
    precompile.compile_first(inner)("fuse", 0, 1)
    assert len(asked) == 4 and steps[-1] == "fuse" and set(steps[:-1]) == {"compile"}


def test_a_change_of_the_list_compiles_again(cache, monkeypatch):
    precompile.compile_kernels("room")
    monkeypatch.setattr(precompile, "_state_digest", lambda: "other")
    assert precompile.needs_compiling("room")
    assert precompile.compile_kernels("room") == 2
    assert [file.name for file in cache.glob("*.done")] == ["room-other.done"]


def test_nothing_is_compiled_into_a_temporary_folder(cache, asked, monkeypatch):
    monkeypatch.setattr(precompile, "CACHE_IS_KEPT", False)
    assert precompile.compile_kernels("room") == 0 and not asked


def test_a_second_process_waits_for_the_first(cache, asked, monkeypatch):
    lock = precompile.Lock(cache / "compile.lock")
    lock.acquire()
    waits = []

    def sleep(seconds):
        waits.append(seconds)
        if len(waits) == 3:
            lock.release()
            precompile._done_file("room").write_bytes(b"")

    monkeypatch.setattr(precompile.time, "sleep", sleep)
    notes = []
    assert precompile.compile_kernels("room", lambda *step: notes.append(step[3])) == 0
    assert notes == ["in another process"] * 3 and not asked


def test_real_kernels_are_compiled_by_processes(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    call = min(read_kernel_calls(), key=lambda call: (len(call.calls), call.size))
    for compiled in (1, 0):
        work = precompile._Compilation([call], lambda *step: None)
        work.run(1)
        assert not work.unfinished and work.compiled == compiled
    assert list(tmp_path.glob("*.nbc"))

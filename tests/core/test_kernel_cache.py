"""Compiled kernels are used again exactly where nothing that they depend on has changed."""

import errno
import importlib
import itertools
import os
import subprocess
import sys
from pathlib import Path

import pytest
from numba.core.caching import IndexDataCacheFile
from numba.core.dispatcher import Dispatcher

from world2minecraft.core.jit import njit
from world2minecraft.core.kernel_cache import KernelLocator, called_kernels, kernel_digest

CALLER = """
from world2minecraft.core.jit import njit
from {called} import Box, add_step

@njit
def move(box: Box, x):
    return add_step(x) + box.width

@njit
def double(x):
    return 2 * x
"""
CALLED = """
from typing import NamedTuple
import numpy as np
from world2minecraft.core.jit import njit

STEP = 3
TABLE = np.array([1, 2])

class Box(NamedTuple):
    width: int
    height: int

@njit
def add_step(x):
    return x + STEP + TABLE[0]
"""


numbers = itertools.count()  # Of modules, which Python imports once.


@pytest.fixture
def digests(tmp_path, monkeypatch):
    """Return the digests of the two kernels of ``CALLER``, with a change of what it calls."""
    monkeypatch.syspath_prepend(tmp_path)

    def make(old: str = "", new: str = "", caller: str = CALLER) -> tuple[str, str]:
        count = next(numbers)
        changed = CALLED.replace(old, new) if old else CALLED
        assert not old or changed != CALLED
        (tmp_path / f"called{count}.py").write_text(changed)
        (tmp_path / f"caller{count}.py").write_text(caller.format(called=f"called{count}"))
        importlib.invalidate_caches()
        module = importlib.import_module(f"caller{count}")
        for function in (module.move, module.double, module.add_step):
            function.py_func.__module__ = "the same"
        return kernel_digest(module.move.py_func), kernel_digest(module.double.py_func)

    return make


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("STEP = 3", "STEP = 4"),
        ("STEP = 3", "STEP = 3.0"),
        ("np.array([1, 2])", "np.array([1, 3])"),
        ("np.array([1, 2])", "np.array([1, 2], np.int8)"),
        ("return x +", "return x -"),
        ("    width: int\n    height: int", "    height: int\n    width: int"),
        ("@njit", "from world2minecraft.core.jit import lean\n@lean"),
    ],
)
def test_a_change_of_what_a_kernel_uses_changes_its_digest(digests, old, new):
    before, after = digests(), digests(old, new)
    assert before[0] != after[0]
    assert before[1] == after[1]


@pytest.mark.parametrize(
    ("old", "new"),
    [("STEP = 3", "\n\nSTEP = 3  # A comment."), ("class Box", "UNUSED = 7\nclass Box")],
)
def test_other_changes_do_not(digests, old, new):
    assert digests() == digests(old, new)


def test_a_kernel_may_move_within_its_file(digests):
    moved = CALLER.replace("@njit\ndef move", "LATER = 1\n\n\n@njit\ndef move")
    assert digests() == digests(caller=moved)


def test_a_global_list_is_refused_with_the_advice(digests):
    listed = CALLER.replace(
        "@njit\ndef double(x):\n    return 2 * x",
        "L = [1]\n@njit\ndef double(x):\n    return L[0] * x",
    )
    with pytest.raises(TypeError, match="uses L, a list: pass it as an argument"):
        digests(caller=listed)


SCRIPT = """
import sys
sys.path.insert(0, {folder!r})
import caller
print(caller.move(caller.Box(1, 2), 10), sum(caller.move.stats.cache_hits.values()))
"""


def test_a_second_process_loads_what_is_unchanged(tmp_path):
    (tmp_path / "caller.py").write_text(CALLER.format(called="called"))

    def run(step: int) -> list[str]:
        (tmp_path / "called.py").write_text(CALLED.replace("STEP = 3", f"STEP = {step}"))
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
        words = [sys.executable, "-B", "-c", SCRIPT.format(folder=str(tmp_path))]
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
        return done.stdout.split()

    assert run(3) == ["15", "0"]
    assert run(3) == ["15", "1"]
    assert run(5) == ["17", "0"]  # What it calls changed, in another file.


def test_all_kernels_of_the_program_have_a_digest():
    package = Path(importlib.import_module("world2minecraft").__file__).parent
    kernels = {}
    for path in package.rglob("*.py"):
        if "world2minecraft.core.jit import" in path.read_text("utf-8"):
            parts = path.relative_to(package.parent).with_suffix("").parts
            for value in vars(importlib.import_module(".".join(parts))).values():
                if isinstance(value, Dispatcher):
                    kernels[value.py_func] = kernel_digest(value.py_func)
    assert len(kernels) > 300
    assert len(set(kernels.values())) == len(kernels)
    assert all(called_kernels(one) <= kernels.keys() for one in kernels)


@pytest.mark.parametrize("place", ["file/kernels", "full"])
def test_a_kernel_runs_where_its_cache_cannot_be_written(place, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setattr(KernelLocator, "folder", tmp_path / place)
    if place == "full":

        def full(*_: object) -> None:
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(IndexDataCacheFile, "_save_data", full)

    @njit
    def doubled(number):
        return 2 * number

    assert doubled(4) == 8 and doubled(2.5) == 5.0
    assert not list(tmp_path.rglob("*.nbc"))

"""Kernels compiled ahead: all that a report needs, by a process that ends with the run."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from world2minecraft.evaluation.report import jit_warmup as ahead

ROOMS = Path(__file__).parents[2] / "construction"

# Draws the box, then a furnished room in all styles, and tells which kernels the room alone needed.
SCRIPT = """
import sys
from numba.core.dispatcher import Dispatcher
from generated_rooms import furnished_room
from world2minecraft.construction import BuildParameters, build_volume
from world2minecraft.rendering.preview import plan_view, preview
from world2minecraft.evaluation.report.jit_warmup import _look_at_it, draw_box
from world2minecraft.evaluation.report.comparison_pictures import make_pairs

def compiled():
    drawing = "world2minecraft.rendering"
    modules = [one for name, one in sys.modules.items() if name.startswith(drawing)]
    kernels = [one for module in modules for one in vars(module).values()]
    return {(kernel.py_func.__name__, str(signature)) for kernel in kernels
            if isinstance(kernel, Dispatcher) for signature in kernel.signatures}

grid, placements = furnished_room(5, "living")
volumes = [build_volume(grid, placements, (), parameters=BuildParameters(style=style))
           for style in ("blocks", "display")]  # Building lights the rooms, by kernels of its own.
draw_box()
before = compiled()
for volume in volumes:
    make_pairs(_look_at_it(), volume)
    plan_view(volume)
    preview(volume, 64, 48)
after = compiled()
assert len(before) > 5, before
print(sorted(after - before))
"""


def test_a_box_needs_all_kernels_that_a_furnished_room_needs():
    paths = os.pathsep.join([str(ROOMS), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env=os.environ | {"PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "[]"


class FakeProcess:
    """Stands for the process: what it was asked to do."""

    def __init__(self, words, **places):
        self.words, self.done = words, []

    def wait(self, patience_s=None):
        self.done.append("wait")

    def kill(self):
        self.done.append("kill")


@pytest.fixture
def started(monkeypatch):
    """The processes that are started on a machine of two cores where nothing is compiled."""
    found = []
    monkeypatch.setattr(ahead, "is_compiled", lambda kernel: False)
    monkeypatch.setattr(ahead, "usable_cores", lambda: 2)
    monkeypatch.setattr(
        subprocess,
        "Popen",
        lambda *words, **more: found.append(FakeProcess(*words, **more)) or found[-1],
    )
    return found


def test_a_first_run_waits_for_what_is_compiled_meanwhile(started):
    with ahead.compile_pictures_meanwhile():
        assert [one.words[1:] for one in started] == [
            ["-m", "world2minecraft.evaluation.report.jit_warmup"]
        ]
        assert started[0].done == []
    assert started[0].done == ["wait", "kill", "wait"]


def test_a_run_that_fails_does_not_wait(started):
    with pytest.raises(OSError, match="full"), ahead.compile_pictures_meanwhile():
        raise OSError("full")
    assert started[0].done == ["kill", "wait"]


@pytest.mark.parametrize(
    "what", [("is_compiled", lambda kernel: True), ("usable_cores", lambda: 1)]
)
def test_warmup_starts_only_where_needed_and_possible(started, monkeypatch, what):
    monkeypatch.setattr(ahead, *what)
    with ahead.compile_pictures_meanwhile():
        assert not started
    assert not started

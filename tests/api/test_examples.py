"""The examples run, in the order in which a newcomer meets them, on a small room."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SCRIPTS = sorted(EXAMPLES.glob("*.py"))
# Small inputs; what is not listed takes the folder OUT alone.
ARGUMENTS = {
    "01_first_world": ["OUT", "8"],
    "02_your_room": ["OUT/capture", "MINE"],
    "09_data_set": ["DATA", "4"],
    "10_agent": ["OUT", "5"],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder in which the first example has run."""
    place = tmp_path_factory.mktemp("examples")
    run(EXAMPLES / "01_first_world.py", place)
    return place


def run(script, place):
    words = ARGUMENTS.get(script.stem, ["OUT"])
    return subprocess.run(
        [sys.executable, str(script), *words],
        cwd=place, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False,
    )  # fmt: skip


def test_there_are_ten_numbered_examples():
    assert [path.stem[:2] for path in SCRIPTS] == [f"{number:02}" for number in range(1, 11)]


@pytest.mark.parametrize("script", SCRIPTS[1:], ids=lambda path: path.stem)
def test_the_example_runs(script, folder):
    done = run(script, folder)
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_the_first_example_leaves_a_world(folder):
    assert (folder / "OUT" / "build" / "world" / "level.dat").is_file()
    assert (folder / "OUT" / "inside.png").stat().st_size > 1000


def test_the_second_example_says_what_is_wrong(tmp_path):
    done = run(EXAMPLES / "02_your_room.py", tmp_path)
    assert done.returncode == 1
    assert "error: " in done.stderr and "Traceback" not in done.stderr

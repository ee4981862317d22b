"""The vectors that the page's tests read too say what the program does."""

import json
import runpy
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.editing.scene.cell_patch import cells_of_runs, runs_of_cells

FOLDER = Path(__file__).parent / "vectors"
SCRIPT = runpy.run_path(str(Path(__file__).parents[2] / "tools" / "make_edit_vectors.py"))
NAMES = ("runs.json", "box.json", "flood.json", "changes.json")


@pytest.fixture(scope="module")
def made():
    return SCRIPT["vectors"]()


@pytest.mark.parametrize("name", NAMES)
def test_the_committed_vectors_are_what_the_script_makes(made, name):
    assert (FOLDER / name).read_text() == SCRIPT["text_of"](made[name])


def cases(name):
    return json.loads((FOLDER / name).read_text())["cases"]


def filled(runs):
    """The flat numbers that runs name, one by one."""
    return [cell for first, length in runs for cell in range(first, first + length)]


def test_runs_name_their_cells_and_no_run_could_be_longer():
    for case in cases("runs.json"):
        shape = tuple(case["shape"])
        assert filled(case["runs"]) == case["flat"]
        cells = cells_of_runs(case["runs"], shape)
        assert sorted(map(list, case["cells"])) == cells.tolist()
        assert runs_of_cells(cells, shape).tolist() == case["runs"]
        ends = [first + length for first, length in case["runs"]]
        assert not set(ends) & {first for first, _ in case["runs"]}


def test_a_box_has_the_cells_between_its_corners():
    for case in cases("box.json"):
        low, high = np.minimum(case["low"], case["high"]), np.maximum(case["low"], case["high"])
        every = np.argwhere(np.ones(case["shape"], bool))
        inside = ((every >= low) & (every <= high)).all(axis=1)
        assert np.flatnonzero(inside).tolist() == filled(case["runs"])


def test_a_flood_is_of_one_label_and_nothing_beside_it_is():
    for case in cases("flood.json"):
        labels = np.array(case["labels"]).reshape(case["shape"])
        reached = np.zeros(labels.size, bool)
        reached[filled(case["runs"])] = True
        assert reached[case["seed"]]
        reached = reached.reshape(labels.shape)
        assert len(np.unique(labels[reached])) == 1
        for axis in range(3):
            first, second = (np.moveaxis(one, axis, 0) for one in (reached, labels))
            same = second[1:] == second[:-1]
            assert (first[1:] == first[:-1])[same].all()


def test_changes_apply_forwards_and_backwards():
    for case in cases("changes.json"):
        for start, runs, end in (
            ("before", "done", "after"),
            ("after", "undone", "before"),
        ):
            held = {name: list(values) for name, values in case[start].items()}
            for first, length, *values in case[runs]:
                for name, value in zip(("labels", "instance", "confidence"), values, strict=True):
                    held[name][first : first + length] = [value] * length
            assert held == case[end]
        assert case["counts"] == np.bincount(case["after"]["labels"], minlength=256)[:12].tolist()

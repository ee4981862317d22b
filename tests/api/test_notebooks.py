"""The notebooks run from their first cell to their last, on small inputs."""

import json
import os
from pathlib import Path

import pytest

NOTEBOOKS = Path(__file__).resolve().parents[2] / "notebooks"
# What the cell tagged "parameters" holds in the tests.
SMALL = {
    "01_scan_to_world": 'out, frames, capture = "OUT", 8, None',
    "02_data_set_and_network": (
        'data_folder, run_folder = "DATA", "RUN"\nhouses, images, steps, image = 2, 4, 2, (64, 48)'
    ),
    "03_agent": "scene, frames, steps = None, 8, 5",
}
NEEDS = {"02_data_set_and_network": ("torch", "pyarrow"), "03_agent": ("gymnasium",)}


def cells(name):
    """The cells of a notebook: kind, text and tags."""
    found = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text())["cells"]
    return [(c["cell_type"], "".join(c["source"]), c["metadata"].get("tags", ())) for c in found]


@pytest.mark.parametrize("name", SMALL)
def test_the_notebook_runs(name, tmp_path, monkeypatch):
    for module in NEEDS.get(name, ()):
        pytest.importorskip(module)
    monkeypatch.chdir(tmp_path)
    space = {"__name__": "__main__"}
    for kind, text, tags in cells(name):
        if kind == "code":
            code = SMALL[name] if "parameters" in tags else text
            exec(compile(code, f"{name}.ipynb", "exec"), space)
    assert os.listdir(tmp_path)


def test_every_notebook_is_run_and_stored_without_output():
    assert sorted(path.stem for path in NOTEBOOKS.glob("*.ipynb")) == sorted(SMALL)
    for name in SMALL:
        stored = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text())["cells"]
        assert not any(cell.get("outputs") for cell in stored)
        assert sum("parameters" in tags for _, _, tags in cells(name)) == 1

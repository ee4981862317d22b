"""Values that the examples of the public API use: a scan, a run, a data set, and a folder."""

import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from _pytest.doctest import DoctestItem
from filelock import FileLock

import world2minecraft as w2m
from world2minecraft.api.datasets import Dataset, build_photo_dataset


@pytest.fixture(scope="session")
def made_once(tmp_path_factory) -> Callable[[str, Callable[[Path], object]], Path]:
    """Return a function that makes a folder once for all workers of pytest-xdist."""
    base = tmp_path_factory.getbasetemp()
    base = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def folder_of(name: str, make: Callable[[Path], object]) -> Path:
        folder, done = base / name, base / f"{name}.done"
        with FileLock(base / f"{name}.lock"):
            if not done.exists():
                make(folder)
                done.touch()
        return folder

    return folder_of


@pytest.fixture(scope="session")
def example_scan(made_once) -> Path:
    """A scanned study of 12 frames."""

    def make(folder: Path) -> None:
        w2m.scan_room(w2m.generate_room("study", seed=3), folder, frames=12)

    return made_once("example_scan", make)


@pytest.fixture(scope="session")
def example_run(made_once, example_scan) -> w2m.Run:
    """The reconstruction of the scan."""
    return w2m.Run(made_once("example_run", lambda folder: w2m.reconstruct(example_scan, folder)))


@pytest.fixture(scope="session")
def example_data(made_once) -> Dataset:
    """Two small pictures of generated rooms."""
    words = {"rooms": 2, "images": 2, "size": (64, 48)}
    return w2m.open_dataset(
        made_once("example_data", lambda folder: build_photo_dataset(folder, **words))
    )


@pytest.fixture(autouse=True)
def api_example(request, doctest_namespace, tmp_path) -> None:
    """Give the examples of ``world2minecraft.api`` the values that they read but do not make."""
    if isinstance(request.node, DoctestItem) and "/api/" in str(request.node.path):
        source = "".join(example.source for example in request.node.dtest.examples)
        for name in ("scan", "run", "data"):
            if re.search(rf"\b{name}\b", source) and f"{name} = w2m" not in source:
                doctest_namespace[name] = request.getfixturevalue(f"example_{name}")
        doctest_namespace["tmp"] = tmp_path

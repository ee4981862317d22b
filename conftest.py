"""Values that the examples of the public API use: a scan, a run, and a folder to write to."""

import pytest
from _pytest.doctest import DoctestItem

import world2minecraft as w2m


@pytest.fixture(scope="session")
def api_example_values(tmp_path_factory) -> dict:
    """A scanned study of 12 frames and its reconstruction, made once."""
    folder = tmp_path_factory.mktemp("api_examples")
    scan = w2m.scan_room(w2m.generate_room("study", seed=3), folder / "scan", frames=12)
    return {"scan": scan, "run": w2m.reconstruct(scan, folder / "run")}


@pytest.fixture(autouse=True)
def api_example(request, doctest_namespace, tmp_path) -> None:
    """Give the examples of ``world2minecraft.api`` their values."""
    if isinstance(request.node, DoctestItem) and "/api/" in str(request.node.path):
        doctest_namespace |= request.getfixturevalue("api_example_values")
        doctest_namespace["tmp"] = tmp_path

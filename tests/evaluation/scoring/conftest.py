"""A capture of the small true room and a perfect run of it, made once."""

from pathlib import Path

import pytest
from true_rooms import write_capture, write_perfect


@pytest.fixture(scope="session")
def capture(tmp_path_factory) -> Path:
    return write_capture(tmp_path_factory.mktemp("capture"))


@pytest.fixture(scope="session")
def perfect(tmp_path_factory, capture) -> Path:
    return write_perfect(tmp_path_factory.mktemp("perfect"), capture)

"""What all tests of the command line share."""

import pytest

from world2minecraft.cli import outcome


@pytest.fixture(autouse=True)
def kernels_compiled(monkeypatch) -> None:
    """Leave out the note on compilation: whether it is printed depends on what ran before."""
    monkeypatch.setattr(outcome, "kernels_are_compiled", lambda: True)

"""What all tests of the command line share."""

import pytest

from world2minecraft.core import precompile


@pytest.fixture(autouse=True)
def kernels_compiled(monkeypatch) -> None:
    """Leave out the compilation of kernels: its messages depend on what ran before."""
    monkeypatch.setattr(precompile, "needs_compiling", lambda work: False)

"""What tests of SceneForge share."""

from pathlib import Path

import pytest
from forge_runs import make_small_run


@pytest.fixture(scope="session")
def small_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run with its capture and its truth; copy it before changing it."""
    return make_small_run(tmp_path_factory.mktemp("small") / "OUT")

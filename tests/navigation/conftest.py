"""The small flat that the tests of navigation share."""

from pathlib import Path

import pytest
from small_flat import write_flat

from world2minecraft.navigation.scene import VlnScene, open_scene


@pytest.fixture(scope="session")
def flat_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the small flat: two rooms, a doorway, a piano."""
    return write_flat(tmp_path_factory.mktemp("flat") / "flat")


@pytest.fixture(scope="session")
def flat(flat_path: Path) -> VlnScene:
    """The small flat, open."""
    return open_scene(flat_path)

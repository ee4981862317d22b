"""Fixtures that all tests share, and hypothesis without chance."""

import gc
import os
from pathlib import Path

import pytest
from hypothesis import settings

from world2minecraft.core.jit import KERNEL_CACHE

REPOSITORY = Path(__file__).resolve().parents[1]

# No test sees furniture that the one who runs it has added.
os.environ["W2M_FURNITURE"] = str(REPOSITORY / "no_furniture")
# Processes with a home folder of their own compile nothing again.
os.environ["NUMBA_CACHE_DIR"] = str(KERNEL_CACHE)

# The same examples on each run and machine, and no deadline that a busy one would miss.
settings.register_profile(
    "project", derandomize=True, deadline=None, max_examples=50, database=None
)
settings.load_profile("project")


def pytest_collection_finish() -> None:
    """Spare the garbage collector all that was collected, which stays until the end."""
    gc.freeze()
    gc.set_threshold(100_000, 50, 100)


@pytest.fixture(scope="session", autouse=True)
def sceneforge_home(tmp_path_factory) -> None:
    """Keep every test away from the SceneForge documents of the developer who runs it."""
    os.environ["W2M_FORGE_HOME"] = str(tmp_path_factory.mktemp("sceneforge_home"))


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real inputs made by others, which is never part of the project."""
    folder = Path(os.environ.get("W2M_SHARED_DATA", REPOSITORY.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"the shared real inputs are not at {folder} (set W2M_SHARED_DATA)")
    return folder

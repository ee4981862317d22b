"""Environment variables of a user, and a source tree of an earlier commit."""

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Set by developers only. With the second, all modules are compiled at each start.
NOT_A_USERS = ("NUMBA_CACHE_DIR", "PYTHONDONTWRITEBYTECODE")


def user_environment() -> dict[str, str]:
    """Return the environment variables without those that only developers set."""
    return {name: value for name, value in os.environ.items() if name not in NOT_A_USERS}


def environment_of(source: Path, cache: Path) -> dict[str, str]:
    """Return the environment variables to run a source tree with a cache folder of its own."""
    return user_environment() | {
        "PYTHONPATH": str(source),
        "NUMBA_CACHE_DIR": str(cache),
        "W2M_CACHE_DIR": str(cache),
    }


@contextmanager
def earlier_sources(commit: str, folder: Path) -> Iterator[Path]:
    """Check a commit out into a new folder, yield its ``src``, and remove the folder."""
    git = ["git", "-C", str(ROOT), "worktree"]
    add = [*git, "add", "--detach", str(folder), commit]
    subprocess.run(add, check=True, capture_output=True)
    try:
        yield folder / "src"
    finally:
        subprocess.run([*git, "remove", "--force", str(folder)], check=False)

"""numba with the project's settings: compiled once, kept in the user's cache folder.

Import ``njit`` from here and never from numba, so that every kernel is cached, releases the GIL
and computes the same bits on every run (no fast-math).
"""

import os
import sys
from pathlib import Path


def user_cache_dir() -> Path:
    """The folder where this program may keep what it can compute again."""
    if "W2M_CACHE_DIR" in os.environ:
        return Path(os.environ["W2M_CACHE_DIR"])
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", home)) / "world2minecraft"
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "world2minecraft"
    return Path(os.environ.get("XDG_CACHE_HOME", home / ".cache")) / "world2minecraft"


os.environ.setdefault("NUMBA_CACHE_DIR", str(user_cache_dir() / "kernels"))

import numba  # noqa: E402  # The cache folder must be named before numba is loaded.

njit = numba.njit(cache=True, nogil=True)

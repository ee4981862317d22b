"""Compilation of kernels with numba using project-wide settings and a cache in the user folder.

Import ``njit``, ``lean`` and similar decorators from this module and never from numba, so that
every kernel is cached, releases the GIL and computes identical bits on every run (no fast-math).
"""

import hashlib
import os
import sys
import tempfile
from pathlib import Path
from typing import Any


def user_cache_dir() -> Path:
    """Return the folder for files that this program can recompute."""
    if "W2M_CACHE_DIR" in os.environ:
        return Path(os.environ["W2M_CACHE_DIR"])
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", home)) / "world2minecraft"
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "world2minecraft"
    return Path(os.environ.get("XDG_CACHE_HOME", home / ".cache")) / "world2minecraft"


def kernel_sources_digest() -> str:
    """Return a digest of all files with kernels.

    The cache of numba detects changes of a kernel's own file, but not of kernels it calls in other
    files. Therefore, each state of the sources has a separate cache folder.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parents[1].rglob("*.py")):
        source = path.read_bytes()
        if b"world2minecraft.core.jit import" in source:
            digest.update(path.name.encode() + source)
    return digest.hexdigest()[:16]


def kernel_cache_dir() -> Path:
    """Create and return the folder of compiled kernels, or a temporary one if it is read-only.

    The files in the folder are executed as code, so it is never a folder that others could have
    filled.
    """
    folder = user_cache_dir() / "kernels" / kernel_sources_digest()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return Path(tempfile.mkdtemp(prefix="world2minecraft-kernels-"))
    if os.access(folder, os.W_OK):
        return folder
    return Path(tempfile.mkdtemp(prefix="world2minecraft-kernels-"))


def is_compiled(kernel: str) -> bool:
    """Return whether an earlier run has cached a kernel, given as ``module.kernel``."""
    return any(KERNEL_CACHE.rglob(f"{kernel}-*.nbi"))


KERNEL_CACHE = kernel_cache_dir()
os.environ.setdefault("NUMBA_CACHE_DIR", str(KERNEL_CACHE))

import numba  # noqa: E402  # The cache folder must be named before numba is loaded.

njit = numba.njit(cache=True, nogil=True)
# For kernels that allocate nothing: without counting references to arrays, which at every call
# inside takes as long as a ray. Such a kernel calls only its like. Division by 0 gives infinity.
_LEAN: dict[str, Any] = {"cache": True, "nogil": True, "_nrt": False, "error_model": "numpy"}
lean = numba.njit(**_LEAN)
# The same for small functions that a kernel calls for every ray: a call costs more than they do.
inlined = numba.njit(forceinline=True, **_LEAN)
# The same for what takes whole tables and is called by kernels alone: without the code by which
# Python could call it, which takes longest to compile. Python that calls it all the same crashes.
_INNER: dict[str, Any] = {**_LEAN, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
inner = numba.njit(forceinline=True, **_INNER)
inner_call = numba.njit(**_INNER)

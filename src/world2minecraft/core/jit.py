"""Compilation of kernels with numba using project-wide settings and a cache in the user folder.

Import ``njit``, ``lean`` and similar decorators from this module and never from numba, so that
every kernel is cached, releases the GIL and computes identical bits on every run (no fast-math).
"""

import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

TEMPORARY_PREFIX = "world2minecraft-kernels-"


def user_cache_dir() -> Path:
    """Return the folder for files that this program can recompute."""
    if chosen := os.environ.get("W2M_CACHE_DIR"):
        return Path(chosen)
    if sys.platform == "win32":
        folder = os.environ.get("LOCALAPPDATA") or Path.home()
    elif sys.platform == "darwin":
        folder = Path.home() / "Library" / "Caches"
    else:
        folder = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(folder) / "world2minecraft"


def kernel_cache_dir() -> Path:
    """Create and return the folder of compiled kernels, or a temporary one if it is read-only.

    The files in the folder are executed as code, so it is never a folder that others could have
    filled.
    """
    try:
        folder = user_cache_dir() / "kernels"
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    except (OSError, RuntimeError):  # RuntimeError: the user has no home folder.
        pass
    return Path(tempfile.mkdtemp(prefix=TEMPORARY_PREFIX))


KERNEL_CACHE = Path(os.environ.get("NUMBA_CACHE_DIR") or kernel_cache_dir())
CACHE_IS_KEPT = not KERNEL_CACHE.name.startswith(TEMPORARY_PREFIX)

import numba  # noqa: E402  # Slow to load; the folder is checked first.
from numba.core.dispatcher import Dispatcher  # noqa: E402

from world2minecraft.core.kernel_cache import KernelCache, KernelLocator  # noqa: E402

KernelLocator.folder = KERNEL_CACHE


def _decorator(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function at its first call and caches it."""
    compile_options = numba.njit(nogil=True, **options)

    def decorate(function: Callable[..., Any]) -> Any:
        kernel = compile_options(function)
        if isinstance(kernel, Dispatcher):  # With NUMBA_DISABLE_JIT it stays a function.
            kernel._cache = KernelCache(function)  # type: ignore[attr-defined]
        return kernel

    return decorate


njit = _decorator()
# For kernels that allocate nothing: without counting references to arrays, which at every call
# inside takes as long as a ray. Such a kernel calls only its like. Division by 0 gives infinity.
_LEAN: dict[str, Any] = {"_nrt": False, "error_model": "numpy"}
lean = _decorator(**_LEAN)
# The same for small functions that a kernel calls for every ray: a call costs more than they do.
inlined = _decorator(forceinline=True, **_LEAN)
# The same for what takes whole tables and is called by kernels alone: without the code by which
# Python could call it, which takes longest to compile. Python that calls it all the same crashes.
_INNER: dict[str, Any] = {**_LEAN, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
inner = _decorator(forceinline=True, **_INNER)
inner_call = _decorator(**_INNER)

"""The cache of compiled kernels, in which each kernel has a key of its own.

numba's own cache notices a change of a kernel's file, but not of kernels that it calls in other
files, nor of their constants. Here the key of a kernel is a digest of its code, of the constants
and named tuples that it uses, and of the kernels that it calls. So an upgrade compiles again what
changed and no more, and copies of the program share what they have in common.
"""

import dis
import hashlib
import inspect
import types
from collections.abc import Callable, Iterator
from contextlib import suppress
from enum import Enum
from functools import cache, cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba.core.caching import CompileResultCacheImpl, FunctionCache, NullCache
from numba.core.dispatcher import Dispatcher

DIGEST_LENGTH = 16
CONSTANTS = (bool, int, float, complex, str, bytes, type(None), np.generic, np.dtype)


def kernel_digest(function: Callable[..., Any]) -> str:
    """Return a digest of a kernel and of all that its compiled code depends on.

    Raises:
        TypeError: the kernel uses a global value of a kind that has no digest.
    """
    whole = hashlib.sha256(_parts(function).digest)
    for digest in sorted(_parts(called).digest for called in called_kernels(function)):
        whole.update(digest)
    return whole.hexdigest()[:DIGEST_LENGTH]


def called_kernels(function: Callable[..., Any]) -> set[Callable[..., Any]]:
    """Return the functions of all kernels that a kernel calls, directly or through others."""
    reached: set[Callable[..., Any]] = set()
    pending = [function]
    while pending:
        new = set(_parts(pending.pop()).called) - reached
        reached |= new
        pending += new
    return reached


class _Parts(NamedTuple):
    """The digest of a function by itself, and the kernels that it calls."""

    digest: bytes
    called: tuple[Callable[..., Any], ...]


@cache
def _parts(function: Callable[..., Any]) -> _Parts:
    """Describe code, defaults, argument types and global values of a function."""
    lines = [f"function {function.__module__}.{function.__qualname__}"]
    lines += _value_lines("defaults", function.__defaults__ or ())
    for name, annotation in inspect.get_annotations(function).items():
        if hasattr(annotation, "_fields"):
            lines += _value_lines(name, annotation)
    codes = list(_nested_codes(function.__code__))
    for code in codes:
        lines += _code_lines(code)
    scope, called = function.__globals__, []
    for name in sorted({name for code in codes for name in _global_names(code)} & scope.keys()):
        lines += _value_lines(name, scope[name])
        if isinstance(scope[name], Dispatcher):
            called.append(scope[name].py_func)
    return _Parts(hashlib.sha256("\n".join(lines).encode()).digest(), tuple(called))


def _nested_codes(code: types.CodeType) -> Iterator[types.CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _nested_codes(constant)


def _global_names(code: types.CodeType) -> Iterator[str]:
    for instruction in dis.get_instructions(code):
        if instruction.opname in ("LOAD_GLOBAL", "LOAD_NAME"):
            yield str(instruction.argval)


def _code_lines(code: types.CodeType) -> Iterator[str]:
    """Yield the contents of a code object, without its file and line."""
    yield f"code {code.co_code.hex()} {code.co_names} {code.co_varnames} {code.co_freevars}"
    for constant in code.co_consts:
        if not isinstance(constant, types.CodeType):
            yield f"constant {constant!r}"


def _value_lines(name: str, value: Any) -> Iterator[str]:
    """Yield a description of a global value that is the same in every process."""
    if isinstance(value, Dispatcher):
        yield f"{name} kernel {sorted(value.targetoptions.items())}"
    elif isinstance(value, CONSTANTS):
        yield f"{name} {type(value).__name__} {value!r}"
    elif isinstance(value, np.ndarray):
        yield f"{name} array {value.dtype} {value.shape} {value.tobytes().hex()}"
    elif isinstance(value, tuple):
        yield f"{name} {type(value).__name__} {len(value)}"
        for number, one in enumerate(value):
            yield from _value_lines(f"{name}[{number}]", one)
    elif isinstance(value, type) and issubclass(value, Enum):
        yield f"{name} {[(member.name, member.value) for member in value]}"
    elif isinstance(value, type) and hasattr(value, "_fields"):
        yield f"{name} {value.__qualname__} {value._fields}"
        for field, annotation in inspect.get_annotations(value).items():
            if hasattr(annotation, "_fields"):
                yield from _value_lines(field, annotation)
    elif (isinstance(value, types.ModuleType) or callable(value)) and not _is_ours(value):
        yield f"{name} {getattr(value, '__module__', '')}.{getattr(value, '__name__', name)}"
    else:
        raise TypeError(f"a kernel uses {name}, a {type(value).__name__}: pass it as an argument")


def _is_ours(value: Any) -> bool:
    module = value.__name__ if isinstance(value, types.ModuleType) else value.__module__
    return str(module).startswith("world2minecraft")


class KernelLocator:
    """Where the compiled code of a kernel is stored, for numba: in one folder, by its digest."""

    folder: Path  # Set by ``core.jit``.

    def __init__(self, function: Callable[..., Any], file: str):
        self._py_file = file  # For warnings of numba.
        self.digest = kernel_digest(function)

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> "KernelLocator":
        """Return the locator of a kernel."""
        return cls(function, file)

    def get_cache_path(self) -> str:
        """Return the folder of compiled kernels."""
        return str(self.folder)

    def ensure_cache_path(self) -> None:
        """Create the folder."""
        self.folder.mkdir(parents=True, exist_ok=True)

    def get_source_stamp(self) -> str:
        """Return what must be equal for compiled code to be used."""
        return self.digest

    def get_disambiguator(self) -> str:
        """Return a part of the file names, which tells versions of a kernel apart."""
        return self.digest


class _KernelCacheImpl(CompileResultCacheImpl):
    _locator_classes = [KernelLocator]  # noqa: RUF012  # numba's own form.


class _KernelFiles(FunctionCache):
    _impl_class = _KernelCacheImpl


class KernelCache(NullCache):
    """The cache of one kernel, for numba.

    Its key is made at the first use: when a kernel is defined, those it calls may not exist yet.
    """

    def __init__(self, function: Callable[..., Any]):
        self.function = function

    @cached_property
    def files(self) -> FunctionCache | NullCache:
        """The files of the kernel, or no files where their folder cannot be written."""
        try:
            return _KernelFiles(self.function)
        except OSError:
            return NullCache()

    @property
    def cache_path(self) -> str:  # type: ignore[override]
        """The folder of compiled kernels."""
        return str(KernelLocator.folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled code for a signature, or None if there is none that can be read."""
        with suppress(OSError):
            return self.files.load_overload(sig, target_context)
        return None

    def save_overload(self, sig: Any, cres: Any) -> None:
        """Save the compiled code for a signature, if there is space for it."""
        with suppress(OSError):
            self.files.save_overload(sig, cres)

    def flush(self) -> None:
        """Forget all compiled code of the kernel."""
        self.files.flush()

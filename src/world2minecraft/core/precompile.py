"""Compilation of the kernels that a command needs, on all cores, before their first use.

``core/data/kernels.json`` lists kernels with the argument types of their calls and the kinds of
work that call them; ``tools/list_kernels.py`` records it. A kernel that is missing there is
compiled at its first call. Each core has a process of its own, ``python -m
world2minecraft.core.precompile``, because numba compiles one kernel at a time in a process. A
kernel waits for those it calls, so that none is compiled twice.
"""

import hashlib
import importlib
import json
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
from numba import types

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.core.jit import CACHE_IS_KEPT, KERNEL_CACHE
from world2minecraft.core.locks import Lock
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.progress import Progress, no_progress

LIST = Path(__file__).parent / "data" / "kernels.json"
WORK = ("room", "pictures", "photos", "dataset", "navigation")
STAGE = "compile"
NOTE = "once for this kind of work"
WAIT_S = 0.5  # Between two looks at the lock.
_this_thread = threading.local()


@dataclass(frozen=True)
class KernelCall:
    """A kernel with the types of the arguments of one of its calls.

    Attributes:
        kernel: Module and name, such as ``geometry.planar_patches:_fit``.
        types: Types of the arguments in the form of ``type_text``.
        calls: Kernels that it calls.
        work: Kinds of work that call it, of ``WORK``.
        size: Size of the compiled code in kB, a measure of the time to compile it.
    """

    kernel: str
    types: tuple[Any, ...]
    calls: tuple[str, ...]
    work: tuple[str, ...]
    size: int


def compile_kernels(work: str, progress: Progress = no_progress) -> int:
    """Compile the kernels of a kind of work that are not compiled yet, on all cores.

    Nothing happens if this was done before with the same kernels, or if compiled kernels cannot
    be kept. A kernel that fails to compile here is left to its first call, which reports why.

    Args:
        work: One of ``WORK``.
        progress: Receives the stage ``compile``.

    Returns:
        The number of kernels that were compiled.
    """
    if _this_thread.__dict__.get("compiles") or not needs_compiling(work):
        return 0
    lock = Lock(KERNEL_CACHE / "compile.lock", "filled")
    while True:
        try:
            lock.acquire()
            break
        except OutputError:
            return 0
        except ConflictError:
            progress(STAGE, 0, 0, "in another process")
            time.sleep(WAIT_S)
    _this_thread.compiles = True  # A callback that compiles must not wait for its caller.
    try:
        if not needs_compiling(work):  # The other process did it.
            return 0
        calls = [call for call in read_kernel_calls() if work in call.work]
        compilation = _Compilation(calls, progress)
        compilation.run(usable_cores())
        if not compilation.unfinished:
            for former in KERNEL_CACHE.glob(f"{work}-*.done"):
                former.unlink(missing_ok=True)
            _done_file(work).write_bytes(b"")
    finally:
        _this_thread.compiles = False
        lock.release()
    return compilation.compiled


def needs_compiling(work: str) -> bool:
    """Return whether kernels of a kind of work may have to be compiled."""
    return CACHE_IS_KEPT and not _done_file(work).exists()


def compile_first(progress: Progress, work: str = "room") -> Progress:
    """Return a progress callback that compiles the kernels of a kind of work at its first report.

    Errors in arguments are raised before any report, so nobody waits to learn of them.
    """
    compiled = False

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        """Compile before the first report, and forward all of them."""
        nonlocal compiled
        if not compiled:
            compiled = True
            compile_kernels(work, progress)
        progress(stage, done, total, note)

    return report


def _done_file(work: str) -> Path:
    return KERNEL_CACHE / f"{work}-{_state_digest()}.done"


@lru_cache(maxsize=1)
def read_kernel_calls() -> tuple[KernelCall, ...]:
    """Return the listed calls of kernels."""
    rows = json.loads(LIST.read_bytes())
    return tuple(
        KernelCall(
            row["kernel"],
            tuple(row["types"]),
            tuple(row["calls"]),
            tuple(row["work"]),
            row["size"],
        )
        for row in rows
    )


@lru_cache(maxsize=1)
def _state_digest() -> str:
    """Return a digest of all that makes compiled kernels obsolete, without reading the modules."""
    parts = [sys.version, numba.__version__, llvmlite.binding.get_host_cpu_name()]
    parts.append(hashlib.sha256(LIST.read_bytes()).hexdigest())
    for module in sorted({call.kernel.partition(":")[0] for call in read_kernel_calls()}):
        with suppress(OSError):
            status = _module_file(module).stat()
            parts.append(f"{module} {status.st_size} {status.st_mtime_ns}")
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def _module_file(module: str) -> Path:
    return Path(__file__).parents[1].joinpath(*module.split(".")).with_suffix(".py")


class _Compilation:
    """The compilation of a list of calls by several processes."""

    def __init__(self, calls: Sequence[KernelCall], progress: Progress):
        self.waiting = sorted(calls, key=lambda call: -call.size)
        self.left = Counter(call.kernel for call in calls)
        self.running = 0
        self.total, self.spent, self.compiled = sum(call.size for call in calls), 0, 0
        self.progress = progress
        self.changed = threading.Condition()

    @property
    def unfinished(self) -> set[str]:
        """The kernels with calls that are not compiled yet."""
        return {kernel for kernel, count in self.left.items() if count}

    def run(self, cores: int) -> None:
        """Compile with one process per core. Calls stay unfinished where all processes fail."""
        if not self.waiting:
            return
        self._report()
        threads = [threading.Thread(target=self._feed, daemon=True) for _ in range(cores)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            with self.changed:
                self.changed.wait(0.5)
            self._report()
        self.progress(STAGE, self.total, self.total, NOTE)

    def _report(self) -> None:
        """Report from the thread that called ``run`` alone."""
        with self.changed:
            done = min(self.spent, self.total - 1)
        self.progress(STAGE, done, self.total, NOTE)

    def _feed(self) -> None:
        """Give calls to one process until none is left or the process fails."""
        words = [sys.executable, "-m", "world2minecraft.core.precompile"]
        with subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        ) as process:
            try:
                while (call := self._next_call()) is not None:
                    answer = _ask(process, call)
                    self._finish(call, answer)
                    if not answer:
                        return
            finally:
                process.kill()

    def _next_call(self) -> KernelCall | None:
        """Wait for a call whose called kernels are compiled. Return None if none is left."""
        with self.changed:
            while self.waiting:
                unfinished = self.unfinished
                ready = [call for call in self.waiting if unfinished.isdisjoint(call.calls)]
                if ready or not self.running:  # Otherwise kernels call each other in a circle.
                    call = (ready or self.waiting)[0]
                    self.waiting.remove(call)
                    self.running += 1
                    return call
                self.changed.wait(0.5)
        return None

    def _finish(self, call: KernelCall, answer: bytes) -> None:
        """Note the end of a call. One that ended its process is not tried again."""
        with self.changed:
            self.running -= 1
            self.left[call.kernel] -= 1
            self.spent += call.size
            self.compiled += answer == b"compiled\n"
            self.changed.notify_all()


def _ask(process: subprocess.Popen[bytes], call: KernelCall) -> bytes:
    """Send a call to a process and return its answer, which is empty if the process failed."""
    if process.stdin is None or process.stdout is None:
        return b""
    try:
        process.stdin.write(json.dumps([call.kernel, call.types]).encode() + b"\n")
        process.stdin.flush()
        return process.stdout.readline()
    except OSError:
        return b""


def serve() -> None:
    """Compile the calls that arrive on stdin, one JSON line each, and answer each with a word."""
    for line in sys.stdin.buffer:
        kernel, kinds = json.loads(line)
        try:
            answer = "compiled" if _compile_call(kernel, kinds) else "known"
        except Exception:  # Its first call in the program reports the cause.
            answer = "failed"
        sys.stdout.write(f"{answer}\n")
        sys.stdout.flush()


def _compile_call(kernel: str, kinds: Iterable[Any]) -> bool:
    """Compile a kernel for types of arguments. Return whether it was not in the cache."""
    module, name = kernel.split(":")
    found = getattr(importlib.import_module(f"world2minecraft.{module}"), name)
    arguments = tuple(type_from_text(text) for text in kinds)
    found.compile(arguments)
    return not found.stats.cache_hits.get(arguments)


def type_text(kind: Any) -> Any:
    """Return a type of numba as text, such as ``float64`` or ``uint8[3,C]``, or as a JSON list.

    Tuples become lists, whose first item is the class of a named tuple or ``null``.

    Raises:
        ValueError: the type has no such form.
    """
    if isinstance(kind, types.Array) and kind.aligned:
        return f"{type_text(kind.dtype)}[{kind.ndim},{kind.layout}{'' if kind.mutable else 'R'}]"
    if isinstance(kind, types.BaseTuple):
        owner = getattr(kind, "instance_class", None)
        module = "" if owner is None else owner.__module__.removeprefix("world2minecraft.")
        named = None if owner is None else f"{module}:{owner.__qualname__}"
        return [named, *(type_text(one) for one in iter(kind))]  # type: ignore[call-overload]
    if isinstance(kind, types.Number | types.Boolean) and not isinstance(kind, types.Literal):
        return str(kind)
    raise ValueError(f"{kind} cannot be listed")


def type_from_text(text: Any) -> Any:
    """Return the type of numba that ``type_text`` wrote."""
    if isinstance(text, list):
        owner, kinds = text[0], tuple(type_from_text(one) for one in text[1:])
        if owner is None:
            return types.BaseTuple.from_types(kinds)
        module, _, name = owner.partition(":")
        found = getattr(importlib.import_module(f"world2minecraft.{module}"), name)
        return types.BaseTuple.from_types(kinds, found)
    if not text.endswith("]"):
        return types.boolean if text == "bool" else getattr(types, text)
    scalar, _, shape = text[:-1].partition("[")
    count, _, layout = shape.partition(",")
    return types.Array(type_from_text(scalar), int(count), layout[0], readonly=layout[1:] == "R")


if __name__ == "__main__":
    serve()

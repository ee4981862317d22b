"""Which graphics card draws: found by wgpu, which is imported only when someone asks.

A software adapter draws on the CPU, slower than our own kernel; it is taken only by name, for
tests: ``W2M_GPU_ADAPTER=software``, or any part of an adapter's name.
"""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from world2minecraft.core.errors import MissingExtraError, UsageError

VARIABLE = "W2M_GPU_ADAPTER"
SOFTWARE = "software"
_SOFTWARE_NAMES = ("llvmpipe", "lavapipe", "swiftshader", "softpipe", "microsoft basic render")
_ORDER = ("DiscreteGPU", "IntegratedGPU", "VirtualGPU", "Unknown", "CPU")
BACKENDS = ("Vulkan", "Metal", "D3D12")  # OpenGL has no compute shaders worth asking for.
_LIMITS = ("max-buffer-size", "max-storage-buffer-binding-size")


@dataclass(frozen=True)
class AdapterInfo:
    """An adapter that was found."""

    name: str
    backend: str
    is_software: bool


class GpuError(UsageError):
    """The GPU cannot do what was asked; the message says what to type instead."""


def wgpu_module() -> Any:
    """Import wgpu and return it."""
    return import_module("wgpu")


def list_adapters() -> list[AdapterInfo]:
    """Return the adapters of this machine, the best first; none where wgpu is not installed."""
    return [info_of(adapter) for adapter in _adapters()] if find_spec("wgpu") else []


def find_adapter(name: str | None = None) -> Any:
    """Return the adapter that draws, a wgpu adapter.

    Args:
        name: a part of its name, or ``software``; None for what ``W2M_GPU_ADAPTER`` says, and
            where that says nothing for the best one that is hardware.

    Raises:
        MissingExtraError: wgpu is not installed.
        GpuError: there is no such adapter.
    """
    if find_spec("wgpu") is None:
        raise MissingExtraError("--device gpu", "gpu")
    wanted = (name or os.environ.get(VARIABLE, "")).strip().lower()
    found = _adapters()
    for adapter in found:
        info = info_of(adapter)
        if wanted == SOFTWARE and info.is_software:
            return adapter
        if wanted and wanted in f"{info.name} {info.backend}".lower():
            return adapter
        if not wanted and not info.is_software:
            return adapter
    names = ", ".join(info_of(adapter).name for adapter in found) or "none"
    if wanted:
        raise GpuError(f"no GPU adapter is named {wanted!r}; there are: {names}")
    raise GpuError(
        f"no graphics card was found (adapters: {names}); install its Vulkan driver, "
        f"or use --device cpu; {VARIABLE}={SOFTWARE} takes a software adapter, for tests"
    )


def info_of(adapter: Any) -> AdapterInfo:
    """Return what an adapter says of itself."""
    info = adapter.info
    name = info.get("device") or info.get("description") or "nameless"
    text = f"{name} {info.get('vendor', '')} {info.get('description', '')}".lower()
    software = info.get("adapter_type") == "CPU" or any(word in text for word in _SOFTWARE_NAMES)
    return AdapterInfo(name, info.get("backend_type", ""), software)


def open_device(adapter: Any) -> Any:
    """Return a wgpu device whose buffers may be as large as the adapter can.

    Raises:
        GpuError: the adapter gives no device.
    """
    limits = {name: adapter.limits[name] for name in _LIMITS if name in adapter.limits}
    try:
        return adapter.request_device_sync(required_limits=limits)
    except Exception as error:  # wgpu raises errors of many kinds, RuntimeError among them.
        raise GpuError(
            f"{info_of(adapter).name} cannot be used: {error}; use --device cpu"
        ) from error


@lru_cache(maxsize=1)
def _adapters() -> list[Any]:
    """Return the adapters, the best first; asking takes a second, so it is done once."""
    with _no_display():
        every = wgpu_module().gpu.enumerate_adapters_sync()
    return sorted((one for one in every if _backend(one) in BACKENDS), key=_rank)


@contextmanager
def _no_display() -> Iterator[None]:
    """Keep a library that looks for a display from complaining where there is none."""
    name = "XDG_RUNTIME_DIR"
    if name in os.environ:
        yield
        return
    with tempfile.TemporaryDirectory() as folder:
        os.environ[name] = folder
        try:
            yield
        finally:
            del os.environ[name]


def _backend(adapter: Any) -> str:
    return adapter.info.get("backend_type", "")


def _rank(adapter: Any) -> tuple[bool, int, int]:
    kind = adapter.info.get("adapter_type", "Unknown")
    place = _ORDER.index(kind) if kind in _ORDER else len(_ORDER)
    return info_of(adapter).is_software, place, BACKENDS.index(_backend(adapter))

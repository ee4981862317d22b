"""GPU adapters, and the device with the compiled shader, created once per adapter and process.

wgpu is only imported when a GPU is requested. A software adapter renders on the CPU, slower than
the CPU kernel. It is used only if selected by name, for tests: ``W2M_GPU_ADAPTER=software``, or any
part of an adapter's name.
"""

import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.resources import files
from importlib.util import find_spec
from typing import Any

import numpy as np

from world2minecraft.core.errors import MissingExtraError, UsageError
from world2minecraft.rendering.gpu.scene_buffers import LAYOUT, buffer_bytes
from world2minecraft.rendering.gpu.uniforms import AT_CORNERS, AT_ENCODE, struct_text
from world2minecraft.rendering.scene import BlockScene

PARTS = ("rays", "elements", "shade", "picture")
# In the order of their bindings.
BINDINGS = ("parameters", "cells", "light", "tables", "texels", "labels", "tone", "views", "out")
_TYPES = {"cells": "i32", "views": "View"}
ADAPTER_VARIABLE = "W2M_GPU_ADAPTER"
SOFTWARE = "software"
_SOFTWARE_NAMES = ("llvmpipe", "lavapipe", "swiftshader", "softpipe", "microsoft basic render")
_ORDER = ("DiscreteGPU", "IntegratedGPU", "VirtualGPU", "Unknown", "CPU")
BACKENDS = ("Vulkan", "Metal", "D3D12")  # OpenGL has no compute shaders worth asking for.
_LIMITS = ("max-buffer-size", "max-storage-buffer-binding-size")


def shader_text() -> str:
    """Return the complete WGSL source of the shader."""
    folder = files("world2minecraft.rendering.gpu")
    places = LAYOUT | {"AT_ENCODE": AT_ENCODE, "AT_CORNERS": AT_CORNERS}
    constants = "".join(f"const {name}: u32 = {value}u;\n" for name, value in places.items())
    bindings = "@group(0) @binding(0) var<uniform> P: Params;\n"
    for place, name in enumerate(BINDINGS[1:], 1):
        access = "read_write" if name == "out" else "read"
        kind = f"array<{_TYPES.get(name, 'u32')}>"
        bindings += f"@group(0) @binding({place}) var<storage, {access}> {name}: {kind};\n"
    parts = [(folder / f"{name}.wgsl").read_text(encoding="utf-8") for name in PARTS]
    return "\n".join([constants, struct_text(), bindings, *parts])


@dataclass(frozen=True)
class AdapterInfo:
    """A GPU adapter of this machine."""

    name: str
    backend: str
    is_software: bool


class GpuError(UsageError):
    """The GPU cannot perform a request. The message names an alternative."""


def wgpu_module() -> Any:
    """Import wgpu and return the module."""
    return import_module("wgpu")


def list_adapters() -> list[AdapterInfo]:
    """Return the GPU adapters of this machine, best first; empty if wgpu is not installed."""
    return [info_of(adapter) for adapter in _adapters()] if find_spec("wgpu") else []


def find_adapter(name: str | None = None) -> Any:
    """Return the wgpu adapter to render with.

    Args:
        name: A part of the adapter's name, or ``software``. None uses ``W2M_GPU_ADAPTER`` if it is
            set, and otherwise the best hardware adapter.

    Raises:
        MissingExtraError: If wgpu is not installed.
        GpuError: If no such adapter is found.
    """
    if find_spec("wgpu") is None:
        raise MissingExtraError("the device gpu", "gpu")
    wanted = (name or os.environ.get(ADAPTER_VARIABLE, "")).strip().lower()
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
        raise GpuError(f"GPU adapter {wanted!r} not found; adapters: {names}")
    raise GpuError(
        f"no GPU found (adapters: {names}); install its Vulkan driver or use the CPU "
        f"(--device cpu); {ADAPTER_VARIABLE}={SOFTWARE} selects a software adapter for tests"
    )


def info_of(adapter: Any) -> AdapterInfo:
    """Return the description of an adapter."""
    info = adapter.info
    name = info.get("device") or info.get("description") or "nameless"
    text = f"{name} {info.get('vendor', '')} {info.get('description', '')}".lower()
    software = info.get("adapter_type") == "CPU" or any(word in text for word in _SOFTWARE_NAMES)
    return AdapterInfo(name, info.get("backend_type", ""), software)


def open_device(adapter: Any) -> Any:
    """Return a wgpu device with the largest buffer limits of its adapter.

    Raises:
        GpuError: If the device cannot be opened.
    """
    limits = {name: adapter.limits[name] for name in _LIMITS if name in adapter.limits}
    try:
        return adapter.request_device_sync(required_limits=limits)
    except Exception as error:  # wgpu raises errors of many kinds, RuntimeError among them.
        raise GpuError(
            f"{info_of(adapter).name} cannot be used: {error}; use the CPU (--device cpu)"
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


@dataclass(frozen=True, eq=False)
class Engine:
    """A wgpu device with its compiled pipeline."""

    name: str
    device: Any
    pipeline: Any

    def check_fits(self, scene: BlockScene) -> None:
        """Check that the buffers of a scene fit the device.

        Raises:
            GpuError: If a buffer exceeds the limit of the device.
        """
        most = min(
            self.device.limits["max-storage-buffer-binding-size"],
            self.device.limits["max-buffer-size"],
        )
        for name, size in buffer_bytes(scene).items():
            if size > most:
                shape = " x ".join(map(str, scene.tables.space.shape))
                raise GpuError(
                    f"a world of {shape} blocks is too large for {self.name}: buffer {name} needs "
                    f"{size / 1e6:,.0f} MB, the limit is {most / 1e6:,.0f} MB; "
                    "use the CPU (--device cpu) or a smaller box (--box)"
                )

    def upload(self, arrays: Mapping[str, np.ndarray]) -> dict[str, Any]:
        """Copy arrays to separate buffers on the GPU.

        Raises:
            GpuError: If the GPU memory is full.
        """
        usage = wgpu_module().BufferUsage.STORAGE
        try:
            return {
                name: self.device.create_buffer_with_data(
                    data=np.ascontiguousarray(array), usage=usage
                )
                for name, array in arrays.items()
            }
        except device_errors() as error:
            raise GpuError(
                f"cannot upload the world to {self.name}: {error}; use the CPU (--device cpu)"
            ) from error


def engine_for(adapter: Any) -> Engine:
    """Return the engine of a wgpu adapter, which is reused as long as its device works."""
    key = id(adapter)
    if key not in _ENGINES:
        device = open_device(adapter)
        module = device.create_shader_module(code=shader_text())
        pipeline = device.create_compute_pipeline(
            layout="auto", compute={"module": module, "entry_point": "main"}
        )
        _ENGINES[key] = Engine(info_of(adapter).name, device, pipeline)
    return _ENGINES[key]


def discard_engine(engine: Engine) -> None:
    """Remove an engine whose device is lost, so that a new one is created."""
    for key in [key for key, value in _ENGINES.items() if value is engine]:
        del _ENGINES[key]


def device_errors() -> tuple[type[Exception], ...]:
    """Return the exception types that wgpu raises for a lost device or full memory."""
    return RuntimeError, wgpu_module().GPUError


_ENGINES: dict[int, Engine] = {}

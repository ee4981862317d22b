"""A device with the compiled shader: made once for each adapter of a process."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.rendering.gpu.adapters import GpuError, info_of, open_device, wgpu_module
from world2minecraft.rendering.gpu.scene_buffers import bytes_of
from world2minecraft.rendering.gpu.shader import shader_text
from world2minecraft.rendering.scene import BlockScene


@dataclass(frozen=True, eq=False)
class Engine:
    """A wgpu device and its pipeline."""

    name: str
    device: Any
    pipeline: Any

    def check_fits(self, scene: BlockScene) -> None:
        """Say what does not fit.

        Raises:
            GpuError: a buffer of the scene is larger than the device takes.
        """
        most = min(
            self.device.limits["max-storage-buffer-binding-size"],
            self.device.limits["max-buffer-size"],
        )
        for name, size in bytes_of(scene).items():
            if size > most:
                shape = " x ".join(map(str, scene.tables.space.shape))
                raise GpuError(
                    f"a world of {shape} blocks is too large for {self.name}: its {name} needs "
                    f"{size / 1e6:,.0f} MB in one piece, and {most / 1e6:,.0f} MB is the most; "
                    "use --device cpu, or a smaller --box"
                )

    def upload(self, arrays: Mapping[str, np.ndarray]) -> dict[str, Any]:
        """Copy arrays to the GPU, each into a buffer of its own.

        Raises:
            GpuError: its memory is full.
        """
        usage = wgpu_module().BufferUsage.STORAGE
        try:
            return {
                name: self.device.create_buffer_with_data(
                    data=np.ascontiguousarray(array), usage=usage
                )
                for name, array in arrays.items()
            }
        except failures() as error:
            raise GpuError(
                f"{self.name} could not take the world: {error}; use --device cpu"
            ) from error


def engine_for(adapter: Any) -> Engine:
    """Return the engine of a wgpu adapter; the same one as long as its device works."""
    key = id(adapter)
    if key not in _ENGINES:
        device = open_device(adapter)
        module = device.create_shader_module(code=shader_text())
        pipeline = device.create_compute_pipeline(
            layout="auto", compute={"module": module, "entry_point": "main"}
        )
        _ENGINES[key] = Engine(info_of(adapter).name, device, pipeline)
    return _ENGINES[key]


def forget(engine: Engine) -> None:
    """Forget an engine whose device is lost, so that the next one is new."""
    for key in [key for key, value in _ENGINES.items() if value is engine]:
        del _ENGINES[key]


def failures() -> tuple[type[Exception], ...]:
    """Return what wgpu raises where a device is lost or its memory is full."""
    return RuntimeError, wgpu_module().GPUError


_ENGINES: dict[int, Engine] = {}

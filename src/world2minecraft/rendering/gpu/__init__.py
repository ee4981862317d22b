"""Rendering on the GPU by a wgpu compute shader over the tables of the scene.

``renderer_for(device, scene)`` returns a CPU or GPU renderer with the same methods. wgpu is part of
the extra ``[gpu]`` and is only imported when it is needed.
"""

from world2minecraft.rendering.gpu.backend_choice import (
    DEVICES,
    CpuRenderer,
    Renderer,
    choose_device,
    renderer_for,
)
from world2minecraft.rendering.gpu.device import AdapterInfo, GpuError, list_adapters
from world2minecraft.rendering.gpu.renderer import GpuRenderer

__all__ = [
    "DEVICES",
    "AdapterInfo",
    "CpuRenderer",
    "GpuError",
    "GpuRenderer",
    "Renderer",
    "choose_device",
    "list_adapters",
    "renderer_for",
]

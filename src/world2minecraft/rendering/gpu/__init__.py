"""Render on the GPU: a compute shader over the scene's tables, by wgpu.

``renderer_for(device, scene)`` returns a renderer for the CPU or the GPU with the
same methods. wgpu comes with the extra ``[gpu]``; nothing here imports it before it is needed.
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

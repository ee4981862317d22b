"""Rendering of many images: batches, process pools and streams.

``render_batch`` renders many poses into arrays in one call. A ``RenderPool`` renders images with
many processes. ``render_stream`` renders while earlier images are written.
"""

from world2minecraft.rendering.batch.arrays import BATCH_OUTPUTS, BatchArrays, batch_arrays
from world2minecraft.rendering.batch.drawing import render_batch
from world2minecraft.rendering.batch.pool import RenderPool
from world2minecraft.rendering.batch.streaming import render_stream

__all__ = [
    "BATCH_OUTPUTS",
    "BatchArrays",
    "RenderPool",
    "batch_arrays",
    "render_batch",
    "render_stream",
]

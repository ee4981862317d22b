"""Pictures by the thousand: batches, processes that share a scene, streams that write.

``render_batch`` fills arrays with the pictures of many poses in one call. A ``RenderPool`` takes
pictures with many processes. ``render_stream`` draws while what was drawn is written.
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

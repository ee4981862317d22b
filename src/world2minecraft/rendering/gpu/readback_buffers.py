"""Double buffers for reading images back from the GPU, so that one is rendered while one is read.

An image is rendered in bands of rows that fit into a buffer. A job is one band of one pose. A
submission consists of several jobs, which are read back together.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.rendering.gpu.device import BINDINGS, wgpu_module
from world2minecraft.rendering.gpu.uniforms import (
    PARAMETER_BYTES,
    TONE_BYTES,
    VIEW,
    PictureRequest,
    tone_words,
)
from world2minecraft.rendering.ray_caster.shading import ShadingParameters

SLOT_BYTES = 64 << 20  # Bytes of one set of buffers.
MAX_JOBS = 256  # Maximum number of jobs in a submission.
MAX_RAYS = 16_000_000  # Rays from the eye of one submission.
TILE = 8  # Pixels a side of a workgroup.


@dataclass(frozen=True)
class SubmissionPlan:
    """The division of a call into jobs: rows per band, and jobs per submission."""

    band_rows: int
    jobs: int
    words: int  # 32-bit words of one job


def plan_submissions(ask: PictureRequest, pictures: int | None) -> SubmissionPlan:
    """Divide images so that a submission fits into ``SLOT_BYTES``, with at least one row.

    ``pictures`` is the number of images, or None if it is unknown.
    """
    height, width = ask.size
    row_words = width * ask.layout.planes
    # Many samples are much work: a submission that lasts seconds is stopped by some drivers.
    most_pixels = MAX_RAYS // ask.samples**2
    room = max(min(SLOT_BYTES // 4, most_pixels * ask.layout.planes), row_words)
    band_rows = min(height, room // row_words)
    words = band_rows * row_words
    jobs = max(1, min(MAX_JOBS, room // words))
    if pictures is not None:
        jobs = min(jobs, pictures * -(-height // band_rows))
    return SubmissionPlan(band_rows, max(jobs, 1), words)


class BufferSet:
    """A set of buffers that is used by one call at a time."""

    def __init__(self, engine: Any, scene: Mapping[str, Any], out_bytes: int):
        """Create the buffers.

        Args:
            engine: Engine with ``device`` and ``pipeline``.
            scene: Buffers of the ``PackedScene`` by name.
            out_bytes: Size in bytes of the output buffer.
        """
        usage = wgpu_module().BufferUsage
        self.scene, self.out_bytes, self._engine, self._bytes = scene, out_bytes, engine, 0
        self._promise: Any = None
        self._shading: ShadingParameters | None = None

        def made(size: int, flags: int) -> Any:
            return engine.device.create_buffer(size=size, usage=flags)

        self._own = {
            "parameters": made(PARAMETER_BYTES, usage.UNIFORM | usage.COPY_DST),
            "tone": made(TONE_BYTES, usage.STORAGE | usage.COPY_DST),
            "views": made(MAX_JOBS * VIEW.itemsize, usage.STORAGE | usage.COPY_DST),
            "out": made(out_bytes, usage.STORAGE | usage.COPY_SRC),
        }
        self._back = made(out_bytes, usage.COPY_DST | usage.MAP_READ)
        named = {**scene, **self._own}
        self._group = engine.device.create_bind_group(
            layout=engine.pipeline.get_bind_group_layout(0),
            entries=[
                {"binding": place, "resource": {"buffer": one, "offset": 0, "size": one.size}}
                for place, one in enumerate(named[name] for name in BINDINGS)
            ],
        )

    def prepare(self, parameters: bytes, shading: ShadingParameters) -> None:
        """Set the resources for the next submission."""
        self._write("parameters", parameters)
        if self._shading is not shading:
            self._write("tone", tone_words(shading))
            self._shading = shading

    def _write(self, name: str, data: bytes | np.ndarray) -> None:
        self._engine.device.queue.write_buffer(self._own[name], 0, data)

    def submit(self, views: np.ndarray, ask: PictureRequest, plan: SubmissionPlan) -> None:
        """Start to render some views, ``VIEW`` [N]."""
        self._write("views", views)
        self._bytes = 4 * plan.words * len(views)
        encoder = self._engine.device.create_command_encoder()
        work = encoder.begin_compute_pass()
        work.set_pipeline(self._engine.pipeline)
        work.set_bind_group(0, self._group)
        work.dispatch_workgroups(-(-ask.size[1] // TILE), -(-plan.band_rows // TILE), len(views))
        work.end()
        encoder.copy_buffer_to_buffer(self._own["out"], 0, self._back, 0, self._bytes)
        self._engine.device.queue.submit([encoder.finish()])
        self._promise = self._back.map_async("READ", 0, self._bytes)

    def words(self) -> np.ndarray:
        """Wait for the submission and return its data as a uint32 view, valid until ``release``."""
        self._promise.sync_wait()
        return np.frombuffer(self._back.read_mapped(0, self._bytes, copy=False), np.uint32)

    def release(self) -> None:
        """Release the data, so that the buffers can be reused."""
        if self._promise is not None:
            self._promise.sync_wait()
            self._back.unmap()
            self._promise = None

    def destroy(self) -> None:
        """Free the GPU memory."""
        for buffer in (*self._own.values(), self._back):
            buffer.destroy()

"""Rendering by a compute shader: the scene is uploaded once, then poses are turned into images."""

from collections import deque
from collections.abc import Collection, Iterable, Iterator, Sized
from dataclasses import dataclass, replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.rendering.gpu.device import (
    GpuError,
    device_errors,
    discard_engine,
    engine_for,
    find_adapter,
)
from world2minecraft.rendering.gpu.readback_buffers import (
    BufferSet,
    SubmissionPlan,
    plan_submissions,
)
from world2minecraft.rendering.gpu.scene_buffers import pack_scene
from world2minecraft.rendering.gpu.uniforms import (
    VIEW,
    PictureRequest,
    PlaneLayout,
    check_pose,
    entry_distance,
    parameter_bytes,
    plane_layout,
    view_of,
)
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.observed_free_space import observed_free_space
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS, Picture, check_request, picture_of
from world2minecraft.rendering.picture_arrays import PixelArrays, pixel_arrays
from world2minecraft.rendering.ray_caster.picture_kernel import INSTANCE, SEMANTIC
from world2minecraft.rendering.ray_caster.ray import GridCamera
from world2minecraft.rendering.ray_caster.shading import ShadingParameters
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import DAY, Backdrop, shading_parameters

MAX_IN_FLIGHT = 2  # Submissions under way: one is drawn while another is read.
MAX_FREE = MAX_IN_FLIGHT  # Sets of buffers that are kept for the next call.
LOST = "the GPU {} no longer responds: {}; use the CPU (--device cpu)"


def unpack_rows(arrays: PixelArrays, planes: np.ndarray, row: int, layout: PlaneLayout) -> None:
    """Copy a band of rows from the GPU into the output arrays.

    Args:
        arrays: Output arrays of the whole image, H x W.
        planes: Data of the band, uint32 [planes, rows, W]. Rows beyond the image are ignored.
        row: First row of the band.
        layout: Contents of the planes.
    """
    last = min(row + planes.shape[1], len(arrays.depth))
    rows, planes = slice(row, last), planes[:, : last - row]
    real, whole = planes.view(np.float32), planes.view(np.int32)
    arrays.depth[rows], arrays.distance[rows] = real[0], real[1]
    arrays.index[rows] = whole[2]
    packed = planes[3].view(np.uint8).reshape(*planes.shape[1:], 4)
    arrays.face[rows] = packed[..., 3]
    arrays.thing[rows] = whole[layout.thing] if layout.thing >= 0 else -1
    if layout.label >= 0:
        halves = planes[layout.label].view(np.uint16).reshape(*planes.shape[1:], 2)
        if arrays.wanted & SEMANTIC:
            arrays.semantic[rows] = halves[..., 0]
        if arrays.wanted & INSTANCE:
            arrays.instance[rows] = halves[..., 1]
    if layout.colour:
        arrays.colour[rows] = packed[..., :3]
    if layout.opaque >= 0:
        arrays.opaque_depth[rows] = real[layout.opaque]
        arrays.opaque_index[rows] = whole[layout.opaque + 1]
        arrays.opaque_thing[rows] = whole[layout.opaque + 2]
    for axis in range(3) if layout.normal >= 0 else ():
        arrays.normal[rows, :, axis] = real[layout.normal + axis]


class GpuRenderer:
    """A renderer that uses the GPU, with the same methods as ``CpuRenderer``.

    It must be used from one thread at a time. A lost device is reopened once per call.
    """

    def __init__(self, scene: BlockScene, *, adapter: str | None = None):
        """Copy a scene to the GPU.

        Args:
            scene: The scene to render.
            adapter: A part of an adapter's name, or ``software``. None uses the best hardware
                adapter.

        Raises:
            MissingExtraError: If wgpu is not installed.
            GpuError: If the adapter is not found, or if the scene does not fit its memory.
        """
        self._adapter = find_adapter(adapter)
        self._scene = scene
        self._open()

    @property
    def name(self) -> str:
        """The name of the GPU adapter."""
        return self._engine.name

    def update(self, scene: BlockScene) -> None:
        """Replace the scene to render; also call this after blocks of the scene have changed."""
        self._scene = scene
        self._close_buffers()
        self._open()

    def close(self) -> None:
        """Release the GPU memory. The renderer cannot be used afterwards."""
        self._close_buffers()

    def render(
        self,
        camera: Camera,
        camera_to_room: np.ndarray,
        *,
        outputs: Collection[str] = DEFAULT_OUTPUTS,
        light: LightSettings = DAY,
        samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:
        """Render an image. The arguments are those of ``render_volume``."""
        (picture,) = self.render_many(
            camera, [camera_to_room], outputs=outputs, light=light, samples=samples,
            background=background,
        )  # fmt: skip
        return picture

    def render_many(
        self,
        camera: Camera,
        poses: Iterable[np.ndarray],
        *,
        outputs: Collection[str] = DEFAULT_OUTPUTS,
        light: LightSettings = DAY,
        samples: int = 1,
        background: Backdrop | None = None,
    ) -> Iterator[Picture]:
        """Yield an image for each pose, in order. Some poses are read ahead.

        Args:
            camera: Camera for all poses.
            poses: ``camera_to_room`` matrices, 4x4 each.
            outputs: Requested outputs, as for ``render_volume``.
            light: Light settings, such as the time of day and the exposure.
            samples: Each pixel's colour is the mean of ``samples`` x ``samples`` rays.
            background: sRGB colours of the first and last row of the background.

        Raises:
            ValueError: If ``render_volume`` would reject an argument, or if a pose contains NaN or
                infinity.
            GpuError: If the GPU no longer responds.
        """
        rays = (camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px)
        size = (camera.height_px, camera.width_px)
        yield from self._pictures(rays, 1.0, size, poses, outputs, light, samples, background)

    def render_parallel(
        self,
        px_per_metre: float,
        size: tuple[int, int],
        camera_to_room: np.ndarray,
        *,
        outputs: Collection[str] = DEFAULT_OUTPUTS,
        light: LightSettings = DAY,
        samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:
        """Render an orthographic image. See ``rendering.picture.render_parallel``."""
        rays = (px_per_metre, px_per_metre, size[1] / 2, size[0] / 2)
        (picture,) = self._pictures(
            rays, 0.0, size, [camera_to_room], outputs, light, samples, background
        )
        return picture

    def _open(self) -> None:
        self._engine = engine_for(self._adapter)
        self._engine.check_fits(self._scene)
        scene = pack_scene(self._scene)
        self._offsets = scene.offsets
        self._buffers = self._engine.upload(scene.buffers)
        self._free: list[BufferSet] = []

    def _close_buffers(self) -> None:
        for slot in self._free:
            slot.destroy()
        for buffer in self._buffers.values():
            buffer.destroy()
        self._free, self._buffers = [], {}

    def _pictures(
        self, rays, spread, size, poses, outputs, light, samples, background
    ) -> Iterator[Picture]:
        check_request(outputs, size, samples)
        scene = self._scene
        layout = plane_layout(tuple(outputs), len(scene.things) > 0)
        ask = PictureRequest(size, rays, spread, samples, layout)
        plan = plan_submissions(ask, _count(poses))

        def jobs() -> Iterator[_Job]:
            """Yield one job for each band of rows of each pose."""
            for camera_to_room in poses:
                pose = (scene.room_to_grid @ np.asarray(camera_to_room, np.float64))[:3]
                check_pose(pose)
                shading = shading_parameters(
                    light, scene, background, pose[:, 3][None] if spread else None
                )
                for row in range(0, size[0], plan.band_rows):
                    yield _Job(pose, row, shading)

        for pose, arrays in self._drawn(ask, plan, group_jobs(jobs(), plan.jobs), outputs):
            picture = picture_of(arrays, outputs)
            if "free" in outputs:
                grid_camera = GridCamera(pose, np.array(rays), spread)
                free = observed_free_space(scene.tables, grid_camera, arrays.depth)
                picture = replace(picture, free=free)
            yield picture

    def _drawn(
        self,
        ask: PictureRequest,
        plan: SubmissionPlan,
        lots: "Iterator[list[_Job]]",
        outputs: Collection[str],
    ) -> Iterator[tuple[np.ndarray, PixelArrays]]:
        """Draw lots of jobs; two submissions are under way at a time."""
        under_way: deque[_Work] = deque()
        arrays, lost = pixel_arrays((1, 1), ()), False
        try:
            while True:
                under_way += [_Work(lot) for lot in islice(lots, MAX_IN_FLIGHT - len(under_way))]
                if not under_way:
                    return
                try:
                    words = self._begin(under_way, ask, plan)
                except device_errors() as error:
                    if lost:
                        raise GpuError(LOST.format(self.name, error)) from error
                    lost = True
                    self._open_again(under_way)
                    continue
                for job, planes in zip(under_way[0].jobs, words, strict=True):
                    arrays = pixel_arrays(ask.size, outputs) if job.row == 0 else arrays
                    unpack_rows(arrays, planes, job.row, ask.layout)
                    if job.row + plan.band_rows >= ask.size[0]:
                        yield job.pose, arrays
                self._give_back(under_way.popleft().slot)
        finally:
            for work in under_way:
                self._give_back(work.slot)

    def _begin(
        self, under_way: "deque[_Work]", ask: PictureRequest, plan: SubmissionPlan
    ) -> np.ndarray:
        """Submit what is not yet; return the first one's words [jobs, planes, rows, W]."""
        for work in under_way:
            if work.slot is None:
                work.slot = self._slot(4 * plan.words * plan.jobs)
                shading = work.jobs[0].shading
                parameters = parameter_bytes(
                    ask, shading, self._scene, self._offsets, plan.band_rows
                )
                work.slot.prepare(parameters, shading)
                work.slot.submit(_views(work.jobs, self._scene, ask), ask, plan)
        first = under_way[0]
        shape = (len(first.jobs), ask.layout.planes, plan.band_rows, ask.size[1])
        return first.slot.words().reshape(shape) if first.slot else np.empty(shape, np.uint32)

    def _open_again(self, under_way: "deque[_Work]") -> None:
        """Open the device again after it was lost."""
        discard_engine(self._engine)
        for work in under_way:
            work.slot = None
        self._open()

    def _slot(self, out_bytes: int) -> BufferSet:
        """Return a set of buffers of a size."""
        for place, slot in enumerate(self._free):
            if slot.out_bytes == out_bytes:
                return self._free.pop(place)
        return BufferSet(self._engine, self._buffers, out_bytes)

    def _give_back(self, slot: BufferSet | None) -> None:
        if slot is None:
            return
        try:
            slot.release()
        except device_errors():  # Its device is lost.
            return
        if slot.scene is not self._buffers:  # The scene has changed since.
            slot.destroy()
            return
        self._free.append(slot)
        if len(self._free) > MAX_FREE:
            self._free.pop(0).destroy()


class _Job(NamedTuple):
    """One band of rows of one picture."""

    pose: np.ndarray  # float64 [3, 4], camera to grid
    row: int  # the band's first
    shading: ShadingParameters


@dataclass
class _Work:
    """Jobs of one submission, and the buffers that it was submitted with."""

    jobs: list[_Job]
    slot: BufferSet | None = None


def group_jobs(jobs: Iterable[_Job], most: int) -> Iterator[list[_Job]]:
    """Yield groups of up to a given number of jobs, in order, with one light per group."""
    lot: list[_Job] = []
    for job in jobs:
        if lot and (len(lot) == most or lot[0].shading is not job.shading):
            yield lot
            lot = []
        lot.append(job)
    if lot:
        yield lot


def _count(poses: object) -> int | None:
    return len(poses) if isinstance(poses, Sized) else None


def _views(jobs: list[_Job], scene: BlockScene, ask: PictureRequest) -> np.ndarray:
    shape = scene.tables.space.shape
    ahead = [0.0 if ask.spread else entry_distance(job.pose, shape) for job in jobs]
    views = [view_of(job.pose, job.row, way) for job, way in zip(jobs, ahead, strict=True)]
    return np.array(views, VIEW)

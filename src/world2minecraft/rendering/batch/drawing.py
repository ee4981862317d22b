"""Rendering of images for many poses in one call."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.rendering.batch.arrays import (
    BatchArrays,
    BatchPart,
    BatchPixels,
    Size,
    array_specs,
    batch_arrays,
    check_arrays,
    check_batch,
    draw_poses,
    kernel_arrays,
)
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.observed_free_space import observed_free_space
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS
from world2minecraft.rendering.picture_arrays import PixelArrays, pixel_arrays
from world2minecraft.rendering.ray_caster.picture_kernel import TILE, band_memory, draw_rows
from world2minecraft.rendering.ray_caster.ray import GridCamera
from world2minecraft.rendering.ray_caster.shading import ShadingParameters
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.scene_tables import SceneTables
from world2minecraft.rendering.shading_parameters import DAY, Backdrop, shading_parameters
from world2minecraft.rendering.thread_pool import bands, run_parallel

LARGE_PX = 200_000  # For larger images, threads share each image instead of the poses.


@dataclass(frozen=True, eq=False)
class KernelScene:
    """The scene in the form that the kernels read."""

    tables: SceneTables
    side_px: int


@dataclass(frozen=True, eq=False)
class Views:
    """N cameras of one size in the form that the kernels read."""

    size: Size
    poses: np.ndarray  # float64 [N, 3, 4], camera to grid
    rays: np.ndarray  # float64 [N, 4]: fx, fy, cx, cy in pixels


def render_batch(
    scene: BlockScene,
    cameras: Camera | Sequence[Camera],
    poses: np.ndarray | Sequence[np.ndarray],
    *,
    outputs: Collection[str] = DEFAULT_OUTPUTS,
    light: LightSettings = DAY,
    samples: int = 1,
    threads: int = 1,
    background: Backdrop | None = None,
    out: BatchArrays | None = None,
) -> BatchArrays:
    """Render images for many camera poses in one kernel call.

    All images share one exposure, computed from all eye positions, unless the light or the scene
    defines one. The result does not depend on the number of threads.

    Args:
        scene: The result of ``prepare_scene`` for a volume, or ``EditableScene.scene``.
        cameras: One camera for all poses, or one camera for each pose, all of the same size.
        poses: ``camera_to_room`` matrices, float64 [N, 4, 4].
        outputs: Outputs from ``BATCH_OUTPUTS``. Only these are computed.
        light: Light settings, such as the time of day and the exposure.
        samples: Each pixel's colour is the mean of ``samples`` x ``samples`` rays.
        threads: Number of threads.
        background: sRGB colours of the first and last row of the background. None uses the sky.
        out: Arrays of an earlier batch, or from ``batch_arrays``, to be filled. None creates new
            arrays.

    Raises:
        UsageError: If an argument is invalid, or if ``out`` does not match the other arguments.
    """
    matrices = checked_poses(poses)
    each = checked_cameras(cameras, len(matrices))
    size = (each[0].height_px, each[0].width_px) if each else (1, 1)
    check_batch(len(matrices), size, samples)
    shape = scene.semantic.shape
    rooms = array_specs(len(matrices), size, outputs, shape)
    arrays = out or batch_arrays(len(matrices), size, outputs, shape)
    if out is not None:
        check_arrays(out, rooms)
    if len(matrices) == 0:
        return arrays
    views = views_of(scene, each, matrices)
    shading = shading_parameters(light, scene, background, views.poses[:, :, 3])
    draw_views(
        KernelScene(scene.tables, scene.side_px), views, shading, outputs, samples, threads, arrays
    )
    return arrays


def views_of(scene: BlockScene, cameras: Sequence[Camera], poses: np.ndarray) -> Views:
    """Return N >= 1 cameras of one size with their poses, float64 [N, 4, 4], in a scene."""
    first = cameras[0]
    return Views(
        (first.height_px, first.width_px),
        np.stack([(scene.room_to_grid @ pose)[:3] for pose in poses]),
        np.array([[one.fx_px, one.fy_px, one.cx_px, one.cy_px] for one in cameras], np.float64),
    )


def checked_poses(poses: np.ndarray | Sequence[np.ndarray]) -> np.ndarray:
    """Return poses as float64 [N, 4, 4].

    Raises:
        UsageError: If the shape is wrong, or if a number is not finite.
    """
    matrices = np.asarray(poses, np.float64)
    if matrices.size == 0:
        return np.empty((0, 4, 4))
    if matrices.ndim != 3 or matrices.shape[1:] != (4, 4):
        raise UsageError(f"poses must have shape [N, 4, 4], got {list(matrices.shape)}")
    wrong = np.flatnonzero(~np.isfinite(matrices).all(axis=(1, 2)))
    if len(wrong):
        raise UsageError(f"pose {wrong[0]} contains NaN or infinity")
    return matrices


def checked_cameras(cameras: Camera | Sequence[Camera], count: int) -> Sequence[Camera]:
    """Return a camera for each pose, all of the same size.

    Raises:
        UsageError: If the number of cameras is wrong, or if their sizes differ.
    """
    each = [cameras] * count if isinstance(cameras, Camera) else list(cameras)
    if len(each) != count:
        raise UsageError(f"{count} poses need one camera or {count} cameras, got {len(each)}")
    for number, camera in enumerate(each):
        if (camera.width_px, camera.height_px) != (each[0].width_px, each[0].height_px):
            raise UsageError(
                f"all images of a batch must have the same size: camera {number} has "
                f"{camera.width_px}x{camera.height_px}, camera 0 has "
                f"{each[0].width_px}x{each[0].height_px}; use RenderPool for different sizes"
            )
    return each


def draw_views(
    scene: KernelScene,
    views: Views,
    shading: ShadingParameters,
    outputs: Collection[str],
    samples: int,
    threads: int,
    arrays: BatchArrays,
) -> None:
    """Render N views into the matching arrays of a batch."""
    fine = "colour" in outputs and samples > 1
    count, (height, width) = len(views.poses), views.size
    depth = arrays.depth_m
    if "free" in outputs and depth is None:
        depth = np.empty((count, height, width), np.float32)
    by_rows = fine or count < 4 * threads or height * width > LARGE_PX
    slots = 1 if by_rows else max(1, threads)
    out = kernel_arrays(arrays, views.size, slots, outputs, fine=fine)
    if depth is not None:
        out = out._replace(depth=depth)
    out.normal[...] = 0.0
    draw = _drawer(scene, views, shading, samples, out)
    if by_rows:
        parts = bands(height, max(1, threads), TILE)
        run_parallel(lambda rows: draw(0, 1, rows, 0), parts)
    else:
        run_parallel(lambda slot: draw(slot, slots, (0, height), slot), range(slots))
    if arrays.free is not None and depth is not None:
        for n in range(count):
            camera = GridCamera(views.poses[n], views.rays[n], 1.0)
            arrays.free[n] = observed_free_space(scene.tables, camera, depth[n])


Drawer = Callable[[int, int, tuple[int, int], int], None]


def _drawer(
    scene: KernelScene, views: Views, shading: ShadingParameters, samples: int, out: BatchPixels
) -> Drawer:
    """Return what draws some rows of every so many pictures."""
    height, width = views.size
    separate = samples > 1 and out.colour.shape[1:3] == views.size
    fine = pixel_arrays((height * samples, width * samples), ("colour",)) if separate else None

    def draw(start: int, stride: int, rows: tuple[int, int], slot: int) -> None:
        """Render some rows of every ``stride``-th image with the arrays of a slot."""
        memory = band_memory()
        part = BatchPart(start, stride, *rows, slot)
        draw_poses(scene.tables, scene.side_px, views.poses, views.rays, part, shading, memory, out)
        if fine is None:
            return
        for n in range(start, len(views.poses), stride):
            camera = GridCamera(views.poses[n], views.rays[n] * samples, 1.0)
            draw_rows(
                scene.tables, scene.side_px, camera, rows[0] * samples, rows[1] * samples,
                shading, memory, fine,
            )  # fmt: skip
            _shrink(fine, samples, rows, out.colour[n])

    return draw


def _shrink(fine: PixelArrays, samples: int, rows: tuple[int, int], colour: np.ndarray) -> None:
    """Average each samples x samples square of ``fine`` into a pixel of ``colour``.

    Args:
        fine: An image ``samples`` times as large as ``colour``.
        samples: Side length of a square in pixels.
        rows: First row of ``colour`` to write and last row + 1.
        colour: The result, uint8 [H, W, 3].
    """
    first, last = rows
    part = fine.colour[first * samples : last * samples]
    squares = part.reshape(last - first, samples, -1, samples, 3)
    total = squares.sum(axis=(1, 3), dtype=np.uint16)
    colour[first:last] = (total + samples * samples // 2) // (samples * samples)

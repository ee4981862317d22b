"""Rendering of several shots one after another, as used by all commands and data sets.

Code that writes files in parallel or distributes the work over processes is built on this module.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from itertools import repeat
from types import ModuleType

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera
from world2minecraft.rendering.batch.pool import RenderPool
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import Picture, render_volume
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import DAY, Backdrop, exposure_of
from world2minecraft.rendering.views.cameras import Shot

GPU = "world2minecraft.rendering.gpu"  # Loaded late: most machines have no use for it.
MIN_PICTURES_PER_JOB = 16  # Pictures: a process takes some seconds to begin.


@dataclass(frozen=True)
class DrawOptions:
    """Rendering options, each with the meaning of the ``render_volume`` argument of that name.

    ``device`` is ``cpu``, ``gpu`` or ``auto``, which uses a GPU if there is one. ``jobs`` is the
    number of processes that render in parallel (``rendering.batch``), each on one CPU thread.
    """

    outputs: tuple[str, ...] = ("colour",)
    light: LightSettings = DAY
    samples: int = 1
    threads: int = 1
    background: Backdrop | None = None
    device: str = "cpu"
    jobs: int = 1


def draw_frames(
    scene: BlockScene,
    cameras: Camera | Iterable[Camera],
    poses: Iterable[np.ndarray],
    options: DrawOptions | None = None,
) -> Iterator[Picture]:
    """Yield the images for a sequence of camera poses, in order.

    Several processes are started only if each has a few images to render. Their images share one
    exposure.

    Args:
        scene: The result of ``prepare_scene`` for a volume.
        cameras: One camera for all poses, or one camera for each pose.
        poses: ``camera_to_room`` matrices, float64 [4, 4] each.
        options: Rendering options.

    Raises:
        ValueError: If ``render_volume`` rejects an option.
        UsageError: If the device is not available.
    """
    how = options or DrawOptions()
    each = repeat(cameras) if isinstance(cameras, Camera) else cameras
    if how.jobs > 1:
        shots = list(zip(each, poses, strict=False))
        jobs = min(how.jobs, len(shots) // MIN_PICTURES_PER_JOB)
        if jobs > 1:
            yield from _by_processes(scene, shots, replace(how, jobs=jobs))
            return
        each, poses = [camera for camera, _ in shots], [pose for _, pose in shots]
    with _drawing(scene, how) as draw:
        for camera, camera_to_room in zip(each, poses, strict=False):
            yield draw(
                camera,
                camera_to_room,
                outputs=how.outputs,
                light=how.light,
                samples=how.samples,
                background=how.background,
            )


def _by_processes(
    scene: BlockScene, shots: Sequence[tuple[Camera, np.ndarray]], how: DrawOptions
) -> Iterator[Picture]:
    cameras, poses = [camera for camera, _ in shots], [pose for _, pose in shots]
    with RenderPool(scene, how.jobs) as pool:
        pictures = pool.render(
            cameras,
            poses,
            outputs=how.outputs,
            light=how.light,
            samples=how.samples,
            background=how.background,
        )
        for _, picture in pictures:
            yield picture


@contextmanager
def _drawing(scene: BlockScene, how: DrawOptions) -> Iterator[Callable[..., Picture]]:
    """Yield a function that takes pictures of a scene on the chosen device."""
    module = None if how.device == "cpu" else _gpu_module(how.device)
    if module is None:
        yield partial(render_volume, scene, threads=how.threads)
        return
    renderer = module.renderer_for(how.device, scene, threads=how.threads)
    try:
        yield renderer.render
    finally:
        renderer.close()


def _gpu_module(device: str) -> ModuleType | None:
    """Return what draws on a graphics card; None where ``auto`` may do without."""
    try:
        return import_module(GPU)
    except ImportError:
        if device == "auto":
            return None
        raise UsageError(f"device {device!r} is not available in this version; use cpu") from None


def draw_shots(
    scene: BlockScene, shots: Collection[Shot], options: DrawOptions | None = None
) -> Iterator[Picture]:
    """Yield the images for a sequence of shots. See ``draw_frames``."""
    cameras, poses = [shot.camera for shot in shots], [shot.camera_to_room for shot in shots]
    return draw_frames(scene, cameras, poses, options)


def with_common_exposure(
    scene: BlockScene, light: LightSettings, shots: Sequence[Shot]
) -> BlockScene:
    """Return the scene with an exposure suited to the light around all cameras.

    One exposure is used for all shots, so that the images of a tour match.

    Args:
        scene: The result of ``prepare_scene`` for a volume.
        light: Light settings.
        shots: The shots. Cameras outside the volume are ignored.
    """
    eyes = np.array([apply(scene.room_to_grid, shot.camera_to_room[:3, 3]) for shot in shots])
    return replace(scene, exposure=exposure_of(light, scene, eyes))

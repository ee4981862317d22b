"""Photorealistic images of a block scene: path-traced, denoised and exposed."""

import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, fields
from itertools import pairwise
from multiprocessing.pool import ThreadPool

import numpy as np

from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.light.exposure import LUMINANCE
from world2minecraft.rendering.path_tracing.emitters import Emitters, emitters_of
from world2minecraft.rendering.path_tracing.film import Film, new_film
from world2minecraft.rendering.path_tracing.film_development import (
    SEEN_POWER,
    dodging,
    irradiance,
    picture_exposure,
    screen_colours,
    surface_light,
)
from world2minecraft.rendering.path_tracing.path_kernel import trace_rows
from world2minecraft.rendering.path_tracing.scattering import PathScene, new_path
from world2minecraft.rendering.path_tracing.sky_light import sky_light
from world2minecraft.rendering.picture import MAX_PIXELS, Picture, render_volume
from world2minecraft.rendering.ray_caster.ray import GridCamera
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import DAY

OUTPUTS = ("depth", "semantic", "instance", "opaque", "normal")
MAX_SAMPLES = 4096
MAX_DEPTH = 64
BAND_ROWS = 8  # Rows that a thread takes at a time.
PASS_SAMPLES = 4  # Samples a pixel between two looks at the clock.


@dataclass(frozen=True, eq=False)
class Photo(Picture):
    """A path-traced image. Depth, ids and normals are those of ``Picture``.

    ``albedo`` is the diffuse reflectance of the first surface behind glass, tinted by the glass.
    """

    radiance: np.ndarray | None = None  # float32 [H, W, 3], linear; times exposure it is shown
    albedo: np.ndarray | None = None  # float32 [H, W, 3]
    exposure: float = 1.0
    samples: int = 0  # that each pixel got: fewer than requested where the budget ended


def render_photo(
    scene: BlockScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    light: LightSettings = DAY,
    samples: int = 16,
    seed: int = 0,
    depth: int = 8,
    threads: int = 1,
    denoise: bool = True,
    budget_s: float | None = None,
    progress: Progress = no_progress,
    emitters: Emitters | None = None,
    lamps: Emitters | None = None,
) -> Photo:
    """Render a path-traced image of a scene.

    Args:
        scene: The result of ``prepare_scene``.
        camera: Camera intrinsics. Distortion is ignored.
        camera_to_room: Camera pose, 4x4, OpenCV axes, metres.
        light: Time of day, and the exposure unless it is determined automatically.
        samples: Paths per pixel, 1 to 4096.
        seed: Random seed. The same seed gives the same image for any number of threads.
        depth: Maximum number of surfaces on a light path, 1 to 64. 1 is direct light only.
        threads: Number of bands of rows traced in parallel.
        denoise: Whether to denoise the light.
        budget_s: Wall-clock seconds after which no further pass starts. At least one pass is made.
        progress: Callback for the stage ``photo`` after each pass, with the samples done and the
            remaining time.
        emitters: The result of ``emitters_of(scene)``, to reuse for several images of a scene.
        lamps: Former name of ``emitters``.

    Raises:
        ValueError: If a number is out of range, or if the light preset has no time of day.
    """
    _check(camera, samples, depth)
    sky = sky_light(light)
    if lamps is not None:
        warnings.warn("lamps is deprecated; use emitters", DeprecationWarning, stacklevel=2)
        emitters = lamps
    emitters = emitters_of(scene) if emitters is None else emitters
    pose = np.ascontiguousarray((scene.room_to_grid @ camera_to_room)[:3], np.float64)
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    path_scene = PathScene(scene.tables, scene.material, scene.side_px, light.tone.decode)
    grid_camera = GridCamera(pose, rays, 1.0)
    film = new_film(camera.height_px, camera.width_px)

    def band(rows: tuple[int, int], of: tuple[int, int]) -> None:
        trace_rows(
            path_scene, emitters, sky, grid_camera, rows, of, np.uint32(seed & 0xFFFFFFFF), depth,
            new_path(), film,
        )  # fmt: skip

    with _Bands(threads) as run:
        done = _trace_passes(band, run, len(film.far), samples, budget_s, progress)
        surfaces = surface_light(film, denoise, run)
    picture = render_volume(scene, camera, camera_to_room, outputs=OUTPUTS, threads=threads)
    return _develop(picture, light, film, surfaces, done)


def _check(camera: Camera, samples: int, depth: int) -> None:
    if not 1 <= samples <= MAX_SAMPLES:
        raise ValueError(f"samples must be 1 to {MAX_SAMPLES}, got {samples}")
    if not 1 <= depth <= MAX_DEPTH:
        raise ValueError(f"depth must be 1 to {MAX_DEPTH}, got {depth}")
    if camera.width_px * camera.height_px > MAX_PIXELS // 8:
        most = f"{MAX_PIXELS // 8:,}"
        raise ValueError(
            f"a photo may have at most {most} pixels, got {camera.width_px}x{camera.height_px}"
        )


class _Bands:
    """Runs a function over bands of rows, on some threads."""

    def __init__(self, threads: int):
        self._pool = ThreadPool(threads) if threads > 1 else None

    def __enter__(self) -> "_Bands":
        return self

    def __exit__(self, *_: object) -> None:
        if self._pool is not None:
            self._pool.terminate()

    def __call__(self, band: Callable[[tuple[int, int]], None], rows: int) -> None:
        bands = pairwise([*range(0, rows, BAND_ROWS), rows])
        if self._pool is None:
            for one in bands:
                band(one)
        else:
            self._pool.map(band, bands, chunksize=1)


def _trace_passes(
    band: Callable[[tuple[int, int], tuple[int, int]], None],
    run: _Bands,
    rows: int,
    samples: int,
    budget_s: float | None,
    progress: Progress,
) -> int:
    """Trace pass by pass; return how many samples each pixel got."""
    start, done = time.monotonic(), 0
    while done < samples:
        until = min(done + PASS_SAMPLES, samples)
        run(lambda one, of=(done, until): band(one, of), rows)
        done = until
        spent = time.monotonic() - start
        left = spent / done * (samples - done)
        progress("photo", done, samples, f"{left:.0f} s left")
        if budget_s is not None and spent >= budget_s:
            break
    return done


def _develop(
    picture: Picture, light: LightSettings, film: Film, surfaces: np.ndarray, done: int
) -> Photo:
    exposure, bright = light.exposure, irradiance(surfaces, film)
    if exposure is None:
        daylight = min(float(LUMINANCE @ light.sky.light), 1.0)
        exposure = picture_exposure(bright, film, daylight)
    count = np.float32(done)
    surfaces = surfaces * dodging(bright, exposure)
    radiance = surfaces + film.seen / count * np.float32(exposure ** (SEEN_POWER - 1))
    return Photo(
        **{
            field.name: getattr(picture, field.name)
            for field in fields(picture)
            if field.name != "colour"
        },
        colour=screen_colours(radiance, exposure, light.tone),
        radiance=radiance.astype(np.float32),
        albedo=(film.share + film.other_share) / count,
        exposure=exposure,
        samples=done,
    )

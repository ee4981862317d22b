"""Pictures of block volumes, through a camera of the room."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from itertools import pairwise
from multiprocessing.pool import ThreadPool

import numpy as np

from world2minecraft.render.cubes import draw_cubes, pixel_bounds
from world2minecraft.render.scene import RayScene, prepare_scene
from world2minecraft.render.shade import TILE, draw_rows
from world2minecraft.types import BlockVolume, Camera

OUTPUTS = ("colour", "depth", "semantic", "instance")
# A quiet, warm light grey, a little darker towards the bottom.
BACKGROUND = ((238, 238, 236), (214, 214, 212))
MAX_PIXELS = 64_000_000  # Two gigabytes of outputs.


@dataclass(frozen=True, eq=False)
class Picture:
    """What one look at a volume gives; arrays that were not asked for are None.

    Where a ray meets nothing, depth and range are 0, ``block_index`` is -1, ``face`` is 255,
    ``semantic`` and ``instance`` are 0. Where it meets a display entity ``block_index`` is -1 too,
    ``cube_index`` is 0 or more, and ``face`` the one of a block that looks most like it.
    """

    depth_m: np.ndarray  # float32 [H, W], z-depth
    range_m: np.ndarray  # float32 [H, W], along the ray
    block_index: np.ndarray  # int32 [H, W], C-order index into volume.states
    face: np.ndarray  # uint8 [H, W], of block axes: -x +x -y +y -z +z
    colour: np.ndarray | None = None  # uint8 [H, W, 3]
    semantic: np.ndarray | None = None  # uint8 [H, W]
    instance: np.ndarray | None = None  # uint16 [H, W]
    cube_index: np.ndarray | None = None  # int32 [H, W], into the scene's cubes; -1 for none


def render_volume(
    volume: BlockVolume | RayScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    outputs: Collection[str] = OUTPUTS,
    threads: int = 1,
    background: tuple[tuple[int, int, int], tuple[int, int, int]] = BACKGROUND,
) -> Picture:
    """Take a picture of a volume.

    Args:
        volume: the blocks, or their scene where many pictures are taken.
        camera: intrinsics; its distortion is ignored.
        camera_to_room: 4x4, OpenCV axes, metres.
        outputs: which of ``OUTPUTS`` to make; depth, range, block and face always come.
        threads: how many bands of rows are drawn at a time; the result is the same for any.
        background: colours of the sky's first and last row.

    Raises:
        ValueError: an output is not known, or the image has over 64 million pixels.
    """
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    size = (camera.height_px, camera.width_px)
    return _draw(volume, rays, 1.0, camera_to_room, size, outputs, threads, background)


def render_parallel(
    volume: BlockVolume | RayScene,
    px_per_metre: float,
    size: tuple[int, int],
    camera_to_room: np.ndarray,
    *,
    outputs: Collection[str] = OUTPUTS,
    threads: int = 1,
    background: tuple[tuple[int, int, int], tuple[int, int, int]] = BACKGROUND,
) -> Picture:
    """Take a picture by parallel rays along the camera's z, its middle at the camera's place.

    Args: as ``render_volume``, with ``size`` (height, width) in pixels.
    """
    rays = np.array([px_per_metre, px_per_metre, size[1] / 2, size[0] / 2])
    return _draw(volume, rays, 0.0, camera_to_room, size, outputs, threads, background)


def _draw(volume, rays, spread, camera_to_room, size, outputs, threads, background) -> Picture:
    unknown = sorted(set(outputs) - set(OUTPUTS))
    if unknown:
        raise ValueError(f"outputs may be {', '.join(OUTPUTS)}, not {unknown[0]!r}")
    if size[0] * size[1] > MAX_PIXELS:
        raise ValueError(f"a picture may have {MAX_PIXELS:,} pixels, not {size[1]}x{size[0]}")
    scene = prepare_scene(volume) if isinstance(volume, BlockVolume) else volume
    pose = np.ascontiguousarray((scene.room_to_grid @ camera_to_room)[:3], np.float64)
    sky = np.array(background, np.float32)
    depth, distance = np.empty(size, np.float32), np.empty(size, np.float32)
    index, face = np.empty(size, np.int32), np.empty(size, np.uint8)
    with_colour = "colour" in outputs
    colour = np.empty((*size, 3) if with_colour else (1, 1, 3), np.uint8)

    cubes = scene.cubes
    cube = np.full(size, -1, np.int32)
    bounds = pixel_bounds(cubes, pose, rays, spread, size)
    to_cube, normals = cubes.from_camera(pose), cubes.normals

    def band(rows: tuple[int, int]) -> None:
        draw_rows(
            scene.cells, scene.states, scene.box_start, scene.boxes, scene.colours, pose, rays,
            spread, rows[0], rows[1], with_colour, sky, depth, distance, index, face, colour,
        )  # fmt: skip
        if len(cubes):
            draw_cubes(
                to_cube, normals, cubes.sides, cubes.colours, bounds, pose, rays, spread,
                rows[0], rows[1], with_colour, depth, distance, index, face, colour, cube,
            )  # fmt: skip

    run_bands(band, size[0], threads)
    return Picture(
        depth_m=depth,
        range_m=distance,
        block_index=index,
        face=face,
        colour=colour if with_colour else None,
        semantic=_labels(scene.semantic, index, cubes.semantic, cube)
        if "semantic" in outputs
        else None,
        instance=_labels(scene.instance, index, cubes.instance, cube)
        if "instance" in outputs
        else None,
        cube_index=cube,
    )


def run_bands(band: Callable[[tuple[int, int]], None], rows: int, threads: int) -> None:
    """Call ``band((first, last))`` for bands that cover ``rows``, on ``threads`` threads."""
    if threads <= 1:
        band((0, rows))
        return
    tiles = -(-rows // TILE)  # Bands begin with a tile, so that bundles do not depend on them.
    edges = [min(rows, TILE * (tiles * n // threads)) for n in range(threads)] + [rows]
    with ThreadPool(threads) as pool:
        pool.map(band, pairwise(edges))


def _labels(
    values: np.ndarray, index: np.ndarray, cube_values: np.ndarray, cube: np.ndarray
) -> np.ndarray:
    """Return the values of the cells and boxes of a picture, 0 where there is neither."""
    found = values.reshape(-1)[np.maximum(index, 0)]
    found[index < 0] = 0
    if len(cube_values):
        shown = cube >= 0
        found[shown] = cube_values[cube[shown]]
    return found

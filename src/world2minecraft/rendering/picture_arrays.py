"""The arrays that images are rendered into, allocated once and reused for any number of images."""

from collections.abc import Callable, Collection
from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.ray_caster.picture_kernel import (
    COLOUR,
    INSTANCE,
    NORMAL,
    OPAQUE,
    SEMANTIC,
    TILE,
    band_memory,
    draw_rows,
)
from world2minecraft.rendering.ray_caster.ray import GridCamera
from world2minecraft.rendering.ray_caster.shading import ShadingParameters
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.thread_pool import bands, run_parallel

OUTPUT_BITS = {
    "colour": COLOUR,
    "opaque": OPAQUE,
    "normal": NORMAL,
    "semantic": SEMANTIC,
    "instance": INSTANCE,
}


class PixelArrays(NamedTuple):
    """The output arrays of ``draw_rows`` for H x W pixels; outputs not requested have one pixel."""

    depth: np.ndarray  # float32 [H, W]
    distance: np.ndarray  # float32 [H, W]
    index: np.ndarray  # pyright: ignore[reportIncompatibleMethodOverride]  # int32 [H, W]
    face: np.ndarray  # uint8 [H, W]
    thing: np.ndarray  # int32 [H, W]
    opaque_depth: np.ndarray  # float32 [H, W]
    opaque_index: np.ndarray  # int32 [H, W]
    opaque_thing: np.ndarray  # int32 [H, W]
    normal: np.ndarray  # float32 [H, W, 3]
    semantic: np.ndarray  # uint8 [H, W]
    instance: np.ndarray  # uint16 [H, W]
    colour: np.ndarray  # uint8 [H, W, 3]
    wanted: int


def pixel_arrays(size: tuple[int, int], outputs: Collection[str]) -> PixelArrays:
    """Return arrays for images of one size.

    Args:
        size: Height and width in pixels.
        outputs: Names of the requested outputs.
    """
    wanted = sum(bit for name, bit in OUTPUT_BITS.items() if name in outputs)

    def room(bit: int) -> tuple[int, int]:
        return size if wanted & bit else (1, 1)

    return PixelArrays(
        depth=np.empty(size, np.float32),
        distance=np.empty(size, np.float32),
        index=np.empty(size, np.int32),
        face=np.empty(size, np.uint8),
        thing=np.empty(size, np.int32),
        opaque_depth=np.empty(room(OPAQUE), np.float32),
        opaque_index=np.empty(room(OPAQUE), np.int32),
        opaque_thing=np.empty(room(OPAQUE), np.int32),
        normal=np.zeros((*room(NORMAL), 3), np.float32),
        semantic=np.empty(room(SEMANTIC), np.uint8),
        instance=np.empty(room(INSTANCE), np.uint16),
        colour=np.empty((*room(COLOUR), 3), np.uint8),
        wanted=wanted,
    )


def draw_into(
    arrays: PixelArrays,
    scene: BlockScene,
    camera: GridCamera,
    shading: ShadingParameters,
    threads: int = 1,
) -> None:
    """Render an image into existing arrays.

    Args:
        arrays: Output arrays, filled in place.
        scene: The scene to render.
        camera: The camera in grid coordinates.
        shading: The light and tone mapping.
        threads: Number of bands of rows rendered in parallel. It does not affect the result.
    """

    def band(rows: tuple[int, int]) -> None:
        draw_rows(
            scene.tables, scene.side_px, camera, rows[0], rows[1], shading, band_memory(), arrays
        )

    if arrays.wanted & NORMAL:
        arrays.normal[:] = 0
    run_bands(band, len(arrays.depth), threads)


def run_bands(band: Callable[[tuple[int, int]], None], rows: int, threads: int) -> None:
    """Call ``band((first, last))`` for bands that cover ``rows``, on ``threads`` threads."""
    # Bands begin with a tile, so that bundles of rays do not depend on them.
    run_parallel(band, bands(rows, max(threads, 1), TILE))

"""The kernel of batches: pictures of many poses in one call, without Python between them."""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.picture_arrays import PixelArrays
from world2minecraft.rendering.ray_caster.picture_kernel import draw_rows


class ManyPixels(NamedTuple):
    """``PixelArrays`` with an axis for N pictures before the others.

    What nobody asked for, but the renderer needs, has fewer pictures: one for each slot.
    """

    depth: np.ndarray  # float32 [N, H, W]
    distance: np.ndarray  # float32 [N, H, W]
    block: np.ndarray  # int32 [N, H, W]
    face: np.ndarray  # uint8 [N, H, W]
    thing: np.ndarray  # int32 [N, H, W]
    opaque_depth: np.ndarray  # float32 [N, H, W]
    opaque_index: np.ndarray  # int32 [N, H, W]
    opaque_thing: np.ndarray  # int32 [N, H, W]
    normal: np.ndarray  # float32 [N, H, W, 3]
    semantic: np.ndarray  # uint8 [N, H, W]
    instance: np.ndarray  # uint16 [N, H, W]
    colour: np.ndarray  # uint8 [N, H, W, 3]
    wanted: int


@lean
def draw_poses(
    tables, side_px, poses, rays, spread, start, stride, first, last, slot, lamp, cells, scratch,
    out,
):  # fmt: skip
    """Fill the rows ``first`` to ``last`` of every ``stride``-th picture, from ``start`` on.

    Args:
        tables: ``SceneTables``, with textures of ``side_px``.
        side_px: the side of a texture.
        poses: float64 [N, 3, 4], camera to grid.
        rays: float64 [N, 4], see ``draw_rows``.
        spread: 1 for pinhole cameras, 0 for parallel rays.
        start: the first picture.
        stride: from one picture to the next.
        first: the first row, a whole number of tiles.
        last: past the last row.
        slot: where arrays without N pictures are written to.
        lamp: the light.
        cells: int64 [CELLS, 3], the caller's own.
        scratch: float64 [SCRATCH], the caller's own.
        out: ``ManyPixels``.
    """
    count = len(poses)
    for n in range(start, count, stride):
        picture = PixelArrays(
            out.depth[place(out.depth, n, slot, count)],
            out.distance[place(out.distance, n, slot, count)],
            out.block[place(out.block, n, slot, count)],
            out.face[place(out.face, n, slot, count)],
            out.thing[place(out.thing, n, slot, count)],
            out.opaque_depth[place(out.opaque_depth, n, slot, count)],
            out.opaque_index[place(out.opaque_index, n, slot, count)],
            out.opaque_thing[place(out.opaque_thing, n, slot, count)],
            out.normal[place(out.normal, n, slot, count)],
            out.semantic[place(out.semantic, n, slot, count)],
            out.instance[place(out.instance, n, slot, count)],
            out.colour[place(out.colour, n, slot, count)],
            out.wanted,
        )
        draw_rows(
            tables, side_px, poses[n], rays[n], spread, first, last, lamp, cells, scratch, picture
        )


@inlined
def place(array, n, slot, count):
    """Return the picture of an array that picture ``n`` is drawn into."""
    return n if len(array) == count else min(slot, len(array) - 1)

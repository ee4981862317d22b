"""What the shader wrote becomes the arrays of a picture."""

import numpy as np

from world2minecraft.rendering.gpu.uniforms import Layout
from world2minecraft.rendering.picture_arrays import PixelArrays
from world2minecraft.rendering.ray_caster.picture_kernel import INSTANCE, SEMANTIC


def fill(arrays: PixelArrays, planes: np.ndarray, row: int, layout: Layout) -> None:
    """Fill in a band of rows.

    Args:
        arrays: of the whole picture, H x W.
        planes: uint32 [planes, rows, W]; rows past the picture's last are of no use.
        row: the first row.
        layout: what the planes hold.
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

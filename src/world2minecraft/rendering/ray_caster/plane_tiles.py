"""Fast rendering of tiles whose pixels all show one plane of full cubes, as in most of a room.

Depth then needs one division, and the data of a cell face (its texture, light and class) is
computed once for all of its pixels. The results equal those of
``rendering.ray_caster.picture_kernel``.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inner_call
from world2minecraft.rendering.light.pixel_light import emission_light
from world2minecraft.rendering.light.tone_mapping import tone_map_pixel
from world2minecraft.rendering.ray_caster.ray import floor_clamped
from world2minecraft.rendering.ray_caster.shading import MAX_TEXELS
from world2minecraft.rendering.scene_tables import EVEN, FLAGS, UNSHADED

# Bits of ``PixelArrays.wanted``; the others are those of ``picture_kernel``.
COLOUR, SEMANTIC, INSTANCE = 1, 8, 16
# What ``prepare_face`` fills in, by the place (p, q) on the face: red, green and blue light as
# a + b p + c q + d p q from 0, 4 and 8 on; the texture's u and v as a + b p + c q from 12 and 15
# on; at 18 the light that it has of itself; its tint from 19 on.
FACE_NUMBERS = 22


class Tile(NamedTuple):
    """The pixels of a tile and the plane that they show: face ``side`` of cells in ``layer``."""

    u: int
    u_end: int
    v: int
    v_end: int
    side: int
    layer: int


@inner_call
def draw_plane_tile(
    tables, side_px, camera, shading, scale, sun, tile, cells, face, out
):  # fmt: skip
    """Render a ``Tile`` of a pinhole camera. Other arguments are those of ``draw_rows``.

    If the sun or a light at the camera differs between pixels, ``picture_kernel`` renders them one
    by one. ``scale`` is the number of blocks per metre, ``sun`` the cosine of the sun on the whole
    tile (0 in shadow), ``cells`` int64 [2, 3] the first and the last cell that the tile covers, and
    ``face`` float64 [FACE_NUMBERS] is scratch memory.
    """
    pose, rays = camera.pose, camera.rays
    side, layer = tile.side, tile.layer
    with_colour = out.wanted & COLOUR != 0
    with_semantic, with_instance = out.wanted & SEMANTIC != 0, out.wanted & INSTANCE != 0
    axis = side // 2
    p = 1 if axis == 0 else 0
    q = 1 if axis == 2 else 2
    a, b, c = pose[axis], pose[p], pose[q]
    away = layer + side % 2 - a[3]
    low_p, high_p = cells[0, p], cells[1, p] + 1
    low_q, high_q = cells[0, q], cells[1, q] + 1
    cell_p, cell_q = -1, -1
    texture, index, semantic, instance = np.uint64(0), np.int32(0), np.uint8(0), np.uint16(0)
    coarse = side_px * scale / rays[0]  # Texels a pixel at one metre, seen straight on.
    coarse *= coarse
    for v in range(np.uint64(tile.v), np.uint64(tile.v_end)):
        y = (v + 0.5 - rays[3]) / rays[1]
        for u in range(np.uint64(tile.u), np.uint64(tile.u_end)):
            x = (u + 0.5 - rays[2]) / rays[0]
            d = a[0] * x + a[1] * y + a[2]
            t = away * (1.0 / d)
            at_p = b[3] + t * (b[0] * x + b[1] * y + b[2])
            at_q = c[3] + t * (c[0] * x + c[1] * y + c[2])
            here_p, here_q = floor_clamped(at_p, low_p, high_p), floor_clamped(at_q, low_q, high_q)
            if here_p != cell_p or here_q != cell_q:
                cell_p, cell_q = here_p, here_q
                i = layer if axis == 0 else cell_p
                j = layer if axis == 1 else (cell_p if axis == 0 else cell_q)
                k = layer if axis == 2 else cell_q
                texture, index = prepare_face(
                    tables, shading, face, sun, side, i, j, k, with_colour
                )
                semantic, instance = tables.semantic[index], tables.instance[index]
            length = np.sqrt(x * x + y * y + 1.0)
            out.depth[v, u], out.distance[v, u] = t, t * length
            out.index[v, u], out.thing[v, u], out.face[v, u] = index, -1, side
            if with_semantic:
                out.semantic[v, u] = semantic
            if with_instance:
                out.instance[v, u] = instance
            if not with_colour:
                continue
            fp, fq = min(max(at_p - cell_p, 0.0), 1.0), min(max(at_q - cell_q, 0.0), 1.0)
            s = face[12] + face[13] * fp + face[14] * fq
            w = face[15] + face[16] * fp + face[17] * fq
            size, start = side_px, 0
            steep = max(abs(d) / (length * scale), 0.04)
            many = coarse * t * t / (steep * steep)
            while many > MAX_TEXELS and size > 1:
                start += size * size
                size //= 2
                many *= 0.25
            column, row = int((s - np.floor(s)) * size), int((w - np.floor(w)) * size)
            at = start + min(row, size - 1) * size + min(column, size - 1)
            texel = tables.texels[texture, np.uint64(at)]
            both = fp * fq
            own = face[18]
            red = max(own, face[0] + face[1] * fp + face[2] * fq + face[3] * both)
            green = max(own, face[4] + face[5] * fp + face[6] * fq + face[7] * both)
            blue = max(own, face[8] + face[9] * fp + face[10] * fq + face[11] * both)
            decode = shading.tone.decode
            out.colour[v, u, 0], out.colour[v, u, 1], out.colour[v, u, 2] = tone_map_pixel(
                decode[np.uint64(texel[0])] * face[19] * red,
                decode[np.uint64(texel[1])] * face[20] * green,
                decode[np.uint64(texel[2])] * face[21] * blue,
                shading.tone,
            )


@inner_call
def prepare_face(tables, shading, face, sun, side, i, j, k, with_colour):
    """Fill ``face`` with the data of a cell face, and return its texture and its index."""
    first, shape = tables.window[0], tables.window[1]
    index = np.int32(((i - first[0]) * shape[1] + j - first[1]) * shape[2] + k - first[2])
    if not with_colour:
        return np.uint64(0), index
    n = tables.refs[tables.look_start[tables.looks[i, j, k]]]
    flags = tables.traits[n, FLAGS]
    axis, up = side // 2, side % 2
    shade = 1.0 if flags & UNSHADED else shading.shades[side]
    mask = 0xFFF if flags & EVEN else 0x3FFF
    light = tables.light[axis]
    step = up * 2 - 1
    for channel in range(3):
        if axis == 0:
            w00, w01 = light[i + step + 1, j, k], light[i + step + 1, j, k + 1]
            w10, w11 = light[i + step + 1, j + 1, k], light[i + step + 1, j + 1, k + 1]
        elif axis == 1:
            w00, w01 = light[i, j + step + 1, k], light[i, j + step + 1, k + 1]
            w10, w11 = light[i + 1, j + step + 1, k], light[i + 1, j + step + 1, k + 1]
        else:
            w00, w01 = light[i, j, k + step + 1], light[i, j + 1, k + step + 1]
            w10, w11 = light[i + 1, j, k + step + 1], light[i + 1, j + 1, k + step + 1]
        c00 = shade * shading.corners[w00 & mask, channel]
        c01 = shade * shading.corners[w01 & mask, channel]
        c10 = shade * shading.corners[w10 & mask, channel]
        c11 = shade * shading.corners[w11 & mask, channel]
        face[4 * channel], face[4 * channel + 1] = c00, c10 - c00
        face[4 * channel + 2], face[4 * channel + 3] = c01 - c00, c11 - c10 - c01 + c00
        face[19 + channel] = tables.tints[n, side, channel]
    face[0] += sun * shading.lit.sun_r
    face[4] += sun * shading.lit.sun_g
    face[8] += sun * shading.lit.sun_b
    p = 1 if axis == 0 else 0
    q = 1 if axis == 2 else 2
    for row in range(2):
        m = tables.uv[n, side, row]
        face[12 + 3 * row] = m[3] + m[axis] * up
        face[13 + 3 * row], face[14 + 3 * row] = m[p], m[q]
    face[18] = 0.0
    if tables.emission[n] > 0:
        face[18] = emission_light(15.0 * tables.emission[n], shading.lit)
    return np.uint64(tables.layers[n, side]), index

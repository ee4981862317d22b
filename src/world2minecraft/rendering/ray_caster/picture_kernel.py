"""The picture kernel: one pass over the pixels gives depth, ids, faces, normals and colour.

``draw_rows`` takes tiles of eight by eight pixels: what a tile's rays have in common is found once
(``rendering.ray_caster.packet_tracing``), then each pixel meets its surface, writes what was asked for, and is coloured
by ``rendering.ray_caster.shading``. Glass is gone through front to back, so that nothing needs sorting.
"""

import numpy as np

from world2minecraft.core.jit import inner, lean
from world2minecraft.rendering.ray_caster.packet_tracing import DIVERGED, MISS, PLANE, trace_packet
from world2minecraft.rendering.ray_caster.plane_tiles import draw_plane_tile
from world2minecraft.rendering.ray_caster.ray import (
    away_from_zero,
    first_cell,
    first_hit,
    floor_clamped,
    is_see_through,
    ray_of_pixel,
)
from world2minecraft.rendering.ray_caster.shading import (
    MAX_GLASS_PANES,
    MEMO,
    SURFACE_OFFSET,
    dominant_face,
    normal_of,
    shade_hit,
    write_pixel,
    write_sky,
)
from world2minecraft.rendering.scene_tables import NO_FACE, OWNER, TURN

TILE = 8
# Bits of what is wanted.
COLOUR, OPAQUE, NORMAL, SEMANTIC, INSTANCE = 1, 2, 4, 8, 16
# What a band of rows needs for itself, see ``draw_rows``: numbers, and rows of whole ones. Four of
# those are of the tile's bundle, the others of that towards the sun.
SCRATCH, CELLS = 96, 8


def band_memory() -> tuple[np.ndarray, np.ndarray]:
    """Return ``cells`` and ``scratch`` of ``draw_rows``, for one band."""
    return np.empty((CELLS, 3), np.int64), np.empty(SCRATCH)


@lean
def draw_rows(tables, side_px, pose, rays, spread, first, last, lamp, cells, scratch, out):
    """Fill the rows ``first`` to ``last`` (past the end) of the outputs.

    Args:
        tables: ``SceneTables``, with textures of ``side_px``.
        side_px: the side of a texture.
        pose: float64 [3, 4], carries the camera (z forward, metres) to the grid.
        rays: float64 [4], fx, fy, cx, cy in pixels, or pixels a metre for parallel rays.
        spread: 1 for a pinhole camera, 0 for parallel rays.
        first: the first row, a whole number of tiles.
        last: past the last row.
        lamp: the light, see ``rendering.ray_caster.shading``.
        cells: int64 [CELLS, 3], this band's own.
        scratch: float64 [SCRATCH], this band's own.
        out: ``PixelArrays``; depth and distance are 0 where there is nothing, index and thing -1,
            face ``NO_FACE``.
    """
    width = out.depth.shape[1]
    corners, memo = scratch[:24].reshape((4, 6)), scratch[24:]
    memo[0] = -1.0
    face = scratch[24 + MEMO :]
    lit = lamp.lit
    plain = spread == 1 and not out.wanted & (OPAQUE | NORMAL)
    plain = plain and lit.headlight == 0
    sunny = lit.sun_r > 0 and out.wanted & COLOUR
    memo[4] = np.sqrt(pose[0, 2] ** 2 + pose[1, 2] ** 2 + pose[2, 2] ** 2)
    for v_tile in range(first, last, TILE):
        v_end = min(v_tile + TILE, last)
        for u_tile in range(0, width, TILE):
            u_end = min(u_tile + TILE, width)
            for corner in range(4):
                x = (u_tile + 0.5 if corner % 2 == 0 else u_end - 0.5) - rays[2]
                y = (v_tile + 0.5 if corner < 2 else v_end - 0.5) - rays[3]
                ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x / rays[0], y / rays[1], spread)
                row = corners[corner]
                row[0], row[1], row[2], row[3], row[4], row[5] = ox, oy, oz, dx, dy, dz
            mode, side, layer = trace_packet(tables.space, tables.bounds, corners, cells)
            sun = 0.0
            if mode == PLANE and plain and sunny:
                sun = sun_on_tile(tables, lit, corners, cells[4:], side, layer)
            if mode == PLANE and plain and sun >= 0:
                draw_plane_tile(
                    tables, side_px, pose, rays, lamp, memo[4], face, cells, sun, side, layer,
                    u_tile, u_end, v_tile, v_end, out.wanted & COLOUR != 0,
                    out.wanted & SEMANTIC != 0, out.wanted & INSTANCE != 0, out,
                )  # fmt: skip
                continue
            for v in range(v_tile, v_end):
                for u in range(u_tile, u_end):
                    draw_pixel(
                        tables, side_px, pose, rays, spread, lamp, memo, cells, mode, side, layer,
                        u, v, out,
                    )  # fmt: skip


@inner
def sun_on_tile(tables, lit, corners, cells, side, layer):
    """Return the cosine of the sun on a tile's plane, 0 in shadow, -1 where pixels differ.

    The rays from the four corners' places towards the sun are a bundle like any other. ``corners``
    are the tile's rays; they become those towards the sun.
    """
    nx, ny, nz = normal_of(tables, -1, side)
    cosine = nx * lit.sun_x + ny * lit.sun_y + nz * lit.sun_z
    if cosine <= 0:
        return 0.0
    axis = side // 2
    for corner in range(4):
        row = corners[corner]
        t = (layer + side % 2 - row[axis]) / row[axis + 3]
        row[0], row[1], row[2] = row[0] + t * row[3], row[1] + t * row[4], row[2] + t * row[5]
        row[axis] = layer + side % 2 + (SURFACE_OFFSET if side % 2 else -SURFACE_OFFSET)
        row[3], row[4], row[5] = lit.sun_x, lit.sun_y, lit.sun_z
    mode, _, _ = trace_packet(tables.space, tables.bounds, corners, cells)
    if mode == DIVERGED:
        return -1.0
    return cosine if mode == MISS else 0.0


@inner
def draw_pixel(
    tables, side_px, pose, rays, spread, lamp, memo, cells, mode, side, layer, u, v, out
):  # fmt: skip
    """Draw one pixel; the arguments are those of ``draw_rows``, and what its tile has found."""
    x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
    ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, spread)
    dx, dy, dz = away_from_zero(dx), away_from_zero(dy), away_from_zero(dz)
    rx, ry, rz = 1.0 / dx, 1.0 / dy, 1.0 / dz
    scale = memo[4]  # Blocks a metre.
    block_px = rays[0] / scale
    length = np.sqrt((x * x + y * y) * spread + 1.0)
    t, i, j, k = 0.0, 0, 0, 0
    element = -1
    if mode == MISS:
        side = NO_FACE
    elif side != NO_FACE:  # From the plane that the tile has come to.
        t, i, j, k = enter_layer(side, layer, cells, ox, oy, oz, dx, dy, dz, rx, ry, rz)
    else:
        t, i, j, k, side = first_cell(tables.space.shape, ox, oy, oz, dx, dy, dz, rx, ry, rz)
    red, green, blue, clear, after = 0.0, 0.0, 0.0, 1.0, 0.0
    for pane in range(MAX_GLASS_PANES):
        if pane > 0 or (mode == DIVERGED and i >= 0):
            t, i, j, k, side, element = first_hit(
                tables, side_px, ox, oy, oz, dx, dy, dz, rx, ry, rz, t, i, j, k, side, after
            )
        if pane == 0:
            write_hit(tables, out, v, u, t, length, i, j, k, side, element)
            if not out.wanted & (COLOUR | OPAQUE):
                return
        if side == NO_FACE:
            break
        glass = is_see_through(tables, side_px, t, i, j, k, side, element, ox, oy, oz, dx, dy, dz)
        if out.wanted & COLOUR:
            r, g, b, alpha = shade_hit(
                tables, side_px, lamp, memo, block_px / t if spread > 0 else block_px,
                t, i, j, k, side, element, ox, oy, oz, dx, dy, dz, length * scale,
            )  # fmt: skip
            share = clear * alpha if glass else clear
            red, green, blue = red + share * r, green + share * g, blue + share * b
            clear -= share
        if not glass:
            break
        side, after = NO_FACE, t
    if out.wanted & OPAQUE:
        write_opaque_hit(tables, out, v, u, t, i, j, k, side, element)
    if out.wanted & COLOUR:
        if side == NO_FACE:
            write_sky(lamp, out.colour, v, u, dx, dy, dz, red, green, blue, clear)
        else:
            write_pixel(lamp, out.colour, v, u, red, green, blue)


@inner
def write_hit(tables, out, v, u, t, length, i, j, k, side, element):
    """Write what the first surface is."""
    if side == NO_FACE:
        out.depth[v, u], out.distance[v, u] = 0.0, 0.0
        out.index[v, u], out.thing[v, u], out.face[v, u] = -1, -1, NO_FACE
        if out.wanted & SEMANTIC:
            out.semantic[v, u] = 0
        if out.wanted & INSTANCE:
            out.instance[v, u] = 0
        return
    out.depth[v, u], out.distance[v, u] = t, t * length
    at, owner = owner_of_hit(tables, element, i, j, k)
    out.index[v, u], out.thing[v, u] = at, owner
    if out.wanted & SEMANTIC:
        out.semantic[v, u] = tables.semantic[at] if owner < 0 else tables.thing_semantic[owner]
    if out.wanted & INSTANCE:
        out.instance[v, u] = tables.instance[at] if owner < 0 else tables.thing_instance[owner]
    turn = tables.traits[element, TURN] if element >= 0 else -1
    out.face[v, u] = side
    if turn >= 0:
        nx, ny, nz = normal_of(tables, turn, side)
        out.face[v, u] = dominant_face(nx, ny, nz)
    if out.wanted & NORMAL:
        out.normal[v, u, 0], out.normal[v, u, 1], out.normal[v, u, 2] = normal_of(
            tables, turn, side
        )


@inner
def write_opaque_hit(tables, out, v, u, t, i, j, k, side, element):
    """Write what lies behind all glass."""
    at, owner = owner_of_hit(tables, element, i, j, k)
    none = side == NO_FACE
    out.opaque_depth[v, u] = 0.0 if none else t
    out.opaque_index[v, u] = -1 if none else at
    out.opaque_thing[v, u] = -1 if none else owner


@inner
def owner_of_hit(tables, element, i, j, k):
    """Return the volume's cell (-1 for none) and the standing thing (-1 for none) of a hit."""
    owner = tables.traits[element, OWNER] if element >= 0 else -1
    if owner >= 0:
        return -1, owner
    if owner < -1:
        return -2 - owner, -1
    first, shape = tables.window[0], tables.window[1]
    return ((i - first[0]) * shape[1] + j - first[1]) * shape[2] + k - first[2], -1


@inner
def enter_layer(side, layer, cells, ox, oy, oz, dx, dy, dz, rx, ry, rz):
    """Return ``(t, i, j, k)`` where a ray enters a layer of cells by a face."""
    plane = layer + side % 2
    t = (plane - ox) * rx if side < 2 else ((plane - oy) * ry if side < 4 else (plane - oz) * rz)
    return (
        t,
        floor_clamped(ox + t * dx, cells[0, 0], cells[1, 0] + 1),
        floor_clamped(oy + t * dy, cells[0, 1], cells[1, 1] + 1),
        floor_clamped(oz + t * dz, cells[0, 2], cells[1, 2] + 1),
    )

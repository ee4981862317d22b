"""The picture kernel, which computes depth, ids, faces, normals and colour in one pass.

``draw_rows`` processes tiles of eight by eight pixels: data shared by a tile's rays is computed
once (``rendering.ray_caster.packet_tracing``), then each pixel finds its surface, writes the
requested outputs, and is shaded by ``rendering.ray_caster.shading``. Glass is traversed front to
back, so no sorting is needed.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inner, lean
from world2minecraft.rendering.ray_caster.packet_tracing import (
    DIVERGED,
    MISS,
    PLANE,
    trace_packet,
)
from world2minecraft.rendering.ray_caster.plane_tiles import (
    COLOUR,
    FACE_NUMBERS,
    INSTANCE,
    SEMANTIC,
    Tile,
    draw_plane_tile,
)
from world2minecraft.rendering.ray_caster.ray import (
    Hit,
    first_cell,
    first_hit,
    floor_clamped,
    is_see_through,
    make_ray,
    ray_of_pixel,
)
from world2minecraft.rendering.ray_caster.shading import (
    CORNER_LIGHT_NUMBERS,
    MAX_GLASS_PANES,
    SURFACE_OFFSET,
    dominant_face,
    normal_of,
    shade_hit,
    write_pixel,
    write_sky,
)
from world2minecraft.rendering.scene_tables import NO_FACE, OWNER, TURN

TILE = 8
# Bits of ``PixelArrays.wanted``, with COLOUR, SEMANTIC and INSTANCE.
OPAQUE, NORMAL = 2, 4


class BandMemory(NamedTuple):
    """The scratch memory of one band of rows. Parallel bands have separate memory."""

    cells: np.ndarray  # int64 [8, 3]: four rows of the tile's packet, four of that to the sun
    corners: np.ndarray  # float64 [4, 6]: origin and direction of the tile's corner rays
    corner_light: np.ndarray  # float64 [CORNER_LIGHT_NUMBERS], see ``cache_corner_light``
    face: np.ndarray  # float64 [FACE_NUMBERS], see ``prepare_face``


def band_memory() -> BandMemory:
    """Return the scratch memory of one band."""
    return BandMemory(
        np.empty((8, 3), np.int64),
        np.empty((4, 6)),
        np.empty(CORNER_LIGHT_NUMBERS),
        np.empty(FACE_NUMBERS),
    )


@lean
def draw_rows(tables, side_px, camera, first, last, shading, memory, out):
    """Render the rows from ``first`` to ``last`` (exclusive) into the outputs.

    Args:
        tables: ``SceneTables`` with textures of ``side_px``.
        side_px: Texture size in pixels.
        camera: ``GridCamera``.
        first: First row, a multiple of the tile size.
        last: End row.
        shading: ``ShadingParameters``.
        memory: ``BandMemory`` of this band.
        out: ``PixelArrays``. Without a surface, depth and distance are 0, index and thing are -1,
            and face is ``NO_FACE``.
    """
    width = out.depth.shape[1]
    corners = memory.corners
    memory.corner_light[0] = -1.0
    lit = shading.lit
    plain = camera.spread == 1 and not out.wanted & (OPAQUE | NORMAL)
    plain = plain and lit.headlight == 0
    sunny = lit.sun_r > 0 and out.wanted & COLOUR
    pose, rays = camera.pose, camera.rays
    scale = np.sqrt(pose[0, 2] ** 2 + pose[1, 2] ** 2 + pose[2, 2] ** 2)  # Blocks per metre.
    for v_tile in range(first, last, TILE):
        v_end = min(v_tile + TILE, last)
        for u_tile in range(0, width, TILE):
            u_end = min(u_tile + TILE, width)
            for corner in range(4):
                x = (u_tile + 0.5 if corner % 2 == 0 else u_end - 0.5) - rays[2]
                y = (v_tile + 0.5 if corner < 2 else v_end - 0.5) - rays[3]
                ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x / rays[0], y / rays[1], camera.spread)
                row = corners[corner]
                row[0], row[1], row[2], row[3], row[4], row[5] = ox, oy, oz, dx, dy, dz
            packet = trace_packet(tables.space, tables.bounds, corners, memory.cells)
            sun = 0.0
            if packet.mode == PLANE and plain and sunny:
                sun = sun_on_tile(tables, lit, corners, memory.cells[4:], packet)
            if packet.mode == PLANE and plain and sun >= 0:
                tile = Tile(u_tile, u_end, v_tile, v_end, packet.face, packet.layer)
                draw_plane_tile(
                    tables, side_px, camera, shading, scale, sun, tile, memory.cells, memory.face,
                    out,
                )  # fmt: skip
                continue
            for v in range(v_tile, v_end):
                for u in range(u_tile, u_end):
                    draw_pixel(tables, side_px, camera, shading, scale, memory, packet, u, v, out)


@inner
def sun_on_tile(tables, lit, corners, cells, packet):
    """Return the cosine of the sun on a tile's plane, 0 in shadow, or -1 if pixels differ.

    The rays from the four corner hits towards the sun are traced as a packet. ``corners`` are the
    rays of the tile and are replaced by those towards the sun.
    """
    side, layer = packet.face, packet.layer
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
    mode = trace_packet(tables.space, tables.bounds, corners, cells).mode
    if mode == DIVERGED:
        return -1.0
    return cosine if mode == MISS else 0.0


@inner
def draw_pixel(tables, side_px, camera, shading, scale, memory, packet, u, v, out):
    """Render one pixel.

    ``scale`` is the number of blocks per metre, and ``packet`` is the distance over which the
    tile's rays stay together. The other arguments are those of ``draw_rows``.
    """
    rays, spread = camera.rays, camera.spread
    x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
    ox, oy, oz, dx, dy, dz = ray_of_pixel(camera.pose, x, y, spread)
    ray = make_ray(ox, oy, oz, dx, dy, dz)
    block_px = rays[0] / scale
    length = np.sqrt((x * x + y * y) * spread + 1.0)
    hit = Hit(0.0, 0, 0, 0, NO_FACE, -1)
    if packet.mode == MISS:
        pass
    elif packet.face != NO_FACE:  # From the plane that the tile has come to.
        hit = enter_layer(packet, memory.cells, ray)
    else:
        hit = first_cell(tables.space.shape, ray)
    red, green, blue, clear, after = 0.0, 0.0, 0.0, 1.0, 0.0
    for pane in range(MAX_GLASS_PANES):
        if pane > 0 or (packet.mode == DIVERGED and hit.i >= 0):
            hit = first_hit(tables, side_px, ray, hit, after)
        if pane == 0:
            write_hit(tables, out, v, u, length, hit)
            if not out.wanted & (COLOUR | OPAQUE):
                return
        if hit.face == NO_FACE:
            break
        glass = is_see_through(tables, side_px, ray, hit)
        if out.wanted & COLOUR:
            r, g, b, alpha = shade_hit(
                tables, side_px, shading, memory.corner_light,
                block_px / hit.t if spread > 0 else block_px, ray, hit, length * scale,
            )  # fmt: skip
            share = clear * alpha if glass else clear
            red, green, blue = red + share * r, green + share * g, blue + share * b
            clear -= share
        if not glass:
            break
        after = hit.t
        hit = Hit(hit.t, hit.i, hit.j, hit.k, NO_FACE, hit.element)
    if out.wanted & OPAQUE:
        write_opaque_hit(tables, out, v, u, hit)
    if out.wanted & COLOUR:
        if hit.face == NO_FACE:
            write_sky(shading, out.colour, v, u, ray, red, green, blue, clear)
        else:
            write_pixel(shading, out.colour, v, u, red, green, blue)


@inner
def write_hit(tables, out, v, u, length, hit):
    """Write the outputs of the first surface, except its colour."""
    t, i, j, k, side, element = hit
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
def write_opaque_hit(tables, out, v, u, hit):
    """Write the outputs of the first surface behind all glass."""
    t, i, j, k, side, element = hit
    at, owner = owner_of_hit(tables, element, i, j, k)
    none = side == NO_FACE
    out.opaque_depth[v, u] = 0.0 if none else t
    out.opaque_index[v, u] = -1 if none else at
    out.opaque_thing[v, u] = -1 if none else owner


@inner
def owner_of_hit(tables, element, i, j, k):
    """Return the volume cell and the display entity of a hit, each -1 for none."""
    owner = tables.traits[element, OWNER] if element >= 0 else -1
    if owner >= 0:
        return -1, owner
    if owner < -1:
        return -2 - owner, -1
    first, shape = tables.window[0], tables.window[1]
    return ((i - first[0]) * shape[1] + j - first[1]) * shape[2] + k - first[2], -1


@inner
def enter_layer(packet, cells, ray):
    """Return the ``Hit`` where a ray enters the layer of cells that its packet has reached."""
    side = packet.face
    plane = packet.layer + side % 2
    t = (
        (plane - ray.ox) * ray.rx
        if side < 2
        else ((plane - ray.oy) * ray.ry if side < 4 else (plane - ray.oz) * ray.rz)
    )
    return Hit(
        t,
        floor_clamped(ray.ox + t * ray.dx, cells[0, 0], cells[1, 0] + 1),
        floor_clamped(ray.oy + t * ray.dy, cells[0, 1], cells[1, 1] + 1),
        floor_clamped(ray.oz + t * ray.dz, cells[0, 2], cells[1, 2] + 1),
        side,
        -1,
    )

"""The mesh that a rasteriser draws of a scene: quads with light at their corners, chunk by chunk.

In: ``SceneTables``. Between two full cubes there are no faces; of all other elements every face
that has a texture is there. Corners carry the light of the same lattice that the ray caster reads.
Quads are sorted by chunks of 16 x 16 x 16 cells, for culling.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from world2minecraft.render.light import LitParameters
from world2minecraft.render.tables import (
    ABSOLUTE,
    BOXES,
    EVEN,
    FLAGS,
    FULL,
    JOINS,
    TURN,
    UNSHADED,
    SceneTables,
)

CHUNK = 16
HOLE = 64  # Alpha under which the rival draws nothing; glass is drawn as if opaque.
EDGE = 1e-3  # Blocks: a face so near its cell's boundary is lit from beyond it.
VERTEX = np.dtype(
    [
        ("place", "3f4"),  # cells
        ("texel", "3f4"),  # u, v and the texture's layer
        ("light", "4f2"),  # red, green, blue that the texture's linear colour is times; nothing
        ("id", "u4"),  # the cell's C-order index
    ]
)
# The corners of a side, counter-clockwise from outside, as steps along the two other axes.
_AROUND = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


@dataclass(frozen=True, eq=False)
class Mesh:
    """Q quads: ``vertices`` [4 Q] of ``VERTEX``, ``triangles`` uint32 [6 Q].

    ``starts`` int64 [C + 1] are the first quads of C chunks, ``low`` and ``high`` float32 [C, 3]
    their extents. From chunk ``solid_chunks`` on, textures have holes.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    starts: np.ndarray
    low: np.ndarray
    high: np.ndarray
    solid_chunks: int

    @property
    def quads(self) -> int:
        """How many."""
        return len(self.vertices) // 4


def mesh_of(tables: SceneTables, lit: LitParameters) -> Mesh:
    """Return the culled mesh of a scene in a light."""
    parts = [part for part in _parts(tables, lit) if len(part)]
    vertices = np.concatenate(parts) if parts else np.empty((0, 4), VERTEX)
    middle = vertices["place"].mean(axis=1)
    chunk = np.clip(middle // CHUNK, 0, 4095).astype(np.int64)
    holes = _has_holes(tables)[vertices["texel"][:, 0, 2].astype(np.int64)]
    key = (holes << 36) | (chunk[:, 0] << 24) | (chunk[:, 1] << 12) | chunk[:, 2]
    order = np.argsort(key, kind="stable")
    vertices, key = vertices[order], key[order]
    starts = np.flatnonzero(np.r_[True, key[1:] != key[:-1]]) if len(key) else np.empty(0, int)
    low = np.minimum.reduceat(vertices["place"].min(axis=1), starts)
    high = np.maximum.reduceat(vertices["place"].max(axis=1), starts)
    solid_chunks = int(np.searchsorted(key[starts], 1 << 36))
    triangles = _triangles(vertices)
    return Mesh(vertices.reshape(-1), triangles, np.r_[starts, len(key)], low, high, solid_chunks)


def _has_holes(tables: SceneTables) -> np.ndarray:
    """Return int64 [L]: 1 where a texture has texels that are not drawn."""
    return (tables.texels[..., 3] < HOLE).any(axis=1).astype(np.int64)


def _triangles(vertices: np.ndarray) -> np.ndarray:
    """Return two triangles a quad, split along the diagonal that is evenly lit."""
    bright = vertices["light"][..., :3].astype(np.float32).sum(axis=-1)
    flipped = bright[:, 0] + bright[:, 2] > bright[:, 1] + bright[:, 3]
    split = np.where(flipped[:, None], [[0, 1, 2, 0, 2, 3]], [[1, 2, 3, 1, 3, 0]])
    return (split + 4 * np.arange(len(vertices))[:, None]).astype(np.uint32).reshape(-1)


def _parts(tables: SceneTables, lit: LitParameters) -> Iterator[np.ndarray]:
    """Give the quads, [N, 4] of ``VERTEX``, of each element's each side wherever it stands."""
    full = tables.space == FULL
    for side in range(6):
        bare = full & ~_ahead(full, side, False)
        yield from _of_cells(tables, lit, np.argwhere(bare), side, None)
    boxes = np.argwhere(tables.space == BOXES)
    for side in range(6):
        yield from _of_cells(tables, lit, boxes, side, _ahead(tables.looks, side, -1))
    for element in np.flatnonzero(tables.traits[:, FLAGS] & ABSOLUTE):
        for side in range(6):
            yield _quads(tables, lit, element, side, np.zeros((1, 3), np.int64))


def _of_cells(
    tables: SceneTables, lit: LitParameters, cells: np.ndarray, side: int, ahead
) -> Iterator[np.ndarray]:
    """Give the quads of one side of all elements of some cells."""
    looks = tables.looks[tuple(cells.T)]
    for look in np.unique(looks):
        own = cells[looks == look]
        for element in tables.refs[tables.look_start[look] : tables.look_start[look + 1]]:
            flags = tables.traits[element, FLAGS]
            if flags & ABSOLUTE:
                continue
            shown = own
            if flags & JOINS and ahead is not None:
                shown = own[ahead[tuple(own.T)] != look]
            yield _quads(tables, lit, element, side, shown)


def _ahead(values: np.ndarray, side: int, outside) -> np.ndarray:
    """Return what each cell's neighbour at a side holds; ``outside`` beyond the volume."""
    axis, up = divmod(side, 2)
    result = np.full_like(values, outside)
    to = [slice(None)] * 3
    of = [slice(None)] * 3
    to[axis], of[axis] = (slice(None, -1), slice(1, None)) if up else (slice(1, None), slice(-1))
    result[tuple(to)] = values[tuple(of)]
    return result


def _quads(
    tables: SceneTables, lit: LitParameters, element: int, side: int, cells: np.ndarray
) -> np.ndarray:
    """Return one side of an element in each of ``cells``, [N, 4] of ``VERTEX``."""
    quads = np.zeros((len(cells), 4), VERTEX)
    layer = tables.layers[element, side]
    if layer < 0 or not len(cells):
        return quads[:0]
    axis, up = divmod(side, 2)
    first, second = (axis + 1) % 3, (axis + 2) % 3
    corners = np.empty((4, 3))
    ends = tables.boxes[element].reshape(2, 3).astype(np.float64)
    corners[:, axis] = ends[up, axis]
    around = _AROUND if up else _AROUND[::-1]
    corners[:, first], corners[:, second] = ends[around[:, 0], first], ends[around[:, 1], second]
    uv = tables.uv[element, side].astype(np.float64)
    quads["texel"][..., :2] = corners @ uv[:, :3].T + uv[:, 3]
    quads["texel"][..., 2] = layer
    normal = np.zeros(3)
    normal[axis] = 2 * up - 1
    turn = tables.traits[element, TURN]
    if turn >= 0:
        back = np.linalg.inv(np.vstack([tables.turns[turn], [0, 0, 0, 1]]))
        corners = corners @ back[:3, :3].T + back[:3, 3]
        normal = tables.normals[turn, axis] * (2 * up - 1)
    flags = tables.traits[element, FLAGS]
    if flags & ABSOLUTE:
        cells = np.floor(corners.mean(axis=0) - 1e-3 * normal).astype(np.int64)[None]
        corners = corners - cells
        cells = np.clip(cells, 0, np.array(tables.space.shape) - 1)
    quads["place"] = corners + cells[:, None]
    light = _corner_light(tables.light, lit, normal, cells, corners, bool(flags & EVEN))
    light = light if flags & UNSHADED else light * _shade(normal, lit)
    light = np.maximum(light, tables.emission[element] * lit.glow)
    quads["light"][..., :3] = light * tables.tints[element, side]
    quads["id"] = np.ravel_multi_index(tuple(cells.T), tables.space.shape)[:, None]
    return quads


def _shade(normal: np.ndarray, lit: LitParameters) -> float:
    """Return how light a face is by its direction."""
    upright = lit.shade_up if normal[1] > 0 else lit.shade_down
    return float(normal**2 @ np.array([lit.shade_x, upright, lit.shade_z]))


def _corner_light(
    lattice: np.ndarray,
    lit: LitParameters,
    normal: np.ndarray,
    cells: np.ndarray,
    corners: np.ndarray,
    even: bool,
) -> np.ndarray:
    """Return float32 [N, 4, 3]: the light where the corners of N quads are, red, green, blue."""
    axis = int(np.abs(normal).argmax())
    along, up = float(corners[:, axis].mean()), normal[axis] > 0
    step = (1 if along > 1 - EDGE else 0) if up else (-1 if along < EDGE else 0)
    others = [other for other in range(3) if other != axis]
    place = np.clip(corners[:, others], 0, 1)
    sums = np.zeros((len(cells), 4, 3), np.float32)
    for a, b in np.ndindex(2, 2):
        weight = np.abs(1 - a - place[:, 0]) * np.abs(1 - b - place[:, 1])
        if not weight.any():
            continue
        at = cells.copy()
        at[:, axis] += step + 1
        at[:, others] += (a, b)
        word = lattice[axis][tuple(at.T)]
        sums += _colours(word, lit, even)[:, None] * weight[:, None].astype(np.float32)
    return sums


def _colours(word: np.ndarray, lit: LitParameters, even: bool) -> np.ndarray:
    """Return float32 [N, 3]: the light of entries of the lattice."""
    every = np.arange(1 << 14)
    sky, block = (every & 63) / 60, (every >> 6 & 63) / 60
    sky, block = (level / (1 + lit.curve * (1 - level)) for level in (sky, block))
    table = np.array([lit.ambient_r, lit.ambient_g, lit.ambient_b])
    table = table + sky[:, None] * (lit.sky_r, lit.sky_g, lit.sky_b)
    table += block[:, None] * np.array([lit.block_r, lit.block_g, lit.block_b])
    dark = 1 if even else 1 - lit.corner * (every >> 12)[:, None]
    return (table * dark).astype(np.float32)[word]

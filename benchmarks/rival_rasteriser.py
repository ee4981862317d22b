"""The rival of the renderer: a rasteriser on the CPU, Mesa's llvmpipe, through moderngl.

It draws the culled mesh of the same scene into three targets, colour, id and depth, with the same
textures and the same light at the corners, and reads all three back to numpy. The mesh has no faces
between full cubes and every textured face of all other elements, sorted by chunks of 16 x 16 x 16
cells. Back faces are culled; chunks outside the view are skipped on request. Glass is drawn as
opaque with holes cut out: the sorting that blending requires is not counted against the rival.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.rendering.light import LightCoefficients
from world2minecraft.rendering.scene_tables import (
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


def mesh_of(tables: SceneTables, lit: LightCoefficients) -> Mesh:
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


def _parts(tables: SceneTables, lit: LightCoefficients) -> Iterator[np.ndarray]:
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
    tables: SceneTables, lit: LightCoefficients, cells: np.ndarray, side: int, ahead
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
    tables: SceneTables, lit: LightCoefficients, element: int, side: int, cells: np.ndarray
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


def _shade(normal: np.ndarray, lit: LightCoefficients) -> float:
    """Return how light a face is by its direction."""
    upright = lit.shade_up if normal[1] > 0 else lit.shade_down
    return float(normal**2 @ np.array([lit.shade_x, upright, lit.shade_z]))


def _corner_light(
    lattice: np.ndarray,
    lit: LightCoefficients,
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


def _colours(word: np.ndarray, lit: LightCoefficients, even: bool) -> np.ndarray:
    """Return float32 [N, 3]: the light of entries of the lattice."""
    every = np.arange(1 << 14)
    sky, block = (every & 63) / 60, (every >> 6 & 63) / 60
    sky, block = (level / (1 + lit.curve * (1 - level)) for level in (sky, block))
    table = np.array([lit.ambient_r, lit.ambient_g, lit.ambient_b])
    table = table + sky[:, None] * (lit.sky_r, lit.sky_g, lit.sky_b)
    table += block[:, None] * np.array([lit.block_r, lit.block_g, lit.block_b])
    dark = 1 if even else 1 - lit.corner * (every >> 12)[:, None]
    return (table * dark).astype(np.float32)[word]


NEAR = 0.02  # Cells. The ray caster has no near plane.
FIELDS = ("place", "at_texel", "light", "id")
FORMAT = "3f4 3f4 4f2 1u4"

VERTEX_SHADER = """
#version 430
uniform mat4 to_clip;
in vec3 place, at_texel; in vec4 light; in uint id;
out vec3 at, lit; flat out uint cell;
void main() {
    gl_Position = to_clip * vec4(place, 1.0);
    at = at_texel;
    lit = light.rgb;
    cell = id + 1u;
}
"""
FRAGMENT_SHADER = """
#version 430
const bool CUT = %s;
uniform sampler2DArray texels;
const float shoulder = 0.6;  // As in render.light.tone.
in vec3 at; in vec3 lit; flat in uint cell;
layout(location = 0) out vec4 colour; layout(location = 1) out uint index;
layout(location = 2) out float depth;
void main() {
    vec4 texel = texture(texels, at);
    if (CUT && texel.a < 0.25) discard;
    vec3 s = texel.rgb;
    vec3 c = s * (s * (s * 0.305306 + 0.682171) + 0.012523) * lit;
    float peak = max(c.r, max(c.g, c.b));
    if (peak > shoulder) {
        float room = 1.0 - shoulder;
        float pressed = 1.0 - room * room / (peak - shoulder + room);
        float keep = 1.0 / (1.0 + 0.18 * (peak - pressed));
        c = c * (keep * pressed / peak) + pressed * (1.0 - keep);
    }
    vec3 second = sqrt(c), fourth = sqrt(second), eighth = sqrt(fourth);
    colour = vec4(0.585122 * second + 0.783140 * fourth - 0.368263 * eighth, 1.0);
    index = cell;
    depth = 1.0 / gl_FragCoord.w;
}
"""


def why_not() -> str | None:
    """Return why the rival cannot run here, or None where it can."""
    try:
        import moderngl
    except ImportError:
        return "moderngl is not installed; pip install moderngl"
    try:
        context = moderngl.create_context(standalone=True, backend="egl")
    except Exception as error:  # Whatever the loader of GL libraries says.
        return f"no EGL context ({error}); apt install libegl1 libgl1-mesa-dri"
    name = context.info["GL_RENDERER"]
    context.release()
    return None if "llvmpipe" in name else f"EGL gives {name}, not Mesa's llvmpipe"


class Rasteriser:
    """Draws a mesh through one camera into arrays of its own."""

    def __init__(self, mesh: Mesh, texels: np.ndarray, side_px: int, camera: Camera):
        import moderngl

        self.gl = moderngl
        self.mesh, self.camera = mesh, camera
        self.context = moderngl.create_context(standalone=True, backend="egl")
        self.name = self.context.info["GL_RENDERER"]
        self.vertices = self.context.buffer(mesh.vertices.view(np.uint8))
        self.triangles = self.context.buffer(mesh.triangles)
        # Textures with holes have a shader of their own: one that may discard cannot test depth
        # before it runs.
        self.arrays = [self._array("false"), self._array("true")]
        finest = np.ascontiguousarray(texels[:, : side_px * side_px])
        self.texture = self.context.texture_array((side_px, side_px, len(finest)), 4, finest)
        self.texture.build_mipmaps()
        self.texture.filter = (moderngl.NEAREST_MIPMAP_NEAREST, moderngl.NEAREST)
        size = (camera.width_px, camera.height_px)
        self.frame = self.context.framebuffer(
            [
                self.context.texture(size, 4),
                self.context.texture(size, 1, dtype="u4"),
                self.context.texture(size, 1, dtype="f4"),
            ],
            self.context.depth_renderbuffer(size),
        )
        shape = (camera.height_px, camera.width_px)
        self.colour = np.empty((*shape, 4), np.uint8)
        self.index = np.empty(shape, np.uint32)
        self.depth = np.empty(shape, np.float32)

    def draw(self, camera_to_grid: np.ndarray, *, by_chunk: bool) -> None:
        """Draw and read back ``colour``, ``index`` and ``depth``.

        Args:
            camera_to_grid: float64 [4, 4], the camera's frame (metres) to cells.
            by_chunk: whether chunks outside the view are left out.
        """
        gl, context = self.gl, self.context
        to_clip = self._to_clip(camera_to_grid)
        self.frame.use()
        context.enable_only(gl.DEPTH_TEST | gl.CULL_FACE)
        context.front_face = "cw"  # Rows go down, which mirrors the picture.
        self.frame.clear(0.0, 0.0, 0.0, 0.0)
        self.texture.use(0)
        chunks = self._seen(to_clip) if by_chunk else np.arange(len(self.mesh.low))
        solid = chunks < self.mesh.solid_chunks
        for array, own in zip(self.arrays, (chunks[solid], chunks[~solid]), strict=True):
            array.program["to_clip"].write(np.ascontiguousarray(to_clip.T, np.float32))
            for first, last in _runs(self.mesh.starts, own):
                array.render(gl.TRIANGLES, vertices=6 * (last - first), first=6 * first)
        self.frame.read_into(self.colour, components=4, attachment=0)
        self.frame.read_into(self.index, components=1, attachment=1, dtype="u4")
        self.frame.read_into(self.depth, components=1, attachment=2, dtype="f4")

    def _array(self, cut: str):
        program = self.context.program(VERTEX_SHADER, FRAGMENT_SHADER % cut)
        return self.context.vertex_array(
            program, [(self.vertices, FORMAT, *FIELDS)], self.triangles
        )

    def _to_clip(self, camera_to_grid: np.ndarray) -> np.ndarray:
        """Return float64 [4, 4], cells to clip space; its w is the camera's z in metres."""
        camera = self.camera
        cell_m = 1 / np.linalg.norm(camera_to_grid[:3, 2])
        near, far = NEAR * cell_m, 2 * cell_m * float(np.linalg.norm(self._size()) + 1)
        projection = np.zeros((4, 4))
        projection[0, 0] = 2 * camera.fx_px / camera.width_px
        projection[0, 2] = 2 * camera.cx_px / camera.width_px - 1
        projection[1, 1] = 2 * camera.fy_px / camera.height_px
        projection[1, 2] = 2 * camera.cy_px / camera.height_px - 1
        projection[2, 2:] = (far + near) / (far - near), -2 * far * near / (far - near)
        projection[3, 2] = 1
        return projection @ np.linalg.inv(camera_to_grid)

    def _size(self) -> np.ndarray:
        return self.mesh.high.max(axis=0) - self.mesh.low.min(axis=0)

    def _seen(self, to_clip: np.ndarray) -> np.ndarray:
        """Return the chunks that reach into the view, int64 [V], the nearest first."""
        low, high = self.mesh.low, self.mesh.high
        seen = np.ones(len(low), bool)
        for row in range(3):
            for sign in (1, -1):
                plane = to_clip[3] + sign * to_clip[row]
                seen &= np.where(plane[:3] > 0, high, low) @ plane[:3] + plane[3] > 0
        chunks = np.flatnonzero(seen)
        middles = (low[chunks] + high[chunks]) / 2
        return chunks[np.argsort(middles @ to_clip[3, :3], kind="stable")]

    def release(self) -> None:
        """Give all of GL's memory back."""
        self.context.release()


def _runs(starts: np.ndarray, chunks: np.ndarray) -> list[tuple[int, int]]:
    """Return the spans of quads of some chunks, in their order; neighbours become one span."""
    runs: list[tuple[int, int]] = []
    for chunk in chunks.tolist():
        first, last = int(starts[chunk]), int(starts[chunk + 1])
        if runs and runs[-1][1] == first:
            runs[-1] = (runs[-1][0], last)
        else:
            runs.append((first, last))
    return runs


__all__ = ["CHUNK", "Rasteriser", "why_not"]

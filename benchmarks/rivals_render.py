"""The renderer's rival: a rasteriser on the processor, Mesa's llvmpipe, driven through moderngl.

It draws the culled mesh of the same scene (``benchmarks.rival_mesh``) into three targets, colour,
id and depth, with the same textures and the same light at the corners, and reads all three back to
numpy. Back faces are culled; chunks outside the view are left out where that is asked for. Glass
is drawn as if opaque, with holes cut out: blending would need sorting, which is spared the rival.
"""

import numpy as np

from benchmarks.rival_mesh import CHUNK, Mesh
from world2minecraft.types import Camera

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

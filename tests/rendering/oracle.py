"""A slow, readable caster in float64 that tells what a picture must hold.

It knows block states, models (``rendering.block_elements``) and nothing of the kernel: no tables,
no empty boxes, no tiles. Every ray goes from cell to cell, and in each is tested against every
element of the cell's block, all rays that are in the same kind of block at once. Elements that
reach beyond their block, and those of display entities, are tested against every ray.

The rules: a surface is the face by which a ray enters an element from outside; an element that
holds the camera is not seen; a face without texture is not there; a texel with alpha under 128 is a
hole, unless the texture is translucent or the block is glass, whose clear parts count; of two at
one place the later listed counts; between two blocks of one state whose model is a see-through
cube, leaves apart, there is no face.
"""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.rendering.block_elements import BlockModel, Element, ModelSource
from world2minecraft.rendering.texture import Texture

NO_FACE = 255
SIGNS = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]])


@dataclass
class Hits:
    """The nearest surface of each of N rays so far."""

    depth: np.ndarray  # float64 [N], inf for none
    index: np.ndarray  # int64 [N], the cell's C-order index, -1 for a display entity or none
    normal: np.ndarray  # float64 [N, 3], outward, in block axes; 0 for none
    thing: np.ndarray  # int64 [N], the number of the display entity, -1 for none

    def keep_nearer(self, rays: np.ndarray, depth, normal, index, thing) -> None:
        """Take what lies nearer on some of the rays, or as near."""
        nearer = (depth <= self.depth[rays]) & np.isfinite(depth)
        rays = rays[nearer]
        self.depth[rays], self.normal[rays] = depth[nearer], normal[nearer]
        self.index[rays] = np.broadcast_to(index, depth.shape)[nearer]
        self.thing[rays] = thing


class WithoutGlass:
    """Looks in which all that is translucent is not there: what lies behind glass is first."""

    def __init__(self, looks: ModelSource):
        self.looks = looks

    def model(self, state: str) -> BlockModel | None:
        """Return the model with the faces that are not translucent."""
        model = self.looks.model(state)
        return model and replace(model, elements=tuple(map(self._seen_through, model.elements)))

    def texture(self, name: str) -> Texture | None:
        """Return a texture as it is."""
        return self.looks.texture(name)

    def _seen_through(self, element: Element) -> Element:
        textures = [face and self.looks.texture(face.texture) for face in element.faces]
        kept = (
            None if texture is not None and texture.translucent else face
            for face, texture in zip(element.faces, textures, strict=True)
        )
        return replace(element, faces=tuple(kept))


def oracle_picture(
    volume: BlockVolume, looks: ModelSource, camera: Camera, camera_to_room: np.ndarray
) -> Hits:
    """Return the first surface that each pixel meets; ``depth`` is the camera's z in metres."""
    u, v = np.meshgrid(np.arange(camera.width_px) + 0.5, np.arange(camera.height_px) + 0.5)
    at_one = np.stack(
        [
            (u - camera.cx_px) / camera.fx_px,
            (v - camera.cy_px) / camera.fy_px,
            np.ones_like(u),
        ],
        axis=-1,
    ).reshape(-1, 3)
    to_grid = np.linalg.inv(volume.block_to_room) @ camera_to_room
    to_grid[:3, 3] -= volume.corner
    hits = cast(volume, looks, to_grid[:3, 3], at_one @ to_grid[:3, :3].T)
    shape = (camera.height_px, camera.width_px)
    fields = (hits.depth, hits.index, hits.normal, hits.thing)
    return Hits(*(field.reshape(*shape, *field.shape[1:]) for field in fields))


def has_face(hits: Hits, face: np.ndarray) -> np.ndarray:
    """Tell where ``face`` is the side of a block that looks most like the surface met.

    Of sides that look like it equally, as of a box turned by 45 degrees, any will do.
    """
    none = face == NO_FACE
    likeness = np.einsum("...a,...a->...", SIGNS[np.where(none, 0, face)], hits.normal)
    best = np.abs(hits.normal).max(axis=-1)
    return np.where(none, best == 0, (best > 0) & (likeness >= best - 1e-6))


def cast(volume: BlockVolume, looks: ModelSource, origin: np.ndarray, rays: np.ndarray) -> Hits:
    """Cast ``rays`` float64 [N, 3] from ``origin`` float64 [3], both in cells of the volume."""
    count = len(rays)
    rays = np.where(np.abs(rays) < 1e-12, 1e-12, rays)
    hits = Hits(
        np.full(count, np.inf), np.full(count, -1), np.zeros((count, 3)), np.full(count, -1)
    )  # fmt: skip
    models = [_elements(looks, state) for state in volume.palette]
    inner = [[one for one in model if not reaches_out(one)] for model in models]
    _walk(volume, looks, inner, origin, rays, hits)
    every = np.arange(count)
    for row, model in enumerate(models):
        for element in filter(reaches_out, model):
            for cell in np.argwhere(volume.states == row):
                number = np.ravel_multi_index(cell, volume.states.shape)
                own = looks_of(volume.palette[row], looks)
                depth, normal = meet(element, own, origin - cell, rays)
                hits.keep_nearer(every, depth, normal, number, -1)
    for number, cube in enumerate(display_cubes(volume.entities)):
        turn = cube.cube_to_world.copy()
        turn[:3, 3] -= volume.corner
        for element in _elements(looks, cube.state):
            depth, normal = meet(element, looks_of(cube.state, looks), origin, rays, turn)
            hits.keep_nearer(every, depth, normal, -1, number)
    return hits


class Panes:
    """Looks whose textures have no holes: those of glass."""

    def __init__(self, looks: ModelSource):
        self._looks = looks
        self.model = looks.model

    def texture(self, name: str) -> Texture | None:
        texture = self._looks.texture(name)
        return texture and replace(texture, translucent=True)


def looks_of(state: str, looks: ModelSource) -> ModelSource:
    """Return what the textures of a state are taken from."""
    return Panes(looks) if "glass" in state.partition("[")[0] else looks


def _elements(looks: ModelSource, state: str) -> tuple[Element, ...]:
    model = looks.model(state)
    return model.elements if model else ()


def reaches_out(element: Element) -> bool:
    """Whether a corner of an element lies beyond its block."""
    ends = np.array([element.low, element.high])
    corners = np.array([[ends[a, 0], ends[b, 1], ends[c, 2]] for a, b, c in np.ndindex(2, 2, 2)])
    if element.turn is not None:
        corners = corners @ element.turn[:3, :3].T + element.turn[:3, 3]
    return bool((corners < -1e-4).any() or (corners > 1 + 1e-4).any())


def meet(
    element: Element,
    looks: ModelSource,
    origin: np.ndarray,
    rays: np.ndarray,
    turn: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return where rays enter an element, float64 [N] or inf, and the normals there, [N, 3].

    Args:
        element: in its own frame.
        looks: gives its textures.
        origin: float64 [3] or [N, 3], in the frame that the element's turn leads to.
        rays: float64 [N, 3], alike.
        turn: leads from the element's block to the frame of the rays, where they differ.
    """
    to_frame = np.eye(4) if turn is None else turn
    to_frame = to_frame if element.turn is None else to_frame @ element.turn
    to_element = np.linalg.inv(to_frame)
    origin = np.broadcast_to(origin @ to_element[:3, :3].T + to_element[:3, 3], rays.shape)
    rays = rays @ to_element[:3, :3].T
    rays = np.where(np.abs(rays) < 1e-12, 1e-12, rays)
    to_low = (np.float32(element.low).astype(float) - origin) / rays
    to_high = (np.float32(element.high).astype(float) - origin) / rays
    enters = np.minimum(to_low, to_high)
    enter, leave = enters.max(axis=1), np.maximum(to_low, to_high).min(axis=1)
    axis = enters.argmax(axis=1)
    going_up = np.take_along_axis(rays, axis[:, None], axis=1)[:, 0] > 0
    face = (2 * axis + ~going_up).astype(np.uint8)
    depth = np.where((enter <= leave) & (enter > 0), enter, np.inf)
    met = np.isfinite(depth)
    points = origin[met] + depth[met, None] * rays[met]
    depth[np.flatnonzero(met)[~_is_there(element, looks, face[met], points)]] = np.inf
    gradient = to_element[:3, :3] / np.linalg.norm(to_element[:3, :3], axis=1, keepdims=True)
    return depth, np.where(going_up, -1, 1)[:, None] * gradient[axis]


def _is_there(element: Element, looks: ModelSource, face: np.ndarray, points: np.ndarray):
    """Tell, bool [N], whether a face has something at points of the element's frame."""
    there = np.ones(len(points), bool)
    for side, look in enumerate(element.faces):
        on = face == side
        if look is None:
            there[on] = False
            continue
        texture = looks.texture(look.texture)
        if texture is None or texture.translucent or not texture.has_holes:
            continue
        size = len(texture.colour)
        place = points[on] @ np.asarray(look.uv)[:, :3].T + np.asarray(look.uv)[:, 3]
        texel = np.minimum(((place - np.floor(place)) * size).astype(int), size - 1)
        there[on] = texture.colour[texel[:, 1], texel[:, 0], 3] >= 128
    return there


def _walk(volume: BlockVolume, looks: ModelSource, models, origin, rays, hits: Hits) -> None:
    """Go from cell to cell with all rays that have met nothing yet."""
    shape = np.array(volume.states.shape)
    joined = [
        _joins(state, model, looks) for state, model in zip(volume.palette, models, strict=True)
    ]
    cell, active = _first_cells(shape, origin, rays)
    while len(active):
        states = volume.states[tuple(cell.T)]
        for row in np.unique(states):
            here = np.flatnonzero(states == row)
            number = np.ravel_multi_index(tuple(cell[here].T), tuple(shape))
            for element in models[row]:
                own = looks_of(volume.palette[row], looks)
                depth, normal = meet(element, own, origin - cell[here], rays[active[here]])
                if joined[row]:
                    depth[_faces_its_like(volume, cell[here], normal)] = np.inf
                hits.keep_nearer(active[here], depth, normal, number, -1)
        going = ~np.isfinite(hits.depth[active])
        active, cell = active[going], cell[going]
        ray = rays[active]
        to_wall = (cell + (ray > 0) - origin) / ray
        axis = to_wall.argmin(axis=1)
        each = np.arange(len(axis))
        cell[each, axis] += np.where(ray[each, axis] > 0, 1, -1)
        inside = ((cell >= 0) & (cell < shape)).all(axis=1)
        active, cell = active[inside], cell[inside]


def _first_cells(shape: np.ndarray, origin: np.ndarray, rays: np.ndarray):
    """Return the first cell of each ray, int64 [M, 3], and which rays have one, int64 [M]."""
    if ((origin >= 0) & (origin < shape)).all():
        return np.tile(np.floor(origin).astype(np.int64), (len(rays), 1)), np.arange(len(rays))
    to_low, to_high = -origin / rays, (shape - origin) / rays
    enters = np.minimum(to_low, to_high)
    enter, leave = enters.max(axis=1), np.maximum(to_low, to_high).min(axis=1)
    active = np.flatnonzero((enter > 0) & (enter < leave))
    cell = np.floor(origin + enter[active, None] * rays[active]).astype(np.int64)
    cell = np.clip(cell, 0, shape - 1)
    axis = enters[active].argmax(axis=1)
    each = np.arange(len(active))
    cell[each, axis] = np.where(rays[active, axis] > 0, 0, shape[axis] - 1)
    return cell, active


def _joins(state: str, model, looks: ModelSource) -> bool:
    """Whether it is a see-through cube that shows no face to its like."""
    if len(model) != 1 or "leaves" in state.partition("[")[0]:
        return False
    (one,) = model
    if one.turn is not None or tuple(one.low) != (0, 0, 0) or tuple(one.high) != (1, 1, 1):
        return False
    textures = [face and looks.texture(face.texture) for face in one.faces]
    return any(face is None or (texture is not None and texture.has_holes)
               for face, texture in zip(one.faces, textures, strict=True))  # fmt: skip


def _faces_its_like(volume: BlockVolume, cell: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Tell, bool [N], whether the neighbour that a face looks at has the same state."""
    shape = np.array(volume.states.shape)
    ahead = cell + np.round(normal).astype(np.int64)
    inside = ((ahead >= 0) & (ahead < shape)).all(axis=1)
    same = np.zeros(len(cell), bool)
    same[inside] = volume.states[tuple(ahead[inside].T)] == volume.states[tuple(cell[inside].T)]
    return same

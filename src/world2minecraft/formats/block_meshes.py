"""Meshes of a block volume: one for each object, wall, floor, ceiling and window.

Meshes are in metres with y up (block axes times the block size, from the room's origin). Each mesh
is closed and has a colour for every face. Display entities belong to the object that they
represent. Invisible blocks (air, barriers, light blocks) have no mesh.

Touching boxes of one owner hide each other's faces, and adjacent faces of one material are merged
to rectangles (greedy meshing). The result is the exact surface of the union of an owner's boxes, if
they do not overlap. Owners do not hide each other's faces: each has a closed mesh of its own that
can be moved. A transparent material hides only other transparent materials.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.coordinates import ROOM_AXES_TO_BLOCK, apply
from world2minecraft.core.jit import njit
from world2minecraft.core.types import BlockVolume
from world2minecraft.core.vocabulary import object_title
from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.collision_shapes import FULL_CUBE
from world2minecraft.minecraft.commands.fill_boxes import cover_with_boxes
from world2minecraft.minecraft.entities import display_cubes, owner_of
from world2minecraft.minecraft.visual_shapes import is_luminous, visual_boxes

# Which ends of u and v the four corners take, counter-clockwise for a face along its axis.
_U_ENDS, _V_ENDS = np.array([0, 1, 1, 0]), np.array([0, 0, 1, 1])
STEPS = 64  # Parts of a block that box corners are rounded to; the game's own table needs 32.
CLEAR_ALPHA = 90  # Of 255: a pane is seen and seen through.
CLEAR_NAMES = ("glass", "ice")  # Parts of names, as of glass_pane; not of packed_ice.
OPAQUE_NAMES = ("packed_ice", "blue_ice", "tinted_glass")
ANY_SIZE = 1 << 30
_CLASSES = 1 << 16  # Owners below it are instances, above it classes without instances.


class Faces(NamedTuple):
    """Rectangles on planes perpendicular to an axis.

    ``u`` and ``v`` are the next two axes in cyclic order. Rows are sorted by owner. A face points
    along its axis if ``side`` is 1, and against it otherwise.
    """

    owner: np.ndarray  # int32 [F]
    axis: np.ndarray  # int32 [F], 0 x, 1 y, 2 z
    plane: np.ndarray  # int32 [F]
    side: np.ndarray  # int32 [F], 0 or 1
    u: np.ndarray  # int32 [F, 2], low and high
    v: np.ndarray  # int32 [F, 2]
    material: np.ndarray  # int32 [F]

    def corners(self) -> np.ndarray:
        """Return the corners, int32 [F, 4, 3], counter-clockwise seen from outside."""
        corners = np.empty((len(self.owner), 4, 3), np.int32)
        u_ends = np.where(self.side[:, None] == 1, _U_ENDS, _U_ENDS[::-1])
        v_ends = np.where(self.side[:, None] == 1, _V_ENDS, _V_ENDS[::-1])
        axis = self.axis[:, None, None]
        values = (
            self.plane[:, None].repeat(4, 1),
            np.take_along_axis(self.u, u_ends, 1),
            np.take_along_axis(self.v, v_ends, 1),
        )
        for step, value in enumerate(values):
            np.put_along_axis(
                corners, np.broadcast_to((axis + step) % 3, (len(axis), 4, 1)), value[..., None], 2
            )
        return corners

    def normals(self) -> np.ndarray:
        """Return the normals of the faces, int32 [F, 3]."""
        result = np.zeros((len(self.owner), 3), np.int32)
        result[np.arange(len(result)), self.axis] = 2 * self.side - 1
        return result


class _Ranks(NamedTuple):
    """The distinct values of each plane along one axis, and the ranks of each row's two ends."""

    values: np.ndarray  # int32 [K], plane by plane
    starts: np.ndarray  # int64 [P + 1], where each plane's values begin
    ranks: np.ndarray  # int64 [N, 2], the numbers of a row's low and high value within its plane


def visible_faces(
    boxes: np.ndarray, owner: np.ndarray, material: np.ndarray, is_clear: np.ndarray
) -> Faces:
    """Return the surface of each owner's boxes.

    Args:
        boxes: Boxes x0 y0 z0 x1 y1 z1 with positive volume, int32 [N, 6].
        owner: Owner of each box, int32 [N].
        material: Index of each box's material into ``is_clear``, int32 [N].
        is_clear: Whether each material is transparent, bool [M].
    """
    rows = np.concatenate([_side(boxes, owner, material, a, s) for a in range(3) for s in (0, 1)])
    rows = rows[np.lexsort((rows[:, 2], rows[:, 1], rows[:, 0]))]
    is_first = np.ones(len(rows) + 1, bool)
    is_first[1:-1] = (rows[1:, :3] != rows[:-1, :3]).any(axis=1)
    starts = np.flatnonzero(is_first)
    plane = np.cumsum(is_first[:-1]) - 1
    us = _ranks(plane, rows[:, [4, 6]])
    vs = _ranks(plane, rows[:, [5, 7]])
    found = np.empty((len(rows), 9), np.int32)
    count = _visible(rows, starts, us, vs, is_clear, found)
    if count > len(found):  # Parts of faces may be more than the faces.
        found = np.empty((count, 9), np.int32)
        _visible(rows, starts, us, vs, is_clear, found)
    owner, axis, plane, side, u0, v0, u1, v1, material = np.ascontiguousarray(found[:count].T)
    return Faces(owner, axis, plane, side, np.stack([u0, u1], 1), np.stack([v0, v1], 1), material)


def _ranks(plane: np.ndarray, ends: np.ndarray) -> _Ranks:
    """Number the distinct values of each plane in ascending order.

    Args:
        plane: Plane of each row in ascending order, int64 [N].
        ends: Values of the rows, int32 [N, 2].
    """
    wide = np.int64(1) << 32
    keys = plane[:, None] * wide + (ends.astype(np.int64) + (wide >> 1))
    held, numbers = np.unique(keys, return_inverse=True)
    owner = held // wide
    starts = np.searchsorted(owner, np.arange(int(plane[-1]) + 2 if len(plane) else 1))
    ranks = numbers.reshape(ends.shape) - starts[plane][:, None]
    return _Ranks((held % wide - (wide >> 1)).astype(np.int32), starts, ranks)


def _side(
    boxes: np.ndarray, owner: np.ndarray, material: np.ndarray, axis: int, side: int
) -> np.ndarray:
    """Return one face of each box: owner, axis, plane, side, u0 v0 u1 v1, material."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    rows = np.empty((len(boxes), 9), np.int32)
    rows[:, 0], rows[:, 1], rows[:, 3], rows[:, 8] = owner, axis, side, material
    rows[:, 2] = boxes[:, axis + 3 * side]
    rows[:, 4], rows[:, 5], rows[:, 6], rows[:, 7] = boxes[:, [u, v, u + 3, v + 3]].T
    return rows


@njit
def _visible(rows, starts, us, vs, is_clear, found):  # pragma: no cover
    """Fill ``found`` as far as it has space, and return the number of rows.

    ``rows`` [N, 9] are those of ``_side``, grouped by plane with offsets ``starts`` [P + 1]. ``us``
    and ``vs`` are their ``_Ranks`` along u and v.
    """
    count = 0
    for plane in range(len(starts) - 1):
        wide = us.starts[plane + 1] - us.starts[plane] - 1
        high = vs.starts[plane + 1] - vs.starts[plane] - 1
        drawn = np.zeros((2, wide, high), np.int32)
        for row in range(starts[plane], starts[plane + 1]):
            side, kind = rows[row, 3], rows[row, 8] + 1
            for u in range(us.ranks[row, 0], us.ranks[row, 1]):
                for v in range(vs.ranks[row, 0], vs.ranks[row, 1]):
                    held = drawn[side, u, v]
                    if held == 0 or is_clear[held - 1]:
                        drawn[side, u, v] = kind
        for u in range(wide):
            for v in range(high):
                low, up = drawn[0, u, v], drawn[1, u, v]
                if low != 0 and up != 0:
                    low_is_clear, up_is_clear = is_clear[low - 1], is_clear[up - 1]
                    if low_is_clear or not up_is_clear:
                        drawn[0, u, v] = 0
                    if up_is_clear or not low_is_clear:
                        drawn[1, u, v] = 0
        first = starts[plane]
        for side in range(2):
            for u in range(wide):
                for v in range(high):
                    kind = drawn[side, u, v]
                    if kind == 0:
                        continue
                    v1 = v + 1
                    while v1 < high and drawn[side, u, v1] == kind:
                        v1 += 1
                    u1 = u + 1
                    while u1 < wide and _is_all(drawn, side, u1, v, v1, kind):
                        u1 += 1
                    for a in range(u, u1):
                        for b in range(v, v1):
                            drawn[side, a, b] = 0
                    if count < len(found):
                        found[count, 0] = rows[first, 0]
                        found[count, 1] = rows[first, 1]
                        found[count, 2] = rows[first, 2]
                        found[count, 3], found[count, 8] = side, kind - 1
                        found[count, 4] = us.values[us.starts[plane] + u]
                        found[count, 5] = vs.values[vs.starts[plane] + v]
                        found[count, 6] = us.values[us.starts[plane] + u1]
                        found[count, 7] = vs.values[vs.starts[plane] + v1]
                    count += 1
    return count


@njit
def _is_all(drawn, side, u, v0, v1, kind):  # pragma: no cover
    for v in range(v0, v1):  # noqa: SIM110  # A kernel has no generators.
        if drawn[side, u, v] != kind:
            return False
    return True


@dataclass(frozen=True)
class Look:
    """The appearance of a face: sRGB colour, opacity (0 to 255), and whether it glows."""

    rgb: tuple[int, int, int]
    alpha: int = 255
    glows: bool = False

    @property
    def is_clear(self) -> bool:
        """Whether the face is transparent."""
        return self.alpha < 255


@dataclass(frozen=True, eq=False)
class BlockMesh:
    """A closed mesh of rectangles in metres with y up.

    ``corners`` are counter-clockwise seen from outside. ``instance`` is 0 for structure and for
    blocks without labels, whose meshes contain all blocks of their class.
    """

    class_id: int
    instance: int
    corners: np.ndarray  # float64 [F, 4, 3]
    normals: np.ndarray  # float64 [F, 3]
    looks: np.ndarray  # int32 [F], indices into the looks of the volume
    object_name: str = ""  # such as "office chair"; empty if unknown

    @property
    def title(self) -> str:
        """The text that people read: the object's name, or that of its class."""
        if not self.class_id:
            return "unknown"
        return object_title(self.object_name, self.class_id)

    @property
    def name(self) -> str:
        """A name that is unique among the meshes of the volume, such as ``office_chair_7``."""
        kind = re.sub(r"\W+", "_", self.title).strip("_") if self.class_id else "blocks"
        return f"{kind}_{self.instance}" if self.instance else kind

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The minimum and maximum corner, float64 [3] each."""
        return self.corners.min(axis=(0, 1)), self.corners.max(axis=(0, 1))


def volume_meshes(
    volume: BlockVolume, names: Mapping[int, str] | None = None
) -> tuple[list[BlockMesh], list[Look]]:
    """Return the meshes of a volume, structure first, then objects by id, and their looks.

    ``names`` contains the names of objects by id, if known.
    """
    named = names or {}
    looks = _Looks()
    owners = _owners(volume)
    parts = [_block_faces(volume, owners, looks), *_display_faces(volume, looks)]
    owner = np.concatenate([part[0] for part in parts])
    corners, normals, kinds = (np.concatenate([part[n] for part in parts]) for n in (1, 2, 3))
    to_metres = np.eye(4)
    to_metres[:3, :3] = ROOM_AXES_TO_BLOCK
    to_metres = to_metres @ volume.block_to_room
    corners = apply(to_metres, corners)
    normals = normals @ to_metres[:3, :3].T
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    class_of = _classes_of(volume, owners)
    meshes = []
    for number in sorted(set(owner.tolist()), key=lambda one: (one < _CLASSES, one)):
        rows = owner == number
        instance = number if number < _CLASSES else 0
        class_id = class_of.get(number, 0) if instance else number - _CLASSES
        faces = (corners[rows], normals[rows], kinds[rows])
        meshes.append(BlockMesh(class_id, instance, *faces, named.get(instance, "")))
    return meshes, looks.held


class _Looks:
    """The distinct looks of a volume."""

    def __init__(self) -> None:
        self.held: list[Look] = []
        self._number_of: dict[Look, int] = {}

    def of(self, state: str) -> int:
        """Return the number of a state's look."""
        name = state.partition("[")[0].partition(":")[2]
        is_clear = any(part in name for part in CLEAR_NAMES) and name not in OPAQUE_NAMES
        look = Look(colour_of(state), CLEAR_ALPHA if is_clear else 255, is_luminous(state))
        if look not in self._number_of:
            self._number_of[look] = len(self.held)
            self.held.append(look)
        return self._number_of[look]

    def clear(self) -> np.ndarray:
        """Return which looks are clear, bool [N]."""
        return np.array([look.is_clear for look in self.held], bool)


def _owners(volume: BlockVolume) -> np.ndarray:
    """Return the owner of each block, int32 [X, Y, Z]: an object id or a structure class."""
    semantic = volume.semantic.astype(np.int32)
    kind = np.where(semantic < len(CLASS_NAMES), semantic, 0)
    return np.where(volume.instance > 0, volume.instance, _CLASSES + kind).astype(np.int32)


def _classes_of(volume: BlockVolume, owners: np.ndarray) -> dict[int, int]:
    """Return the class of each object by its blocks, or by its entities if it has none."""
    found = {instance: class_id for class_id, instance in map(owner_of, volume.entities)}
    labelled = (volume.instance > 0) & (volume.semantic > 0)
    labelled &= volume.semantic < len(CLASS_NAMES)
    pairs = volume.instance[labelled].astype(np.int64) * 256 + volume.semantic[labelled]
    kinds, counts = np.unique(pairs, return_counts=True)
    for pair in kinds[np.argsort(counts, kind="stable")].tolist():  # The most frequent wins.
        found[pair // 256] = pair % 256
    return found


def _block_faces(volume: BlockVolume, owners: np.ndarray, looks: _Looks) -> tuple[np.ndarray, ...]:
    """Return owner [F], corners [F, 4, 3] and normals [F, 3] in blocks, and look [F]."""
    full, found = [], []
    for number in np.unique(volume.states).tolist():
        state = volume.palette[number]
        boxes = visual_boxes(state)
        if np.array_equal(boxes, FULL_CUBE):
            full.append(number)
        elif len(boxes):
            found.append(_part_boxes(volume.states == number, owners, boxes, looks.of(state)))
    found.append(_cube_boxes(volume, owners, full, looks))
    rows = np.concatenate(found).astype(np.int32)
    faces = visible_faces(rows[:, :6], rows[:, 6], rows[:, 7], looks.clear())
    corners = faces.corners() / STEPS + np.array(volume.corner, np.float64)
    return faces.owner, corners, faces.normals().astype(np.float64), faces.material


def _part_boxes(where: np.ndarray, owners: np.ndarray, boxes: np.ndarray, look: int) -> np.ndarray:
    """Return the boxes of all blocks of one state with owner and look, int64 [N, 8]."""
    cells = np.argwhere(where)
    parts = np.rint(boxes.astype(np.float64) * STEPS).astype(np.int64)
    parts = parts[(parts[:, 3:] > parts[:, :3]).all(axis=1)]
    placed = np.tile(cells, 2)[:, None] * STEPS + parts
    whose = np.repeat(owners[tuple(cells.T)], len(parts))
    return np.column_stack([placed.reshape(-1, 6), whose, np.full(len(whose), look)])


def _cube_boxes(
    volume: BlockVolume, owners: np.ndarray, full: list[int], looks: _Looks
) -> np.ndarray:
    """Return the boxes of full blocks like ``_part_boxes``, merging equal neighbours."""
    look_of = np.full(len(volume.palette), -1, np.int64)
    look_of[full] = [looks.of(volume.palette[number]) for number in full]
    kinds = look_of[volume.states]
    keys = np.where(kinds >= 0, owners * (len(volume.palette) + 1) + kinds + 1, 0)
    pairs, numbers = np.unique(keys, return_inverse=True)
    first = int(pairs[0] != 0) if len(pairs) else 0  # 0 stands for "no whole block".
    boxes = cover_with_boxes((numbers.reshape(keys.shape) + first).astype(np.int32), ANY_SIZE)
    pair = pairs[boxes[:, 0] - first] - 1
    whose, look = np.divmod(pair, len(volume.palette) + 1)
    spans = np.concatenate([boxes[:, 1:4], boxes[:, 4:] + 1], axis=1) * STEPS
    return np.column_stack([spans, whose, look])


def _display_faces(volume: BlockVolume, looks: _Looks) -> Iterable[tuple[np.ndarray, ...]]:
    """Yield the faces of each block display like ``_block_faces``."""
    for cube in display_cubes(volume.entities):
        boxes = visual_boxes(cube.state).astype(np.float64)
        if not len(boxes):
            continue
        look = looks.of(cube.state)
        rows = np.rint(boxes * STEPS).astype(np.int32)
        owner = cube.instance or _CLASSES + cube.class_id
        whose, kinds = np.full(len(rows), owner, np.int32), np.full(len(rows), look, np.int32)
        faces = visible_faces(rows, whose, kinds, looks.clear())
        corners = apply(cube.cube_to_world, faces.corners() / STEPS)
        # Normals go by the inverse's transpose; what a mirror turns inside out is turned back.
        turn = cube.cube_to_world[:3, :3]
        if abs(np.linalg.det(turn)) < 1e-12:
            continue
        normals = faces.normals() @ np.linalg.inv(turn)
        if np.linalg.det(turn) < 0:
            corners = corners[:, ::-1]
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        yield faces.owner, corners, normals, faces.material

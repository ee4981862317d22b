"""A block volume as bodies: one mesh for each object, wall, floor, ceiling and window.

In: a BlockVolume. Out: bodies in metres with y up (block axes times the block's size, from the
room's origin), closed each for itself, with the colour of every face. Display entities belong to
the object that they draw. What nobody sees (air, barriers, light blocks) has no body.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.coordinates import ROOM_AXES_TO_BLOCK, apply
from world2minecraft.core.types import BlockVolume
from world2minecraft.formats.faces import faces_of_boxes
from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.collision_shapes import FULL_CUBE
from world2minecraft.minecraft.commands.fill_boxes import merge_boxes
from world2minecraft.minecraft.displays import display_cubes, owner_of
from world2minecraft.minecraft.glow import is_luminous
from world2minecraft.minecraft.visual import visual_boxes_of

STEPS = 64  # Parts of a block that box corners are rounded to; the game's own table needs 32.
CLEAR_ALPHA = 90  # Of 255: a pane is seen and seen through.
CLEAR_NAMES = ("glass", "ice")  # Parts of names, as of glass_pane; not of packed_ice.
OPAQUE_NAMES = ("packed_ice", "blue_ice", "tinted_glass")
ANY_SIZE = 1 << 30
_CLASSES = 1 << 16  # Owners below it are instances, above it classes without instances.


@dataclass(frozen=True)
class Look:
    """How a face is drawn: its sRGB colour, how opaque it is (0 to 255), whether it glows."""

    rgb: tuple[int, int, int]
    alpha: int = 255
    glows: bool = False

    @property
    def is_clear(self) -> bool:
        """Whether one sees through."""
        return self.alpha < 255


@dataclass(frozen=True, eq=False)
class Body:
    """One closed mesh of rectangles, in metres, y up.

    ``corners`` are counter-clockwise seen from outside. ``instance`` is 0 for structure and for
    what has no label; their bodies hold all blocks of their class.
    """

    class_id: int
    instance: int
    corners: np.ndarray  # float64 [F, 4, 3]
    normals: np.ndarray  # float64 [F, 3]
    looks: np.ndarray  # int32 [F], indices into the looks of the volume

    @property
    def name(self) -> str:
        """A name that no other body of the volume has."""
        kind = CLASS_NAMES[self.class_id] if self.class_id else "blocks"
        return f"{kind}_{self.instance}" if self.instance else kind

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and the highest corner, float64 [3] each."""
        return self.corners.min(axis=(0, 1)), self.corners.max(axis=(0, 1))


def bodies_of(volume: BlockVolume) -> tuple[list[Body], list[Look]]:
    """Return the bodies of a volume, structure first, then objects by number; and their looks."""
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
    bodies = []
    for number in sorted(set(owner.tolist()), key=lambda one: (one < _CLASSES, one)):
        rows = owner == number
        instance = number if number < _CLASSES else 0
        class_id = class_of.get(number, 0) if instance else number - _CLASSES
        bodies.append(Body(class_id, instance, corners[rows], normals[rows], kinds[rows]))
    return bodies, looks.held


class _Looks:
    """The looks that are met, each once."""

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
    """Return whose each block is, int32 [X, Y, Z]: an instance, else a class of structure."""
    semantic = volume.semantic.astype(np.int32)
    kind = np.where(semantic < len(CLASS_NAMES), semantic, 0)
    return np.where(volume.instance > 0, volume.instance, _CLASSES + kind).astype(np.int32)


def _classes_of(volume: BlockVolume, owners: np.ndarray) -> dict[int, int]:
    """Return the class of each instance: of most of its blocks, else of its entities."""
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
        boxes = visual_boxes_of(state)
        if np.array_equal(boxes, FULL_CUBE):
            full.append(number)
        elif len(boxes):
            found.append(_part_boxes(volume.states == number, owners, boxes, looks.of(state)))
    found.append(_cube_boxes(volume, owners, full, looks))
    rows = np.concatenate(found).astype(np.int32)
    faces = faces_of_boxes(rows[:, :6], rows[:, 6], rows[:, 7], looks.clear())
    corners = faces.corners() / STEPS + np.array(volume.corner, np.float64)
    return faces.owner, corners, faces.normals().astype(np.float64), faces.material


def _part_boxes(where: np.ndarray, owners: np.ndarray, boxes: np.ndarray, look: int) -> np.ndarray:
    """Return int64 [N, 8]: the boxes of all blocks of one state in steps, owner, look."""
    cells = np.argwhere(where)
    parts = np.rint(boxes.astype(np.float64) * STEPS).astype(np.int64)
    parts = parts[(parts[:, 3:] > parts[:, :3]).all(axis=1)]
    placed = np.tile(cells, 2)[:, None] * STEPS + parts
    whose = np.repeat(owners[tuple(cells.T)], len(parts))
    return np.column_stack([placed.reshape(-1, 6), whose, np.full(len(whose), look)])


def _cube_boxes(
    volume: BlockVolume, owners: np.ndarray, full: list[int], looks: _Looks
) -> np.ndarray:
    """Return the boxes of whole blocks as ``_part_boxes`` does, equal neighbours as one."""
    look_of = np.full(len(volume.palette), -1, np.int64)
    look_of[full] = [looks.of(volume.palette[number]) for number in full]
    kinds = look_of[volume.states]
    keys = np.where(kinds >= 0, owners * (len(volume.palette) + 1) + kinds + 1, 0)
    pairs, numbers = np.unique(keys, return_inverse=True)
    first = int(pairs[0] != 0) if len(pairs) else 0  # 0 stands for "no whole block".
    boxes = merge_boxes((numbers.reshape(keys.shape) + first).astype(np.int32), ANY_SIZE)
    pair = pairs[boxes[:, 0] - first] - 1
    whose, look = np.divmod(pair, len(volume.palette) + 1)
    spans = np.concatenate([boxes[:, 1:4], boxes[:, 4:] + 1], axis=1) * STEPS
    return np.column_stack([spans, whose, look])


def _display_faces(volume: BlockVolume, looks: _Looks) -> Iterable[tuple[np.ndarray, ...]]:
    """Yield as ``_block_faces`` what each block display draws."""
    for cube in display_cubes(volume.entities):
        boxes = visual_boxes_of(cube.state).astype(np.float64)
        if not len(boxes):
            continue
        look = looks.of(cube.state)
        rows = np.rint(boxes * STEPS).astype(np.int32)
        owner = cube.instance or _CLASSES + cube.class_id
        whose, kinds = np.full(len(rows), owner, np.int32), np.full(len(rows), look, np.int32)
        faces = faces_of_boxes(rows, whose, kinds, looks.clear())
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

"""Collisions of a moving box with block boxes: axis sweeps, stepping up and standing.

Boxes are float64 [N, 6] with the low and the high corner. A box that the moving box already
overlaps does not stop it.
"""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.physics.player_body import STEP_HEIGHT, TOUCH, WIDTH, body_box

_OTHERS = ((1, 2), (0, 2), (0, 1))
_TALLEST = 1  # Cells by which a box may reach beyond its own: fences are 1.5 high.
_RINGS = 40  # Of places tried around one that is taken, a quarter of a body apart.


def find_overlaps(boxes: np.ndarray, box: np.ndarray, touch: float = TOUCH) -> np.ndarray:
    """Return which boxes overlap a given box, as bool [N]. Boxes that only touch do not overlap."""
    inside = (boxes[:, :3] < box[3:] - touch) & (boxes[:, 3:] > box[:3] + touch)
    return np.asarray(inside.all(axis=1))


def free_distance(
    boxes: np.ndarray, box: np.ndarray, axis: int, way: float, touch: float = TOUCH
) -> float:
    """Return the distance that a box can move along one axis before it meets another box.

    The distance has the sign of ``way`` and at most its size.
    """
    if not way or not len(boxes):
        return way
    one, two = _OTHERS[axis]
    in_reach = (
        (boxes[:, one] < box[3 + one] - touch)
        & (boxes[:, 3 + one] > box[one] + touch)
        & (boxes[:, two] < box[3 + two] - touch)
        & (boxes[:, 3 + two] > box[two] + touch)
    )
    if way > 0:
        gaps = boxes[in_reach, axis] - box[3 + axis]
        return float(min(way, gaps[gaps >= -touch].min(initial=way)))
    gaps = boxes[in_reach, 3 + axis] - box[axis]
    return float(max(way, gaps[gaps <= touch].max(initial=way)))


def sweep_box(
    boxes: np.ndarray, box: np.ndarray, way: np.ndarray, touch: float = TOUCH
) -> tuple[float, float, float]:
    """Return how far a box can move along a movement vector, float64 [3], before it collides.

    As in the game, the box moves vertically first and then along the longer horizontal axis, so
    that it slides along obstacles.
    """
    longer_first = (1, 2, 0) if abs(way[0]) < abs(way[2]) else (1, 0, 2)
    gone = [0.0, 0.0, 0.0]
    here = box.copy()
    for axis in longer_first:
        gone[axis] = free_distance(boxes, here, axis, float(way[axis]), touch)
        here[[axis, 3 + axis]] += gone[axis]
    return gone[0], gone[1], gone[2]


def sweep_with_step(
    boxes: np.ndarray, box: np.ndarray, way: np.ndarray, height: float, touch: float = TOUCH
) -> tuple[float, float, float]:
    """Return how far a box can move along a movement vector if it may step up by a given height."""
    best = sweep_box(boxes, box, np.array([way[0], height, way[2]]), touch)
    reach = box.copy()  # The space that it crosses, all of which limits the height of the step.
    reach[:3] += np.minimum([way[0], 0, way[2]], 0)
    reach[3:] += np.maximum([way[0], 0, way[2]], 0)
    up = free_distance(boxes, reach, 1, height, touch)
    if up < height:
        x, _, z = sweep_box(
            boxes, _translate(box, (0, up, 0)), np.array([way[0], 0, way[2]]), touch
        )
        if _length(x, z) > _length(best[0], best[2]):
            best = (x, up, z)
    down = free_distance(boxes, _translate(box, best), 1, way[1] - best[1], touch)
    return best[0], best[1] + down, best[2]


def _translate(box: np.ndarray, way: tuple[float, float, float]) -> np.ndarray:
    return box + np.array([*way, *way])


def _length(x: float, z: float) -> float:
    return x * x + z * z


class World(Protocol):
    """Interface of a world with collision boxes."""

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return boxes as float64 [N, 6] in blocks, including all boxes that overlap a region."""
        ...


class BoxWorld:
    """A world that consists of a list of boxes."""

    def __init__(self, boxes: Sequence[Sequence[float]] | np.ndarray):
        self.boxes = np.asarray(boxes, np.float64).reshape(-1, 6)

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return the boxes that overlap a region."""
        return self.boxes[find_overlaps(self.boxes, np.concatenate([low, high]), 0.0)]


class BlockWorld:
    """The collision boxes of a volume, in world block coordinates.

    ``kinds``, uint16 [X, Y, Z], contains the shape index of each cell. Each shape in ``shapes`` is
    float32 [N, 6] in block units; shape 0 is air, which has no box. ``corner`` is the block
    position of cell (0, 0, 0).
    """

    def __init__(
        self, kinds: np.ndarray, shapes: Sequence[np.ndarray], corner: Sequence[int]
    ) -> None:
        self.kinds, self.shapes = kinds, tuple(shapes)
        self.corner = np.array(corner, np.int64)

    @classmethod
    def of_volume(cls, volume: BlockVolume) -> "BlockWorld":
        """Build the world of a volume. Block states with the same boxes use the same shape."""
        shapes: list[np.ndarray] = [np.zeros((0, 6), np.float32)]
        numbers = {shapes[0].tobytes(): 0}
        rows = np.zeros(len(volume.palette), np.uint16)
        for row, state in enumerate(volume.palette):
            boxes = boxes_of(state)
            rows[row] = numbers.setdefault(boxes.tobytes(), len(shapes))
            if rows[row] == len(shapes):
                shapes.append(boxes)
        return cls(rows[volume.states], shapes, volume.corner)

    @classmethod
    def of_cells(cls, solid: np.ndarray, corner: Sequence[int] = (0, 0, 0)) -> "BlockWorld":
        """Build a world of full cubes and air from bool [X, Y, Z] in block axes."""
        cube = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
        return cls(solid.astype(np.uint16), (np.zeros((0, 6), np.float32), cube), corner)

    def near(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return the boxes of all cells in a region and of the cells just below it."""
        first = np.floor(low).astype(np.int64) - self.corner - [0, _TALLEST, 0]
        last = np.floor(high).astype(np.int64) - self.corner + 1
        first = np.clip(first, 0, self.kinds.shape)
        last = np.clip(last, 0, self.kinds.shape)
        part = self.kinds[tuple(slice(a, b) for a, b in zip(first, last, strict=True))]
        found = [np.zeros((0, 6))]
        for kind in np.unique(part):
            shape = self.shapes[kind]
            if len(shape):
                cells = np.argwhere(part == kind) + first + self.corner
                found.append((np.tile(cells, 2)[:, None] + shape[None]).reshape(-1, 6))
        return np.concatenate(found)


def find_standing_place(
    world: World, position: tuple[float, float, float], scale: float = 1.0
) -> tuple[float, float, float]:
    """Find the position nearest to a given position where a body of a given scale can stand.

    Positions are searched in square rings around the given position, up to one step higher or
    lower. The given position is returned if no free position is found.
    """
    for ring in range(_RINGS):
        for x, z in _ring_offsets(ring):
            at = np.array(position) + np.array([x, 0, z]) * WIDTH * scale / 4
            if (free := _settle_on_ground(world, at, scale)) is not None:
                return free
    return position


def _ring_offsets(ring: int) -> list[tuple[int, int]]:
    """Return the offsets of a square ring, ordered by distance from its middle."""
    span = range(-ring, ring + 1)
    places = [(x, z) for x in span for z in span if max(abs(x), abs(z)) == ring]
    return sorted(places, key=lambda place: (place[0] ** 2 + place[1] ** 2, place))


def _settle_on_ground(
    world: World, at: np.ndarray, scale: float
) -> tuple[float, float, float] | None:
    """Move a position onto the ground within one step, or return None if a body does not fit."""
    reach = STEP_HEIGHT * scale
    x, y, z = at.tolist()
    box = body_box((x, y, z), scale)
    boxes = world.near(box[:3] - 2 * reach, box[3:] + 2 * reach)
    for lift in (0.0, reach):
        raised = box + np.tile([0, lift, 0], 2)
        if find_overlaps(boxes, raised, TOUCH * scale).any():
            continue
        down = free_distance(boxes, raised, 1, -lift - reach, TOUCH * scale)
        if down > -lift - reach:
            return x, y + lift + down, z
    return None

"""A box moves among boxes: how far it comes along each axis, and up what steps.

Boxes are float64 [N, 6]: low and high corner. What a box lies in already does not hold it.
"""

import numpy as np

from world2minecraft.minecraft.physics.body import TOUCH

_OTHERS = ((1, 2), (0, 2), (0, 1))


def overlapping(boxes: np.ndarray, box: np.ndarray, touch: float = TOUCH) -> np.ndarray:
    """Return which of some boxes a box lies over, bool [N]; touching is not lying over."""
    inside = (boxes[:, :3] < box[3:] - touch) & (boxes[:, 3:] > box[:3] + touch)
    return np.asarray(inside.all(axis=1))


def free_way(
    boxes: np.ndarray, box: np.ndarray, axis: int, way: float, touch: float = TOUCH
) -> float:
    """Return how much of a way along one axis a box can go before it meets another."""
    if not way or not len(boxes):
        return way
    one, two = _OTHERS[axis]
    beside = (
        (boxes[:, one] < box[3 + one] - touch)
        & (boxes[:, 3 + one] > box[one] + touch)
        & (boxes[:, two] < box[3 + two] - touch)
        & (boxes[:, 3 + two] > box[two] + touch)
    )
    if way > 0:
        gaps = boxes[beside, axis] - box[3 + axis]
        return float(min(way, gaps[gaps >= -touch].min(initial=way)))
    gaps = boxes[beside, 3 + axis] - box[axis]
    return float(max(way, gaps[gaps <= touch].max(initial=way)))


def swept(
    boxes: np.ndarray, box: np.ndarray, way: np.ndarray, touch: float = TOUCH
) -> tuple[float, float, float]:
    """Return how much of a way, float64 [3], a box can go: up or down, then the longer side first.

    That order is the game's: one slides along what one meets.
    """
    longer_first = (1, 2, 0) if abs(way[0]) < abs(way[2]) else (1, 0, 2)
    gone = [0.0, 0.0, 0.0]
    here = box.copy()
    for axis in longer_first:
        gone[axis] = free_way(boxes, here, axis, float(way[axis]), touch)
        here[[axis, 3 + axis]] += gone[axis]
    return gone[0], gone[1], gone[2]


def climbed(
    boxes: np.ndarray, box: np.ndarray, way: np.ndarray, height: float, touch: float = TOUCH
) -> tuple[float, float, float]:
    """Return how much of a way a box can go when it may step up by a height and down again."""
    best = swept(boxes, box, np.array([way[0], height, way[2]]), touch)
    reach = box.copy()  # All that it would pass over: as high as all of that lets it.
    reach[:3] += np.minimum([way[0], 0, way[2]], 0)
    reach[3:] += np.maximum([way[0], 0, way[2]], 0)
    up = free_way(boxes, reach, 1, height, touch)
    if up < height:
        x, _, z = swept(boxes, _moved(box, (0, up, 0)), np.array([way[0], 0, way[2]]), touch)
        if _length(x, z) > _length(best[0], best[2]):
            best = (x, up, z)
    down = free_way(boxes, _moved(box, best), 1, way[1] - best[1], touch)
    return best[0], best[1] + down, best[2]


def _moved(box: np.ndarray, way: tuple[float, float, float]) -> np.ndarray:
    return box + np.array([*way, *way])


def _length(x: float, z: float) -> float:
    return x * x + z * z

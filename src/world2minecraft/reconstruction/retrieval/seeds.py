"""The first, coarse trials: every template of a class, turned and sized by the object's box."""

from collections.abc import Iterator
from itertools import product

from world2minecraft.furniture import Template
from world2minecraft.reconstruction.retrieval.object_evidence import Evidence
from world2minecraft.reconstruction.retrieval.trial import Cells, Trial

HIDDEN_CELLS = 1  # How far a scan's noise may eat into both sides of an object at once.
CLEAR_M = 0.3  # What hangs on a wall leaves at least this much free under it.


def reach_of(templates: tuple[Template, ...], voxel_m: float) -> Cells:
    """Return the largest of the smallest sizes: how far a trial can leave an object's box."""
    side = max((limits(one, voxel_m, axis)[0] for one in templates for axis in (0, 1)), default=1)
    height = max((limits(one, voxel_m, 2)[0] for one in templates), default=1)
    return side, side, height


def limits(template: Template, voxel_m: float, axis: int) -> tuple[int, int]:
    """Return the fewest and the most cells that a template may have along one of its axes."""
    span = template.size_m[axis]
    least = max(1, int(span.minimum / voxel_m + 1e-6))
    return least, max(least, int(-(-span.maximum // voxel_m)))


def seeds(
    templates: tuple[Template, ...], evidence: Evidence, voxel_m: float, *, anywhere: bool = False
) -> Iterator[Trial]:
    """Give the trials of every template, turn and anchoring, with usual parameters.

    A template that stands on the floor is tried down to it, for a scan seldom sees under a
    table; one that hangs on a wall only clear of the floor (with ``anywhere``, all of them at the
    object's bottom). Where the object's box is smaller or larger than such furniture can be, the
    template is tried flush with either end of it and in its middle; a template that lacks both
    depth and width there is not tried, for an object seen from one side still shows its width.
    """
    for template in templates:
        values = tuple(sorted(template.complete().items()))
        low = evidence.low[2] if anywhere else bottom_of(template, evidence, voxel_m)
        if low is None:
            continue
        for turns in range(template.turns):
            box = _own_axes(evidence, low, turns)
            counts = _clipped(template, box, voxel_m)
            if not anywhere and min(counts[0] - box[0], counts[1] - box[1]) > HIDDEN_CELLS:
                continue
            trial = Trial(template, turns, counts, values, (0, 0, 0))
            for corner in product(*_anchors(trial, evidence, low, anywhere)):
                yield trial._replace(corner=corner)


def bottom_of(template: Template, evidence: Evidence, voxel_m: float) -> int | None:
    """Return the layer where a template begins, or None where it cannot be."""
    low = max(evidence.low[2], min(evidence.floor, evidence.high[2] - 1))
    if template.mount == "floor":
        return min(low, evidence.floor) if evidence.floor < evidence.high[2] else low
    if template.mount == "wall" and (low - evidence.floor) * voxel_m < CLEAR_M:
        return None
    return low


def _clipped(template: Template, box: Cells, voxel_m: float) -> Cells:
    spans = [limits(template, voxel_m, axis) for axis in range(3)]
    depth, width, height = (min(max(n, a), b) for n, (a, b) in zip(box, spans, strict=True))
    return depth, width, height


def _own_axes(evidence: Evidence, low: int, turns: int) -> Cells:
    x, y = (evidence.high[axis] - evidence.low[axis] for axis in (0, 1))
    height = evidence.high[2] - low
    return (y, x, height) if turns % 2 else (x, y, height)


def _anchors(trial: Trial, evidence: Evidence, bottom: int, anywhere: bool) -> list[list[int]]:
    """Return, for each axis of the room, where the trial's box may begin."""
    lows = (evidence.low[0], evidence.low[1], bottom)
    anchors = []
    for axis, count in enumerate(trial.turned_counts):
        spare = evidence.high[axis] - lows[axis] - count
        anchors.append(sorted({lows[axis], lows[axis] + spare // 2, lows[axis] + spare}))
    if trial.template.mount == "floor" and not anywhere:
        anchors[2] = [bottom]
    return anchors

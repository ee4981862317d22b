"""The first, coarse trials: every template of a class, turned and sized by the object's box."""

from collections.abc import Iterator
from itertools import product

from world2minecraft.furnish.evidence import Evidence
from world2minecraft.furnish.trial import Cells, Trial
from world2minecraft.furniture import Template


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


def seeds(templates: tuple[Template, ...], evidence: Evidence, voxel_m: float) -> Iterator[Trial]:
    """Give the trials of every template, turn, height and anchoring, with usual parameters.

    A template that stands on the floor is also tried down to the floor where the object's cells
    end above it, for a scan seldom sees under a table. Where the object's box is smaller or
    larger than such furniture can be, the template is tried flush with either end of it.
    """
    for template in templates:
        values = tuple(sorted(template.complete().items()))
        for turns in range(template.turns):
            for low in _bottoms(template, evidence):
                box = _own_axes(evidence, low, turns)
                counts = _clipped(template, box, voxel_m)
                trial = Trial(template, turns, counts, values, (0, 0, 0))
                for corner in product(*_anchors(trial, evidence, low)):
                    yield trial._replace(corner=corner)


def _clipped(template: Template, box: Cells, voxel_m: float) -> Cells:
    spans = [limits(template, voxel_m, axis) for axis in range(3)]
    depth, width, height = (min(max(n, a), b) for n, (a, b) in zip(box, spans, strict=True))
    return depth, width, height


def _bottoms(template: Template, evidence: Evidence) -> list[int]:
    low = evidence.low[2]
    if template.mount == "floor" and evidence.floor < low:
        return [low, evidence.floor]
    return [low]


def _own_axes(evidence: Evidence, low: int, turns: int) -> Cells:
    x, y = (evidence.high[axis] - evidence.low[axis] for axis in (0, 1))
    height = evidence.high[2] - low
    return (y, x, height) if turns % 2 else (x, y, height)


def _anchors(trial: Trial, evidence: Evidence, bottom: int) -> list[list[int]]:
    """Return, for each axis of the room, where the trial's box may begin."""
    lows = (evidence.low[0], evidence.low[1], bottom)
    anchors = []
    for axis, count in enumerate(trial.turned_counts):
        spare = evidence.high[axis] - lows[axis] - count
        anchors.append(sorted({lows[axis], lows[axis] + spare // 2, lows[axis] + spare}))
    return anchors

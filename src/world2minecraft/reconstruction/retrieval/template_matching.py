"""Template matching: the paper's argmax over templates, rotations, sizes, parameters and shifts.

A ``Trial`` is a template with a size, rotation and position; its score is the paper's IoU plus
tie-breaking terms. The first, coarse trials are all templates of a class in all rotations, sized by
the object's box.
"""

from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture import Template, rasterize
from world2minecraft.furniture.rasterization import best_shift
from world2minecraft.reconstruction.retrieval.object_evidence import Evidence
from world2minecraft.reconstruction.retrieval.parameters import RetrievalParameters

PARAMETER_SHARE = 0.3  # Weight of an unusual parameter relative to an unusual size.
Cells = tuple[int, int, int]
Values = tuple[tuple[str, float], ...]

HIDDEN_CELLS = 1  # Cells that noise may remove on both sides of an object at once.
CLEAR_M = 0.3  # Minimum free height below an object on a wall.

NO_SHIFT = np.zeros((1, 3), np.int64)
ROUNDS = 2  # A third round changed no match in trials on generated furniture.
PARAMETER_STEPS = 5  # About one cell of 0.08 m for the widest parameter.


class Trial(NamedTuple):
    """A template with its size in cells along its own axes, its parameters, rotation and position.

    ``corner`` is the first cell of the rotated box in the window of the evidence.
    """

    template: Template
    quarter_turns: int
    counts: Cells
    values: Values
    corner: Cells

    @property
    def turned_counts(self) -> Cells:
        """The size of the box in cells along the axes of the room."""
        depth, width, height = self.counts
        return (width, depth, height) if self.quarter_turns % 2 else (depth, width, height)


class Scored(NamedTuple):
    """A trial with its IoU and the score used by the search."""

    score: float
    iou: float
    trial: Trial


class Bias(NamedTuple):
    """The terms of the score beside the IoU.

    Attributes:
        quarter_turns: Detected front.
        voxel_m: Cell size in metres.
        size_weight: Maximum penalty for an unusual size or parameter.
        front_weight: Bonus for agreement with the front.
        beyond_weight: Maximum penalty for a template in unseen space.
        named: Names of the templates that show what the object is named.
        name_bonus: Bonus for these.
    """

    quarter_turns: int
    voxel_m: float
    size_weight: float
    front_weight: float
    beyond_weight: float
    named: frozenset[str] = frozenset()
    name_bonus: float = 0.0

    @classmethod
    def of(cls, quarter_turns: int, voxel_m: float, chosen: RetrievalParameters) -> "Bias":
        """Return the terms that parameters state, none for the paper's equation."""
        if chosen.paper_compat:
            return cls(quarter_turns, voxel_m, 0.0, 0.0, 0.0)
        weights = (chosen.size_weight, chosen.front_weight, chosen.beyond_weight)
        return cls(quarter_turns, voxel_m, *weights)


def score_shifts(evidence: Evidence, trial: Trial, shifts: np.ndarray, bias: Bias) -> Scored:
    """Return the best of a trial's shifts, int64 [S, 3]; the first wins a tie.

    The IoU is covered own cells / (own cells + covered cells against), the paper's equation without
    the template's cells of unknown state. Unseen space outside the object reduces the score but not
    the IoU, so templates extend into it only as far as necessary.
    """
    solid = _turned(trial.template, trial.counts, trial.values, bias.voxel_m, trial.quarter_turns)
    corners = shifts + np.array(trial.corner)
    best, found, iou = best_shift(
        solid, evidence.code, corners, evidence.own, float(bias.beyond_weight)
    )
    x, y, z = corners[best].tolist()
    score = round(found + tie_break(trial, bias), 12)
    return Scored(score, iou, trial._replace(corner=(x, y, z)))


def tie_break(trial: Trial, bias: Bias) -> float:
    """Return the contribution of typical size and parameters, front and name to the score."""
    spans, own = trial.template.size_m, trial.template.parameters
    size = sum(
        _strangeness(count * bias.voxel_m, *span)
        for count, span in zip(trial.counts, spans, strict=True)
    )
    values = sum(_strangeness(value, *own[name]) for name, value in trial.values)
    far = size / 3 + PARAMETER_SHARE * values / max(len(own), 1)
    looks = (trial.quarter_turns - bias.quarter_turns) % trial.template.turns == 0
    told = bias.name_bonus if trial.template.name in bias.named else 0.0
    return bias.front_weight * looks - bias.size_weight * far + told


def _strangeness(value: float, minimum: float, typical: float, maximum: float) -> float:
    room = (typical - minimum) if value < typical else (maximum - typical)
    return min(abs(value - typical) / room, 1.0) if room > 0 else float(value != typical)


@lru_cache(maxsize=1024)
def _turned(
    template: Template, counts: Cells, values: Values, voxel_m: float, quarter_turns: int
) -> np.ndarray:
    solid = rasterize(template, counts, values, voxel_m)
    return np.ascontiguousarray(turn_grid(solid, quarter_turns))


def reach_of(templates: tuple[Template, ...], voxel_m: float) -> Cells:
    """Return the largest minimum size of the templates, in cells along each axis.

    It limits how far a trial can extend beyond an object's box.
    """
    side = max((limits(one, voxel_m, axis)[0] for one in templates for axis in (0, 1)), default=1)
    height = max((limits(one, voxel_m, 2)[0] for one in templates), default=1)
    return side, side, height


def limits(template: Template, voxel_m: float, axis: int) -> tuple[int, int]:
    """Return the minimum and maximum number of cells of a template along one of its axes."""
    span = template.size_m[axis]
    least = max(1, int(span.minimum / voxel_m + 1e-6))
    return least, max(least, int(-(-span.maximum // voxel_m)))


def seeds(
    templates: tuple[Template, ...], evidence: Evidence, voxel_m: float, *, anywhere: bool = False
) -> Iterator[Trial]:
    """Yield the trials of every template, rotation and anchoring with typical parameters.

    A template that stands on the floor is extended down to it, since scans rarely see below a
    table; one that hangs on a wall is tried only above the floor. With ``anywhere``, all templates
    are placed at the bottom of the object. If the object's box is outside the size limits of the
    template, the template is tried at both ends and in the middle of the box; it is skipped if both
    depth and width are out of range, because an object seen from one side still shows its width.
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
    """Return the layer at which a template begins, or None if it does not fit."""
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
    """Return the possible first cells of the trial's box for each axis of the room."""
    lows = (evidence.low[0], evidence.low[1], bottom)
    anchors = []
    for axis, count in enumerate(trial.turned_counts):
        spare = evidence.high[axis] - lows[axis] - count
        anchors.append(sorted({lows[axis], lows[axis] + spare // 2, lows[axis] + spare}))
    if trial.template.mount == "floor" and not anywhere:
        anchors[2] = [bottom]
    return anchors


def best_matches(
    templates: tuple[Template, ...], evidence: Evidence, bias: Bias, chosen: RetrievalParameters
) -> list[Scored]:
    """Return the best refined trial of each template and rotation, best first."""
    first: dict[tuple[str, int], Scored] = {}
    for trial in seeds(templates, evidence, bias.voxel_m, anywhere=chosen.paper_compat):
        scored = score_shifts(evidence, trial, NO_SHIFT, bias)
        _keep(first, scored)
    coarse = sorted(first.values(), key=lambda one: -one.score)
    refined: dict[tuple[str, int], Scored] = {}
    for scored in coarse[: chosen.finalists]:
        _keep(refined, _refine(scored, evidence, bias, chosen))
    rest = {key: one for key, one in first.items() if key not in refined}
    return sorted([*refined.values(), *rest.values()], key=lambda one: -one.score)


def _keep(best: dict[tuple[str, int], Scored], scored: Scored) -> None:
    key = (scored.trial.template.name, scored.trial.quarter_turns)
    if key not in best or scored.score > best[key].score:
        best[key] = scored


def _refine(seed: Scored, evidence: Evidence, bias: Bias, chosen: RetrievalParameters) -> Scored:
    """Improve a seed by shifts, parameters and sizes in turn, each within its bounds.

    A parameter is tested at every shift; otherwise a seat one cell too low would be matched by a
    chair one cell too high.
    """
    home = seed.trial.corner
    shifts = shifts_within(chosen.shift_cells)
    shifts = shifts[home[2] + shifts[:, 2] >= min(evidence.floor, home[2])]
    best = _better(seed, iter([seed.trial]), evidence, bias, shifts)
    for _ in range(ROUNDS):
        before = best
        for name, _value in seed.trial.values:
            moves = (one._replace(corner=home) for one in _with_parameter(best.trial, name))
            best = _better(best, moves, evidence, bias, shifts)
        for axis in range(3):
            moves = _with_size(best.trial, seed.trial, axis, bias.voxel_m, chosen)
            best = _better(best, moves, evidence, bias, NO_SHIFT)
        again = iter([best.trial._replace(corner=home)])
        best = _better(best, again, evidence, bias, shifts)
        if best is before:
            break
    return best


def _better(
    best: Scored, trials: Iterator[Trial], evidence: Evidence, bias: Bias, shifts: np.ndarray
) -> Scored:
    """Return the best of the current result and the trials; the current result wins a tie."""
    for trial in trials:
        scored = score_shifts(evidence, trial, shifts, bias)
        best = scored if scored.score > best.score else best
    return best


def shifts_within(shift_cells: int) -> np.ndarray:
    """Return all shifts, int64 [S, 3], of up to ``shift_cells`` along each axis, smallest first."""
    steps = range(-shift_cells, shift_cells + 1)
    every = sorted(product(steps, steps, steps), key=lambda s: (sum(map(abs, s)), s))
    return np.array(every, np.int64)


def _with_parameter(trial: Trial, name: str) -> Iterator[Trial]:
    span = trial.template.parameters[name]
    steps = {round(float(v), 4) for v in np.linspace(span.minimum, span.maximum, PARAMETER_STEPS)}
    for value in sorted(steps | {span.typical}):
        values = tuple((known, value if known == name else old) for known, old in trial.values)
        yield trial._replace(values=values)


def _with_size(
    trial: Trial, seed: Trial, axis: int, voxel_m: float, chosen: RetrievalParameters
) -> Iterator[Trial]:
    """Yield the trial one cell smaller or larger along one of its own axes, at either end.

    The bottom is not changed, since it is given by the floor or by the shift.
    """
    least, most = limits(trial.template, voxel_m, axis)
    room_axis = 1 - axis if axis < 2 and trial.quarter_turns % 2 else axis
    for step in (-1, 1):
        count = trial.counts[axis] + step
        if not least <= count <= most or abs(count - seed.counts[axis]) > chosen.size_slack:
            continue
        for shift in (0,) if axis == 2 else (0, -step):
            yield _resized(trial, axis, count, room_axis, shift)


def _resized(trial: Trial, axis: int, count: int, room_axis: int, shift: int) -> Trial:
    counts, corner = list(trial.counts), list(trial.corner)
    counts[axis] = count
    corner[room_axis] += shift
    return trial._replace(counts=tuple(counts), corner=tuple(corner))

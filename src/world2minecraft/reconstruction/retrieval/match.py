"""The paper's argmax over templates and turns, with sizes, parameters and shifts beside them."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from world2minecraft.furniture import Template
from world2minecraft.reconstruction.retrieval.object_evidence import Evidence
from world2minecraft.reconstruction.retrieval.parameters import FurnishParameters
from world2minecraft.reconstruction.retrieval.seeds import limits, seeds
from world2minecraft.reconstruction.retrieval.trial import Bias, Scored, Trial, score_shifts

NO_SHIFT = np.zeros((1, 3), np.int64)
ROUNDS = 2  # A third round changed no match in trials on generated furniture.
PARAMETER_STEPS = 5  # About one cell of 0.08 m for the widest parameter.


def best_matches(
    templates: tuple[Template, ...], evidence: Evidence, bias: Bias, chosen: FurnishParameters
) -> list[Scored]:
    """Return the best trial of each template and turn, refined, best first."""
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


def _refine(seed: Scored, evidence: Evidence, bias: Bias, chosen: FurnishParameters) -> Scored:
    """Climb from a seed by shifts, parameters and sizes in turn, each within its bounds.

    A parameter is tried at every shift: a seat one cell too low would else be met by a chair
    one cell too high.
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
    """Return the best of what is known and the trials; of equals what was known first."""
    for trial in trials:
        scored = score_shifts(evidence, trial, shifts, bias)
        best = scored if scored.score > best.score else best
    return best


def shifts_within(shift_cells: int) -> np.ndarray:
    """Return all shifts, int64 [S, 3], of up to ``shift_cells`` along each axis, nearest first."""
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
    trial: Trial, seed: Trial, axis: int, voxel_m: float, chosen: FurnishParameters
) -> Iterator[Trial]:
    """Give the trial one cell smaller or larger along one of its own axes, at either end.

    The bottom stays: it is the floor's, or the shift's to find.
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

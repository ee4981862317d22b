"""One way to put one template, and its score: the paper's IoU and what breaks ties."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture import Template, raster
from world2minecraft.furniture.overlap import overlaps
from world2minecraft.reconstruction.retrieval.object_evidence import Evidence

PARAMETER_SHARE = 0.3  # An unusual parameter is less strange than an unusual size.

Cells = tuple[int, int, int]
Values = tuple[tuple[str, float], ...]


class Trial(NamedTuple):
    """A template with its size in cells along its own axes, its parameters, turn and place.

    ``corner`` is the first cell of the turned box, in the window of the evidence.
    """

    template: Template
    quarter_turns: int
    counts: Cells
    values: Values
    corner: Cells

    @property
    def turned_counts(self) -> Cells:
        """The size of the box in the room's axes."""
        depth, width, height = self.counts
        return (width, depth, height) if self.quarter_turns % 2 else (depth, width, height)


class Scored(NamedTuple):
    """A trial with its IoU, and the score that the search compares."""

    score: float
    iou: float
    trial: Trial


class Bias(NamedTuple):
    """What decides beside IoU: the front seen by find/, the cell size, and how much each weighs."""

    quarter_turns: int
    voxel_m: float
    size_weight: float
    front_weight: float
    beyond_weight: float


def score_shifts(evidence: Evidence, trial: Trial, shifts: np.ndarray, bias: Bias) -> Scored:
    """Return the best of a trial at several shifts, int64 [S, 3]; of equals the first.

    IoU = covered own cells / (own cells + cells covered against): the paper's equation, in which
    cells that say nothing are left out of the template. Growing into what was never seen costs
    score, not IoU, so that a template goes beyond the object only as far as it must.
    """
    solid = _turned(trial.template, trial.counts, trial.values, bias.voxel_m, trial.quarter_turns)
    counts = overlaps(solid, evidence.code, shifts + np.array(trial.corner))
    ious = counts[:, 0] / (evidence.own + counts[:, 1])
    scores = ious - bias.beyond_weight * counts[:, 2] / np.count_nonzero(solid)
    best = int(np.argmax(np.round(scores, 12)))
    x, y, z = (int(a) + int(b) for a, b in zip(trial.corner, shifts[best], strict=True))
    moved = trial._replace(corner=(x, y, z))
    score = round(float(scores[best]) + tie_break(trial, bias), 12)
    return Scored(score, float(ious[best]), moved)


def tie_break(trial: Trial, bias: Bias) -> float:
    """Return what the usual size, the usual parameters and the seen front add to the score."""
    spans, own = trial.template.size_m, trial.template.parameters
    size = sum(
        _strangeness(count * bias.voxel_m, *span)
        for count, span in zip(trial.counts, spans, strict=True)
    )
    values = sum(_strangeness(value, *own[name]) for name, value in trial.values)
    far = size / 3 + PARAMETER_SHARE * values / max(len(own), 1)
    looks = (trial.quarter_turns - bias.quarter_turns) % trial.template.turns == 0
    return bias.front_weight * looks - bias.size_weight * far


def _strangeness(value: float, minimum: float, typical: float, maximum: float) -> float:
    room = (typical - minimum) if value < typical else (maximum - typical)
    return min(abs(value - typical) / room, 1.0) if room > 0 else float(value != typical)


@lru_cache(maxsize=1024)
def _turned(
    template: Template, counts: Cells, values: Values, voxel_m: float, quarter_turns: int
) -> np.ndarray:
    solid = raster(template, counts, values, voxel_m)
    return np.ascontiguousarray(turn_grid(solid, quarter_turns))

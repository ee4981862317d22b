"""Stage 6: each object becomes furniture of the library, in its place, or stays its own cells."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.furnish.evidence import Evidence, evidence_of
from world2minecraft.furnish.match import best_matches
from world2minecraft.furnish.parameters import FurnishParameters
from world2minecraft.furnish.runs import cut_into_runs
from world2minecraft.furnish.seeds import reach_of
from world2minecraft.furnish.trial import Bias, Scored
from world2minecraft.furniture import templates_of
from world2minecraft.types import Alternative, ObjectInstance, OccupancyGrid, Placement

OWN_CELLS = "cells"


def furnish(
    grid: OccupancyGrid,
    instances: Sequence[ObjectInstance],
    parameters: FurnishParameters | None = None,
) -> tuple[Placement, ...]:
    """Return the furniture that stands for each object, in the objects' order.

    An object that was cut has several placements with its id. Where no template reaches
    ``min_iou`` the template is ``cells`` and ``iou`` is that of the best one refused.
    """
    chosen = parameters or FurnishParameters()
    placed: list[Placement] = []
    for instance in instances:
        placed += _furnish_one(grid, instance, chosen)
    return tuple(placed)


def _furnish_one(
    grid: OccupancyGrid, instance: ObjectInstance, chosen: FurnishParameters
) -> list[Placement]:
    if not len(instance.cells):
        return []
    whole, matches = _match(grid, instance, instance.cells, chosen)
    single = matches[0].iou if matches else 0.0
    if chosen.paper_compat or single >= chosen.cut_below or _is_short(grid, whole, chosen):
        return [_placement(grid, instance, whole, matches, chosen)]
    runs = cut_into_runs(whole, chosen.max_runs, chosen.min_run_cells)
    parts = [_match(grid, instance, (run + whole.corner).astype(np.int32), chosen) for run in runs]
    cuts = sum(evidence.own >= chosen.min_run_cells for evidence, _ in parts) - 1
    if cuts > 0 and _together(parts) >= single + chosen.cut_gain * cuts:
        return [_placement(grid, instance, *part, chosen) for part in parts]
    return [_placement(grid, instance, whole, matches, chosen)]


def _is_short(grid: OccupancyGrid, evidence: Evidence, chosen: FurnishParameters) -> bool:
    sides = [evidence.high[axis] - evidence.low[axis] for axis in (0, 1)]
    return max(sides) * grid.voxel_m < chosen.cut_from_m


def _match(
    grid: OccupancyGrid, instance: ObjectInstance, cells: np.ndarray, chosen: FurnishParameters
) -> tuple[Evidence, list[Scored]]:
    templates = templates_of(instance.class_id)
    reach = reach_of(templates, grid.voxel_m)
    evidence = evidence_of(grid, cells, reach, chosen.paper_compat)
    weights = (0.0, 0.0) if chosen.paper_compat else (chosen.tie_weight, chosen.beyond_weight)
    bias = Bias(_turns_of(instance), grid.voxel_m, *weights)
    return evidence, best_matches(templates, evidence, bias, chosen)


def _turns_of(instance: ObjectInstance) -> int:
    return int(np.floor(instance.yaw_deg / 90 + 0.5)) % 4


def _together(parts: list[tuple[Evidence, list[Scored]]]) -> float:
    """Return the IoU of all runs, each weighed by its cells."""
    own = sum(evidence.own for evidence, _ in parts)
    return sum(e.own * (m[0].iou if m else 0.0) for e, m in parts) / own


def _placement(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    evidence: Evidence,
    matches: list[Scored],
    chosen: FurnishParameters,
) -> Placement:
    explained = bool(matches) and (chosen.paper_compat or matches[0].iou >= chosen.min_iou)
    others = matches[1:] if explained else matches
    low, counts, turns = _own_box(evidence, instance)
    if explained:
        trial = matches[0].trial
        low, counts, turns = np.array(trial.corner), trial.counts, trial.quarter_turns
    turned = np.array(counts)[[1, 0, 2]] if turns % 2 else np.array(counts)
    middle = (evidence.corner + low + turned / 2) * grid.voxel_m + grid.origin_m
    return Placement(
        object_id=instance.id,
        class_id=instance.class_id,
        template=matches[0].trial.template.name if explained else OWN_CELLS,
        center_m=np.round(middle, 4),
        size_m=np.round(np.array(counts) * grid.voxel_m, 4),
        quarter_turns=turns,
        iou=round(matches[0].iou, 4) if matches else 0.0,
        parameters=dict(matches[0].trial.values) if explained else {},
        alternatives=tuple(
            Alternative(one.trial.template.name, one.trial.quarter_turns, round(one.iou, 4))
            for one in others[: chosen.alternatives]
        ),
    )


def _own_box(
    evidence: Evidence, instance: ObjectInstance
) -> tuple[np.ndarray, tuple[int, ...], int]:
    turns = _turns_of(instance)
    low = np.array(evidence.low)
    size = np.array(evidence.high) - low
    own_axes = size[[1, 0, 2]] if turns % 2 else size
    return low, tuple(int(side) for side in own_axes), turns

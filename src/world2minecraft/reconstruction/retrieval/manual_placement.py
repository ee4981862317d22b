"""Placement of a furniture template that a person chose for an object."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import nearest_quarter_turns
from world2minecraft.core.types import OWN_CELLS, Layout, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.furniture import Template, template, template_cells, templates_of_class
from world2minecraft.furniture.rasterization import size_in_cells
from world2minecraft.reconstruction.retrieval.object_evidence import Evidence, evidence_of
from world2minecraft.reconstruction.retrieval.parameters import RetrievalParameters
from world2minecraft.reconstruction.retrieval.placement_settling import floor_under_m, within_rooms
from world2minecraft.reconstruction.retrieval.template_matching import (
    Bias,
    Scored,
    best_matches,
    limits,
    reach_of,
)


def fit_template(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    name: str,
    quarter_turns: int | None = None,
    rooms: Sequence[Layout] = (),
) -> Placement:
    """Place a template at an object, with its size and position fitted to the object's cells.

    If the template does not match the cells, or there are none, it fills the object's box as far as
    its size limits allow. The template is always placed, since the user's choice has priority.

    Args:
        grid: Grid with the object's cells.
        instance: The object.
        name: Name of the template, or ``cells`` to build the object from its cells.
        quarter_turns: Orientation, 0 to 3; None uses the best orientation.
        rooms: Rooms of the scan. If given, the placement is within one and stands on its floor.

    Raises:
        UnknownNameError: If the template does not exist.
    """
    seen = nearest_quarter_turns(instance.yaw_deg)
    if name == OWN_CELLS:
        return _own_box(grid, instance, seen if quarter_turns is None else quarter_turns)
    chosen = template(name)
    placed = _near_cells(grid, instance, chosen, quarter_turns, rooms)
    if placed is None:
        placed = _in_box(grid, instance, chosen, seen if quarter_turns is None else quarter_turns)
    return within_rooms(placed, rooms, grid.voxel_m) or placed


def ranked_matches(
    grid: OccupancyGrid, instance: ObjectInstance, count: int = 5, rooms: Sequence[Layout] = ()
) -> tuple[tuple[str, int, float], ...]:
    """Return the best templates of an object's class as (name, quarter turns, IoU), best first.

    Each template is listed once with its best rotation. ``rooms`` determine the floor of the
    object.
    """
    if not len(instance.cells):
        return ()
    best: dict[str, tuple[str, int, float]] = {}
    for one in _matches(grid, instance, templates_of_class(instance.class_id), rooms)[1]:
        row = (one.trial.template.name, one.trial.quarter_turns, round(one.iou, 4))
        best.setdefault(row[0], row)
    return tuple(best.values())[:count]


def score_placements(
    grid: OccupancyGrid, instance: ObjectInstance, placements: Sequence[Placement]
) -> tuple[Placement, ...]:
    """Return the placements of an object with the IoU of its templates where they stand.

    The IoU is that of the matching: covered cells of the object, over its cells and the covered
    cells that are known to be empty or structure. Several pieces of one object share one value.
    Placements of own cells, and those of an object without cells, keep theirs.

    Args:
        grid: Grid with the object's cells.
        instance: The object.
        placements: Its placements.
    """
    pieces = [one for one in placements if one.template != OWN_CELLS]
    if not pieces or not len(instance.cells):
        return tuple(placements)
    own = np.zeros(grid.shape, np.bool_)
    own[tuple(instance.cells.T)] = True
    covered = np.zeros(grid.shape, np.bool_)
    for one in pieces:
        covered[tuple(_covered_cells(grid, one).T)] = True
    against = covered & ~own & (grid.labels <= SemanticClass.WINDOW)
    iou = float((covered & own).sum() / (len(instance.cells) + against.sum()))
    scored = {id(one): replace(one, iou=round(iou, 4)) for one in pieces}
    return tuple(scored.get(id(one), one) for one in placements)


def _covered_cells(grid: OccupancyGrid, one: Placement) -> np.ndarray:
    """Return the cells of the grid that a placed template covers, int [N, 3]."""
    counts = size_in_cells(one.size_m, grid.voxel_m)
    middle = (one.center_m - grid.origin_m) / grid.voxel_m
    corner = np.floor(middle - _along(np.array(counts), one.quarter_turns) / 2 + 0.5)
    values = (dict(one.parameters), one.quarter_turns, corner.astype(int).tolist(), grid.voxel_m)
    cells = template_cells(template(one.template), one.size_m, *values)
    return cells[((cells >= 0) & (cells < grid.shape)).all(axis=1)]


def _matches(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    templates: tuple[Template, ...],
    rooms: Sequence[Layout],
) -> tuple[Evidence, list[Scored]]:
    chosen = RetrievalParameters()
    floor_m = floor_under_m(instance.center_m, rooms, grid.voxel_m)
    reach = reach_of(templates, grid.voxel_m)
    evidence = evidence_of(grid, instance.cells, reach, False, floor_m)
    bias = Bias.of(nearest_quarter_turns(instance.yaw_deg), grid.voxel_m, chosen)
    return evidence, best_matches(templates, evidence, bias, chosen)


def _near_cells(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    chosen: Template,
    quarter_turns: int | None,
    rooms: Sequence[Layout],
) -> Placement | None:
    if not len(instance.cells):
        return None
    evidence, matches = _matches(grid, instance, (chosen,), rooms)
    wanted = None if quarter_turns is None else quarter_turns % chosen.turns
    found = [one for one in matches if wanted in (None, one.trial.quarter_turns)]
    if not found or found[0].iou <= 0:
        return None
    trial = found[0].trial
    counts = np.array(trial.counts)
    middle = evidence.corner + trial.corner + np.array(trial.turned_counts) / 2
    turns = trial.quarter_turns if quarter_turns is None else quarter_turns % 4
    return _placed(
        grid, instance, chosen.name, middle, counts, turns, found[0].iou, dict(trial.values)
    )


def _in_box(
    grid: OccupancyGrid, instance: ObjectInstance, chosen: Template, turns: int
) -> Placement:
    """Return a template of about the object's size that stands where its box stands."""
    sides = np.round(
        _along(instance.size_m, turns - nearest_quarter_turns(instance.yaw_deg)) / grid.voxel_m
    )
    spans = [limits(chosen, grid.voxel_m, axis) for axis in range(3)]
    counts = np.clip(sides, *np.array(spans).T).astype(int)
    middle = (instance.center_m - grid.origin_m) / grid.voxel_m
    middle[2] += (counts[2] - instance.size_m[2] / grid.voxel_m) / 2
    return _placed(grid, instance, chosen.name, middle, counts, turns, 0.0, chosen.complete())


def _own_box(grid: OccupancyGrid, instance: ObjectInstance, turns: int) -> Placement:
    if not len(instance.cells):
        size = _along(instance.size_m, turns - nearest_quarter_turns(instance.yaw_deg))
        middle = (instance.center_m - grid.origin_m) / grid.voxel_m
        return _placed(grid, instance, OWN_CELLS, middle, size / grid.voxel_m, turns, 0.0, {})
    low, high = instance.cells.min(axis=0), instance.cells.max(axis=0) + 1
    counts = _along(high - low, turns)
    return _placed(grid, instance, OWN_CELLS, (low + high) / 2, counts, turns, 0.0, {})


def _placed(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    name: str,
    middle: np.ndarray,
    counts: np.ndarray,
    turns: int,
    iou: float,
    values: dict[str, float],
) -> Placement:
    """Return a placement whose box has its middle and its sides in cells of the grid."""
    return Placement(
        object_id=instance.id,
        class_id=instance.class_id,
        template=name,
        center_m=np.round(grid.origin_m + middle * grid.voxel_m, 4),
        size_m=np.round(counts * grid.voxel_m, 4),
        quarter_turns=turns,
        iou=round(iou, 4),
        parameters=values,
    )


def _along(sides: np.ndarray, quarter_turns: int) -> np.ndarray:
    return sides[[1, 0, 2]] if quarter_turns % 2 else sides

"""Stage 6: replace each object by library furniture in its place, or keep its own cells.

Cutting an object into runs leaves small remains. Those hidden by a template's surface are dropped,
and those that belong together are merged.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import nearest_quarter_turns
from world2minecraft.core.types import (
    OWN_CELLS,
    Alternative,
    Layout,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.core.vocabulary import MIN_NAME_CONFIDENCE, read_vocabulary
from world2minecraft.furniture import Template, template, templates_of_class
from world2minecraft.furniture.chair_fitting import direction_to_table, fit_seat, without_open_top
from world2minecraft.furniture.front_estimation import (
    Surroundings,
    estimate_facing,
    read_surroundings,
)
from world2minecraft.reconstruction.retrieval.object_evidence import OWN, Evidence, evidence_of
from world2minecraft.reconstruction.retrieval.parameters import RetrievalParameters
from world2minecraft.reconstruction.retrieval.placement_settling import (
    floor_under_m,
    settle_placements,
)
from world2minecraft.reconstruction.retrieval.rectangle_decomposition import cut_into_runs
from world2minecraft.reconstruction.retrieval.template_matching import (
    NO_SHIFT,
    Bias,
    Cells,
    Scored,
    Trial,
    best_matches,
    reach_of,
    score_shifts,
)
from world2minecraft.reconstruction.retrieval.variants import (
    Choice,
    choose,
    colour_of_cells,
    offers_of,
)

FEWEST = 4  # Minimum number of cells of a remaining part; smaller parts are noise.
Box = tuple[np.ndarray, np.ndarray]

HALF = 0.5
LEVEL_M = 0.25  # Tops of runs of one worktop; a kettle or a rim at the wall is on some of them.
SURELY_MET = 0.9  # A chair of typical size that covers this share of the cells is preferred.


def merge_crumbs(
    crumbs: list[np.ndarray], matched: list[np.ndarray], boxes: list[Box]
) -> list[np.ndarray]:
    """Return the remains of an object, int [N, 3] each, that get a placement of their own.

    Small remains within one cell of a placed template's box are dropped, since the construction
    stage sets cells that no block shows. Touching remains are merged unless their common box would
    include cells of a placed run.

    Args:
        crumbs: Cells of each remaining part in the grid.
        matched: Cells of each run that has a template.
        boxes: First and exclusive last cell of each of these templates.
    """
    retained = [one for one in crumbs if len(one) >= FEWEST and not _is_hidden(one, boxes)]
    placed = np.concatenate(matched) if matched else np.zeros((0, 3), np.int32)
    joined = True
    while joined:
        joined = False
        for m in range(len(retained)):
            for n in range(m + 1, len(retained)):
                if _belong(retained[m], retained[n], placed):
                    retained[m] = np.concatenate([retained[m], retained.pop(n)])
                    joined = True
                    break
            if joined:
                break
    return retained


def _is_hidden(cells: np.ndarray, boxes: list[Box]) -> bool:
    return any(((cells >= low - 1) & (cells <= high)).all() for low, high in boxes)


def _belong(one: np.ndarray, other: np.ndarray, placed: np.ndarray) -> bool:
    first, second = _box(one), _box(other)
    if (np.maximum(first[0], second[0]) > np.minimum(first[1], second[1])).any():
        return False
    both = np.minimum(first[0], second[0]), np.maximum(first[1], second[1])
    taken = _within(placed, first) | _within(placed, second)
    return bool((_within(placed, both) == taken).all())


def _within(cells: np.ndarray, box: Box) -> np.ndarray:
    return np.asarray(((cells >= box[0]) & (cells < box[1])).all(axis=1))


def _box(cells: np.ndarray) -> Box:
    return cells.min(axis=0), cells.max(axis=0) + 1


class Matched(NamedTuple):
    """Some cells of an object, their orientation, and their matches, best first.

    Attributes:
        evidence: Evidence of the cells.
        quarter_turns: Direction of the front.
        matches: Matches, best first.
        named: Names of the templates that show what the object is named.
        whole: Whether the first match is used regardless of its IoU.
    """

    evidence: Evidence
    quarter_turns: int
    matches: tuple[Scored, ...]
    named: frozenset[str] = frozenset()
    whole: bool = False

    @property
    def iou(self) -> float:
        """The IoU of the best match, or 0 if there is none."""
        return self.matches[0].iou if self.matches else 0.0

    @property
    def is_named(self) -> bool:
        """Whether the best match shows what the object is named."""
        return bool(self.matches) and self.matches[0].trial.template.name in self.named

    def unmatched(self) -> "Matched":
        """Return the object cells without any match, so that they are built as blocks."""
        return self._replace(matches=())


def place_templates(
    grid: OccupancyGrid,
    instances: Sequence[ObjectInstance],
    parameters: RetrievalParameters | None = None,
    rooms: Sequence[Layout] = (),
) -> tuple[Placement, ...]:
    """Return the placements of the furniture for each object, in the order of the objects.

    An object that was cut has several placements with its id. If no template reaches ``min_iou``,
    or if the confidence of the object is below ``min_confidence``, the template is ``cells`` and
    ``iou`` is that of the best rejected template. Placements are
    within ``rooms``, if given, stand on their floors, and their solid parts do not overlap.
    """
    chosen = parameters or RetrievalParameters()
    around = read_surroundings(grid.labels)
    placed: list[Choice] = []
    for instance in instances:
        if len(instance.cells):
            floor_m = floor_under_m(instance.center_m, rooms, grid.voxel_m)
            placed += _furnish_one(grid, instance, around, chosen, floor_m)
    if chosen.paper_compat:
        return tuple(one.placement for one in placed)
    return settle_placements(choose(placed), grid, rooms)


def _furnish_one(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    around: Surroundings,
    chosen: RetrievalParameters,
    floor_m: float,
) -> list[Choice]:
    turns = nearest_quarter_turns(instance.yaw_deg)
    whole = match_object(grid, instance, instance.cells, turns, chosen, floor_m)
    if _is_uncertain(instance, chosen):
        return [Choice(placement_of(grid, instance, whole, chosen), (), None)]
    if whole.iou < chosen.seat_below and instance.class_id == SemanticClass.CHAIR:
        seated = None if chosen.paper_compat else _seated(grid, whole, chosen)
        if seated is not None:
            return [_choice(grid, instance, seated, chosen)]
    if not _may_be_cut(whole, grid.voxel_m, chosen):
        return [_choice(grid, instance, whole, chosen)]
    parts = []
    for run in cut_into_runs(whole.evidence, chosen.max_runs, chosen.min_run_cells):
        cells = (run + whole.evidence.corner).astype(np.int32)
        front = estimate_facing(cells, instance.class_id, around).quarter_turns
        parts.append(match_object(grid, instance, cells, front, chosen, floor_m))
    least = max(chosen.min_run_cells, chosen.min_run_share * whole.evidence.own)
    parts = [part if part.evidence.own >= least else part.unmatched() for part in parts]
    parts = _with_one_design(parts, grid.voxel_m, chosen)
    if _is_better_cut(parts, whole.iou, chosen):
        parts = _with_tidy_crumbs(grid, instance, parts, chosen)
        return [_choice(grid, instance, part, chosen) for part in parts]
    return [_choice(grid, instance, whole, chosen)]


def _is_uncertain(instance: ObjectInstance, chosen: RetrievalParameters) -> bool:
    return not chosen.paper_compat and instance.confidence < chosen.min_confidence


def _with_one_design(
    parts: list[Matched], voxel_m: float, chosen: RetrievalParameters
) -> list[Matched]:
    """Return the runs with the same template for all standing runs of about one height.

    The arms of an L of counters are one piece of furniture: the template that explains most of
    their cells is used for all of them, where it reaches ``min_iou``.
    """
    result = list(parts)
    standing = [n for n, part in enumerate(parts) if part.matches and part.iou >= chosen.min_iou]
    standing = [n for n in standing if parts[n].evidence.low[2] <= parts[n].evidence.floor + 1]
    tops = {n: _top_layer(parts[n]) for n in standing}
    for lead in sorted(standing, key=lambda n: -parts[n].evidence.own)[:1]:
        level = [n for n in standing if abs(tops[n] - tops[lead]) * voxel_m <= LEVEL_M]
        if len(level) < 2:
            continue
        shares: dict[str, float] = {}
        for n in level:
            best: dict[str, float] = {}
            for one in parts[n].matches:
                name = one.trial.template.name
                best[name] = max(best.get(name, 0.0), one.iou)
            for name, iou in best.items():
                if iou >= chosen.min_iou:
                    shares[name] = shares.get(name, 0.0) + iou * parts[n].evidence.own
        common = max(shares, key=lambda name: (shares[name], name))
        for n in level:
            first = [one for one in parts[n].matches if one.trial.template.name == common]
            if first and first[0].iou >= chosen.min_iou:
                rest = [one for one in parts[n].matches if one.trial.template.name != common]
                result[n] = parts[n]._replace(matches=(*first, *rest))
    return result


def _top_layer(part: Matched) -> int:
    return int(part.evidence.corner[2]) + part.evidence.high[2]


def _with_tidy_crumbs(
    grid: OccupancyGrid, instance: ObjectInstance, parts: list[Matched], chosen: RetrievalParameters
) -> list[Matched]:
    """Return the runs, and those remains of the cut that need a placement of their own."""
    runs = [part for part in parts if part.matches]
    placed = [part for part in runs if part.iou >= chosen.min_iou]
    boxes = []
    for part in placed:
        trial = part.matches[0].trial
        low = part.evidence.corner + trial.corner
        boxes.append((low, low + np.array(trial.turned_counts)))
    crumbs = [_cells_of(part) for part in parts if not part.matches]
    reach = reach_of(templates_of_class(instance.class_id), grid.voxel_m)
    front = parts[0].quarter_turns
    retained = merge_crumbs(crumbs, [_cells_of(part) for part in placed], boxes)
    return runs + [Matched(evidence_of(grid, one, reach, False), front, ()) for one in retained]


def _cells_of(part: Matched) -> np.ndarray:
    return (np.argwhere(part.evidence.code == OWN) + part.evidence.corner).astype(np.int32)


def _seated(grid: OccupancyGrid, found: Matched, chosen: RetrievalParameters) -> Matched | None:
    """Return a whole chair for cells without match if it agrees with the observations.

    A chair rotated against the grid matches few cells exactly, and of a chair at a table only the
    back is seen. A whole chair is nevertheless more recognizable than its cells.
    """
    evidence = found.evidence
    cells = _cells_of(found)
    tables = (grid.labels == SemanticClass.TABLE).any(axis=2)
    look = direction_to_table(cells, tables, int(chosen.seat_look_m / grid.voxel_m))
    fit = fit_seat(template("chair"), evidence.code, evidence.floor, grid.voxel_m, look)
    if (
        fit is None
        or fit.opposed > chosen.seat_opposed
        or fit.met.mean() < (chosen.seat_met if found.iou < chosen.min_iou else SURELY_MET)
    ):
        return None
    fit = without_open_top(fit, template("chair"), evidence.code, grid.voxel_m)
    trial = Trial(template("chair"), fit.quarter_turns, fit.counts, fit.values, fit.corner)
    scored = score_shifts(
        evidence, trial, NO_SHIFT, Bias.of(found.quarter_turns, grid.voxel_m, chosen)
    )
    return found._replace(matches=(scored, *found.matches), whole=True)


def match_object(
    grid: OccupancyGrid,
    instance: ObjectInstance,
    cells: np.ndarray,
    quarter_turns: int,
    chosen: RetrievalParameters,
    floor_m: float,
) -> Matched:
    """Match some cells of an object, whose front has the direction ``quarter_turns``."""
    named = () if chosen.paper_compat else named_templates(instance)
    names = frozenset(one.name for one in named)
    usual = tuple(one for one in templates_of_class(instance.class_id) if one.name not in names)
    reach = reach_of((*usual, *named), grid.voxel_m)
    evidence = evidence_of(grid, cells, reach, chosen.paper_compat, floor_m)
    bonus = chosen.name_weight * instance.name_confidence
    bias = Bias.of(quarter_turns, grid.voxel_m, chosen)._replace(named=names, name_bonus=bonus)
    matches = best_matches(usual, evidence, bias, chosen)
    if named:
        # A name counts only if the shape does not contradict it.
        told = best_matches(named, evidence, bias, chosen)
        told = [one for one in told if one.iou >= chosen.name_min_iou]
        matches = sorted([*told, *matches], key=lambda one: -one.score)
    return Matched(evidence, quarter_turns, tuple(matches), names)


def named_templates(instance: ObjectInstance) -> tuple[Template, ...]:
    """Return the templates that show what an object is named, if its name is sure enough."""
    entry = read_vocabulary().names.get(instance.name)
    if entry is None or instance.name_confidence < MIN_NAME_CONFIDENCE:
        return ()
    return tuple(map(template, entry.templates))


def _may_be_cut(whole: Matched, voxel_m: float, chosen: RetrievalParameters) -> bool:
    if chosen.paper_compat or whole.iou >= chosen.cut_below:
        return False
    low, high = whole.evidence.low, whole.evidence.high
    return max(high[0] - low[0], high[1] - low[1]) * voxel_m >= chosen.cut_from_m


def _is_better_cut(parts: list[Matched], single: float, chosen: RetrievalParameters) -> bool:
    """Return whether the runs large enough to be furniture match better than the whole.

    If no template matches the whole, runs that match half of it are accepted.
    """
    every = sum(part.evidence.own for part in parts)
    large = [part for part in parts if part.matches]
    if single < chosen.min_iou:
        explained = [part.evidence.own for part in large if part.iou >= chosen.min_iou]
        return sum(explained) >= HALF * every
    together = sum(part.evidence.own * part.iou for part in large) / every
    return len(large) > 1 and together >= single + chosen.cut_gain * (len(large) - 1)


def _choice(
    grid: OccupancyGrid, instance: ObjectInstance, found: Matched, chosen: RetrievalParameters
) -> Choice:
    """Return the placement of a match and the designs that may replace it."""
    placement = placement_of(grid, instance, found, chosen)
    if placement.template == OWN_CELLS or not chosen.variants or chosen.paper_compat:
        return Choice(placement, (), None)
    bias = Bias.of(found.quarter_turns, grid.voxel_m, chosen)
    offers = offers_of(found.evidence, found.matches[0], bias)
    entry = read_vocabulary().names.get(instance.name)
    if entry is not None and placement.template in entry.templates:
        offers = tuple(offer for offer in offers if offer.template in entry.templates)
    return Choice(placement, offers, colour_of_cells(grid, found.evidence))


def placement_of(
    grid: OccupancyGrid, instance: ObjectInstance, found: Matched, chosen: RetrievalParameters
) -> Placement:
    """Return the placement of the best match, or of the own cells if the match explains too few."""
    least = 0.0 if chosen.paper_compat else chosen.min_iou
    explained = bool(found.matches) and (found.whole or found.is_named or found.iou >= least)
    explained &= found.is_named or not _is_uncertain(instance, chosen)
    low, counts, turns = _own_box(found)
    if explained:
        trial = found.matches[0].trial
        low, counts, turns = trial.corner, trial.counts, trial.quarter_turns
    turned = np.array(counts)[[1, 0, 2]] if turns % 2 else np.array(counts)
    middle = (found.evidence.corner + low + turned / 2) * grid.voxel_m + grid.origin_m
    others = found.matches[1 if explained else 0 :][: chosen.alternatives]
    return Placement(
        object_id=instance.id,
        class_id=instance.class_id,
        template=found.matches[0].trial.template.name if explained else OWN_CELLS,
        center_m=np.round(middle, 4),
        size_m=np.round(np.array(counts) * grid.voxel_m, 4),
        quarter_turns=turns,
        iou=round(found.iou, 4),
        parameters=dict(found.matches[0].trial.values) if explained else {},
        alternatives=tuple(
            Alternative(one.trial.template.name, one.trial.quarter_turns, round(one.iou, 4))
            for one in others
        ),
    )


def _own_box(found: Matched) -> tuple[Cells, Cells, int]:
    """Return the first cell, the size along its own axes and the rotation of an object's box."""
    low, high = found.evidence.low, found.evidence.high
    x, y, z = (high[axis] - low[axis] for axis in range(3))
    return low, (y, x, z) if found.quarter_turns % 2 else (x, y, z), found.quarter_turns

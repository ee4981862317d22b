"""Exchange furniture that compares badly with the photos for furniture that compares better.

The world is built and rendered once for each round. A round tries one candidate for each of the
worst objects, so that the number of rounds is the number of candidates of an object. The last
worlds contain all changes together, and what no longer compares better is taken back.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.types import BlockVolume, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.furniture.solid_parts import OWN_CELLS, box_m, depth_m, solids_m
from world2minecraft.reconstruction.repair.parameters import RepairParameters
from world2minecraft.reconstruction.retrieval.other_furniture import Furniture, OtherFurniture
from world2minecraft.reconstruction.verification.built_names import stands_for
from world2minecraft.reconstruction.verification.photo_agreement import (
    ViewAgreement,
    things_of_photo,
)
from world2minecraft.reconstruction.verification.photo_samples import PhotoSample
from world2minecraft.reconstruction.verification.world_agreement import (
    MIN_PIXELS,
    ObjectScore,
    built_things,
    compare_views,
    headline_gains,
    score_objects,
    share_right,
)

Build = Callable[[Sequence[Placement]], BlockVolume]
CELLS_BELOW = 0.5  # Agreement of the best furniture below which an object may become its cells.
MAX_SILHOUETTE_LOSS = 0.02
MAX_OVERLAP_M = 0.03  # As in the settling of placements.
CHECKS = 3


@dataclass(frozen=True, eq=False)
class Change:
    """Furniture that was exchanged.

    Attributes:
        object_id: Id of the object.
        before: Placements before.
        after: Placements after.
        agreement: Agreement of the object before and after.
        iou: IoU of the object's cells and its furniture before and after.
    """

    object_id: int
    before: Furniture
    after: Furniture
    agreement: tuple[float, float]
    iou: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Repaired:
    """The furniture of a room after repair.

    Attributes:
        placements: All placements, in the order of the objects.
        changes: What was exchanged.
        headline: Headline of the compared photos before and after.
        tried: Number of objects with candidates.
    """

    placements: tuple[Placement, ...]
    changes: tuple[Change, ...]
    headline: tuple[float, float]
    tried: int


@dataclass(frozen=True, eq=False)
class _Result:
    """A compared world.

    Attributes:
        headline: Its headline.
        scores: Scores of its objects, by id.
        gains: Gain of the headline that each object accounts for, by id.
        views: Agreement of each photo.
    """

    headline: float
    scores: Mapping[int, ObjectScore]
    gains: Mapping[int, float]
    views: Sequence[ViewAgreement]


class _Comparison:
    """Compares worlds with the same photos."""

    def __init__(
        self,
        samples: Sequence[PhotoSample],
        grid: OccupancyGrid,
        instances: Sequence[ObjectInstance],
        build: Build,
    ):
        self.samples, self.grid, self.instances, self.build = samples, grid, instances, build
        self.shown = [things_of_photo(sample, grid) for sample in samples]

    def of(self, placements: Sequence[Placement], before: _Result | None = None) -> _Result:
        """Return the result of the world with these placements, compared with that of another."""
        things = built_things(self.instances, placements)
        volume = self.build(placements)
        views = compare_views(self.samples, self.shown, things, volume, self.grid.voxel_m)
        gains = headline_gains(self.samples, before.views, views) if before else {}
        return _Result(share_right(self.samples, views), score_objects(views), gains, views)


def repair_placements(
    samples: Sequence[PhotoSample],
    grid: OccupancyGrid,
    instances: Sequence[ObjectInstance],
    placements: Sequence[Placement],
    build: Build,
    others: OtherFurniture,
    parameters: RepairParameters | None = None,
) -> Repaired:
    """Return the furniture with which the world compares better with the photos.

    Args:
        samples: Samples of the photos.
        grid: Grid with the class and the object of each cell.
        instances: Objects of the room.
        placements: Their furniture.
        build: Function that builds the world with other furniture.
        others: Lists other furniture.
        parameters: Limits of the repair.
    """
    chosen = parameters or RepairParameters()
    comparison = _Comparison(samples, grid, instances, build)
    before = comparison.of(placements)
    candidates = _candidates(grid, instances, placements, before.scores, others, chosen)
    best = _try_candidates(comparison, placements, candidates, before, chosen)
    by_id = {one.id: one for one in instances}
    losses = {
        number: others.iou(by_id[number], _of_object(placements, number))
        - others.iou(by_id[number], made)
        for number, made in best.items()
    }
    best = _within_mean_loss(best, losses, chosen.mean_iou_loss * len(instances))
    best, after = _checked(comparison, placements, best, before, chosen)
    changes = tuple(
        Change(
            number,
            _of_object(placements, number),
            best[number],
            (before.scores[number].agreement, after.scores[number].agreement),
            tuple(
                others.iou(by_id[number], one)
                for one in (_of_object(placements, number), best[number])
            ),
        )
        for number in sorted(best)
    )
    headline = (before.headline, after.headline)
    return Repaired(tuple(_exchanged(placements, best)), changes, headline, len(candidates))


def _candidates(
    grid: OccupancyGrid,
    instances: Sequence[ObjectInstance],
    placements: Sequence[Placement],
    scores: Mapping[int, ObjectScore],
    others: OtherFurniture,
    chosen: RepairParameters,
) -> dict[int, list[Furniture]]:
    """Return the candidates of the worst objects, by id."""
    bad = [
        one
        for one in instances
        if one.id in scores
        and scores[one.id].pixels >= MIN_PIXELS
        and scores[one.id].agreement < chosen.good
        and len(one.cells)
    ]
    bad.sort(key=lambda one: (-scores[one.id].wrong, one.id))
    result = {}
    for instance in bad[: chosen.max_objects]:
        placed = _of_object(placements, instance.id)
        least = others.iou(instance, placed) - chosen.max_iou_loss
        around = [one for one in placements if one.object_id != instance.id]
        found: list[Furniture] = []
        for made in others.options(instance, placed):
            if _is_cells(made) or (
                len(found) < chosen.max_candidates - 1
                and stands_for(instance, made)
                and others.iou(instance, made) >= least
                and _fits(made, placed, around, grid)
            ):
                found.append(made)
        if found:
            result[instance.id] = found
    return result


def _fits(
    made: Furniture, placed: Furniture, around: Sequence[Placement], grid: OccupancyGrid
) -> bool:
    """Return whether furniture overlaps its surroundings no more than the placed furniture."""
    before = max((_overlap_m(one, around, grid) for one in placed), default=0.0)
    return all(
        _overlap_m(one, around, grid) <= max(MAX_OVERLAP_M, before) + 1e-6 for one in made
    )


def _overlap_m(one: Placement, around: Sequence[Placement], grid: OccupancyGrid) -> float:
    if one.template == OWN_CELLS:
        return 0.0
    box, solid = box_m(one), solids_m(one, grid)
    near = [
        other
        for other in around
        if (np.minimum(box[1], box_m(other)[1]) > np.maximum(box[0], box_m(other)[0])).all()
    ]
    return max((depth_m(solid, solids_m(other, grid)) for other in near), default=0.0)


def _try_candidates(
    comparison: _Comparison,
    placements: Sequence[Placement],
    candidates: Mapping[int, Sequence[Furniture]],
    before: _Result,
    chosen: RepairParameters,
) -> dict[int, Furniture]:
    """Return the furniture of each object that compares best, if it is better than before."""
    best: dict[int, Furniture] = {}
    reached = {number: before.scores[number].agreement for number in candidates}
    for turn in range(max(map(len, candidates.values()), default=0)):
        tried = {
            number: made[turn]
            for number, made in candidates.items()
            if turn < len(made) and (not _is_cells(made[turn]) or reached[number] < CELLS_BELOW)
        }
        if not tried:
            continue
        result = comparison.of(_exchanged(placements, best | tried), before)
        for number, made in tried.items():
            if not _is_better(number, result, before, chosen):
                continue
            if result.scores[number].agreement > reached[number]:
                best[number], reached[number] = made, result.scores[number].agreement
    return best


def _checked(
    comparison: _Comparison,
    placements: Sequence[Placement],
    best: dict[int, Furniture],
    before: _Result,
    chosen: RepairParameters,
) -> tuple[dict[int, Furniture], _Result]:
    """Return the exchanged furniture that compares better together, and the result of its world."""
    for _ in range(CHECKS):
        if not best:
            break
        after = comparison.of(_exchanged(placements, best), before)
        better = {n: made for n, made in best.items() if _is_better(n, after, before, chosen)}
        if len(better) == len(best) and after.headline >= before.headline:
            return best, after
        best = better
    return {}, before


def _is_better(number: int, after: _Result, before: _Result, chosen: RepairParameters) -> bool:
    if number not in after.scores:
        return False
    new, old = after.scores[number], before.scores[number]
    return (
        new.agreement >= old.agreement + chosen.min_gain
        and new.silhouette_iou >= old.silhouette_iou - MAX_SILHOUETTE_LOSS
        and after.gains.get(number, 0.0) >= 0
    )


def _is_cells(made: Furniture) -> bool:
    return all(one.template == OWN_CELLS for one in made)


def _within_mean_loss(
    best: Mapping[int, Furniture], losses: Mapping[int, float], most: float
) -> dict[int, Furniture]:
    """Return the exchanged furniture without that which loses most IoU, up to a sum of losses."""
    kept: dict[int, Furniture] = {}
    total = 0.0
    for number in sorted(best, key=lambda n: (round(losses[n], 9), n)):
        total += max(losses[number], 0.0)
        if total <= most:
            kept[number] = best[number]
    return kept


def _of_object(placements: Sequence[Placement], number: int) -> Furniture:
    return tuple(one for one in placements if one.object_id == number)


def _exchanged(
    placements: Sequence[Placement], made: Mapping[int, Furniture]
) -> tuple[Placement, ...]:
    """Return the placements with other furniture in the place of an object's first placement."""
    result: list[Placement] = []
    done: set[int] = set()
    for one in placements:
        if one.object_id not in made:
            result.append(one)
        elif one.object_id not in done:
            done.add(one.object_id)
            result += made[one.object_id]
    return tuple(result)

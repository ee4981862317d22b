"""Exchange furniture that compares badly with the photos for furniture that compares better.

The world is built and rendered once for each round. A round tries one candidate for each of the
worst objects, so that the number of rounds is the number of candidates of an object. The last
worlds contain all changes together, and what no longer compares better is taken back.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.types import (
    OWN_CELLS,
    BlockVolume,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.furniture.solid_parts import box_m, depth_m, solids_m
from world2minecraft.reconstruction.repair.parameters import RepairParameters
from world2minecraft.reconstruction.retrieval.furniture_placement import named_templates
from world2minecraft.reconstruction.retrieval.other_furniture import Fit, Furniture, OtherFurniture
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
# Own cells are faithful, but people recognise furniture. They replace furniture that shows the
# object's name only if less than this share of it is in its place, other furniture if less agrees.
NAMED_THERE, OTHER_AGREEMENT = 0.3, 0.5
CELLS_GAIN = 0.15
MAX_LEFT = 0.1  # Share of the cells that other furniture may leave to be built beside it.
MAX_OVERLAP_M = 0.03  # As in the settling of placements.
CHECKS = 3  # Worlds with all changes that are compared before all are given up.


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
    repair = _Repair(samples, grid, instances, placements, build, others, chosen)
    candidates = repair.candidates()
    best, after = repair.check(repair.try_all(candidates))
    scores = repair.before.scores
    changes = tuple(
        Change(
            number,
            repair.placed[number],
            best[number],
            (scores[number].agreement, after.scores[number].agreement),
            (repair.fit(number, repair.placed[number]).iou, repair.fit(number, best[number]).iou),
        )
        for number in sorted(best)
    )
    headline = (repair.before.headline, after.headline)
    return Repaired(repair.exchanged(best), changes, headline, len(candidates))


class _Repair:
    """The repair of one room.

    Attributes:
        placed: Furniture of each object before the repair, by id.
        before: Result of the world before the repair.
    """

    def __init__(
        self,
        samples: Sequence[PhotoSample],
        grid: OccupancyGrid,
        instances: Sequence[ObjectInstance],
        placements: Sequence[Placement],
        build: Build,
        others: OtherFurniture,
        chosen: RepairParameters,
    ):
        self.samples, self.grid, self.instances = samples, grid, instances
        self.placements, self.build, self.others, self.chosen = placements, build, others, chosen
        self.by_id = {one.id: one for one in instances}
        self.placed: dict[int, Furniture] = {
            number: tuple(one for one in placements if one.object_id == number)
            for number in self.by_id
        }
        self.shown = [things_of_photo(sample, grid) for sample in samples]
        self.before = self.compare({}, None)

    def fit(self, number: int, made: Furniture) -> Fit:
        """Return how well furniture fits an object's cells."""
        return self.others.fit(self.by_id[number], made)

    def lost_iou(self, number: int, made: Furniture) -> float:
        """Return how much IoU an object loses by other furniture."""
        return self.fit(number, self.placed[number]).iou - self.fit(number, made).iou

    def compare(self, made: Mapping[int, Furniture], before: _Result | None) -> _Result:
        """Return the result of the world with other furniture, and its gains over another."""
        placements = self.exchanged(made)
        things = built_things(self.instances, placements)
        volume = self.build(placements)
        views = compare_views(self.samples, self.shown, things, volume, self.grid.voxel_m)
        gains = headline_gains(self.samples, before.views, views) if before else {}
        return _Result(share_right(self.samples, views), score_objects(views), gains, views)

    def exchanged(self, made: Mapping[int, Furniture]) -> tuple[Placement, ...]:
        """Return the placements with other furniture in the place of an object's first one."""
        result: list[Placement] = []
        for one in self.placements:
            number = one.object_id
            if number not in made:
                result.append(one)
            elif one is self.placed[number][0]:
                result += made[number]
        return tuple(result)

    def candidates(self) -> dict[int, list[Furniture]]:
        """Return the candidates of the worst objects, by id."""
        scores, chosen = self.before.scores, self.chosen
        bad = [
            number
            for number, placed in self.placed.items()
            if placed
            and number in scores
            and scores[number].pixels >= MIN_PIXELS
            and scores[number].agreement < chosen.good
        ]
        bad.sort(key=lambda number: (-scores[number].wrong, number))
        every = {number: self._candidates_of(number) for number in bad[: chosen.max_objects]}
        return {number: found for number, found in every.items() if found}

    def _candidates_of(self, number: int) -> list[Furniture]:
        instance, placed = self.by_id[number], self.placed[number]
        around = [one for one in self.placements if one.object_id != number]
        least = self.fit(number, placed).near - MAX_LEFT
        found: list[Furniture] = []
        for made in self.others.options(instance, placed):
            if _is_cells(made) or (
                len(found) < self.chosen.max_candidates - 1
                and stands_for(instance, made)
                and self.lost_iou(number, made) <= self.chosen.max_iou_loss
                and self.fit(number, made).near >= least
                and _fits(made, placed, around, self.grid)
            ):
                found.append(made)
        return found

    def try_all(self, candidates: Mapping[int, Sequence[Furniture]]) -> dict[int, Furniture]:
        """Return the best candidate of each object, if it compares better than before."""
        best: dict[int, Furniture] = {}
        reached = {number: self.before.scores[number] for number in candidates}
        for turn in range(max(map(len, candidates.values()), default=0)):
            tried = {
                number: found[turn]
                for number, found in candidates.items()
                if turn < len(found) and self._is_allowed(number, found[turn], reached[number])
            }
            if not tried:
                continue
            result = self.compare(best | tried, self.before)
            for number, made in tried.items():
                if not self.is_better(number, made, result):
                    continue
                if result.scores[number].agreement > reached[number].agreement:
                    best[number], reached[number] = made, result.scores[number]
        return best

    def _is_allowed(self, number: int, made: Furniture, reached: ObjectScore) -> bool:
        """Return whether furniture that reached a score may become the object's own cells."""
        if not _is_cells(made):
            return True
        is_named = _shows_name(self.by_id[number], self.placed[number])
        return reached.agreement < OTHER_AGREEMENT and not (
            is_named and reached.there >= NAMED_THERE
        )

    def check(self, best: Mapping[int, Furniture]) -> tuple[dict[int, Furniture], _Result]:
        """Return the furniture that compares better together, and the result of its world."""
        kept = self._within_mean_loss(best)
        for _ in range(CHECKS):
            if not kept:
                break
            after = self.compare(kept, self.before)
            better = {n: made for n, made in kept.items() if self.is_better(n, made, after)}
            if len(better) == len(kept):
                if after.headline >= self.before.headline:
                    return kept, after
                del better[min(better, key=lambda n: (round(after.gains.get(n, 0.0), 9), n))]
            kept = better
        return {}, self.before

    def is_better(self, number: int, made: Furniture, after: _Result) -> bool:
        """Return whether an object compares better than before with other furniture.

        It must gain more agreement than it loses IoU, with its cells and with its silhouettes in
        the photos, and must not lower the headline.
        """
        if number not in after.scores or after.gains.get(number, 0.0) < 0:
            return False
        new, old = after.scores[number], self.before.scores[number]
        lost = max(self.lost_iou(number, made), old.silhouette_iou - new.silhouette_iou)
        least = CELLS_GAIN if _is_cells(made) else self.chosen.min_gain
        return new.agreement - old.agreement >= max(least, lost)

    def _within_mean_loss(self, best: Mapping[int, Furniture]) -> dict[int, Furniture]:
        """Return the furniture without that which loses most IoU, up to the mean loss allowed."""
        losses = {n: max(self.lost_iou(n, made), 0.0) for n, made in best.items()}
        order = sorted(best, key=lambda n: (round(losses[n], 9), n))
        sums = np.cumsum([losses[n] for n in order])
        most = self.chosen.mean_iou_loss * len(self.instances)
        return {n: best[n] for n, total in zip(order, sums, strict=True) if total <= most}


def _fits(
    made: Furniture, placed: Furniture, around: Sequence[Placement], grid: OccupancyGrid
) -> bool:
    """Return whether furniture overlaps its surroundings no more than the placed furniture."""
    before = max((_overlap_m(one, around, grid) for one in placed), default=0.0)
    return all(_overlap_m(one, around, grid) <= max(MAX_OVERLAP_M, before) + 1e-6 for one in made)


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


def _shows_name(instance: ObjectInstance, placed: Furniture) -> bool:
    """Return whether all furniture shows the name of an object, if that is sure."""
    named = {one.name for one in named_templates(instance)}
    return bool(named) and all(one.template in (*named, OWN_CELLS) for one in placed)


def _is_cells(made: Furniture) -> bool:
    return all(one.template == OWN_CELLS for one in made)

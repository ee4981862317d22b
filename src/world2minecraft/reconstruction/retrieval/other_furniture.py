"""Other furniture for an object than the one placed: templates, quarter turns, designs, cells."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain, zip_longest
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import Layout, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.furniture import (
    estimate_facing,
    read_surroundings,
    template,
    template_cells,
    variants_of,
)
from world2minecraft.furniture.solid_parts import box_m, own_cells
from world2minecraft.reconstruction.retrieval.furniture_placement import (
    OWN_CELLS,
    Matched,
    match_object,
    placement_of,
)
from world2minecraft.reconstruction.retrieval.parameters import RetrievalParameters
from world2minecraft.reconstruction.retrieval.placement_settling import floor_under_m, within_rooms
from world2minecraft.reconstruction.retrieval.variants import (
    colour_of_cells,
    design_cost,
    in_other_design,
)

Furniture = tuple[Placement, ...]  # All placements of one object.
SURE_FRONT = 0.6  # Confidence of a front from which furniture is not turned.


class Fit(NamedTuple):
    """The IoU of furniture and an object's cells, and the share of the cells that it covers."""

    iou: float
    covered: float


class OtherFurniture:
    """Lists other furniture for the objects of a room."""

    def __init__(
        self,
        grid: OccupancyGrid,
        rooms: Sequence[Layout] = (),
        parameters: RetrievalParameters | None = None,
    ):
        self.grid, self.rooms = grid, rooms
        self.parameters = parameters or RetrievalParameters()
        self._around = read_surroundings(grid.labels)

    def options(self, instance: ObjectInstance, placed: Furniture) -> Iterator[Furniture]:
        """Yield other furniture for an object, the likely first, and its own cells last.

        Templates that match the whole object, in the order of their scores, alternate with other
        designs of the placed furniture, in the order of size and colour. Furniture whose front is
        sure is not turned. An object that is built from its cells keeps them.

        Args:
            instance: The object, with cells.
            placed: Its placements.
        """
        if all(one.template == OWN_CELLS for one in placed):
            return
        turns = int(np.floor(instance.yaw_deg / 90 + 0.5)) % 4
        floor_m = floor_under_m(instance.center_m, self.rooms, self.grid.voxel_m)
        whole = match_object(self.grid, instance, instance.cells, turns, self.parameters, floor_m)
        matched = self._templates(instance, whole)
        designs = self._designs(placed, colour_of_cells(self.grid, whole.evidence))
        listed = {_looks_of(placed)}
        for made in chain.from_iterable(zip_longest(matched, designs)):
            if made is not None and _looks_of(made) not in listed:
                listed.add(_looks_of(made))
                yield tuple(replace(one, alternatives=placed[0].alternatives) for one in made)
        cells = placement_of(self.grid, instance, whole.unmatched(), self.parameters)
        rejected = round(whole.iou, 4)
        yield (replace(cells, iou=rejected, alternatives=placed[0].alternatives),)

    def fit(self, instance: ObjectInstance, placed: Furniture) -> Fit:
        """Return how well furniture fits an object's cells, 1 and 1 for its own cells.

        As in the matching, cells of unknown state and those of other objects do not count.
        """
        parts = [self._cells(one) for one in placed]
        cells = np.unique(np.concatenate([np.zeros((0, 3), np.int64), *parts]), axis=0)
        cells = cells[((cells >= 0) & (cells < self.grid.shape)).all(axis=1)]
        labels = self.grid.labels[tuple(cells.T)]
        own = self.grid.instance[tuple(cells.T)] == instance.id
        against = ~own & (labels <= SemanticClass.WINDOW) & (labels != UNKNOWN)
        covered, every = float(own.sum()), max(len(instance.cells), 1)
        return Fit(covered / (every + float(against.sum())), covered / every)

    def _templates(self, instance: ObjectInstance, whole: Matched) -> list[Furniture]:
        """Return the templates that match an object, in each rotation that its front allows."""
        facing = estimate_facing(instance.cells, instance.class_id, self._around)
        result = []
        for match in whole.matches:
            found = whole._replace(matches=(match,))
            placement = placement_of(self.grid, instance, found, self.parameters)
            one = within_rooms(placement, self.rooms, self.grid.voxel_m)
            if one is None or one.template == OWN_CELLS:
                continue
            period = template(one.template).turns
            is_front = (one.quarter_turns - facing.quarter_turns) % period == 0
            if is_front or facing.confidence < SURE_FRONT:
                result.append((one,))
        return result

    def _designs(self, placed: Furniture, colour: np.ndarray | None) -> list[Furniture]:
        """Return the furniture in each other design of its families."""
        known = [one for one in placed if one.template != OWN_CELLS]
        names = {
            other.name: other
            for one in known
            for other in variants_of(template(one.template).family)
        }
        rows = []
        for name, other in sorted(names.items()):
            made = tuple(filter(None, (in_other_design(one, other) for one in known)))
            if len(made) == len(known):
                cost = sum(design_cost(one, colour) for one in made)
                rest = tuple(one for one in placed if one.template == OWN_CELLS)
                rows.append((round(cost, 6), name, (*made, *rest)))
        return [made for _, _, made in sorted(rows, key=lambda row: row[:2])]

    def _cells(self, one: Placement) -> np.ndarray:
        """Return the cells that a placement covers, int [N, 3]."""
        if one.template == OWN_CELLS:
            return own_cells(one, self.grid)
        voxel_m = self.grid.voxel_m
        shift = np.round((box_m(one)[0] - self.grid.origin_m) / voxel_m).astype(int)
        return template_cells(
            template(one.template),
            one.size_m,
            one.parameters,
            one.quarter_turns,
            tuple(shift.tolist()),
            voxel_m,
        )


def _looks_of(placed: Furniture) -> tuple[tuple[str, int], ...]:
    return tuple(sorted((one.template, one.quarter_turns) for one in placed))

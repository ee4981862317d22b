"""Other furniture for an object than the one placed: templates, quarter turns, designs, cells."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain, zip_longest
from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_dilation

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import nearest_quarter_turns
from world2minecraft.core.types import OWN_CELLS, Layout, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.furniture import (
    estimate_facing,
    read_surroundings,
    template,
    template_cells,
    variants_of,
)
from world2minecraft.furniture.solid_parts import box_m, own_cells
from world2minecraft.reconstruction.retrieval.furniture_placement import (
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
NEAR = 2  # Cells: about half a block at four blocks per metre.
SURE_FRONT = 0.6  # Confidence of a front from which furniture is not turned sideways.


class Fit(NamedTuple):
    """The IoU of furniture and an object's cells, and the share of the cells at most ``NEAR`` away.

    Other cells would be built beside the furniture.
    """

    iou: float
    near: float


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
        designs of the placed furniture, in the order of size and colour. A template is listed in
        its best rotation, with the front of the object, and sideways if that front is not sure, but
        never with its back to the front: backs are plain, and plain surface compares well. An
        object that is built from its cells keeps them.

        Args:
            instance: The object, with cells.
            placed: Its placements.
        """
        if all(one.template == OWN_CELLS for one in placed):
            return
        turns = nearest_quarter_turns(instance.yaw_deg)
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
        against = ~own & (labels <= SemanticClass.WINDOW)
        every = max(len(instance.cells), 1)
        iou = float(own.sum() / (every + against.sum()))
        return Fit(iou, _share_near(instance.cells, cells))

    def _templates(self, instance: ObjectInstance, whole: Matched) -> list[Furniture]:
        """Return the templates that match an object, in the best and in all possible rotations."""
        facing = estimate_facing(instance.cells, instance.class_id, self._around)
        result: list[Furniture] = []
        for match in whole.matches:
            found = whole._replace(matches=(match,))
            placement = placement_of(self.grid, instance, found, self.parameters)
            one = within_rooms(placement, self.rooms, self.grid.voxel_m)
            if one is None or one.template == OWN_CELLS:
                continue
            turned = (one.quarter_turns - facing.quarter_turns) % template(one.template).turns
            is_best = all(one.template != made[0].template for made in result)
            sideways = turned % 2 == 1 and facing.confidence < SURE_FRONT
            if turned == 0 or is_best or sideways:
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


def _share_near(own: np.ndarray, cells: np.ndarray) -> float:
    """Return the share of an object's cells, int [N, 3], within ``NEAR`` of others, int [M, 3]."""
    low, size = own.min(axis=0) - NEAR, np.ptp(own, axis=0) + 1 + 2 * NEAR
    at = cells - low
    filled = np.zeros(tuple(size), bool)
    filled[tuple(at[((at >= 0) & (at < size)).all(axis=1)].T)] = True
    return float(binary_dilation(filled, iterations=NEAR)[tuple((own - low).T)].mean())


def _looks_of(placed: Furniture) -> tuple[tuple[str, int], ...]:
    return tuple(sorted((one.template, one.quarter_turns) for one in placed))

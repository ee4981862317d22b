"""Detection of the planes of a room in its cells: floors, ceilings and walls, each a flat sheet.

A floor or a ceiling is a layer with at least one flat square metre of its class. A wall is a flat
connected region of wall and window cells in one layer across x or y, with non-structure cells in
front or behind. Crossings of other walls, slopes and walls at an angle to the axes are not flat in
any layer and are not planes. Noise one layer in front or behind belongs to the sheet. Rooms on one
level share a floor. Regions separated by a doorway are one wall, and regions separated by a wider
passage are two.

Planes are named ``floor``, ``floor:2`` (largest first), ``ceiling`` and ``wall:1`` to ``wall:N``
(by axis, layer and position, so that repairing one keeps the names of the others).
"""

from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import STRUCTURE_CLASSES, UNKNOWN, SemanticClass
from world2minecraft.editing.scene.scene_draft import SceneDraft
from world2minecraft.geometry.connected_components import label_components

FLOOR_M2 = 1.0  # A smaller area is a step or the edge of a landing.
WALL_M2 = 0.5  # As the smallest wall that stage 4 calls one.
# Sides in cells of the square around a cell, most of which must be masked for the cell to be flat.
FLAT_WALL, FLAT_LEVEL = 9, 13  # A pillar is a wall; a strip of a sloped ceiling is no ceiling.
DOORWAY_M = 1.2  # The widest gap within a wall, or between two walls that meet.
REACH_M = 2.2  # A wall that ends this near a floor or a ceiling continues to it, hidden.
WALL_CLASSES = (SemanticClass.WALL, SemanticClass.WINDOW)


@dataclass(frozen=True, eq=False)
class Plane:
    """A flat sheet perpendicular to ``axis``. Its 2D arrays span the other two axes in order.

    ``low`` and ``high`` (exclusive) are the bounds in these two axes. ``meets`` states for both
    ends of each of them whether a floor, a ceiling or another wall adjoins.
    """

    name: str
    class_id: int
    axis: int
    layer: int
    low: tuple[int, int]
    high: tuple[int, int]
    meets: tuple[tuple[bool, bool], tuple[bool, bool]] = ((False, False), (False, False))

    @property
    def window(self) -> tuple[slice, slice]:
        """The part of a layer that the plane covers."""
        return slice(self.low[0], self.high[0]), slice(self.low[1], self.high[1])

    def near(self, labels: np.ndarray) -> np.ndarray:
        """Return the labels [X, Y, Z] of the plane's layer and the layers on both sides, [3, A, B].

        Cells beyond the grid are unknown.
        """
        layers = np.full((3, *np.delete(labels.shape, self.axis)), UNKNOWN, labels.dtype)
        for number, layer in enumerate(range(self.layer - 1, self.layer + 2)):
            if 0 <= layer < labels.shape[self.axis]:
                layers[number] = np.take(labels, layer, self.axis)
        return layers

    def cells(self, flat: np.ndarray, layers: np.ndarray) -> np.ndarray:
        """Return the cells int [N, 3] at positions int [N, 2] in the layers int [N]."""
        return np.insert(flat, self.axis, layers, axis=1)


def find_planes(draft: SceneDraft) -> list[Plane]:
    """Return all planes: floors and ceilings, largest first, then walls by position."""
    level = [*_levels(draft, SemanticClass.FLOOR), *_levels(draft, SemanticClass.CEILING)]
    return [*level, *_walls(draft, level)]


def _levels(draft: SceneDraft, class_id: SemanticClass) -> list[Plane]:
    """Return the floors or the ceilings."""
    mask = np.moveaxis(draft.labels == class_id, 2, 0)
    # Only the face towards the room: solid cells above a slope are not several ceilings.
    inward = -1 if class_id == SemanticClass.FLOOR else 1
    mask &= ~np.roll(mask, inward, axis=0)
    counts = (mask & _is_flat(mask, FLAT_LEVEL)).sum(axis=(1, 2))
    least = FLOOR_M2 / draft.voxel_m**2
    found: list[Plane] = []
    while counts.size and counts.max() >= least:
        layer = int(counts.argmax())
        name = class_id.name.lower() + (f":{len(found) + 1}" if found else "")
        whole = (draft.shape[0], draft.shape[1])
        found.append(Plane(name, int(class_id), 2, layer, (0, 0), whole))
        counts[max(layer - 1, 0) : layer + 2] = 0
    return found


def _walls(draft: SceneDraft, levels: list[Plane]) -> list[Plane]:
    found: list[Plane] = []
    least = WALL_M2 / draft.voxel_m**2
    for axis in (0, 1):
        mask = np.moveaxis(np.isin(draft.labels, WALL_CLASSES), axis, 0)
        flat = mask & _is_flat(mask, FLAT_WALL) & _is_face(np.moveaxis(draft.labels, axis, 0))
        sizes = flat.sum(axis=(1, 2))
        while sizes.size and sizes.max() >= least:
            layer = int(sizes.argmax())
            regions = _merge_regions(_regions(mask[layer], flat[layer], least), draft.voxel_m)
            for low, high in regions:
                flat[max(layer - 1, 0) : layer + 2, low[0] : high[0], low[1] : high[1]] = False
                found.append(Plane("", int(SemanticClass.WALL), axis, layer, low, high))
            flat[layer] = False
            near = slice(max(layer - 1, 0), layer + 2)
            sizes[near] = flat[near].sum(axis=(1, 2))
    found.sort(key=lambda one: (one.axis, one.layer, one.low))
    return [
        replace(_meeting(one, [*levels, *found], draft.voxel_m), name=f"wall:{number}")
        for number, one in enumerate(found, 1)
    ]


def _is_flat(mask: np.ndarray, side: int) -> np.ndarray:
    """Return where most of the square around a cell in its layer (the first axis) is masked."""
    count = mask.astype(np.uint8)
    for axis in (1, 2):
        count = ndimage.convolve1d(count, np.ones(side, np.uint8), axis=axis, mode="constant")
    return cast(np.ndarray, count) > side**2 // 2


def _is_face(labels: np.ndarray) -> np.ndarray:
    """Return where one of the two neighbours along the first axis is not structure."""
    other = np.ones((labels.shape[0] + 2, *labels.shape[1:]), bool)
    other[1:-1] = ~np.isin(labels, STRUCTURE_CLASSES)
    return other[:-2] | other[2:]


Region = tuple[tuple[int, int], tuple[int, int]]


def _regions(mask: np.ndarray, flat: np.ndarray, least: float) -> list[Region]:
    """Return the bounds of each large flat region of a layer, bool [A, B]."""
    parts, count = label_components(flat)
    found = []
    for number, box in enumerate(ndimage.find_objects(parts, count), 1):
        if (parts[box] == number).sum() < least:
            continue
        # The rim of a region is not flat: extend it to the last cell of the sheet nearby.
        margin = FLAT_WALL // 2
        start = [max(side.start - margin, 0) for side in box]
        near = mask[start[0] : box[0].stop + margin, start[1] : box[1].stop + margin]
        at = np.argwhere(near) + start
        low, high = at.min(axis=0), at.max(axis=0) + 1
        found.append(((int(low[0]), int(low[1])), (int(high[0]), int(high[1]))))
    return found


def _merge_regions(regions: list[Region], voxel_m: float) -> list[Region]:
    """Join adjacent regions with common heights, which a doorway separates."""
    joined: list[Region] = []
    for low, high in sorted(regions):
        if joined:
            before, end = joined[-1]
            shared = min(end[1], high[1]) - max(before[1], low[1])
            if low[0] - end[0] <= DOORWAY_M / voxel_m and shared > 0:
                low = (before[0], min(before[1], low[1]))  # noqa: PLW2901
                high = (max(end[0], high[0]), max(end[1], high[1]))  # noqa: PLW2901
                joined.pop()
        joined.append((low, high))
    return joined


def _meeting(wall: Plane, planes: list[Plane], voxel_m: float) -> Plane:
    """Extend a wall to the floor, the ceiling and the walls near its ends, and record them."""
    beside = wall.layer, wall.layer + 1
    reach = round(DOORWAY_M / voxel_m)
    across = [one for one in planes if one.axis == 1 - wall.axis and _near(beside, one, reach)]
    floors = [one for one in planes if one.class_id == SemanticClass.FLOOR]
    ceilings = [one for one in planes if one.class_id == SemanticClass.CEILING]
    level = round(REACH_M / voxel_m)
    ends = [
        (_nearest(wall.low[0] - 1, across, -reach), _nearest(wall.high[0], across, reach)),
        (_nearest(wall.low[1] - 1, floors, -level), _nearest(wall.high[1], ceilings, level)),
    ]
    (left, right), (bottom, top) = ends
    low = [
        wall.low[0] if left is None else min(wall.low[0], left + 1),
        wall.low[1] if bottom is None else bottom + 1,
    ]
    high = [
        wall.high[0] if right is None else max(wall.high[0], right),
        wall.high[1] if top is None else top,
    ]
    meets = [(end[0] is not None, end[1] is not None) for end in ends]
    return replace(wall, low=(low[0], low[1]), high=(high[0], high[1]), meets=(meets[0], meets[1]))


def _nearest(end: int, planes: list[Plane], reach: int) -> int | None:
    """Return the nearest layer after the end of a wall within ``reach``, or None."""
    side = 1 if reach > 0 else -1
    near = [one.layer for one in planes if -2 <= (one.layer - end) * side <= abs(reach)]
    return min(near, key=lambda layer: abs(layer - end), default=None)


def _near(span: tuple[int, int], other: Plane, reach: int) -> bool:
    """Return whether a span is within the extent of a wall enlarged by ``reach``."""
    return span[1] > other.low[0] - reach and span[0] < other.high[0] + reach

"""Commands that repair faults of a scan: floaters, holes and rough surfaces.

**Floaters.** A piece consists of all occupied cells, of any class, that are connected by faces,
edges or corners. It is a floater if it is small and not the largest piece of the scene. A piece
with structure cells is a floater only if it is smaller than the smallest wall, regardless of the
requested size. A lamp whose cord was not observed is also a floater by this rule, so the list names
its object.

**Holes.** A gap is a region of a plane without cells of the plane or of other objects in its
layer, bounded by structure on three of the four sides in the plane. In a floor or a ceiling, cells
above or below the gap must also have been observed. Otherwise, the gap must be bounded on all four
sides and have at most four square metres, like the floor below a wardrobe. A wall or ceiling ends
at a slope or another wall in front of it. Window cells belong to their wall. Gaps that are holes:

==================================  =============================================================
hidden: neither the cell nor its    a hole, such as the wall behind a wardrobe or the floor below
neighbours in front or behind were  a bed
observed
unobserved, but next to observed    a hole in a floor or a ceiling; in a wall, it can be the glass
air                                 of a window, so the next rule applies
observed as air                     a hole up to a quarter of a square metre; larger gaps are
                                    doors, windows or stairwells and stay open
==================================  =============================================================

**Smoothing** is a majority filter over the 26 neighbours that never moves structure or unobserved
cells.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from scipy import ndimage

from world2minecraft.core.classes import (
    OBJECT_CLASSES,
    STRUCTURE_CLASSES,
    UNKNOWN,
    SemanticClass,
    display_name,
)
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene.cell_patch import cells_of_runs
from world2minecraft.editing.scene.command import MAX_RUNS, Tools
from world2minecraft.editing.scene.plane_detection import WALL_CLASSES, WALL_M2, Plane, find_planes
from world2minecraft.editing.scene.scene_draft import SceneDraft
from world2minecraft.editing.scene.voxel_commands import (
    Cell,
    CellCommand,
    Runs,
    check_cell,
    plan_cells,
)
from world2minecraft.geometry.connected_components import label_components

# About a football. In ten tuning rooms 13 pieces floated, and 12 of them were real objects that had
# lost their support, so larger pieces are not offered for deletion by default.
MAX_CELLS = 30
HOLE_M2 = 0.25  # A square of half a metre, as for blocks; a cat flap or a chute is no larger.
HIDDEN_M2 = 4.0  # No piece of furniture is larger.
PILLAR_CELLS = 3  # A column with so many wall cells bounds the floor.
FLAT_FACES = 4  # Number of other faces of a cell within a sheet.
PIT = 17  # Of 26 neighbours: a pit in a flat surface. An inner edge has 15 and is kept.


@dataclass(frozen=True, eq=False)
class Floater:
    """A floating piece: its cells int32 [N, 3], its most frequent class, and its object ids."""

    cells: np.ndarray
    class_id: int
    object_ids: tuple[int, ...]


def find_floaters(draft: SceneDraft, max_cells: int = MAX_CELLS) -> list[Floater]:
    """Return the unconnected pieces with at most ``max_cells`` cells, largest first."""
    occupied = (draft.labels > 0) & (draft.labels < 255)
    parts, count = label_components(occupied)
    sizes = np.bincount(parts.ravel(), minlength=count + 1)
    sizes[0] = 0
    small = (sizes > 0) & (sizes <= max_cells)
    built = np.unique(parts[np.isin(draft.labels, STRUCTURE_CLASSES)])
    small[built] &= sizes[built] < WALL_M2 / draft.voxel_m**2
    small[int(sizes.argmax())] = False
    at = np.argwhere(small[parts]).astype(np.int32)
    numbers = parts[tuple(at.T)]
    order = np.argsort(numbers, kind="stable")
    pieces = np.split(at[order], np.flatnonzero(np.diff(numbers[order])) + 1) if len(at) else []
    return sorted((_floater(draft, cells) for cells in pieces), key=_largest_first)


def _floater(draft: SceneDraft, cells: np.ndarray) -> Floater:
    owners = np.unique(draft.instance[tuple(cells.T)])
    class_id = int(np.bincount(draft.labels[tuple(cells.T)]).argmax())
    return Floater(cells, class_id, tuple(int(one) for one in owners if one))


def _largest_first(one: Floater) -> tuple:
    return (-len(one.cells), *map(int, one.cells[0]))


@dataclass(frozen=True, eq=False)
class PlaneGaps:
    """The gaps of a plane. Masks are bool [A, B] over the whole layer."""

    plane: Plane
    own: np.ndarray  # Where it has a cell, one layer before or behind too.
    holes: np.ndarray  # Cells to fill.
    openings: np.ndarray  # Doors, windows and stairwells.

    @property
    def share(self) -> float:
        """The fraction of the plane that consists of holes, without openings."""
        whole = int(self.own[self.plane.window].sum() + self.holes.sum())
        return float(self.holes.sum()) / whole if whole else 0.0


def plane_gaps(draft: SceneDraft, plane: Plane, *, hole_m2: float = HOLE_M2) -> PlaneGaps:
    """Return the gaps of a plane. Observed gaps up to ``hole_m2`` square metres are holes."""
    near = plane.near(draft.labels)
    wanted = WALL_CLASSES if plane.axis != 2 else (plane.class_id,)
    own = np.asarray(np.isin(near, wanted).any(axis=0))
    gap = _find_bounded(draft, plane, near, own) & ~own & (near[1] % UNKNOWN == 0)
    gap &= ~_behind_structure(draft, plane)
    unseen = near[1] == UNKNOWN
    aired = (near[0] == 0) | (near[2] == 0)
    if plane.axis == 2:
        aired = np.zeros_like(aired)
    hidden = gap & unseen & ~aired
    holes = hidden | _up_to(gap & ~hidden, hole_m2 / draft.voxel_m**2)
    return PlaneGaps(plane, own, holes, gap & ~holes)


def hole_cells(draft: SceneDraft, gaps: PlaneGaps, mask: np.ndarray) -> np.ndarray:
    """Return the cells int [N, 3] that fill positions bool [A, B] of a plane.

    Each cell is in the layer of the nearest part of the plane, or in the middle layer if that cell
    is occupied.
    """
    plane = gaps.plane
    near = plane.near(draft.labels)
    wanted = WALL_CLASSES if plane.axis != 2 else (plane.class_id,)
    has = np.isin(near, wanted)
    offset = np.where(has[1], 0, np.where(has[0], -1, 1))
    nearest = ndimage.distance_transform_edt(~gaps.own, return_distances=False, return_indices=True)
    flat = np.argwhere(mask)
    at = tuple(flat.T)
    moved = offset[tuple(nearest[(slice(None), *at)])]  # type: ignore[index]
    inside = (plane.layer + moved >= 0) & (plane.layer + moved < draft.shape[plane.axis])
    taken = ~inside | (near[(1 + moved, *at)] % UNKNOWN > 0)
    return plane.cells(flat, plane.layer + np.where(taken, 0, moved))


def gap_at(gaps: PlaneGaps, place: tuple[int, int]) -> np.ndarray:
    """Return the gap (hole or opening) at a position of the plane, bool [A, B].

    The mask is empty if the position is not in a gap.
    """
    parts = label_components(gaps.holes | gaps.openings, corners=False)[0]
    return (parts == parts[place]) & (parts > 0)


def _find_bounded(draft: SceneDraft, plane: Plane, near: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Return where structure bounds a position of the plane, bool [A, B]."""
    if plane.axis != 2:
        result = np.zeros(own.shape, bool)
        bounds = np.asarray(np.isin(near, STRUCTURE_CLASSES).any(axis=0))[plane.window]
        # Beyond each end that meets another plane there is a bound, were its own cells missing.
        framed = np.pad(bounds, 1)
        framed[0], framed[-1] = plane.meets[0]
        framed[1:-1, 0], framed[1:-1, -1] = plane.meets[1]
        result[plane.window] = _sides(framed)[1:-1, 1:-1] >= 3
        return result
    pillars = np.isin(draft.labels, WALL_CLASSES).sum(axis=2) >= PILLAR_CELLS
    sides = _sides(own | pillars)
    up = slice(plane.layer + 1, None)
    room = draft.labels[:, :, up if plane.class_id == SemanticClass.FLOOR else slice(plane.layer)]
    seen = (room != UNKNOWN).any(axis=2)
    unseen = _up_to(~pillars & ~own & ~seen & (sides == 4), HIDDEN_M2 / draft.voxel_m**2)
    return (~pillars & seen & (sides >= 3)) | unseen


def _behind_structure(draft: SceneDraft, plane: Plane) -> np.ndarray:
    """Return where a plane would be behind a slope or another wall, bool [A, B].

    There, the first known cell on one side is structure, and on the other side structure or none. A
    floor continues below all of them.
    """
    if plane.class_id == SemanticClass.FLOOR:
        return np.zeros(np.delete(draft.shape, plane.axis), bool)
    layers = np.moveaxis(draft.labels, plane.axis, 0)
    above = _first_known(layers[plane.layer + 1 :])
    below = _first_known(layers[: plane.layer][::-1])
    walls = WALL_CLASSES if plane.axis != 2 else ()
    hiding = (*walls, SemanticClass.CEILING)
    hidden = [np.isin(one, hiding) for one in (above, below)]
    nothing = [one == UNKNOWN for one in (above, below)]
    return (hidden[0] & (hidden[1] | nothing[1])) | (nothing[0] & hidden[1])


def _first_known(layers: np.ndarray) -> np.ndarray:
    """Return the first known label along the first axis of [N, A, B], or 255 if there is none."""
    known = layers != UNKNOWN
    if not len(layers):
        return np.full(layers.shape[1:], UNKNOWN, np.uint8)
    return np.take_along_axis(layers, known.argmax(axis=0)[None], axis=0)[0]


def _sides(bounds: np.ndarray) -> np.ndarray:
    """Return the number of bounded sides of the four sides, int [A, B]."""
    sides = np.zeros(bounds.shape, np.int64)
    for axis in (0, 1):
        sides += np.maximum.accumulate(bounds, axis=axis)
        sides += np.flip(np.maximum.accumulate(np.flip(bounds, axis), axis=axis), axis)
    return sides


def _up_to(mask: np.ndarray, most: float) -> np.ndarray:
    """Return the parts of a mask bool [A, B], connected by edges, up to a number of cells."""
    parts = label_components(mask, corners=False)[0]
    small = np.bincount(parts.ravel()) <= most
    small[0] = False
    return small[parts]


def smooth_labels(labels: np.ndarray) -> np.ndarray:
    """Return labels uint8 [X, Y, Z] after one pass of the majority filter.

    A furniture cell takes the class of more than half of the furniture cells in its 3x3x3 block. An
    empty cell with at least 17 furniture neighbours is filled, because it is a pit in a surface. A
    bump, which is a cell that touches only one cell, is removed if that cell touches four others.
    Ends of legs and rims are kept.
    """
    furniture = np.isin(labels, OBJECT_CLASSES)
    counts = np.stack([_around(labels == one) for one in OBJECT_CLASSES])
    total = counts.sum(axis=0)
    most = counts.max(axis=0)
    commonest = np.array(OBJECT_CLASSES, np.uint8)[counts.argmax(axis=0)]
    result = labels.copy()
    changes = furniture & (2 * most > total)
    result[changes] = commonest[changes]
    filled = (labels == 0) & (total >= PIT)
    result[filled] = commonest[filled]
    result[furniture & _bumps((labels > 0) & (labels < 255))] = 0
    return result


def _around(mask: np.ndarray) -> np.ndarray:
    """Return the number of masked cells in the block of 27 around each cell, uint8 [X, Y, Z]."""
    count = mask.astype(np.uint8)
    for axis in range(3):
        count = ndimage.convolve1d(count, np.ones(3, np.uint8), axis=axis, mode="constant")
    return np.asarray(count)


def _bumps(occupied: np.ndarray) -> np.ndarray:
    """Return the cells that touch only one cell, which is inside a sheet, bool [X, Y, Z]."""
    padded = np.pad(occupied, 1)
    faces = np.zeros(padded.shape, np.uint8)
    for axis in range(3):
        for step in (-1, 1):
            faces += np.roll(padded, step, axis)
    sheet = padded & (faces > FLAT_FACES)
    beside = np.zeros(padded.shape, bool)
    for axis in range(3):
        for step in (-1, 1):
            beside |= np.roll(sheet, step, axis)
    inner = (slice(1, -1),) * 3
    return (padded & (faces == 1) & beside)[inner]


class RemoveFloaters(CellCommand):
    """Erase all unconnected pieces with at most ``max_cells`` cells.

    Pieces that contain one of the cells ``keep`` (flat indices) are not erased.
    """

    op: Literal["remove_floaters"] = "remove_floaters"
    max_cells: Annotated[int, Field(ge=1)] = MAX_CELLS
    keep: Annotated[tuple[Annotated[int, Field(ge=0)], ...], Field(max_length=MAX_RUNS)] = ()

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the erased cells."""
        found = [one.cells for one in find_floaters(draft, self.max_cells)]
        numbers = [np.ravel_multi_index(tuple(cells.T), draft.shape) for cells in found]
        gone = [
            cells
            for cells, flat in zip(found, numbers, strict=True)
            if not np.isin(flat, self.keep).any() and self.free(draft, cells).all()
        ]
        if not gone:
            raise UsageError(f"no floaters with at most {self.max_cells} cells found")
        return plan_cells(draft, "delete", np.concatenate(gone), 0)


class FillHoles(CellCommand):
    """Fill the holes of a plane, of an object's surface, or of all planes.

    ``plane`` is ``floor``, ``ceiling``, ``wall:1`` and so on as listed by the query ``holes``,
    ``all`` planes, or ``object:7``. The holes of an object are empty cells with cells of the object
    on both sides along two axes. With ``cell``, only the gap that contains the cell is filled, even
    if it is a door. Otherwise, all gaps except openings are filled, including observed gaps up to
    ``hole_m2``.
    """

    op: Literal["fill_holes"] = "fill_holes"
    plane: Annotated[str, Field(max_length=40)]
    cell: Cell | None = None
    hole_m2: Annotated[float, Field(ge=0)] = HOLE_M2

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the filled cells."""
        if self.plane.startswith("object:"):
            return self._object(draft)
        planes = find_planes(draft)
        if self.plane != "all":
            planes = [named_plane(planes, self.plane)]
        parts = [self._cells(draft, plane) for plane in planes]
        cells = np.concatenate([*parts, np.zeros((0, 3), np.int64)])
        classes = np.repeat([plane.class_id for plane in planes], [len(part) for part in parts])
        cells, first = np.unique(cells, axis=0, return_index=True)  # Two planes meet in a corner.
        if not len(cells):
            where = "any plane" if self.plane == "all" else self.plane
            raise UsageError(
                f"{where} has no holes to fill; specify a cell of an opening to close it"
            )
        return plan_cells(draft, "fill", cells, classes[first], 0, counts_as="add")

    def _cells(self, draft: SceneDraft, plane: Plane) -> np.ndarray:
        gaps = plane_gaps(draft, plane, hole_m2=self.hole_m2)
        if self.cell is None:
            return hole_cells(draft, gaps, gaps.holes)
        check_cell(draft, self.cell)
        place = tuple(np.delete(self.cell, plane.axis).tolist())
        mask = gap_at(gaps, place)
        if not mask.any():
            raise UsageError(f"cell {list(self.cell)} is not in a gap of {plane.name}")
        return hole_cells(draft, gaps, mask)

    def _object(self, draft: SceneDraft) -> Operation:
        number = self.plane.partition(":")[2]
        if not number.isdecimal() or int(number) not in draft.objects:
            raise UsageError(f"object {number} not found; see the object tree")
        one = draft.objects[int(number)]
        cells = pinholes(draft.labels, draft.instance == one.id)
        if not len(cells):
            raise UsageError(f"object {one.id} has no holes")
        return plan_cells(draft, "fill", cells, one.class_id, one.id, counts_as="add")


class Smooth(CellCommand):
    """Smooth furniture with a majority filter, without moving structure.

    If ``class_id`` is given, only cells of that class are changed or created. If ``runs`` is given,
    only those cells are changed.
    """

    op: Literal["smooth"] = "smooth"
    class_id: Annotated[int, Field(ge=min(OBJECT_CLASSES), le=max(OBJECT_CLASSES))] | None = None
    runs: Runs | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the changed cells."""
        result = smooth_labels(draft.labels)
        changes = result != draft.labels
        if self.class_id is not None:
            changes &= (draft.labels == self.class_id) | (result == self.class_id)
        if self.runs is not None:
            chosen = np.zeros(draft.shape, bool)
            chosen[tuple(cells_of_runs(self.runs, draft.shape).T)] = True
            changes &= chosen
        cells = np.argwhere(changes)
        cells = cells[self.free(draft, cells)]
        if not len(cells):
            what = f"class {display_name(self.class_id)}" if self.class_id else "furniture"
            raise UsageError(f"nothing to change: {what} is already smooth or locked")
        return plan_cells(draft, "smooth", cells, result[tuple(cells.T)], counts_as="other")


def named_plane(planes: list[Plane], name: str) -> Plane:
    """Return the plane with a name. The suffix ``:1`` is optional.

    Raises:
        UnknownNameError: If the scene has no such plane.
    """
    by_name = {plane.name: plane for plane in planes}
    for spelled in (name, name.removesuffix(":1"), f"{name}:1"):
        if spelled in by_name:
            return by_name[spelled]
    raise UnknownNameError("plane", name, [*by_name, "all"])


def pinholes(labels: np.ndarray, mine: np.ndarray) -> np.ndarray:
    """Return empty or unobserved cells int [N, 3] with masked cells on both sides of two axes.

    ``labels`` uint8 and ``mine`` bool are [X, Y, Z].
    """
    between = np.zeros(labels.shape, np.uint8)
    for axis in range(3):
        inner = [slice(None)] * 3
        inner[axis] = slice(1, -1)
        moved = np.moveaxis(mine, axis, 0)
        both = np.moveaxis(moved[:-2] & moved[2:], 0, axis)
        between[tuple(inner)] += both
    return np.argwhere((between >= 2) & (labels % 255 == 0))

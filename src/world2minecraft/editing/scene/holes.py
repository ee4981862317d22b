"""Holes in the planes of a room, told from doors, windows and stairwells.

A gap is where a plane has no cell, nothing else stands in its layer, and structure bounds it to
three of the four sides in the plane. In a floor or a ceiling something was seen over or under it
too; where nothing was, it is bounded to all four sides and has at most four square metres, as the
floor under a wardrobe. Behind a slope or another wall a wall or a ceiling ends. What of a gap is
a hole:

==================================  =============================================================
hidden: neither the cell nor one    a hole: the wall behind a wardrobe, the floor under a bed
before or behind it was seen
unseen, but beside seen air         in a floor or a ceiling a hole; in a wall it may be the glass
                                    of a window, so as below
seen to be air                      a hole up to a quarter of a square metre; a larger one is a
                                    door, a window or a stairwell, and stays open
==================================  =============================================================

Window cells are part of their wall. Whoever names a cell of a gap fills that gap, whatever it is.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import STRUCTURE_CLASSES, UNKNOWN, SemanticClass
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.planes import WALL_CLASSES, Plane
from world2minecraft.geometry.connected_components import label_components

HOLE_M2 = 0.25  # A square of half a metre, as for blocks; a cat flap or a chute is no larger.
HIDDEN_M2 = 4.0  # No piece of furniture is larger.
PILLAR_CELLS = 3  # A column with so many wall cells bounds the floor.


@dataclass(frozen=True, eq=False)
class PlaneGaps:
    """What a plane lacks. Masks are bool [A, B] over the whole layer."""

    plane: Plane
    own: np.ndarray  # Where it has a cell, one layer before or behind too.
    holes: np.ndarray  # What is to be filled.
    openings: np.ndarray  # Doors, windows and stairwells.

    @property
    def share(self) -> float:
        """The part of the plane that is holes, openings left out."""
        whole = int(self.own[self.plane.window].sum() + self.holes.sum())
        return float(self.holes.sum()) / whole if whole else 0.0


def plane_gaps(draft: SceneDraft, plane: Plane, *, hole_m2: float = HOLE_M2) -> PlaneGaps:
    """Return what a plane lacks; seen gaps up to ``hole_m2`` are holes."""
    near = plane.near(draft.labels)
    wanted = WALL_CLASSES if plane.axis != 2 else (plane.class_id,)
    own = np.asarray(np.isin(near, wanted).any(axis=0))
    gap = _bounded(draft, plane, near, own) & ~own & (near[1] % UNKNOWN == 0)
    gap &= ~_behind_structure(draft, plane)
    unseen = near[1] == UNKNOWN
    aired = (near[0] == 0) | (near[2] == 0)
    if plane.axis == 2:
        aired = np.zeros_like(aired)
    hidden = gap & unseen & ~aired
    holes = hidden | _up_to(gap & ~hidden, hole_m2 / draft.voxel_m**2)
    return PlaneGaps(plane, own, holes, gap & ~holes)


def hole_cells(draft: SceneDraft, gaps: PlaneGaps, mask: np.ndarray) -> np.ndarray:
    """Return the cells int [N, 3] that fill places bool [A, B] of a plane.

    Each is in the layer in which the plane is nearest, or in the middle where that is taken.
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
    """Return the gap bool [A, B], hole or opening, that a place of the plane is in; or nothing."""
    parts = label_components(gaps.holes | gaps.openings, corners=False)[0]
    return (parts == parts[place]) & (parts > 0)


def _bounded(draft: SceneDraft, plane: Plane, near: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Where structure bounds a place of the plane, bool [A, B]."""
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
    """Where a plane would lie behind a slope or another wall, bool [A, B]: there it is no more.

    That is where the first known cell on one side is structure, and on the other too, or nothing.
    A floor lies under all of them.
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
    """The first label that is known along the first axis of [N, A, B]; 255 where none is."""
    known = layers != UNKNOWN
    if not len(layers):
        return np.full(layers.shape[1:], UNKNOWN, np.uint8)
    return np.take_along_axis(layers, known.argmax(axis=0)[None], axis=0)[0]


def _sides(bounds: np.ndarray) -> np.ndarray:
    """To how many of the four sides there is a bound, int [A, B]."""
    sides = np.zeros(bounds.shape, np.int64)
    for axis in (0, 1):
        sides += np.maximum.accumulate(bounds, axis=axis)
        sides += np.flip(np.maximum.accumulate(np.flip(bounds, axis), axis=axis), axis)
    return sides


def _up_to(mask: np.ndarray, most: float) -> np.ndarray:
    """The parts, joined by edges, of a mask bool [A, B] that have at most so many cells."""
    parts = label_components(mask, corners=False)[0]
    small = np.bincount(parts.ravel()) <= most
    small[0] = False
    return small[parts]

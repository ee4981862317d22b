"""Objects as block shapes: fitted in their own frame, rotated and placed on the lattice.

Half blocks are an array ``halves`` uint8 [X, Y, Z], with bit 1 for the lower and bit 2 for the
upper half of a block. They are used if no finer shape exists in an object's colours; each becomes a
full block.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.fitting import Fit, PartsFit, fit_parts
from world2minecraft.construction.fitting.shapes import SUB, ShapeSet, shape_set
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture import Part

LOWER, UPPER, FULL = 1, 2, 3
TIE = 1e-6
LAID_ON = (SemanticClass.TABLE,)  # Things lie on these; a top in mid-block would leave a gap.


def halves_from_layers(layers: np.ndarray) -> np.ndarray:
    """Convert a bool array [X, Y, 2 Z], two layers per block, to half blocks uint8 [X, Y, Z]."""
    return (layers[:, :, 0::2] * LOWER + layers[:, :, 1::2] * UPPER).astype(np.uint8)


class Design(NamedTuple):
    """Block shapes on the lattice, with the part number of each block (1 if there are no parts)."""

    low: np.ndarray  # int [3], the lattice index of the first block
    numbers: np.ndarray  # intp [X, Y, Z], of the shape set
    part: np.ndarray  # int16 [X, Y, Z], 0 where it is empty
    shapes: ShapeSet

    @property
    def filled(self) -> np.ndarray:
        """Bool [X, Y, Z] mask of the filled blocks."""
        return self.numbers > 0

    def moved(self, step: np.ndarray) -> "Design":
        """Return the design moved by whole blocks, int [3]."""
        return self._replace(low=self.low + step)

    def cut(self, low: np.ndarray, box: tuple[slice, ...], numbers: np.ndarray) -> "Design":
        """Return the part of the design in a box that begins at ``low``, with new shape numbers."""
        return Design(low, numbers, np.where(numbers > 0, self.part[box], 0), self.shapes)


def design_of_halves(low: np.ndarray, halves: np.ndarray, part: np.ndarray | None = None) -> Design:
    """Convert half blocks, uint8 [X, Y, Z], to a design of full blocks that begins at ``low``."""
    numbers = (halves > 0).astype(np.intp)
    own = numbers.astype(np.int16) if part is None else np.where(halves > 0, part, 0)
    return Design(low, numbers, own, shape_set(frozenset()))


def single_block_design(place: np.ndarray) -> Design:
    """Return a design of one full block at a block position, int [3]."""
    ones = np.ones((1, 1, 1), np.intp)
    return Design(place, ones, ones.astype(np.int16), shape_set(frozenset()))


def design_of_parts(
    placement: Placement, parts: Sequence[Part], lattice: Lattice, kinds: frozenset[str]
) -> Design:
    """Convert the parts of a placement to block shapes, rotated and in place.

    Equal parts give equal shapes at the same scale, independent of their position.
    """
    sizes = placement.size_m * lattice.blocks_per_metre
    middle = lattice.coordinates_of(placement.center_m)
    base, bottom = base_layer(middle[2] - sizes[2] / 2, lattice)
    counts, start = _plan(placement, sizes, middle)
    boxes = tuple(tuple(np.round(part.box_m, 4).tolist()) for part in parts)
    fit, part = _fit_of_parts(
        boxes, lattice.blocks_per_metre, kinds, counts, bottom, placement.class_id in LAID_ON
    )
    shapes, turns = shape_set(kinds), placement.quarter_turns
    numbers = shapes.turns[turns][np.rot90(fit.numbers, turns)]
    centre = rotate_middle(fit, turns)
    xy = np.floor(middle[:2] - centre + 0.5 - TIE).astype(int) if start is None else start
    return Design(np.array([*xy, base]), numbers, np.rot90(part, turns), shapes)


@lru_cache(maxsize=512)
def _fit_of_parts(boxes, blocks_per_metre, kinds, counts, bottom, flush) -> PartsFit:
    return fit_parts(
        np.array(boxes),
        blocks_per_metre,
        shape_set(kinds),
        counts=counts,
        bottom=bottom,
        flush=flush,
    )


def rotate_middle(fit: Fit, quarter_turns: int) -> np.ndarray:
    """Return the centre of a fit in its box after quarter turns, float64 [2]."""
    x, y = fit.middle.tolist()
    wide, long = fit.numbers.shape[:2]
    for _ in range(quarter_turns % 4):
        x, y, wide, long = long - y, x, long, wide
    return np.array([x, y])


def base_layer(bottom: float, lattice: Lattice) -> tuple[int, int]:
    """Return the layer of an object's bottom and its sub-cell, rounded to a whole or half block."""
    half = float(np.floor(2 * bottom + 0.5) / 2)
    ground = float(lattice.ground_under(half))
    half = ground if half < ground + 1 else half
    return int(np.floor(half)), round((half - np.floor(half)) * SUB)


def _plan(
    placement: Placement, sizes: np.ndarray, middle: np.ndarray
) -> tuple[tuple[int, int] | None, np.ndarray | None]:
    """Return the number of blocks along a placement's own axes and its first block, or None.

    For objects along walls, the sides are rounded to block boundaries, so that the front keeps its
    position.
    """
    if placement.class_id != SemanticClass.FURN:
        return None, None
    count, start = size_at_wall(placement, sizes, middle)
    along, across = count.tolist()
    return (along, across), start


def size_at_wall(
    placement: Placement, sizes: np.ndarray, middle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the size of a placement with its sides rounded to blocks, and its first block.

    Args:
        placement: The placement.
        sizes: Its size along its own axes in blocks, float64 [3].
        middle: Its centre on the lattice, float64 [3].

    Returns:
        The whole blocks along its own axes and its first block along x and y, int [2] each.
    """
    odd = placement.quarter_turns % 2
    turned = sizes[:2][::-1] if odd else sizes[:2]
    # Halves go outward on both sides, so that a turn or a mirror image changes nothing.
    start = np.ceil(middle[:2] - turned / 2 - 0.5 - TIE).astype(int)
    end = np.floor(middle[:2] + turned / 2 + 0.5 + TIE).astype(int)
    count = np.maximum(end - start, 1)
    return (count[::-1] if odd else count), start

"""A furniture template as blocks: its metric parts snapped onto the block lattice.

The placement's box is snapped to whole blocks first and the parts are stretched with it, in the
template's own frame: so a symmetric chair stays symmetric, equal chairs come out equal, and the
quarter turn comes last.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.fitted_objects import of_half_layers
from world2minecraft.construction.lattice import Lattice
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import Placement
from world2minecraft.furniture import Part

THIN = 0.75  # Blocks: a part thinner than this along an axis is one layer.
TIE = 1e-6
POST = 0.5  # Blocks: an upright part thinner than this both ways is a post.


class Design(NamedTuple):
    """A template on the lattice: which part fills each half block, 1 = the first, 0 = none."""

    low: np.ndarray  # int [3], the lattice index of the first block
    halves: np.ndarray  # uint8 [X, Y, Z]
    part: np.ndarray  # int16 [X, Y, Z], index into the parts + 1
    posts: np.ndarray  # bool [X, Y, Z]


def design_of(placement: Placement, parts: Sequence[Part], lattice: Lattice) -> Design:
    """Return the half blocks of a placement's parts, turned and in place."""
    sizes = placement.size_m * lattice.blocks_per_metre
    middle = lattice.coordinates_of(placement.center_m)
    count, start = _plan(placement, sizes, middle)
    bottom = _half(middle[2] - sizes[2] / 2)
    ground = float(lattice.ground_under(bottom))
    bottom = ground if bottom < ground + 1 else bottom
    top = max(_half(middle[2] + sizes[2] / 2), bottom + 0.5)
    base = int(np.floor(bottom))
    height = int(np.ceil(top)) - base
    owner = np.zeros((count[0], count[1], 2 * height), np.int16)
    posts = np.zeros(owner.shape, bool)
    # Posts first: a leg that is rounded up to the plate it carries must not pierce its corner.
    thin = [_is_post(one.box_m * lattice.blocks_per_metre) for one in parts]
    order = sorted(range(len(parts)), key=lambda i: (not thin[i], -_volume(parts[i].box_m)))
    scale = np.array([*(count / sizes[:2]), (top - bottom) / sizes[2]])
    for index in order:
        box = parts[index].box_m.reshape(2, 3) * lattice.blocks_per_metre
        box[:, :2] += sizes[:2] / 2
        box *= scale
        spans = [_span(box[0, axis], box[1, axis], int(count[axis])) for axis in (0, 1)]
        lower = 2 * (bottom - base)
        spans.append(_span(2 * box[0, 2] + lower, 2 * box[1, 2] + lower, 2 * height))
        where = tuple(slice(*span) for span in spans)
        owner[where] = index + 1
        posts[where] = _is_post(box.ravel())
    for index in order:
        if parts[index].role == "seat":
            _rest_on_posts(index + 1, owner, posts)
    return _turned(owner, posts, np.array([*start, base]), placement.quarter_turns)


def _plan(
    placement: Placement, sizes: np.ndarray, middle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the blocks, int [2], along a placement's own depth and width, and its first block.

    Sizes are rounded, so that equal things come out equal. Of what stands along walls the sides
    are rounded instead, each to the nearest edge of a block: its front stays where it is.
    """
    odd = placement.quarter_turns % 2
    if placement.class_id == SemanticClass.FURN:
        turned = sizes[:2][::-1] if odd else sizes[:2]
        # Halves go outward on both sides, so that a turn or a mirror image changes nothing.
        start = np.ceil(middle[:2] - turned / 2 - 0.5 - TIE).astype(int)
        end = np.floor(middle[:2] + turned / 2 + 0.5 + TIE).astype(int)
        count = np.maximum(end - start, 1)
        return (count[::-1] if odd else count), start
    count = np.maximum(np.floor(sizes[:2] + 0.5), 1).astype(int)
    size = count[::-1] if odd else count
    return count, np.floor(middle[:2] - size / 2 + 0.5).astype(int)


def _is_post(box: np.ndarray) -> bool:
    """Whether a box, float64 [6] in blocks, is upright and thinner than a post both ways."""
    wide = box[3:] - box[:3]
    return bool((wide[:2] < POST).all() and wide[2] > 1)


def _rest_on_posts(seat: int, owner: np.ndarray, posts: np.ndarray) -> None:
    """Lower a thin seat from the upper to the lower half of its blocks, in place.

    A half post cannot be built: under a plate in the upper half it would have to be a whole
    block, and a chair became a cube. What stands on the seat comes down with it.
    """
    layers = np.unique(np.argwhere(owner == seat)[:, 2])
    if len(layers) != 1 or layers[0] % 2 == 0 or layers[0] < 3:
        return
    level = int(layers[0])
    mask = owner[:, :, level] == seat
    if not posts[:, :, level - 1][mask].any():
        return
    above = owner[:, :, level + 1] if level + 1 < owner.shape[2] else np.zeros_like(mask, np.int16)
    owner[:, :, level - 1][mask] = seat
    posts[:, :, level - 1][mask] = False
    owner[:, :, level][mask] = above[mask]


def _turned(owner, posts, low, quarter_turns) -> Design:
    owner, posts = (turn_grid(values, quarter_turns) for values in (owner, posts))
    halves = of_half_layers(owner > 0)
    upper, lower = owner[:, :, 1::2], owner[:, :, 0::2]
    part = np.where(upper > 0, upper, lower)
    return Design(low, halves, part, posts[:, :, 0::2] & posts[:, :, 1::2])


def _half(value: float) -> float:
    return float(np.floor(2 * value + 0.5) / 2)


def _volume(box: np.ndarray) -> float:
    return float(np.prod(box[3:] - box[:3]))


def _span(low: float, high: float, count: int) -> tuple[int, int]:
    """Return the layers [start, stop) of a part from low to high, the same for its mirror image."""
    if high - low < THIN:
        start = int(np.clip(np.floor((low + high) / 2), 0, count - 1))
        return start, start + 1
    start = int(np.clip(np.floor(low + 0.5), 0, count - 1))
    return start, int(np.clip(np.ceil(high - 0.5), start + 1, count))

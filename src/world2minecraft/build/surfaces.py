"""Painting what was shaped: each surface of the shell and each object gets its blocks."""

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.hues import default_colour, group_medians, spread
from world2minecraft.build.paint import paint
from world2minecraft.build.palettes import Palette
from world2minecraft.build.parameters import BuildParameters


def block_colours(
    shape: tuple[int, ...], blocks: np.ndarray, colours: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the median colour of each block, float32 [X, Y, Z, 3], and where there is one, bool.

    Args:
        shape: the lattice's.
        blocks: int [N, 3], the block of each colour; those outside are left out.
        colours: float32 [N, 3], Oklab.
    """
    inside = ((blocks >= 0) & (blocks < np.array(shape))).all(1)
    flat = np.ravel_multi_index(tuple(blocks[inside].T), shape)
    used, groups = np.unique(flat, return_inverse=True)
    medians, _ = group_medians(groups, colours[inside], len(used))
    result = np.zeros((int(np.prod(shape)), 3), np.float32)
    known = np.zeros(len(result), bool)
    result[used], known[used] = medians, True
    return result.reshape((*shape, 3)), known.reshape(shape)


def painted(
    mask: np.ndarray,
    colours: np.ndarray,
    known: np.ndarray,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
    most: int,
) -> np.ndarray:
    """Return the block states, object [N], for the N blocks of a mask, all of one surface."""
    default = palette.defaults[class_id]
    if not (known & mask).any():
        return np.full(int(mask.sum()), default, object)
    choices = palette.blocks[class_id]
    found = spread(colours, known & mask, mask, default_colour(default))
    index = paint(
        found,
        np.argwhere(mask),
        choices,
        most=most,
        lightness_weight=parameters.lightness_weight,
        calm_step=parameters.calm,
    )
    return np.array(choices, object)[index]


def put_painted(canvas: Canvas, mask: np.ndarray, states: np.ndarray, class_id: int, instance=0):
    """Set the blocks of a mask to the states that ``painted`` gave for it."""
    names, index = np.unique(states.astype(str), return_inverse=True)
    canvas.put(mask, canvas.ids_of(names.tolist())[index], class_id, instance)

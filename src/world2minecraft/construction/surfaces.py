"""Painting what was shaped: each surface of the shell and each object gets its blocks."""

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.cell_colours import default_colour, group_medians, spread
from world2minecraft.construction.paint import FADED, paint
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.core.classes import STRUCTURE_CLASSES
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of

NEW_PAINT = 0.03  # What a block must be nearer by to come in beside those that the room has.
TOLD_APART = 0.06  # Oklab distance of two blocks that one tells apart at a glance; a guess.


def block_colours(
    shape: tuple[int, ...], blocks: np.ndarray, colours: np.ndarray, usable: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the median colour of each block, float32 [X, Y, Z, 3], and where there is one, bool.

    Args:
        shape: the lattice's.
        blocks: int [N, 3], the block of each colour; those outside are left out.
        colours: float32 [N, 3], Oklab.
        usable: bool [N], which of them are colours.
    """
    inside = usable & ((blocks >= 0) & (blocks < np.array(shape))).all(1)
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
    *,
    beside: frozenset[str] = frozenset(),
    used: frozenset[str] = frozenset(),
    only: tuple[str, ...] = (),
) -> np.ndarray:
    """Return the block states, object [N], for the N blocks of a mask, all of one surface.

    Args:
        mask: bool [X, Y, Z].
        colours: float32 [X, Y, Z, 3], Oklab.
        known: bool [X, Y, Z], where ``colours`` holds one.
        class_id: whose blocks of the palette may be used.
        palette: what may be used.
        parameters: how colours are weighed.
        most: at most so many different blocks.
        beside: blocks that the surface is to stand out from: none that looks like them is used.
        used: blocks that the room already has; they win where they are about as near.
        only: the blocks of the class that may be used; none stands for all.
    """
    default = palette.defaults[class_id]
    if not (known & mask).any():
        return np.full(int(mask.sum()), default, object)
    choices = _unlike(only or palette.blocks[class_id], beside)
    preferred = palette.preferred[class_id] or choices
    handicaps = np.array([parameters.preference * (block not in preferred) for block in choices])
    if used:
        handicaps += [NEW_PAINT * (block not in used) for block in choices]
    shell, weight = class_id in STRUCTURE_CLASSES, parameters.lightness_weight
    index = paint(
        spread(colours, known & mask, mask, default_colour(default)),
        np.argwhere(mask),
        choices,
        most=most,
        lightness_weight=parameters.structure_lightness_weight if shell else weight,
        noticed=parameters.structure_noticed if shell else parameters.object_noticed,
        match_weight=weight,
        calm_step=parameters.calm,
        handicaps=handicaps,
        fading=0.0 if shell else FADED,
    )
    return np.array(choices, object)[index]


def _unlike(choices: tuple[str, ...], beside: frozenset[str]) -> tuple[str, ...]:
    """Return the choices that one can tell from some blocks; all where none is left."""
    if not beside:
        return choices
    offered = srgb_to_oklab(colours_of(choices))
    others = srgb_to_oklab(colours_of(sorted(beside)))
    apart = np.linalg.norm(offered[:, None] - others, axis=-1).min(1) >= TOLD_APART
    return tuple(np.array(choices)[apart].tolist()) or choices


def put_painted(
    canvas: Canvas, mask: np.ndarray, states: np.ndarray, class_id: int, instance: int = 0
) -> None:
    """Set the blocks of a mask to the states that ``painted`` gave for it."""
    names, index = np.unique(states.astype(str), return_inverse=True)
    canvas.put(mask, canvas.ids_of(names.tolist())[index], class_id, instance)

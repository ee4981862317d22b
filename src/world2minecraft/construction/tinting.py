"""The materials of a vanilla design in an object's real colours.

Roles of one material take one colour, the median of their cells, so that a chair's legs and seat
are of one wood; each becomes the nearest of its kind that has all the shapes it needs. Where a
wood or stone is plainly wrong (red cupboards), what is nearest among all that has these shapes
stands for it. Plain blocks are painted one by one, like what is built from an object's own cells.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.paint import FADED, costs_of
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.surfaces import painted
from world2minecraft.furniture import IdiomBlock, Material
from world2minecraft.furniture.materials import FIXED, PLAIN, Swatch, restated, shape_of, swatches
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.collision_shapes import is_full_cube

OTHER_CLOTH = 0.03  # Oklab: what another full block must be nearer by than wool. A guess.
OTHER_KIND = 0.1  # Oklab: what another kind of material must come nearer by. A guess.
OWN_LOOK = 0.1  # Oklab: up to this far off a fixed block keeps its own look. A guess.
CLEAR_CHROMA, CLEAR_SHARE = 0.06, 0.3
PLAIN_PAINTS = 3  # Blocks of one plain role: a front, its trim and one thing in it.


class Hue(NamedTuple):
    """What is known of an object's colours, in its own box of blocks."""

    colours: np.ndarray  # float32 [X, Y, Z, 3], Oklab
    known: np.ndarray  # bool [X, Y, Z]
    paint: np.ndarray | None  # float32 [3], where all of it has one colour


def tinted(
    blocks: Sequence[IdiomBlock],
    cells: np.ndarray,
    materials: Mapping[str, Material],
    hue: Hue,
    class_id: int,
    palette: Palette,
    parameters: BuildParameters,
) -> list[str]:
    """Return the state of each block of a design in the object's colours.

    Args:
        blocks: N blocks.
        cells: int [N, 3], where they stand in the box of ``hue``.
        materials: what each role is made of; blocks of other roles stay.
        hue: the object's colours.
        class_id: the object's class.
        palette: the blocks that plain roles may become.
        parameters: how colours are weighed.
    """
    states = [block.state for block in blocks]
    if hue.paint is None and not hue.known.any():
        return states
    groups: dict[Material, list[int]] = {}
    for index, block in enumerate(blocks):
        material = materials.get(block.role)
        if material is not None and material.takes_colour:
            groups.setdefault(material, []).append(index)
    for material, indices in groups.items():
        own, at = [states[index] for index in indices], cells[indices]
        colour = _colour(at, hue)
        if material.kind == "cloth" and all(map(is_full_cube, own)):
            renewed = [_cube_of(colour, own[0], palette.blocks[class_id], parameters)] * len(own)
        elif material.kind not in (PLAIN, FIXED):
            renewed = _restated(own, material.kind, colour, parameters)
        elif material.kind == FIXED and not _is_far(material, colour, parameters.lightness_weight):
            renewed = own
        elif hue.paint is None and all(map(is_full_cube, own)):
            renewed = _painted(at, hue, class_id, palette, parameters)
        else:
            renewed = own if material.kind == FIXED else _restated(own, PLAIN, colour, parameters)
        for index, state in zip(indices, renewed, strict=True):
            states[index] = state
    return states


def _cube_of(
    colour: np.ndarray, wool: str, choices: Sequence[str], parameters: BuildParameters
) -> str:
    """Return the full block nearest to the colour of a cloth: wool, or what is clearly nearer.

    Cloth comes in sixteen colours, and no cube looks woven.
    """
    own = _restated([wool], "cloth", colour, parameters)
    offered = [*own, *choices]
    handicaps = np.array([0.0] + [OTHER_CLOTH] * len(choices))
    costs = costs_of(colour[None], offered, parameters.lightness_weight, handicaps, FADED)
    return offered[int(costs[0].argmin())]


def _is_far(material: Material, colour: np.ndarray, lightness_weight: float) -> bool:
    """Whether a fixed material looks unlike an object: books in a red cupboard."""
    own = oklab_of_srgb(np.array(colour_of(material.block("full") or ""), np.uint8))
    return float(np.linalg.norm((own - colour) * [lightness_weight**0.5, 1, 1])) > OWN_LOOK


def _colour(cells: np.ndarray, hue: Hue) -> np.ndarray:
    """Return the median colour, float32 [3], of cells; that of the whole object where none is."""
    if hue.paint is not None:
        return hue.paint
    at = tuple(cells.T)
    usable = hue.known[at]
    chosen = hue.colours[at][usable] if usable.any() else hue.colours[hue.known]
    clear = np.hypot(chosen[:, 1], chosen[:, 2]) >= CLEAR_CHROMA
    if clear.mean() >= CLEAR_SHARE:  # Shade and what shines through take a colour's hue away.
        chosen = chosen[clear]
    return np.median(chosen, axis=0).astype(np.float32)


def _painted(
    cells: np.ndarray, hue: Hue, class_id: int, palette: Palette, parameters: BuildParameters
) -> list[str]:
    """Return full blocks of the palette for cells, each as its own colour asks, but calmly."""
    mask = np.zeros(hue.known.shape, bool)
    mask[tuple(cells.T)] = True
    known = hue.known & mask if (hue.known & mask).any() else hue.known
    most = min(PLAIN_PAINTS, parameters.object_colours)
    renewed = np.empty(mask.shape, object)
    within = mask | known
    renewed[within] = painted(within, hue.colours, known, class_id, palette, parameters, most)
    return renewed[tuple(cells.T)].tolist()


def _restated(
    states: list[str], kind: str, colour: np.ndarray, parameters: BuildParameters
) -> list[str]:
    """Return states in the material nearest to a colour; those of no known kind stay."""
    found = {state: shape_of(state, kind) for state in states}
    own = frozenset(shape for shape in found.values() if shape)
    swatch = _nearest(kind, own, colour, parameters) if own else None
    plain = {state: shape_of(state, PLAIN) for state, shape in found.items() if not shape}
    shapes = frozenset(shape for shape in plain.values() if shape)
    other = _nearest(PLAIN, shapes, colour, parameters) if shapes else None
    renewed = []
    for state in states:
        shape, strange = found[state], plain.get(state)
        if shape and swatch:
            renewed.append(restated(state, shape, swatch))
        elif strange and other:
            renewed.append(restated(state, strange, other))
        else:
            renewed.append(state)
    return renewed


def _nearest(
    kind: str, shapes: frozenset[str], colour: np.ndarray, parameters: BuildParameters
) -> Swatch | None:
    """Return the material nearest to a colour that has all the shapes; its own kind rather."""
    own = swatches(kind, shapes)
    others = swatches(PLAIN, shapes) if kind in ("wood", "stone") else ()
    offered = [*own, *(one for one in others if one not in own)]
    if not offered:
        return None
    handicaps = np.array([0.0] * len(own) + [OTHER_KIND] * (len(offered) - len(own)))
    samples = [one.sample for one in offered]
    costs = costs_of(colour[None], samples, parameters.lightness_weight, handicaps, FADED)
    return offered[int(costs[0].argmin())]

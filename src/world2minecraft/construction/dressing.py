"""Shapes get their blocks: which kinds an object may use, and the states of a design."""

import numpy as np

from world2minecraft.construction.fitted_objects import Design
from world2minecraft.construction.materials import WEIGHTS, materials_of
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.surfaces import painted
from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of

PAINTS = {int(SemanticClass.TABLE): 1}  # A table is of one wood; shade and glare are not.
GIVEN_UP = 0.06  # Oklab distance that a colour may lose for the sake of a shape.
MOST_COLOURS = 400  # Of an object, looked at to see which shapes exist in them.


class Dresser:
    """Finds the blocks of shapes in a palette."""

    def __init__(self, palette: Palette, parameters: BuildParameters):
        self.palette, self.parameters = palette, parameters
        self.materials = materials_of(palette)

    def kinds(self, colours: np.ndarray, class_id: int) -> frozenset[str]:
        """Return the kinds of shape that exist in the Oklab colours, [N, 3], of an object."""
        if self.parameters.shapes == "cubes":
            return frozenset(("full",))
        few = colours[:: 1 + len(colours) // MOST_COLOURS]
        full = self.palette.blocks[class_id]
        preferred = self.palette.preferred[class_id] or full
        handicaps = np.array([self.parameters.preference * (one not in preferred) for one in full])
        weight = self.parameters.lightness_weight
        return self.materials.kinds_for(few, full, handicaps, class_id, weight)

    def states(
        self, design: Design, colours: np.ndarray, known: np.ndarray, class_id: int
    ) -> np.ndarray:
        """Return the states, object [N], of a design's N blocks: its shapes in its colours.

        Each kind of shape is painted with what exists in it. Where that would miss the colour, it
        is a full block of the right one.
        """
        most = PAINTS.get(class_id, self.parameters.object_colours)
        choice = (class_id, self.palette, self.parameters, most)
        full = self.palette.blocks[class_id]
        kinds = design.shapes.kinds[design.numbers]
        used = sorted(set(kinds[design.filled].tolist()) - {"full"})
        shaped = design.filled & (kinds != "full")
        plain = np.empty(design.numbers.shape, object)
        own, able = plain.copy(), self.materials.in_all(used, full)
        if able and shaped.any():
            own[shaped] = painted(shaped, colours, known & shaped, *choice, only=able)
        alike = frozenset(own[shaped].tolist()) if able else frozenset()
        plain[design.filled] = painted(design.filled, colours, known, *choice, used=alike)
        if not able:
            own = plain
        result = plain.copy()
        for at in zip(*np.nonzero(shaped), strict=True):
            shape = design.shapes.shapes[int(design.numbers[at]) - 1]
            first, second = str(own[at]), str(plain[at])
            near = self._is_near(first, second, colours[at])
            state = self.materials.dressed(shape, first if near else second)
            result[at] = state or plain[at]
        return result[design.filled]

    def _is_near(self, block: str, other: str, colour: np.ndarray) -> bool:
        """Whether a block shows a colour nearly as well as another does."""
        offered = srgb_to_oklab(colours_of([block, other]))
        light = np.sqrt(self.parameters.lightness_weight)
        apart = np.linalg.norm((offered - colour) * [light, *WEIGHTS[1:]], axis=1)
        return bool(apart[0] - apart[1] <= GIVEN_UP)

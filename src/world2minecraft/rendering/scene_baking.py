"""Baking of block models to the element tables of ``SceneTables``.

Elements are taken from the models of a ``ModelSource``. Elements that extend beyond their block,
such as banner cloth, are handled by ``rendering.off_grid_elements``, which lists them in each cell
that they reach.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from world2minecraft.rendering.atlas import Atlas, build_atlas, to_linear
from world2minecraft.rendering.block_elements import BlockModel, Element, ElementFace, ModelSource
from world2minecraft.rendering.scene_tables import BOXES, EVEN, FULL, SEE_THROUGH, UNSHADED
from world2minecraft.rendering.texture import Texture

AIR = 0  # Result of ``kind_of`` for a model without elements.
_MISSING = Texture(np.full((1, 1, 4), (255, 0, 255, 255), np.uint8))  # Seen at once.
_INSIDE = 1e-4  # Blocks: a turned element may be off by rounding.


@dataclass
class Baker:
    """A collector of elements and their textures. ``table`` returns the arrays."""

    looks: ModelSource
    side_px: int = 16
    names: dict[str, int] = field(default_factory=dict)
    textures: list[Texture] = field(default_factory=list)
    elements: list[tuple[Element, int, int]] = field(default_factory=list)

    def add(self, element: Element, flags: int = 0, owner: int = -1, even: bool = False) -> int:
        """Add an element and return its number.

        Args:
            element: The element in cell coordinates, or in grid coordinates if the flags contain
                ``ABSOLUTE``.
            flags: ``ABSOLUTE`` and ``JOINS``; other flags are computed.
            owner: Owner of the element, see ``SceneTables.traits``.
            even: Whether to disable ambient occlusion at its corners.
        """
        for face in element.faces:
            if face is not None:
                self._layer(face)
        see_through = any(
            face is None or self.textures[self._layer(face)].has_holes for face in element.faces
        )
        flags |= SEE_THROUGH * see_through | UNSHADED * (not element.shade) | EVEN * even
        self.elements.append((element, flags, owner))
        return len(self.elements) - 1

    def _layer(self, face: ElementFace) -> int:
        layer = self.names.get(face.texture)
        if layer is None:
            layer = self.names[face.texture] = len(self.textures)
            self.textures.append(self.looks.texture(face.texture) or _MISSING)
        return layer

    def table(self) -> "ElementTable":
        """Return the arrays of all elements added so far."""
        count = len(self.elements)
        table = ElementTable(
            boxes=np.zeros((count, 6), np.float32),
            traits=np.full((count, 3), -1, np.int32),
            turns=np.empty((0, 3, 4)),
            normals=np.empty((0, 3, 3)),
            layers=np.full((count, 6), -1, np.int32),
            uv=np.zeros((count, 6, 2, 4), np.float32),
            tints=np.ones((count, 6, 3), np.float32),
            emission=np.zeros(count, np.float32),
            atlas=build_atlas(self.textures or [_MISSING], self.side_px),
        )
        turns = []
        for row, (element, flags, owner) in enumerate(self.elements):
            table.boxes[row] = (*element.low, *element.high)
            table.traits[row, 1:] = flags, owner
            table.emission[row] = element.emission / 15
            if element.turn is not None:
                table.traits[row, 0] = len(turns)
                turns.append(np.linalg.inv(element.turn)[:3])
            for side, face in enumerate(element.faces):
                if face is not None:
                    table.layers[row, side] = self._layer(face)
                    table.uv[row, side] = face.uv
                    if face.tint is not None:
                        table.tints[row, side] = _linear_tint(face.tint)
        rows = np.array(turns).reshape(-1, 3, 4)
        lengths = np.linalg.norm(rows[:, :, :3], axis=2, keepdims=True)
        return table._with_turns(rows, rows[:, :, :3] / np.maximum(lengths, 1e-12))


@dataclass(frozen=True, eq=False)
class ElementTable:
    """The tables of E elements and T rotations, with the names and dtypes of ``SceneTables``."""

    boxes: np.ndarray
    traits: np.ndarray
    turns: np.ndarray
    normals: np.ndarray
    layers: np.ndarray
    uv: np.ndarray
    tints: np.ndarray
    emission: np.ndarray
    atlas: Atlas

    def _with_turns(self, turns: np.ndarray, normals: np.ndarray) -> "ElementTable":
        return ElementTable(
            self.boxes, self.traits, np.ascontiguousarray(turns), np.ascontiguousarray(normals),
            self.layers, self.uv, self.tints, self.emission, self.atlas,
        )  # fmt: skip


@lru_cache(maxsize=1024)
def _linear_tint(tint: tuple[int, int, int]) -> np.ndarray:
    return to_linear(np.array(tint))


def kind_of(model: BlockModel, looks: ModelSource) -> int:
    """Return ``FULL`` for a single opaque cube, ``BOXES`` for other elements, ``AIR`` for none."""
    if len(model.elements) == 0:
        return AIR
    (first, *more) = model.elements
    if more or not is_unit_cube(first):
        return BOXES
    for face in first.faces:
        texture = None if face is None else looks.texture(face.texture)
        if face is None or (texture is not None and texture.has_holes):
            return BOXES
    return FULL


def is_unit_cube(element: Element) -> bool:
    """Return whether an element fills its block and is not rotated."""
    return element.turn is None and element.low == (0, 0, 0) and element.high == (1, 1, 1)


def joins_neighbours(state: str, model: BlockModel) -> bool:
    """Return whether adjacent blocks of this state have no visible face between them.

    This holds for glass and water, so that a pool has no inner walls, but not for leaves.
    """
    if state.partition("[")[0] == "minecraft:water":
        return True
    return (
        len(model.elements) == 1
        and is_unit_cube(model.elements[0])
        and "leaves" not in state.partition("[")[0]
    )


def reaches_out(element: Element) -> bool:
    """Return whether an element extends beyond its block."""
    if element.turn is None:
        ends = (*element.low, *element.high)
        return min(ends) < -_INSIDE or max(ends) > 1 + _INSIDE
    corners = element_corners(element)
    return bool((corners < -_INSIDE).any() or (corners > 1 + _INSIDE).any())


def element_corners(element: Element) -> np.ndarray:
    """Return the eight corners of an element in block coordinates, float64 [8, 3]."""
    ends = np.array([element.low, element.high], np.float64)
    corners = np.stack(np.meshgrid(*ends.T, indexing="ij"), axis=-1).reshape(-1, 3)
    if element.turn is None:
        return corners
    return corners @ element.turn[:3, :3].T + element.turn[:3, 3]


def is_pane(state: str) -> bool:
    """Return whether a state is glass, whose surface counts even if its texture is transparent."""
    return "glass" in state.partition("[")[0].partition(":")[2]


def models_of(palette: Sequence[str], looks: ModelSource) -> list[BlockModel]:
    """Return the model of each state, which is empty for states unknown to the source."""
    return [looks.model(state) or BlockModel() for state in palette]

"""Elements outside the block grid: display entities, and parts of blocks that leave their cell.

These elements use grid coordinates and are listed in every cell that they reach. Each such cell has
its own row of elements: the elements of its block, then the freestanding ones. The grid is enlarged
to contain all elements.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.rendering.block_elements import BlockModel, Element, ModelSource
from world2minecraft.rendering.scene_baking import Baker, element_corners, is_pane, reaches_out
from world2minecraft.rendering.scene_tables import ABSOLUTE, PANE, owner_of_cell

MAX_DISPLAY_ENTITIES = 200_000  # A house in display style has some thousands.
MAX_CELLS = 4_000_000  # That one element is listed in.
MAX_MARGIN = 64  # Cells by which the grid grows on a side.
_FLAT = 1e-9  # Blocks: a box thinner than this has no inside that a ray could enter.
_TOUCH = 1e-6

CellElements = dict[tuple[int, ...], list[int]]  # cell of the grid to numbers of elements


@dataclass(frozen=True, eq=False)
class EntityLabels:
    """The classes and the object ids of N display entities."""

    semantic: np.ndarray  # uint8 [N]
    instance: np.ndarray  # uint16 [N]

    def __len__(self) -> int:
        return len(self.semantic)


@dataclass(frozen=True, eq=False)
class PlacedElement:
    """An element in grid coordinates with its owner (see ``SceneTables.traits``)."""

    element: Element
    owner: int
    flags: int = 0  # of ``SceneTables.traits``, beside those that the baker finds

    @property
    def matrix(self) -> np.ndarray:
        """Transform from the element's frame to the grid, float64 [4, 4]."""
        return np.eye(4) if self.element.turn is None else self.element.turn

    def moved(self, shift: np.ndarray) -> "PlacedElement":
        """Return the element translated by a vector, float64 [3]."""
        matrix = self.matrix.copy()
        matrix[:3, 3] += shift
        return replace(self, element=replace(self.element, turn=matrix))


def display_entity_elements(
    volume: BlockVolume, looks: ModelSource
) -> tuple[EntityLabels, list[PlacedElement]]:
    """Return the display entities of a volume, and their elements in grid coordinates."""
    to_grid = np.eye(4)
    to_grid[:3, 3] = -np.asarray(volume.corner, np.float64)
    guests, semantic, instance = [], [], []
    for cube in display_cubes(volume.entities)[:MAX_DISPLAY_ENTITIES]:
        model = looks.model(cube.state)
        for element in model.elements if model else ():
            matrix = to_grid @ cube.cube_to_world
            if element.turn is not None:
                matrix = matrix @ element.turn
            flags = PANE * is_pane(cube.state)
            guests.append(PlacedElement(replace(element, turn=matrix), len(semantic), flags))
        semantic.append(cube.class_id)
        instance.append(cube.instance)
    labels = EntityLabels(np.array(semantic, np.uint8), np.array(instance, np.uint16))
    return labels, [guest for guest in guests if _has_volume(guest)]


def split_overhanging(
    models: Sequence[BlockModel], states: np.ndarray
) -> tuple[list[BlockModel], list[PlacedElement]]:
    """Remove elements that extend beyond their block from the models, and place them in the grid.

    Args:
        models: Model of each palette entry.
        states: Indices of ``models``, uint16 [X, Y, Z].
    """
    inner, guests = [], []
    for row, model in enumerate(models):
        outer = [element for element in model.elements if reaches_out(element)]
        kept = tuple(element for element in model.elements if not reaches_out(element))
        inner.append(replace(model, elements=kept) if outer else model)
        for cell in np.argwhere(states == row) if outer else ():
            owner = owner_of_cell(int(np.ravel_multi_index(tuple(cell), states.shape)))
            guests += [PlacedElement(element, owner).moved(cell) for element in outer]
    return inner, guests


def _has_volume(guest: PlacedElement) -> bool:
    matrix = guest.matrix[:3, :3]
    longest = np.linalg.norm(matrix, axis=0).max()
    return bool(abs(np.linalg.det(matrix)) > _FLAT**2 and longest < 1e6)


def grid_margin(guests: Sequence[PlacedElement], shape: tuple[int, ...]) -> np.ndarray:
    """Return the number of cells to add before and after the grid along each axis, int [2, 3]."""
    margin = np.zeros((2, 3), np.int64)
    for guest in guests:
        corners = element_corners(guest.element)
        margin[0] = np.maximum(margin[0], np.ceil(-corners.min(axis=0) - _TOUCH))
        margin[1] = np.maximum(margin[1], np.ceil(corners.max(axis=0) - shape - _TOUCH))
    return np.clip(margin, 0, MAX_MARGIN)


def cells_reached(element: Element, shape: tuple[int, ...]) -> np.ndarray:
    """Return the cells that a box in grid coordinates may reach, int64 [N, 3]."""
    corners = element_corners(element)
    low = np.floor(corners.min(axis=0) + _TOUCH)
    high = np.maximum(np.floor(corners.max(axis=0) - _TOUCH), low) + 1  # A plate may have no depth.
    low = np.clip(low, 0, shape).astype(np.int64)
    high = np.clip(high, 0, shape).astype(np.int64)
    if (high <= low).any() or np.prod((high - low).astype(float)) > MAX_CELLS:
        return np.empty((0, 3), np.int64)
    spans = [np.arange(first, last) for first, last in zip(low, high, strict=True)]
    cells = np.stack(np.meshgrid(*spans, indexing="ij"), axis=-1).reshape(-1, 3)
    if len(cells) < 9 or element.turn is None:
        return cells
    to_box = np.linalg.inv(element.turn)
    middle = (cells + 0.5) @ to_box[:3, :3].T + to_box[:3, 3]
    slack = np.abs(to_box[:3, :3]).sum(axis=1) / 2 + _TOUCH
    inside = (middle >= np.array(element.low) - slack) & (middle <= np.array(element.high) + slack)
    return cells[inside.all(axis=1)]


def elements_by_cell(
    guests: Sequence[PlacedElement], shape: tuple[int, ...], baker: Baker
) -> CellElements:
    """Bake placed elements, and return their numbers for each cell that they reach."""
    lists: CellElements = {}
    for guest in guests:
        cells = cells_reached(guest.element, shape)
        number = baker.add(guest.element, ABSOLUTE | guest.flags, guest.owner) if len(cells) else -1
        for cell in map(tuple, cells.tolist()):
            lists.setdefault(cell, []).append(number)
    return lists


def add_cell_rows(
    lists: CellElements, looks: np.ndarray, start: np.ndarray, refs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Give cells that placed elements reach their own rows.

    Args:
        lists: Placed elements of each cell.
        looks: Row of each cell, int32 [X, Y, Z], modified in place.
        start: Start of each row, int32 [R + 1]; see ``SceneTables``.
        refs: Elements of all rows, int32 [N].

    Returns:
        ``start`` and ``refs`` with the new rows.
    """
    rows: dict[tuple[int, tuple[int, ...]], int] = {}
    parts, ends = [refs], []
    end = len(refs)
    for cell, elements in lists.items():
        key = (int(looks[cell]), tuple(elements))
        if key not in rows:
            own = refs[start[key[0]] : start[key[0] + 1]]
            rows[key] = len(start) - 1 + len(rows)
            parts += [own, np.array(elements, np.int32)]
            end += len(own) + len(elements)
            ends.append(end)
        looks[cell] = rows[key]
    return (
        np.concatenate([start, np.array(ends, np.int32)]).astype(np.int32),
        np.concatenate(parts).astype(np.int32),
    )

"""A scene whose blocks can be edited in place, for building agents and editors.

An edit only updates the cell, and the empty boxes and the light around it, not the whole scene.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.rendering.block_elements import ModelSource
from world2minecraft.rendering.block_models import BuiltinModels
from world2minecraft.rendering.empty_space_boxes import update_empty_boxes
from world2minecraft.rendering.light import edit_light
from world2minecraft.rendering.off_grid_elements import (
    CellElements,
    elements_by_cell,
    split_overhanging,
)
from world2minecraft.rendering.scene import BlockScene, bake_model, bake_scene, with_elements
from world2minecraft.rendering.scene_baking import AIR, Baker, kind_of
from world2minecraft.rendering.scene_tables import BOXES, owner_of_cell

_OWNER = 2  # Of what the baker keeps of an element.


class EditableScene:
    """An editable scene of a volume. ``scene`` is always the current scene."""

    def __init__(
        self,
        volume: BlockVolume,
        looks: ModelSource | None = None,
        *,
        texture_px: int = 16,
        reach: float | None = None,
        hidden_lamps: bool | None = None,
    ):
        """Create the scene of a volume. The volume itself is never modified.

        The arguments are those of ``prepare_scene``.
        """
        self._baker = Baker(looks or BuiltinModels(texture_px), texture_px)
        scene, self._guests = bake_scene(volume, self._baker, reach, hidden_lamps)
        self.scene = _with_own_labels(scene)
        self._palette = list(volume.palette)
        self._states = volume.states.copy()
        start, refs = self.scene.tables.look_start, self.scene.tables.refs.tolist()
        self._looks = [tuple(refs[a:b]) for a, b in pairwise(start)]
        self._own = [*self._looks[: len(self._palette)]]
        self._kinds = [self._kind(state) for state in self._palette]
        self._rows = {elements: row for row, elements in reversed(list(enumerate(self._looks)))}

    @property
    def volume_states(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """The current blocks, read-only uint16 [X, Y, Z], and the palette."""
        return self._states, tuple(self._palette)

    def set_blocks(
        self,
        cells: np.ndarray,
        states: Sequence[str],
        *,
        semantic: int = 0,
        instance: int = 0,
    ) -> None:
        """Set blocks.

        Args:
            cells: Cells of the volume, int [N, 3].
            states: N block states. Air removes a block.
            semantic: Class of all these blocks.
            instance: Object id of all these blocks.

        Raises:
            UsageError: If a cell is outside the volume, if a text is not a valid block state, or if
                the numbers of cells and states differ.
        """
        cells = np.asarray(cells, np.int64).reshape(-1, 3)
        if len(cells) != len(states):
            raise UsageError(f"{len(cells)} cells need {len(cells)} states, got {len(states)}")
        shape = np.array(self._states.shape)
        for cell in cells[((cells < 0) | (cells >= shape)).any(axis=1)]:
            raise UsageError(
                f"cell {tuple(cell.tolist())} is outside the volume of {self._states.shape} cells"
            )
        rows = [self._row_of_state(state) for state in states]
        if not rows:
            return
        self._states[tuple(cells.T)] = rows
        flat = np.asarray(np.ravel_multi_index(tuple(cells.T), self._states.shape))
        self.scene.tables.semantic[flat] = semantic
        self.scene.tables.instance[flat] = instance
        touched = self._move_guests(cells, flat, states)
        self._apply(touched)
        self._light(cells)

    def _row_of_state(self, state: str) -> int:
        """Return the palette's row of a state; bake a new one."""
        if state in self._palette:
            return self._palette.index(state)
        model = self._baker.looks.model(state)
        inner = [] if model is None else split_overhanging([model], self._states[:0])[0]
        numbers = [n for one in inner for n in bake_model(state, one, self._baker)]
        self._own.append(tuple(numbers))
        self._kinds.append(self._kind(state))
        self._palette.append(state)
        return len(self._palette) - 1

    def _kind(self, state: str) -> int:
        model = self._baker.looks.model(state)
        return AIR if model is None else kind_of(model, self._baker.looks)

    def _move_guests(
        self, cells: np.ndarray, flat: np.ndarray, states: Sequence[str]
    ) -> list[tuple[int, ...]]:
        """Take away what reached out of the cells and list what does now; return all touched."""
        first = self.scene.tables.window[0]
        touched = {tuple(cell) for cell in (cells + first).tolist()}
        gone = {owner_of_cell(int(index)) for index in flat}
        for cell, numbers in list(self._guests.items()):
            kept = [n for n in numbers if self._baker.elements[n][_OWNER] not in gone]
            if len(kept) < len(numbers):
                touched.add(cell)
                self._guests[cell] = kept
        for cell, index, state in zip(cells, flat, states, strict=True):
            for at, numbers in self._overhang(state, cell, int(index)).items():
                touched.add(at)
                self._guests[at] = self._guests.get(at, []) + numbers
        return sorted(touched)

    def _overhang(self, state: str, cell: np.ndarray, index: int) -> CellElements:
        model = self._baker.looks.model(state)
        if model is None:
            return {}
        alone = np.zeros((1, 1, 1), np.uint16)
        guests = split_overhanging([model], alone)[1]
        at = cell + self.scene.tables.window[0]
        placed = [replace(guest.moved(at), owner=owner_of_cell(index)) for guest in guests]
        return elements_by_cell(placed, self.scene.tables.space.shape, self._baker)

    def _apply(self, touched: Sequence[tuple[int, ...]]) -> None:
        """Give touched cells their looks and kinds."""
        first, shape = self.scene.tables.window
        kinds, looks = [], []
        for cell in touched:
            inner = np.array(cell) - first
            inside = ((inner >= 0) & (inner < shape)).all()
            row = int(self._states[tuple(inner)]) if inside else 0
            guests = self._guests.get(cell, [])
            elements = (*self._own[row], *guests)
            kind = self._kinds[row]
            kinds.append(BOXES if guests and kind == AIR else kind)
            if elements not in self._rows:
                self._rows[elements] = len(self._looks)
                self._looks.append(elements)
            looks.append(self._rows[elements])
        self.scene = with_elements(self.scene, self._baker, self._looks)
        tables = self.scene.tables
        where = np.array(touched, np.int64)
        tables.looks[tuple(where.T)] = looks
        bounds = update_empty_boxes(tables.space, tables.bounds, where, np.array(kinds, np.int8))
        self.scene = replace(self.scene, tables=tables._replace(bounds=bounds))

    def _light(self, cells: np.ndarray) -> None:
        """Bring the light around set cells up to date."""
        low, high = cells.min(axis=0), cells.max(axis=0) + 1
        box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
        corner = tuple((low + self.scene.tables.window[0]).tolist())
        edit_light(self.scene.light, corner, self._states[box], tuple(self._palette))
        self.scene.exposures.clear()


def _with_own_labels(scene: BlockScene) -> BlockScene:
    """Return the scene with classes and objects that may be written to."""
    semantic, instance = scene.semantic.copy(), scene.instance.copy()
    tables = scene.tables._replace(semantic=semantic.reshape(-1), instance=instance.reshape(-1))
    return replace(scene, tables=tables, semantic=semantic, instance=instance)

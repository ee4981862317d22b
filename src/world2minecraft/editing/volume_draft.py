"""A draft of a volume that records its edits, and a history with undo and redo."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from world2minecraft.core.errors import ConflictError, LimitError, UsageError
from world2minecraft.core.types import AIR, BlockEdit, BlockEntity, Blocks, BlockVolume, Entity
from world2minecraft.editing.journal import Journal
from world2minecraft.minecraft.nbt import write_nbt

MAX_STATES = 1 << 16
Position = tuple[int, int, int]


class Draft:
    """The blocks of a volume, changed only by edits. Arrays are [X, Y, Z] in block axes."""

    def __init__(self, volume: BlockVolume):
        self.start = volume
        self.corner = np.array(volume.corner, np.int64)
        self.states = volume.states.copy()
        self.semantic = volume.semantic.copy()
        self.instance = volume.instance.copy()
        self.edits: list[BlockEdit] = []
        self._ids = {state: number for number, state in reversed([*enumerate(volume.palette)])}
        self._palette = list(volume.palette)
        self._data = {entity.block_pos: entity for entity in volume.block_entities}
        self._entities = {entity_key(entity): entity for entity in volume.entities}

    @property
    def palette(self) -> tuple[str, ...]:
        """The block states that ``states`` indexes. Edits append states."""
        return tuple(self._palette)

    @property
    def entities(self) -> tuple[Entity, ...]:
        """The current entities, which are independent of the block grid."""
        return tuple(self._entities.values())

    def id_of(self, state: str) -> int:
        """Return the palette index of a block state, appending the state if necessary.

        Raises:
            LimitError: If the palette is full.
        """
        if state not in self._ids:
            if len(self._palette) >= MAX_STATES:
                raise LimitError("palette", f"exceeds the limit of {MAX_STATES:,} block states")
            self._ids[state] = len(self._palette)
            self._palette.append(state)
        return self._ids[state]

    def contents(self, cells: np.ndarray, entities: Sequence[Entity] = ()) -> Blocks:
        """Return the current contents of cells.

        Args:
            cells: Array indices, int [N, 3].
            entities: Entities that belong to the cells.
        """
        at = tuple(cells.T)
        places = map(_position, cells + self.corner) if self._data else ()
        data = tuple(self._data[place] for place in places if place in self._data)
        found = self.states[at], self.semantic[at], self.instance[at]
        return Blocks(*found, data, tuple(entities))

    def change(self, kind: str, cells: np.ndarray, after: Blocks, **details: Any) -> BlockEdit:
        """Set cells and record the edit.

        Args:
            kind: Verb of the edit, such as ``drop``.
            cells: Array indices, int [N, 3].
            after: New contents of the cells. Their states index ``palette``.
            details: ``reason``, ``class_id`` and ``instance`` of the edit, and ``entities`` that
                are removed with the previous contents.
        """
        before = self.contents(cells, details.pop("entities", ()))
        used = np.unique(np.concatenate([before.states, after.states]))
        numbers = np.zeros(len(self._palette), np.uint16)
        numbers[used] = np.arange(len(used))
        edit = BlockEdit(
            kind,
            (cells + self.corner).astype(np.int32),
            tuple(self._palette[number] for number in used.tolist()),
            replace(before, states=numbers[before.states]),
            replace(after, states=numbers[after.states]),
            **details,
        )
        self._set(cells, edit)
        self.edits.append(edit)
        return edit

    def fill(self, kind: str, cells: np.ndarray, state: str, **details: Any) -> BlockEdit:
        """Set all cells to one block state and record the edit.

        Args:
            kind: Verb of the edit, such as ``fill``.
            cells: Array indices, int [N, 3].
            state: New block state.
            details: The details of ``change``, and the new class id ``as_class`` and object id
                ``as_instance``, which default to 0.
        """
        numbers = np.full(len(cells), self.id_of(state), np.uint16)
        semantic = np.full(len(cells), details.pop("as_class", 0), np.uint8)
        instance = np.full(len(cells), details.pop("as_instance", 0), np.uint16)
        return self.change(kind, cells, Blocks(numbers, semantic, instance), **details)

    def apply(self, edit: BlockEdit) -> None:
        """Apply an edit.

        Raises:
            ConflictError: If the cells differ from the edit's previous contents. Nothing is
                changed.
        """
        if reason := self._find_conflict(edit):
            raise ConflictError(f"edit {edit.kind}", reason)
        self._set(edit.cells - self.corner, edit)
        self.edits.append(edit)

    def holds(self, edit: BlockEdit) -> bool:
        """Return whether the cells match the previous contents recorded in an edit."""
        return not self._find_conflict(edit)

    def volume(self) -> BlockVolume:
        """Return the current blocks as a volume with a sorted palette and no unused states."""
        names = sorted({self._palette[number] for number in np.unique(self.states)} - {AIR})
        order = {AIR: 0} | {name: number for number, name in enumerate(names, 1)}
        numbers = np.array([order.get(state, 0) for state in self._palette], np.uint16)
        return replace(
            self.start,
            states=numbers[self.states],
            palette=(AIR, *names),
            semantic=self.semantic,
            instance=self.instance,
            block_entities=tuple(self._data[place] for place in sorted(self._data)),
            entities=self.entities,
        )

    def _find_conflict(self, edit: BlockEdit) -> str:
        """Return why an edit cannot be applied, or an empty string."""
        cells = edit.cells - self.corner
        inside = ((cells >= 0) & (cells < self.states.shape)).all(axis=1)
        if not inside.all():
            return f"block {_position(edit.cells[~inside][0])} is outside the volume"
        now, names = self.contents(cells), np.array(edit.palette, object)
        wrong = np.array(self._palette, object)[now.states] != names[edit.before.states]
        wrong |= now.semantic != edit.before.semantic
        wrong |= now.instance != edit.before.instance
        if wrong.any():
            at = int(np.argmax(wrong))
            place, was = _position(edit.cells[at]), names[edit.before.states[at]]
            held = self._palette[now.states[at]]
            return f"block {place} is now {held}, expected {was}"
        gone = {entity_key(entity) for entity in edit.before.entities} - self._entities.keys()
        if gone or block_entity_keys(now.block_entities) != block_entity_keys(
            edit.before.block_entities
        ):
            return "a sign, a chest or an entity has changed since the edit"
        return ""

    def _set(self, cells: np.ndarray, edit: BlockEdit) -> None:
        at = tuple(cells.T)
        numbers = np.array([self.id_of(state) for state in edit.palette], np.uint16)
        self.states[at] = numbers[edit.after.states]
        self.semantic[at], self.instance[at] = edit.after.semantic, edit.after.instance
        for place in map(_position, edit.cells) if self._data else ():
            self._data.pop(place, None)
        for data in edit.after.block_entities:
            self._data[data.block_pos] = data
        for entity in edit.before.entities:
            self._entities.pop(entity_key(entity), None)
        for entity in edit.after.entities:
            self._entities[entity_key(entity)] = entity


def apply_edits(volume: BlockVolume, *edits: BlockEdit) -> BlockVolume:
    """Return a volume with edits applied in order.

    Raises:
        ConflictError: If a cell differs from the previous contents recorded in an edit.
    """
    draft = Draft(volume)
    for edit in edits:
        draft.apply(edit)
    return draft.volume()


def entity_key(entity: Entity) -> bytes:
    """Return bytes that are equal for entities with the same position, type and data."""
    held = {"id": entity.id, "Pos": [float(v) for v in entity.position], "nbt": entity.nbt}
    return write_nbt(held)


def block_entity_keys(entities: Sequence[BlockEntity]) -> set[bytes]:
    """Return one key per block entity, equal for the same position, type and data."""
    return {
        write_nbt({"id": e.id, "pos": list(map(int, e.block_pos)), "nbt": e.nbt}) for e in entities
    }


def _position(cell: Any) -> Position:
    x, y, z = (int(value) for value in cell)
    return x, y, z


class History:
    """The undo and redo history of a volume. Each step is recorded in the journal first."""

    def __init__(self, volume: BlockVolume, journal: Journal):
        """Open the history of a volume.

        Args:
            volume: Blocks as stored on disk. The last steps of the journal may be missing if the
                program was killed before writing the blocks.
            journal: Journal of the edits so far.

        Raises:
            ConflictError: If the journal belongs to another volume.
        """
        self.journal = journal
        self.volume = _replay_missing(volume, journal)
        self._undone: list[int] = []

    def do(self, edit: BlockEdit) -> None:
        """Apply an edit and record it.

        Raises:
            ConflictError: If the edit does not match the volume. Nothing is changed then.
            OutputError: If the journal cannot be written. Nothing is changed then.
        """
        volume = apply_edits(self.volume, edit)
        self.journal.do(edit)
        self.volume = volume
        self._undone.clear()

    def undo(self, number: int | None = None) -> int:
        """Undo an applied edit and return its number.

        Args:
            number: Number of the edit. None selects the last applied edit.

        Raises:
            UsageError: If the edit does not exist or is not applied.
            ConflictError: If a later edit changed the same blocks.
        """
        done = [place for place, is_done in enumerate(self.journal.is_done) if is_done]
        if not done:
            raise UsageError("there is nothing to undo")
        chosen = done[-1] if number is None else number
        if chosen not in done:
            known = ", ".join(str(place + 1) for place in done)
            raise UsageError(f"edit {chosen + 1} is not applied; applied edits: {known}")
        volume = apply_edits(self.volume, self.journal.edits[chosen].inverse())
        self.journal.undo(chosen)
        self.volume = volume
        self._undone.append(chosen)
        return chosen

    def redo(self, number: int | None = None) -> int:
        """Redo an edit that was undone and return its number.

        Args:
            number: Number of the edit. None selects the last edit undone in this history.

        Raises:
            UsageError: If the edit has not been undone, or if there is nothing to redo.
            ConflictError: If a later edit changed the same blocks.
        """
        if number is None and not self._undone:
            raise UsageError("there is nothing to redo")
        chosen = self._undone[-1] if number is None else number
        if not 0 <= chosen < len(self.journal.edits) or self.journal.is_done[chosen]:
            raise UsageError(f"edit {chosen + 1} has not been undone")
        volume = apply_edits(self.volume, self.journal.edits[chosen])
        self.journal.redo(chosen)
        self.volume = volume
        if chosen in self._undone:
            self._undone.remove(chosen)
        return chosen


def _replay_missing(volume: BlockVolume, journal: Journal) -> BlockVolume:
    """Return the volume with all steps of the journal, because blocks are written after records."""
    edits = [
        journal.edits[number] if is_done else journal.edits[number].inverse()
        for is_done, number in journal.steps
    ]
    draft = Draft(volume)
    missing = len(edits)
    for place in reversed(range(len(edits))):
        if draft.holds(edits[place].inverse()):
            break
        missing = place
    if missing == len(edits):
        return volume
    for edit in edits[missing:]:
        draft.apply(edit)
    return draft.volume()

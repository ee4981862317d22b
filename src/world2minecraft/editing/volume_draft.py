"""A volume while it is edited: a draft that records its edits, and its history of undo and redo."""

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
    """The blocks of a volume, writable only through edits. Arrays are [X, Y, Z], block axes."""

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
        """The block states that ``states`` indexes; edits add to its end."""
        return tuple(self._palette)

    @property
    def entities(self) -> tuple[Entity, ...]:
        """What stands free of the grid now."""
        return tuple(self._entities.values())

    def id_of(self, state: str) -> int:
        """Return the number of a block state.

        Raises:
            LimitError: the palette is full.
        """
        if state not in self._ids:
            if len(self._palette) >= MAX_STATES:
                raise LimitError("palette", f"has more than {MAX_STATES:,} block states")
            self._ids[state] = len(self._palette)
            self._palette.append(state)
        return self._ids[state]

    def contents(self, cells: np.ndarray, entities: Sequence[Entity] = ()) -> Blocks:
        """Return what some cells hold now.

        Args:
            cells: int [N, 3], indices into the arrays.
            entities: those that belong to the cells.
        """
        at = tuple(cells.T)
        places = map(_position, cells + self.corner) if self._data else ()
        data = tuple(self._data[place] for place in places if place in self._data)
        found = self.states[at], self.semantic[at], self.instance[at]
        return Blocks(*found, data, tuple(entities))

    def change(self, kind: str, cells: np.ndarray, after: Blocks, **details: Any) -> BlockEdit:
        """Set cells and record the edit.

        Args:
            kind: a verb.
            cells: int [N, 3], indices into the arrays.
            after: what they become; states index ``palette``.
            details: ``reason``, ``class_id``, ``instance`` of the edit, and ``entities`` that go
                with what was there before.
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
            kind: a verb.
            cells: int [N, 3], indices into the arrays.
            state: what they become.
            details: as in ``change``, and ``as_class`` and ``as_instance``, what they count as: 0
                where left out.
        """
        numbers = np.full(len(cells), self.id_of(state), np.uint16)
        semantic = np.full(len(cells), details.pop("as_class", 0), np.uint8)
        instance = np.full(len(cells), details.pop("as_instance", 0), np.uint16)
        return self.change(kind, cells, Blocks(numbers, semantic, instance), **details)

    def apply(self, edit: BlockEdit) -> None:
        """Do an edit.

        Raises:
            ConflictError: the cells do not hold what it says they held; nothing is changed.
        """
        if reason := self._find_conflict(edit):
            raise ConflictError(f"edit {edit.kind}", reason)
        self._set(edit.cells - self.corner, edit)
        self.edits.append(edit)

    def holds(self, edit: BlockEdit) -> bool:
        """Whether the cells hold what an edit says they held before it."""
        return not self._find_conflict(edit)

    def volume(self) -> BlockVolume:
        """Return the blocks as they are now; the palette sorted, without unused states."""
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
        """Why an edit cannot be done here; empty where it can."""
        cells = edit.cells - self.corner
        inside = ((cells >= 0) & (cells < self.states.shape)).all(axis=1)
        if not inside.all():
            return f"block {_position(edit.cells[~inside][0])} lies outside the volume"
        now, names = self.contents(cells), np.array(edit.palette, object)
        wrong = np.array(self._palette, object)[now.states] != names[edit.before.states]
        wrong |= now.semantic != edit.before.semantic
        wrong |= now.instance != edit.before.instance
        if wrong.any():
            at = int(np.argmax(wrong))
            place, was = _position(edit.cells[at]), names[edit.before.states[at]]
            held = self._palette[now.states[at]]
            return f"block {place} holds {held} now, not {was} as before the edit"
        gone = {entity_key(entity) for entity in edit.before.entities} - self._entities.keys()
        if gone or block_entity_keys(now.block_entities) != block_entity_keys(
            edit.before.block_entities
        ):
            return "a sign, a chest or an entity changed since"
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
    """Return a volume with edits done, one after the other.

    Raises:
        ConflictError: a cell does not hold what an edit says it held.
    """
    draft = Draft(volume)
    for edit in edits:
        draft.apply(edit)
    return draft.volume()


def entity_key(entity: Entity) -> bytes:
    """Return bytes that are the same for two entities of the same place, kind and data."""
    held = {"id": entity.id, "Pos": [float(v) for v in entity.position], "nbt": entity.nbt}
    return write_nbt(held)


def block_entity_keys(entities: Sequence[BlockEntity]) -> set[bytes]:
    """Return bytes for each block entity, the same for the same place, kind and data."""
    return {
        write_nbt({"id": e.id, "pos": list(map(int, e.block_pos)), "nbt": e.nbt}) for e in entities
    }


def _position(cell: Any) -> Position:
    x, y, z = (int(value) for value in cell)
    return x, y, z


class History:
    """The one that edits a volume. Each step is in the journal before it is seen here."""

    def __init__(self, volume: BlockVolume, journal: Journal):
        """Take a volume with the edits of its journal.

        Args:
            volume: the blocks as they lie on disk: with all steps of the journal, or without
                the last ones, where the program was ended before it wrote the blocks.
            journal: the edits so far.

        Raises:
            ConflictError: the volume is another one than the journal speaks of.
        """
        self.journal = journal
        self.volume = _replay_missing(volume, journal)
        self._undone: list[int] = []

    def do(self, edit: BlockEdit) -> None:
        """Do an edit. Raises ConflictError or OutputError; then nothing has changed."""
        volume = apply_edits(self.volume, edit)
        self.journal.do(edit)
        self.volume = volume
        self._undone.clear()

    def undo(self, number: int | None = None) -> int:
        """Take back the edit of a number, or the last one that is done; return its number.

        Raises:
            UsageError: there is no such edit, or it is not done.
            ConflictError: a later edit changed the same blocks; take that back first.
        """
        done = [place for place, is_done in enumerate(self.journal.is_done) if is_done]
        if not done:
            raise UsageError("there is nothing to undo")
        chosen = done[-1] if number is None else number
        if chosen not in done:
            known = ", ".join(str(place + 1) for place in done)
            raise UsageError(f"edit {chosen + 1} is not done; those that are: {known}")
        volume = apply_edits(self.volume, self.journal.edits[chosen].inverse())
        self.journal.undo(chosen)
        self.volume = volume
        self._undone.append(chosen)
        return chosen

    def redo(self, number: int | None = None) -> int:
        """Do again the edit of a number, or what was last undone here; return its number.

        Raises:
            UsageError: nothing was undone since the last edit, or not that one.
            ConflictError: a later edit changed the same blocks.
        """
        if number is None and not self._undone:
            raise UsageError("there is nothing to redo")
        chosen = self._undone[-1] if number is None else number
        if chosen >= len(self.journal.edits) or self.journal.is_done[chosen]:
            raise UsageError(f"edit {chosen + 1} was not taken back")
        volume = apply_edits(self.volume, self.journal.edits[chosen])
        self.journal.redo(chosen)
        self.volume = volume
        if chosen in self._undone:
            self._undone.remove(chosen)
        return chosen


def _replay_missing(volume: BlockVolume, journal: Journal) -> BlockVolume:
    """Return the volume with all steps of the journal: blocks are written after their records."""
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

"""A volume and the edits made to it: do, undo, redo, any of them by its number."""

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockEdit, BlockVolume
from world2minecraft.editing.draft import Draft, applied
from world2minecraft.editing.journal import Journal


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
        self.volume = _caught_up(volume, journal)
        self._undone: list[int] = []

    def do(self, edit: BlockEdit) -> None:
        """Do an edit. Raises ConflictError or OutputError; then nothing has changed."""
        volume = applied(self.volume, edit)
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
        volume = applied(self.volume, self.journal.edits[chosen].inverse())
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
        volume = applied(self.volume, self.journal.edits[chosen])
        self.journal.redo(chosen)
        self.volume = volume
        if chosen in self._undone:
            self._undone.remove(chosen)
        return chosen


def _caught_up(volume: BlockVolume, journal: Journal) -> BlockVolume:
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

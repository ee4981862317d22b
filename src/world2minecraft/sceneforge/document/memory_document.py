"""An open scene whose edit history is in memory, not on disk."""

from collections.abc import Callable
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene import MemoryLog, SceneDraft, SceneHistory
from world2minecraft.sceneforge.document.saving import write_scene_files
from world2minecraft.sceneforge.document.snapshots import State
from world2minecraft.sceneforge.scene_sources import OpenedScene


class SavedMark:
    """The distance of a scene from its saved state, in steps of undo and redo.

    Args:
        away: Steps applied since the last save, negative after undoing past it. None if undo and
            redo cannot reach the saved state, or if the distance is not known.
    """

    def __init__(self, away: int | None = 0):
        self.away = away

    @property
    def is_here(self) -> bool:
        """Whether the scene is as it was saved."""
        return self.away == 0

    def step(self, step: str) -> None:
        """Count a step: ``do``, ``undo`` or ``redo``."""
        if self.away is None:
            return
        if step == "do" and self.away < 0:  # What would lead to the saved state is discarded.
            self.away = None
        else:
            self.away += -1 if step == "undo" else 1


class MemoryDocument:
    """A scene that is edited in memory. ``Document`` is the subclass for a scene on disk.

    ``draft`` is the scene, and ``history`` changes it. ``rev`` counts the steps so far, including
    undo and redo. ``saved_rev`` is the value of ``rev`` at the last save, and ``saved_mark`` tells
    whether the scene is as it was saved. ``read_only`` is the
    reason why the scene cannot be edited, or empty. ``notes`` are messages for the user. ``opened``
    is the scene as it was first opened.
    """

    draft: SceneDraft
    history: SceneHistory
    opened: OpenedScene

    def __init__(self, opened: OpenedScene, clock: Callable[[], float]):
        """Create a document for a scene that was read."""
        self.opened, self.clock = opened, clock
        self.draft = SceneDraft(opened.grid, opened.objects)
        self.history = SceneHistory(self.draft, MemoryLog())
        self.rev = self.saved_rev = 0
        self.saved_mark = SavedMark()
        self.read_only, self.notes = "", []

    def do(self, operation: Operation) -> Operation:
        """Apply an operation to the scene.

        Raises:
            ConflictError: If the scene has changed since the operation was planned. Nothing is
                changed.
            OutputError: If the journal cannot be written. Nothing is changed.
        """
        self.check_writable()
        return self._stepped("do", self.history.do(operation), operation.actor, operation.time_s)

    def undo(self, actor: str = "") -> Operation:
        """Undo the last operation and return its inverse.

        Raises:
            UsageError: If there is nothing to undo, or if the scene is read-only.
            OutputError: If the journal cannot be written.
        """
        self.check_writable()
        now = self.clock()
        return self._stepped("undo", self.history.undo(actor, now), actor, now)

    def redo(self, actor: str = "") -> Operation:
        """Redo the operation that was last undone, and return the operation.

        Raises:
            UsageError: If there is nothing to redo, or if the scene is read-only.
            OutputError: If the journal cannot be written.
        """
        self.check_writable()
        now = self.clock()
        return self._stepped("redo", self.history.redo(actor, now), actor, now)

    def active(self, actor: str = "") -> None:
        """Record that someone is at work."""

    def state(self) -> State:
        """Return a copy of the current scene."""
        objects = tuple(self.draft.objects[number] for number in sorted(self.draft.objects))
        fields = (self.opened.scan_to_room, self.rev, self.generation, self.history.line)
        return State(self.draft.grid(), objects, *fields)

    @property
    def generation(self) -> str:
        """The name of the current journal generation, or an empty string without a journal."""
        return ""

    def save(self) -> Path:
        """Save the five files of the scene and return their folder.

        Raises:
            OutputError: If the files cannot be written.
        """
        self.check_writable()
        write_scene_files(self.opened.folder, self.state())
        self.saved_rev, self.saved_mark = self.rev, SavedMark()
        return self.opened.folder

    def close(self) -> None:
        """Close the scene."""
        self.read_only = self.read_only or "the scene is closed"

    def check_writable(self) -> None:
        """Check that the scene may be edited.

        Raises:
            UsageError: If the scene is read-only or closed.
        """
        if self.read_only:
            raise UsageError(f"{self.opened.name} is open read-only: {self.read_only}")

    def _stepped(self, step: str, operation: Operation, actor: str, time_s: float) -> Operation:
        self.rev += 1
        self.saved_mark.step(step)
        return operation

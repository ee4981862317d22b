"""An open scene: edited step by step, its history in memory and not on disk."""

from collections.abc import Callable
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene import MemoryLog, SceneDraft, SceneHistory
from world2minecraft.sceneforge.document.saving import write_scene_files
from world2minecraft.sceneforge.document.snapshots import State
from world2minecraft.sceneforge.scene_sources import OpenedScene


class MemoryDocument:
    """One scene that is edited; ``Document`` is one on disk.

    ``draft`` is the scene, ``history`` changes it. ``rev`` counts the steps so far, those of undo
    and redo too; ``saved_rev`` is its value when the scene was saved last. ``read_only`` is why
    nothing may be edited, empty where it may. ``notes`` are sentences for the user. ``opened``
    is the scene as it was opened first.
    """

    draft: SceneDraft
    history: SceneHistory
    opened: OpenedScene

    def __init__(self, opened: OpenedScene, clock: Callable[[], float]):
        """Take a scene that was read."""
        self.opened, self.clock = opened, clock
        self.draft = SceneDraft(opened.grid, opened.objects)
        self.history = SceneHistory(self.draft, MemoryLog())
        self.rev = self.saved_rev = 0
        self.read_only, self.notes = "", []

    def do(self, operation: Operation) -> Operation:
        """Do an operation. Raises ConflictError or OutputError; then nothing has changed."""
        self.check_writable()
        return self._stepped("do", self.history.do(operation), operation.actor, operation.time_s)

    def undo(self, actor: str = "") -> Operation:
        """Take the last operation back; return its inverse. Raises UsageError, OutputError."""
        self.check_writable()
        now = self.clock()
        return self._stepped("undo", self.history.undo(actor, now), actor, now)

    def redo(self, actor: str = "") -> Operation:
        """Do again what was last undone. Raises UsageError, OutputError."""
        self.check_writable()
        now = self.clock()
        return self._stepped("redo", self.history.redo(actor, now), actor, now)

    def active(self, actor: str = "") -> None:
        """Note that someone is at work."""

    def state(self) -> State:
        """Return the scene as it is now, a copy."""
        objects = tuple(self.draft.objects[number] for number in sorted(self.draft.objects))
        fields = (self.opened.scan_to_room, self.rev, self.generation, self.history.line)
        return State(self.draft.grid(), objects, *fields)

    @property
    def generation(self) -> str:
        """The name of the journal that goes on from here; empty where there is none."""
        return ""

    def save(self) -> Path:
        """Write the five files of the scene to their places; return their folder.

        Raises:
            OutputError: they cannot be written.
        """
        self.check_writable()
        write_scene_files(self.opened.folder, self.state())
        self.saved_rev = self.rev
        return self.opened.folder

    def close(self) -> None:
        """Let go of the scene."""
        self.read_only = self.read_only or "the scene is closed"

    def check_writable(self) -> None:
        """Raise UsageError where the scene may only be looked at."""
        if self.read_only:
            raise UsageError(f"{self.opened.name} is open read-only: {self.read_only}")

    def _stepped(self, step: str, operation: Operation, actor: str, time_s: float) -> Operation:
        self.rev += 1
        return operation

"""The Python interface of SceneForge: open a scene, edit it by commands, query it and save it.

The server uses this class, and scripts or language models may use it too::

    editor = Editor.open(Path("OUT"))
    editor.do("set_cells", cells=[[1200, 3]], class_id=0)
    editor.undo()
    editor.save()
    editor.close()
"""

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene import Command, SceneDraft, parse_command
from world2minecraft.sceneforge.document.document import Document
from world2minecraft.sceneforge.document.document_metadata import document_folder
from world2minecraft.sceneforge.document.memory_document import MemoryDocument
from world2minecraft.sceneforge.queries import parse_query
from world2minecraft.sceneforge.scene_sources import OpenedScene
from world2minecraft.sceneforge.stage_tools import tools_of
from world2minecraft.sceneforge.wire_format import PROTOCOL, classes_json, counts_json, objects_json

Listener = Callable[[int, str, Operation], None]
Value = TypeVar("Value")
MAX_IDS = 1 << 16


class Editor:
    """An open scene that is edited by commands.

    All methods are thread-safe and run one at a time. ``document`` is the scene's document, with
    ``notes`` for the user. ``cells_of`` int64 [65536] is the number of cells of each object.
    ``has`` lists the additional data that the page can show. ``progress`` is a callback for the
    progress of long queries.
    """

    progress: Progress = staticmethod(no_progress)

    def __init__(
        self, document: MemoryDocument | OpenedScene, clock: Callable[[], float] = time.time
    ):
        """Create an editor for an open document, or for a scene in memory. See ``Editor.open``."""
        self.document = (
            MemoryDocument(document, clock) if isinstance(document, OpenedScene) else document
        )
        self.name = self.document.opened.name
        self.tools = tools_of(self.opened.rooms)
        self.has: dict[str, Any] = {"photos": 0, "truth": False}
        self.cells_of = np.bincount(self.draft.instance.ravel(), minlength=MAX_IDS)
        self._listeners: list[Listener] = []
        self._lock = threading.RLock()

    @classmethod
    def open(
        cls,
        source: Path | None,
        *,
        out: Path | None = None,
        clock: Callable[[], float] = time.time,
    ) -> "Editor":
        """Open a scene in its last state, including unsaved edits.

        If another process edits the scene, it is opened read-only and ``read_only`` states the
        reason.

        Args:
            source: A run folder, an occupancy file or a ``.forge`` folder. None opens the demo
                room.
            out: Folder that ``save`` writes. None uses the source's own folder.
            clock: Function that returns the time in seconds since 1970.

        Raises:
            InputError: If the source cannot be read.
            OutputError: If its ``.forge`` folder cannot be created.
            ConflictError: If the source has changed since and there are unsaved edits.
        """
        return cls(Document.open(source, out=out, clock=clock))

    @property
    def draft(self) -> SceneDraft:
        """The current scene, which must not be modified directly."""
        return self.document.draft

    @property
    def opened(self) -> OpenedScene:
        """The scene as it was first opened, with its source."""
        return self.document.opened

    @property
    def rev(self) -> int:
        """The number of steps so far, including undo and redo."""
        return self.document.rev

    @property
    def saved_rev(self) -> int:
        """The revision that was last saved."""
        return self.document.saved_rev

    @property
    def is_saved(self) -> bool:
        """Whether the scene is as it was saved, also after undo."""
        return self.document.saved_mark.is_here

    @property
    def read_only(self) -> str:
        """The reason why the scene cannot be edited, or an empty string."""
        return self.document.read_only

    @property
    def notes(self) -> list[str]:
        """Messages for the user about recovered edits and files that could not be written."""
        return self.document.notes

    def holds(self, source: Path | None) -> bool:
        """Return whether this editor has the scene open that ``open`` would return for a source."""
        document = self.document
        return isinstance(document, Document) and document.folder == document_folder(source)

    def do(self, op: str | Command | Operation, *, actor: str = "", **fields: Any) -> Operation:
        """Run a command and return the operation that it performed.

        Args:
            op: A command, the name of a command (with its fields as ``fields``), or an operation
                that was planned on the current scene.
            actor: Name of the user, which is recorded but not checked.
            fields: Fields of the command.

        Raises:
            UsageError: If the command is invalid or cannot be applied to this scene.
            ConflictError: If the scene has changed since the operation was planned.
        """
        with self._lock:
            planned = op if isinstance(op, Operation) else self.preview(op, **fields)
            who, now = actor or planned.actor, self.document.clock()
            return self._tell("do", self.document.do(replace(planned, actor=who, time_s=now)))

    def undo(self, *, actor: str = "") -> Operation:
        """Undo the last operation and return its inverse.

        Raises:
            UsageError: If there is nothing to undo.
        """
        with self._lock:
            return self._tell("undo", self.document.undo(actor))

    def redo(self, *, actor: str = "") -> Operation:
        """Redo the operation that was last undone, and return it.

        Raises:
            UsageError: If nothing was undone since the last edit.
        """
        with self._lock:
            return self._tell("redo", self.document.redo(actor))

    def preview(self, op: str | Command, **fields: Any) -> Operation:
        """Return the operation that a command would perform, without performing it.

        Raises:
            UsageError: If the command is invalid or cannot be applied to this scene.
        """
        command = parse_command({"op": op, **fields}) if isinstance(op, str) else op
        with self._lock:
            return command.plan(self.draft, self.tools)

    def ask(self, name: str, **fields: Any) -> Any:
        """Return the answer to a query as JSON values.

        Raises:
            UnknownNameError: If no query has this name.
            UsageError: If the query cannot be answered for this scene.
        """
        query = parse_query(name, fields)
        with self._lock:
            return query.answer(self)

    def scene_json(self) -> dict[str, Any]:
        """Return the scene without its cells, as ``Scene`` of ``wire.ts``."""
        with self._lock:
            return {
                "protocol": PROTOCOL,
                "name": self.name,
                "rev": self.rev,
                "saved": self.is_saved,
                "read_only": self.read_only,
                "notes": list(self.notes),
                "voxel_m": float(self.draft.voxel_m),
                "origin_m": [float(value) for value in self.draft.origin_m],
                "shape": list(self.draft.shape),
                "classes": classes_json(),
                "counts": counts_json(self.draft.counts),
                "objects": objects_json(self.draft.objects, self.cells_of),
                "undo": self.undo_kind,
                "redo": self.redo_kind,
                "is_demo": self.opened.is_demo,
                "has": dict(self.has),
            }

    @property
    def undo_kind(self) -> str:
        """The kind of the operation that ``undo`` would undo, or an empty string."""
        return self.document.history.line.undo_kind

    @property
    def redo_kind(self) -> str:
        """The kind of the operation that ``redo`` would redo, or an empty string."""
        return self.document.history.line.redo_kind

    def read(self, look: Callable[[], Value]) -> Value:
        """Call a function on the scene while no step can change it, and return its result."""
        with self._lock:
            return look()

    def on_change(self, listener: Listener) -> Callable[[], None]:
        """Call ``listener(rev, step, operation)`` after each step, and return a cancel function.

        ``step`` is ``do``, ``undo`` or ``redo``. The operation is the change that was made to the
        scene, so for an undo it is the inverse. The listener is called on the thread of the step,
        for one step at a time.
        """
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def active(self, actor: str = "") -> None:
        """Record that a person is at work, so that the effort log can separate work from idle time.

        Nothing is recorded while a step is running, since the step itself is recorded. The call
        never blocks.
        """
        if self._lock.acquire(blocking=False):
            try:
                self.document.active(actor)
            finally:
                self._lock.release()

    def save(self) -> Path:
        """Save the scene to the files that other w2m commands read, and return their folder.

        Raises:
            OutputError: If the folder cannot be written.
            ConflictError: If a file there was changed by another program. Nothing is written.
        """
        with self._lock:
            return self.document.save()

    def close(self) -> None:
        """Close the scene. Unsaved edits remain in its ``.forge`` folder."""
        with self._lock:
            self.document.close()

    def _tell(self, step: str, operation: Operation) -> Operation:
        self.cells_of -= np.bincount(operation.before.instance, minlength=MAX_IDS)
        self.cells_of += np.bincount(operation.after.instance, minlength=MAX_IDS)
        for listener in tuple(self._listeners):
            listener(self.rev, step, operation)
        return operation

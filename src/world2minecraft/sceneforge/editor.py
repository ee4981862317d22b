"""The Python of SceneForge: a scene is opened, edited by commands, asked and saved.

The server drives this class, and so may a script or a language model::

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
    """One scene that is edited. All methods may be called from any thread; one runs at a time.

    ``document`` is its folder, with ``notes`` for the user. ``cells_of`` int64 [65536] counts
    each object's cells. ``has`` is what there is beside the scene, for the page; ``progress`` is
    told how far a long question is.
    """

    progress: Progress = staticmethod(no_progress)

    def __init__(
        self, document: MemoryDocument | OpenedScene, clock: Callable[[], float] = time.time
    ):
        """Take an open document, or a scene to be edited in memory alone; see ``Editor.open``."""
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
        """Open a scene where it was left; edits that were not saved are still there.

        Where another process edits it, it is opened to be read only; ``read_only`` says why.

        Args:
            source: a run's folder, any occupancy file, a ``.forge`` folder; None is the demo room.
            out: the folder that ``save`` writes, where it is not the source's own.
            clock: gives the time in seconds since 1970.

        Raises:
            InputError: it cannot be read. OutputError: its ``.forge`` folder cannot be made.
            ConflictError: the source changed since, and there are edits that were not saved.
        """
        return cls(Document.open(source, out=out, clock=clock))

    @property
    def draft(self) -> SceneDraft:
        """The scene as it is now, to be read only."""
        return self.document.draft

    @property
    def opened(self) -> OpenedScene:
        """The scene as it was opened first, and what it was read from."""
        return self.document.opened

    @property
    def rev(self) -> int:
        """How many steps led here, those of undo and redo too."""
        return self.document.rev

    @property
    def saved_rev(self) -> int:
        """The revision that was saved last."""
        return self.document.saved_rev

    @property
    def read_only(self) -> str:
        """Why the scene cannot be edited; empty where it can."""
        return self.document.read_only

    @property
    def notes(self) -> list[str]:
        """Sentences for the user: what was recovered, what could not be written."""
        return self.document.notes

    def holds(self, source: Path | None) -> bool:
        """Whether this is the scene that ``open`` would give for a source."""
        document = self.document
        return isinstance(document, Document) and document.folder == document_folder(source)

    def do(self, op: str | Command | Operation, *, actor: str = "", **fields: Any) -> Operation:
        """Do a command and return what it did.

        Args:
            op: a command, its name (with its fields as ``fields``), or an operation that was
                planned on the scene as it is.
            actor: who does it; only recorded.
            fields: of the command.

        Raises:
            UsageError: the command is wrong, or cannot be done to this scene.
            ConflictError: the scene changed since the operation was planned.
        """
        with self._lock:
            planned = op if isinstance(op, Operation) else self.preview(op, **fields)
            who, now = actor or planned.actor, self.document.clock()
            return self._tell("do", self.document.do(replace(planned, actor=who, time_s=now)))

    def undo(self, *, actor: str = "") -> Operation:
        """Take the last operation back; return the operation that did so, its inverse.

        Raises:
            UsageError: there is nothing to undo.
        """
        with self._lock:
            return self._tell("undo", self.document.undo(actor))

    def redo(self, *, actor: str = "") -> Operation:
        """Do again what was last undone; return it.

        Raises:
            UsageError: nothing was undone since the last edit.
        """
        with self._lock:
            return self._tell("redo", self.document.redo(actor))

    def preview(self, op: str | Command, **fields: Any) -> Operation:
        """Return what a command would do, without doing it. Raises what ``do`` raises."""
        command = parse_command({"op": op, **fields}) if isinstance(op, str) else op
        with self._lock:
            return command.plan(self.draft, self.tools)

    def ask(self, name: str, **fields: Any) -> Any:
        """Return the answer of a query as JSON values.

        Raises:
            UnknownNameError: there is no such query. UsageError: it cannot be answered.
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
                "saved_rev": self.saved_rev,
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
        """The kind of what ``undo`` would take back; empty where there is nothing."""
        return self.document.history.line.undo_kind

    @property
    def redo_kind(self) -> str:
        """The kind of what ``redo`` would do again; empty where there is nothing."""
        return self.document.history.line.redo_kind

    def read(self, look: Callable[[], Value]) -> Value:
        """Return what ``look`` returns; no step is done meanwhile."""
        with self._lock:
            return look()

    def on_change(self, listener: Listener) -> Callable[[], None]:
        """Call ``listener(rev, step, operation)`` after each step; return how to stop it.

        ``step`` is ``do``, ``undo`` or ``redo``; the operation is what was done to the scene, so
        of an undo the inverse. It is called on the thread of the step, one step at a time.
        """
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def active(self, actor: str = "") -> None:
        """Note that a person is at work, so that the effort log knows time from idle time.

        While a step is done nothing is noted: the step is sign enough, and this never waits.
        """
        if self._lock.acquire(blocking=False):
            try:
                self.document.active(actor)
            finally:
                self._lock.release()

    def save(self) -> Path:
        """Write the scene to the files that the other verbs read; return their folder.

        Raises:
            OutputError: the folder cannot be written. ConflictError: a file there was changed by
            another program; nothing is written.
        """
        with self._lock:
            return self.document.save()

    def close(self) -> None:
        """Let go of the scene; what was not saved stays in its ``.forge`` folder."""
        with self._lock:
            self.document.close()

    def _tell(self, step: str, operation: Operation) -> Operation:
        self.cells_of -= np.bincount(operation.before.instance, minlength=MAX_IDS)
        self.cells_of += np.bincount(operation.after.instance, minlength=MAX_IDS)
        for listener in tuple(self._listeners):
            listener(self.rev, step, operation)
        return operation

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

from world2minecraft.edit.scene import (
    Command,
    MemoryLog,
    SceneDraft,
    SceneHistory,
    instances_of,
    parse_command,
    placements_of,
)
from world2minecraft.errors import UsageError
from world2minecraft.exchange.objects import write_objects, write_placements
from world2minecraft.exchange.paper import write_centers_json, write_occ_json
from world2minecraft.exchange.room import write_room
from world2minecraft.forge.queries import parse_query
from world2minecraft.forge.sources import Opened, read_source
from world2minecraft.forge.tools import tools_of
from world2minecraft.forge.wire import PROTOCOL, classes_json, counts_json, objects_json
from world2minecraft.types import Operation

Listener = Callable[[int, str, Operation], None]
Value = TypeVar("Value")
MAX_IDS = 1 << 16


class Editor:
    """One scene that is edited. All methods may be called from any thread; one runs at a time.

    ``draft`` is the scene, to be read only. ``rev`` counts the steps so far, undo and redo too;
    ``saved_rev`` is its value when the scene was last saved. ``read_only`` says why the scene
    cannot be edited, empty where it can. ``cells_of`` int64 [65536] counts each object's cells.
    """

    def __init__(self, opened: Opened, clock: Callable[[], float] = time.time):
        """Take a scene that was read; ``open`` is the usual way."""
        self.opened, self.name, self.clock = opened, opened.name, clock
        self.draft = SceneDraft(opened.grid, opened.objects)
        self.tools = tools_of(opened.rooms)
        self.rev = self.saved_rev = 0
        self.read_only = ""
        self.cells_of = np.bincount(self.draft.instance.ravel(), minlength=MAX_IDS)
        self._history = SceneHistory(self.draft, MemoryLog())
        self._listeners: list[Listener] = []
        self._lock = threading.RLock()

    @classmethod
    def open(
        cls, source: Path, *, out: Path | None = None, clock: Callable[[], float] = time.time
    ) -> "Editor":
        """Open a run's folder or an occupancy file.

        Args:
            source: what ``w2m reconstruct`` wrote, or any file that holds an occupancy grid.
            out: the folder that ``save`` writes, where it is not the source's own.
            clock: gives the time in seconds since 1970.

        Raises:
            InputError: it cannot be read.
        """
        opened = read_source(source)
        return cls(replace(opened, folder=out or opened.folder), clock)

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
            self._check_writable()
            planned = op if isinstance(op, Operation) else self.preview(op, **fields)
            told = replace(planned, actor=actor or planned.actor, time_s=self.clock())
            return self._step("do", self._history.do(told))

    def undo(self, *, actor: str = "") -> Operation:
        """Take the last operation back; return the operation that did so, its inverse.

        Raises:
            UsageError: there is nothing to undo.
        """
        with self._lock:
            self._check_writable()
            return self._step("undo", self._history.undo())

    def redo(self, *, actor: str = "") -> Operation:
        """Do again what was last undone; return it.

        Raises:
            UsageError: nothing was undone since the last edit.
        """
        with self._lock:
            self._check_writable()
            return self._step("redo", self._history.redo())

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
                "voxel_m": float(self.draft.voxel_m),
                "origin_m": [float(value) for value in self.draft.origin_m],
                "shape": list(self.draft.shape),
                "classes": classes_json(),
                "counts": counts_json(self.draft.counts),
                "objects": objects_json(self.draft.objects, self.cells_of),
                "undo": self.undo_kind,
                "redo": self.redo_kind,
                "is_demo": self.opened.is_demo,
                "has": {"photos": 0, "truth": False},
            }

    @property
    def undo_kind(self) -> str:
        """The kind of what ``undo`` would take back; empty where there is nothing."""
        return self._history.line.undo_kind

    @property
    def redo_kind(self) -> str:
        """The kind of what ``redo`` would do again; empty where there is nothing."""
        return self._history.line.redo_kind

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

    def save(self) -> Path:
        """Write the scene to the files that the other verbs read; return their folder.

        Raises:
            OutputError: the folder cannot be written.
        """
        with self._lock:
            self._check_writable()
            folder, grid = self.opened.folder, self.draft.grid()
            objects = self.draft.objects.values()
            instances = instances_of(objects, grid.instance)
            write_room(folder / "room.npz", grid, self.opened.scan_to_room)
            write_objects(folder / "objects.json", instances)
            write_placements(folder / "placements.json", placements_of(objects))
            write_occ_json(folder / "occ.json", grid)
            write_centers_json(folder / "centers.json", instances)
            self.saved_rev = self.rev
            return folder

    def close(self) -> None:
        """Let go of the scene; what was not saved stays in its journal."""

    def _check_writable(self) -> None:
        if self.read_only:
            raise UsageError(f"{self.name} is open to be read only: {self.read_only}")

    def _step(self, step: str, operation: Operation) -> Operation:
        self.rev += 1
        self.cells_of -= np.bincount(operation.before.instance, minlength=MAX_IDS)
        self.cells_of += np.bincount(operation.after.instance, minlength=MAX_IDS)
        for listener in tuple(self._listeners):
            listener(self.rev, step, operation)
        return operation

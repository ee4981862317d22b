"""The state of a server process: the document, its tabs, and the order of requests.

Requests that use the document are served one at a time, first come, first served. Small edits are
applied at once. Longer work, such as detecting or matching objects again or queries about the whole
grid, is computed in a thread, so that pages, pings and volumes are still served, and then applied
as one operation before the next request. Work that takes seconds on a large scene runs as a job on
a copy and does not delay other requests. ``change_message`` returns ``Change`` of ``wire.ts``,
``preview_message`` returns ``Preview`` of ``connection.ts``.
"""

import asyncio
import logging
import zlib
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import GridCells, Operation
from world2minecraft.editing.scene import Command, SceneDraft, parse_command
from world2minecraft.sceneforge.array_messages import confidence_bytes, copy_volume
from world2minecraft.sceneforge.broadcast import Broadcaster
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.jobs.background_job import TITLES, copy_editor, run_in_background
from world2minecraft.sceneforge.jobs.jobs import Jobs
from world2minecraft.sceneforge.wire_format import PROTOCOL, counts_json, object_json

MAX_RUNS = 20_000  # As JSON 0.5 MB; of more, the page gets the whole volume again.
QUICK = frozenset({"set_cells", "move_object", "turn_objects", "delete_objects", "set_template"})
QUICK_CELLS = 1 << 20  # In a larger grid, a thread runs these too.
NO_ROOM = "no room is open; choose one on the start page"
LOG = logging.getLogger(__name__)


def change_message(editor: Editor, rev: int, step: str, operation: Operation) -> dict[str, Any]:
    """Return the message that informs every tab of a step that was applied to the scene.

    It lists the objects that changed and those that gained or lost cells.
    """
    draft = editor.draft
    named = {one.id for one in (*operation.objects_before, *operation.objects_after)}
    owners = np.union1d(operation.before.instance, operation.after.instance).tolist()
    changed = sorted({*named, *owners} & draft.objects.keys())
    return {
        "type": "change",
        "rev": rev,
        "kind": operation.kind,
        "counts_as": operation.counts_as,
        "actor": operation.actor,
        "step": step,
        "cells": encode_runs(operation.cells, operation.after, draft.shape),
        "objects": [object_json(draft.objects[n], int(editor.cells_of[n])) for n in changed],
        "gone": sorted(named - draft.objects.keys()),
        "counts": counts_json(draft.counts),
        "undo": editor.undo_kind,
        "redo": editor.redo_kind,
        "saved": editor.is_saved,
    }


def preview_message(draft: SceneDraft, operation: Operation) -> dict[str, Any]:
    """Return the cells and objects that an operation would change, and removed objects."""
    counts = np.bincount(operation.after.instance, minlength=1)
    after = [
        object_json(one, counts[one.id] if one.id < len(counts) else 0)
        for one in operation.objects_after
    ]
    held = {one.id for one in operation.objects_after}
    return {
        "kind": operation.kind,
        "counts_as": operation.counts_as,
        "cells": encode_runs(operation.cells, operation.after, draft.shape),
        "objects": after,
        "gone": sorted({one.id for one in operation.objects_before} - held),
    }


def encode_runs(
    cells: np.ndarray, held: GridCells, shape: tuple[int, int, int]
) -> list[list[int]] | None:
    """Return cells int [N, 3] as runs of [first, length, label, instance, confidence].

    Confidence is 0 to 255. Return None if there would be more than ``MAX_RUNS`` runs.
    """
    if not len(cells):
        return []
    flat = np.ravel_multi_index(tuple(cells.T), shape)
    order = np.argsort(flat, kind="stable")
    columns = (flat, held.labels, held.instance, confidence_bytes(held.confidence))
    rows = np.column_stack([np.asarray(one, np.int64)[order] for one in columns])
    breaks = np.ones(len(rows), bool)
    breaks[1:] = (np.diff(rows[:, 0]) != 1) | (rows[1:, 1:] != rows[:-1, 1:]).any(axis=1)
    first = np.flatnonzero(breaks)
    if len(first) > MAX_RUNS:
        return None
    lengths = np.diff(first, append=len(rows))
    return np.column_stack([rows[first, 0], lengths, rows[first, 1:]]).tolist()


Value = TypeVar("Value")


class Session:
    """The document of a server and the tabs that show it.

    ``editor`` is None until a document is opened. ``shown`` counts the documents opened so far, so
    that a tab can tell a new document from a new revision. It is 0 before the first document.
    ``jobs`` are the background jobs.
    """

    def __init__(self, editor: Editor | None = None):
        self.editor: Editor | None = None
        self.broadcaster = Broadcaster()
        self.jobs = Jobs(self.broadcaster.broadcast_threadsafe)
        self.shown = 0
        self._count = 0
        self._turn = asyncio.Lock()
        self._volumes: dict[str, tuple[int, bytes]] = {}
        self._unlisten: Callable[[], None] = lambda: None
        self._take(editor)

    @property
    def document(self) -> Editor:
        """The editor of the open document.

        Raises:
            UsageError: If no document is open.
        """
        if self.editor is None:
            raise UsageError(NO_ROOM)
        return self.editor

    @property
    def rev(self) -> int:
        """The revision of the document, or 0 if no document is open."""
        return self.editor.rev if self.editor else 0

    async def show(self, editor: Editor | None) -> None:
        """Close the current document, show another one and reload every tab."""
        async with self._turn:
            old = self.editor
            self._unlisten()
            self._take(editor)
            if old is not None:
                await asyncio.to_thread(old.close)
        self.broadcaster.restart()

    async def do(self, command: Any, actor: str = "") -> dict[str, Any]:
        """Run a command and inform every tab.

        Args:
            command: The command as a JSON object with ``op``.
            actor: Name of the user, which is only recorded.

        Returns:
            ``rev``, ``kind``, ``counts_as`` and the number of changed ``cells``.

        Raises:
            World2MinecraftError: If the command cannot be applied. Nothing is changed.
        """
        checked = parse_command(command)
        if command["op"] in TITLES and not self._is_small:
            return await self._do_long(command["op"], checked, actor)
        async with self._turn:
            document = self.document
            if command["op"] in QUICK and self._is_small:
                return await self._done(document.do(checked, actor=actor))
            planned = await asyncio.to_thread(_plan, document, checked)
            return await self._step(lambda: document.do(planned, actor=actor))

    async def undo(self, actor: str = "") -> dict[str, Any]:
        """Undo the last operation. The result and the errors are those of ``do``."""
        async with self._turn:
            document = self.document
            return await self._step(lambda: document.undo(actor=actor))

    async def redo(self, actor: str = "") -> dict[str, Any]:
        """Redo the last undone operation. The result and the errors are those of ``do``."""
        async with self._turn:
            document = self.document
            return await self._step(lambda: document.redo(actor=actor))

    async def preview(self, command: Any) -> dict[str, Any]:
        """Return the effect of a command without applying it.

        Raises:
            World2MinecraftError: If the command cannot be applied.
        """
        checked = parse_command(command)

        def work(document: Editor) -> dict[str, Any]:
            return preview_message(document.draft, _plan(document, checked))

        if command["op"] in TITLES and not self._is_small:
            return await self._run_in_background(command["op"], work)
        return await self._read(work)

    async def ask(self, name: str, fields: Mapping[str, Any]) -> Any:
        """Return the answer to a query about the scene.

        Raises:
            World2MinecraftError: If the query cannot be answered.
        """

        def question(document: Editor) -> Any:
            return document.ask(name, **fields)

        if name in TITLES and not self._is_small:
            return await self._run_in_background(name, question)
        return await self._read(question)

    async def read(self, question: Callable[[Editor], Value]) -> Value:
        """Call a function with the document in a thread, one call at a time; return its result."""
        return await self._read(question)

    async def save(self) -> int:
        """Save the files of the scene and return the saved revision.

        Raises:
            World2MinecraftError: If the files cannot be written.
        """
        async with self._turn:
            document = self.document
            await asyncio.to_thread(document.save)
        self.broadcaster.broadcast({"type": "saved", "rev": document.saved_rev})
        return document.saved_rev

    async def scene(self) -> dict[str, Any]:
        """Return the scene as ``Scene`` of ``wire.ts``.

        Raises:
            UsageError: If no document is open.
        """
        document = {"document": self.shown}
        return document | await asyncio.to_thread(self.document.scene_json)

    async def volume(self, what: str, zipped: bool) -> tuple[int, bytes]:
        """Return the revision and one array as a ``W2MV`` message.

        Args:
            what: Name of the array.
            zipped: Whether to compress the message with gzip.

        Raises:
            UsageError: If there is no array of this name, or if no document is open.
        """
        document = self.document
        cached = self._volumes.get(what)
        if zipped and cached and cached[0] == document.rev:
            return cached
        rev, data = await asyncio.to_thread(_volume, document, what, zipped)
        if zipped and document is self.editor:
            self._volumes[what] = (rev, data)
        return rev, data

    async def active(self, actor: str = "") -> None:
        """Record that a person is at work, so that the effort log can exclude idle time."""
        if self.editor is not None:
            await asyncio.to_thread(self.editor.active, actor)  # It writes a file.

    def hello(self) -> dict[str, Any]:
        """Return the first message for a tab, which also tells it to reload the scene."""
        return {"type": "hello", "protocol": PROTOCOL, "rev": self.rev, "document": self.shown}

    def report(self, error: BaseException) -> None:
        """Print the traceback of an internal error to the terminal."""
        LOG.error("unexpected %s", type(error).__name__, exc_info=error)

    async def close(self) -> None:
        """Cancel the jobs and close the document."""
        await asyncio.to_thread(self.jobs.close)
        await self.show(None)

    def _take(self, editor: Editor | None) -> None:
        """Show a document, and send each of its steps to the tabs, whoever performs it."""
        self.editor = editor
        self._volumes.clear()
        self.shown = 0
        self._unlisten = lambda: None
        if editor is not None:
            self._count += 1
            self.shown = self._count

            def on_change(rev: int, step: str, operation: Operation) -> None:
                self.broadcaster.broadcast_threadsafe(change_message(editor, rev, step, operation))

            self._unlisten = editor.on_change(on_change)

    @property
    def _is_small(self) -> bool:
        return self.document.draft.labels.size <= QUICK_CELLS

    async def _step(self, act: Callable[[], Operation]) -> dict[str, Any]:
        """Apply a planned step, in a thread if it may affect millions of cells."""
        operation = act() if self._is_small else await asyncio.to_thread(act)
        return await self._done(operation)

    async def _done(self, operation: Operation) -> dict[str, Any]:
        await asyncio.sleep(0)  # The queued change is sent before the answer.
        return {
            "rev": self.rev,
            "kind": operation.kind,
            "counts_as": operation.counts_as,
            "cells": len(operation.cells),
        }

    async def _run_in_background(self, name: str, work: Callable[[Editor], Value]) -> Value:
        """Return the result of long work on a copy of the scene. Only the copying takes a turn."""
        copy = await self._read(copy_editor)
        return await run_in_background(self.jobs, name, copy, work)

    async def _do_long(self, name: str, command: Command, actor: str) -> dict[str, Any]:
        """Plan a command in the background, and apply it if its cells have not changed."""
        document = self.document
        planned = await self._run_in_background(name, lambda copy: _plan(copy, command))
        async with self._turn:
            if document is not self.editor:
                raise UsageError("another room was opened; nothing was changed")
            return await self._step(lambda: document.do(planned, actor=actor))

    async def _read(self, question: Callable[[Editor], Value]) -> Value:
        async with self._turn:
            return await asyncio.to_thread(question, self.document)


def _plan(document: Editor, command: Command) -> Operation:
    """Plan without the document's lock, because the turn prevents other edits by the server."""
    return command.plan(document.draft, document.tools)


def _volume(document: Editor, what: str, zipped: bool) -> tuple[int, bytes]:
    rev, volume = document.read(lambda: (document.rev, copy_volume(document.draft, what)))
    raw = volume.as_bytes()  # Edits wait only for the copy.
    if not zipped:
        return rev, raw
    packer = zlib.compressobj(1, zlib.DEFLATED, 31)
    return rev, packer.compress(raw) + packer.flush()

"""A scene on disk while it is edited: the folder ``NAME.forge`` beside its source.

=====================  =========================================================================
``document.json``      the source of the scene, and where it is saved
``base.npz``           the scene as it was first opened; never changed
``journal.bin``        all steps since then; each is written before its effect is shown
``snapshot-*.npz``     complete scenes, so that opening the document is fast
``effort.jsonl``       the effort log
``saved.json``         the state of the last save; ``saving``: the files of a save in progress
``lock``               the process that edits the document
=====================  =========================================================================

No file outside the folder is written before ``save`` is called. The folder that the scene is saved
to is locked while the document is open, so that no command writes there.
"""

import hashlib
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.core.locks import LOCK_FILE, Lock
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene import SceneHistory
from world2minecraft.editing.scene.journal import DO, UNDO
from world2minecraft.sceneforge.document import saving
from world2minecraft.sceneforge.document.document_metadata import (
    document_folder,
    is_document,
    read_identity,
    retire_outdated,
    write_identity,
)
from world2minecraft.sceneforge.document.effort_log import EffortLog
from world2minecraft.sceneforge.document.memory_document import MemoryDocument, SavedMark
from world2minecraft.sceneforge.document.recovery import (
    JOURNAL_FILE,
    RecoveredScene,
    copy_damaged,
    recover,
    rewrite_journal,
)
from world2minecraft.sceneforge.document.snapshots import (
    State,
    snapshot_path,
    snapshot_paths,
    write_state,
)
from world2minecraft.sceneforge.scene_sources import OpenedScene, read_source

SNAPSHOT_STEPS, SNAPSHOT_S = 200, 60.0
HISTORY_BYTES = 256 << 20  # Maximum size on disk of the edits that can be undone.
MAX_SNAPSHOTS = 2


class Document(MemoryDocument):
    """A scene with its ``.forge`` folder on disk.

    Only one thread at a time may use a document, which ``Editor`` ensures. ``notes`` are messages
    for the user about problems found when opening or editing. ``recovered`` is the number of
    unsaved steps that were found when opening.
    """

    def __init__(self, folder: Path, clock: Callable[[], float], lock: Lock | None, reason: str):
        """Read a document. Use ``open`` instead of this constructor.

        Args:
            folder: Folder of the document.
            clock: Function that returns the time in seconds since 1970.
            lock: The acquired lock, or None to open the document read-only.
            reason: Reason why the document is read-only, or an empty string.
        """
        self.folder, self.clock, self.read_only = folder, clock, reason
        self.notes: list[str] = []
        self.history_bytes = HISTORY_BYTES
        self._lock, self._writer = lock, None
        self._target: Lock | None = None
        self.identity = read_identity(folder)
        self.saved_rev = saving.saved_rev(folder)
        found = recover(folder)
        self.recovered = max(found.rev - self.saved_rev, 0)
        self.saved_mark = SavedMark(None if self.recovered else 0)
        if self.recovered:
            edits = "1 unsaved edit" if self.recovered == 1 else f"{self.recovered} unsaved edits"
            self.notes.append(f"Recovered {edits}.")
        if found.fault:
            lost = f"; {found.lost} edits are lost" if found.lost else ""
            self.notes.append(f"{found.fault}{lost}.")
        self._take(found)
        self.opened = self.identity.opened(found.base)
        self._effort: EffortLog | None = None
        if lock is not None:
            self._own(found)

    @classmethod
    def open(
        cls, source: Path | None, *, out: Path | None = None, clock: Callable[[], float]
    ) -> "Document":
        """Open the document of a source, and create it if it does not exist.

        If another process edits the document or writes the run, or if the document's folder is not
        writable, the document is opened read-only and ``read_only`` states the reason.

        Args:
            source: A source that ``scene_sources.py`` reads, or a document folder. None opens the
                demo room.
            out: Folder to save to, beside which the document folder is created. None uses the
                source's folder.
            clock: Function that returns the time in seconds since 1970.

        Raises:
            InputError: If the source cannot be read.
            OutputError: If the document folder cannot be created.
            ConflictError: If the source has changed since and the document has unsaved edits, or if
                another process writes the run and there is no document yet.
        """
        folder = document_folder(source, out)
        opened = None if is_document(folder) else read_source(source, out)
        lock, reason = _take_lock(folder)
        if lock is None:
            return cls(folder, clock, None, reason)
        target = None
        try:
            target = _lock_target(opened.folder if opened else read_identity(folder).target)
            notes = _prepare(folder, source, out, opened)
            document = cls(folder, clock, lock, "")
        except BaseException as error:
            _release(lock, target)
            busy = isinstance(error, ConflictError) and target is None
            if not is_document(folder):
                with suppress(OSError):
                    (folder / "lock").unlink()
                    folder.rmdir()
                raise
            if not busy and not isinstance(error, OutputError):
                raise
            reason = f"{error}; open it again when that has ended" if busy else str(error)
            return cls(folder, clock, None, reason)
        document._target = target
        document.notes[:0] = notes
        return document

    def active(self, actor: str = "") -> None:
        """Record in the effort log that someone is at work."""
        if self._effort is not None:
            self._effort.active(self.clock(), actor)

    def save(self) -> Path:
        """Save the five files of the scene and return their folder.

        Raises:
            ConflictError: If a file there was changed by another program.
            OutputError: If the files cannot be written.
        """
        self.check_writable()
        if self._target is None:
            with suppress(OSError):  # What is wrong is reported when the files are written.
                self.opened.folder.mkdir(parents=True, exist_ok=True)
            self._target = _lock_target(self.opened.folder)
        state = self.state()
        known = self.identity.inputs.values()
        saving.save(self.folder, self.opened.source, self.opened.folder, state, known)
        self.saved_rev, self.saved_mark = state.rev, SavedMark()
        self._snapshot()
        return self.identity.target

    @property
    def generation(self) -> str:
        """The name of the current journal generation."""
        return self._journal.generation

    def wait(self) -> None:
        """Wait until the snapshot in progress is on disk."""
        if self._writer is not None:
            self._writer.join()
            self._writer = None

    def close(self) -> None:
        """Close the document. Unsaved edits remain in its journal."""
        if self._lock is None:
            return
        if self.rev > self._snapshot_rev:
            self._snapshot()
        self.wait()
        _release(self._lock, self._target)
        self._lock, self.read_only = None, "the scene is closed"

    def _take(self, found: RecoveredScene) -> None:
        self.draft = found.draft
        self.rev, self._base, self._journal = found.rev, found.base, found.journal
        self.history = SceneHistory(self.draft, found.journal, found.line)
        self._snapshot_rev, self._snapshot_s = self.rev, self.clock()

    def _own(self, found: RecoveredScene) -> None:
        """Prepare the document folder for writing."""
        _tidy(self.folder)
        path = self.folder / JOURNAL_FILE
        if found.fault:
            if path.exists():
                aside = copy_damaged(path)
                self.notes.append(f"The damaged journal was moved to {aside.name}.")
            furthest = max(found.rev, found.journal.rev, self.saved_rev) + 1
            self._begin_anew(replace(found, rev=furthest))
        elif not found.journal.generation:
            found.journal.begin(found.base.generation)
        elif path.stat().st_size > found.journal.file.end:
            self.notes.append("The last edit was incomplete and was discarded.")
        self._effort = EffortLog(self.folder)
        self._log_again(self._effort)
        self._effort.opened(self.clock())

    def _log_again(self, effort: EffortLog) -> None:
        """Add the steps to the effort log that were lost when the program was killed."""
        for rev, step in enumerate(self._journal.steps, self._journal.start + 1):
            if rev <= effort.last_rev:
                continue
            operation = self._journal.operation(step.number)
            if step.verb == DO:
                effort.step(rev, "do", operation, operation.actor, operation.time_s)
            else:
                word = "undo" if step.verb == UNDO else "redo"
                effort.step(rev, word, operation, *self._journal.author_of(step))

    def _stepped(self, step: str, operation: Operation, actor: str, time_s: float) -> Operation:
        self.rev += 1
        self.saved_mark.step(step)
        if self._effort is not None:
            self._effort.step(self.rev, step, operation, actor, time_s)
        if self._journal.file.end > 2 * self.history_bytes:
            self._shorten()
        steps, seconds = self.rev - self._snapshot_rev, self.clock() - self._snapshot_s
        if steps >= SNAPSHOT_STEPS or seconds >= SNAPSHOT_S:
            self._snapshot()
        return operation

    def _shorten(self) -> None:
        """Remove the oldest operations, so that ``history_bytes`` of operations can be undone."""
        self.wait()
        reached = len(self.history.line.numbers)
        line, journal = self.history.line, self._journal
        found = RecoveredScene(self.draft, journal, line, self.rev, self._base)
        try:
            self._begin_anew(found)
        except OutputError as error:
            self.notes.append(f"The history could not be shortened: {error}.")
            return
        forgotten = reached - len(self.history.line.numbers)
        if forgotten:
            most = f"{self.history_bytes >> 20:,} MB"
            self.notes.append(
                f"The {forgotten} oldest edits cannot be undone: the history limit is {most}."
            )

    def _begin_anew(self, found: RecoveredScene) -> None:
        journal, line, rev = rewrite_journal(self.folder, found, self.history_bytes)
        self._take(replace(found, journal=journal, line=line, rev=rev))

    def _snapshot(self) -> None:
        """Write a snapshot in a thread. A failure is noted, and a later snapshot is tried."""
        self.wait()
        self._snapshot_rev, self._snapshot_s = self.rev, self.clock()
        self._writer = threading.Thread(target=self._write, args=(self.state(),))
        self._writer.start()

    def _write(self, state: State) -> None:
        try:
            write_state(snapshot_path(self.folder, state.rev, state.generation), state)
            _prune(self.folder, state.generation)
        except OutputError as error:
            self.notes.append(f"No snapshot was written: {error}. The journal contains all edits.")


def _take_lock(folder: Path) -> tuple[Lock | None, str]:
    """Return the lock of a document, or None and the reason why it is not available."""
    lock = Lock(folder / "lock")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except ConflictError:
        if not is_document(folder):
            raise
        return None, f"it {lock.conflict()}; close the scene there, then open it again"
    except (OutputError, OSError) as error:
        if not is_document(folder):
            raise OutputError(folder, f"cannot be created ({error})") from error
        return None, str(error)
    return lock, ""


def _lock_target(target: Path) -> Lock | None:
    """Acquire the lock of the folder that a scene is saved to, if it exists and is writable.

    Raises:
        ConflictError: If another process writes the folder.
    """
    if not target.is_dir():
        return None
    lock = Lock(target / LOCK_FILE)
    try:
        lock.acquire()
    except OutputError:
        return None
    return lock


def _release(lock: Lock, target: Lock | None) -> None:
    lock.release()
    if target is not None:
        target.remove()


def _prepare(
    folder: Path, source: Path | None, out: Path | None, opened: OpenedScene | None
) -> list[str]:
    """Repair the files of a document before it is read, and return notes for the user."""
    notes = []
    if is_document(folder) and saving.finish_interrupted_save(folder, read_identity(folder).target):
        notes.append("An interrupted save was completed.")
    if is_document(folder) and source is not None and source != folder:
        retired = retire_outdated(folder)
        notes += [retired] if retired else []
    if not is_document(folder):
        opened = opened or read_source(source, out)
        write_identity(folder, opened, generation_of(opened))
    return notes


def generation_of(opened: OpenedScene) -> str:
    """Return the name of the first journal generation of a scene: a hash of its cells."""
    held = (opened.grid.labels, opened.grid.instance, opened.grid.colour)
    return hashlib.sha256(b"".join(np_bytes.tobytes() for np_bytes in held)).hexdigest()[:8]


def _prune(folder: Path, generation: str) -> None:
    """Remove the old snapshots of a generation, except the newest and the first."""
    held = [path for path in snapshot_paths(folder) if path.stem.endswith(generation)]
    for path in held[MAX_SNAPSHOTS:-1]:
        path.unlink(missing_ok=True)


def _tidy(folder: Path) -> None:
    """Remove incomplete files left by a killed program."""
    for path in [*folder.glob(".*.npz.*"), *folder.glob(".*.json.*"), folder / "journal.new"]:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise OutputError(path, f"cannot be removed: {error.strerror or error}") from error

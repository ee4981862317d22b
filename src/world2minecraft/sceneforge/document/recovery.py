"""Recovery of a scene from its document: the newest intact snapshot, then the journal.

A record that was being written when the program ended is discarded. If bytes were damaged later,
the snapshots and the journal restore as much as possible, the damaged journal is set aside, and a
new journal is started.
"""

import hashlib
import os
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from world2minecraft.core.errors import ConflictError, DamagedFileError, InputError, OutputError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene import SceneDraft, Timeline
from world2minecraft.editing.scene.journal import UNDO, SceneJournal, Step
from world2minecraft.sceneforge.document.snapshots import (
    State,
    read_state,
    snapshot_path,
    snapshot_paths,
    write_state,
)

JOURNAL_FILE, BASE_FILE = "journal.bin", "base.npz"


@dataclass(frozen=True, eq=False)
class RecoveredScene:
    """A scene as restored from the files of its document.

    ``fault`` describes the damage to the journal, or is empty. ``lost`` is the number of steps that
    could not be restored.
    """

    draft: SceneDraft
    journal: SceneJournal
    line: Timeline
    rev: int
    base: State
    fault: str = ""
    lost: int = 0


def recover(folder: Path) -> RecoveredScene:
    """Restore the scene of a document without writing anything.

    Raises:
        InputError: If the document has no base snapshot.
        DamagedFileError: If none of its snapshots can be read.
    """
    base = _base(folder)
    journal, fault = _journal(folder, base)
    state = _newest(folder, journal, base)
    if state.generation != journal.generation:
        is_new = not journal.generation and state is base
        fault = fault or (
            "" if is_new else f"{journal.file.path} is missing or belongs to another scene"
        )
        return RecoveredScene(state.draft(), journal, Timeline(), state.rev, base, fault)
    steps = journal.steps[state.rev - journal.start :]
    if state.rev > journal.rev:
        fault = fault or f"{journal.file.path} is truncated: the latest edits are missing"
    draft, line, done, reason = _replay(state, journal, steps)
    fault = fault or reason
    line = _reachable(line, journal)
    return RecoveredScene(draft, journal, line, state.rev + done, base, fault, len(steps) - done)


def rewrite_journal(
    folder: Path, found: RecoveredScene, keep_bytes: int
) -> tuple[SceneJournal, Timeline, int]:
    """Start a new journal with the newest operations of an old journal.

    The snapshots of the new journal are written first, and then the new journal replaces the old
    one, so that either journal is intact if the program is killed.

    Args:
        folder: Folder of the document.
        found: The scene with its old journal. ``rev`` is its current revision.
        keep_bytes: Maximum size in bytes of the operations that can still be undone.

    Returns:
        The new journal, the operations that can be undone and redone, and the revision. The
        revision increases only if the old journal was damaged.

    Raises:
        OutputError: If the new journal cannot be written. The old journal then remains in use.
    """
    line = _trim_line(found.line, found.journal, keep_bytes)
    undone = len(line.numbers) - line.done
    rev = max(found.rev, len(line.numbers) + undone)
    generation = _next_generation(found.journal.generation, rev)
    operations = [found.journal.operation(number) for number in line.numbers]
    new = folder / "journal.new"
    new.unlink(missing_ok=True)
    journal = SceneJournal(new, found.draft.shape)
    start = rev - len(line.numbers) - undone
    first = SceneDraft(found.draft.grid(), found.draft.objects.values())
    for operation in reversed(operations[: line.done]):
        first.apply(operation.inverse())
    for draft, at, reach in ((first, start, Timeline()), (found.draft, rev, _renumber(line))):
        objects = tuple(draft.objects.values())
        fields = (found.base.scan_to_room, at, generation, reach)
        write_state(snapshot_path(folder, at, generation), State(draft.grid(), objects, *fields))
    journal.begin(generation, start)
    for operation in operations:
        journal.do(operation)
    for number in reversed(range(line.done, len(operations))):
        journal.undo(number)
    _put(new, folder / JOURNAL_FILE)
    journal.file.path = folder / JOURNAL_FILE
    for path in snapshot_paths(folder):
        if not path.stem.endswith(generation):
            path.unlink(missing_ok=True)
    return journal, _renumber(line), rev


def copy_damaged(path: Path) -> Path:
    """Copy a damaged file to another name and return the path of the copy.

    Raises:
        OutputError: If the copy cannot be written.
    """
    names = (path.with_name(f"{path.stem}-damaged-{n}{path.suffix}") for n in count(1))
    aside = next(path for path in names if not path.exists())
    try:
        try:
            os.link(path, aside)  # A link needs no space, even on a full disk.
        except OSError:
            shutil.copyfile(path, aside)
    except OSError as error:
        raise OutputError(aside, f"cannot be written: {error.strerror or error}") from error
    return aside


def _base(folder: Path) -> State:
    """Return the scene as it was first opened, or the newest snapshot if the base is damaged."""
    try:
        return read_state(folder / BASE_FILE)
    except InputError:
        for state in _states(folder, ""):
            return state
        raise


def _journal(folder: Path, base: State) -> tuple[SceneJournal, str]:
    """Return the journal and its damage, or an empty journal if it cannot be read."""
    path = folder / JOURNAL_FILE
    try:
        journal = SceneJournal(path, base.grid.shape)
    except (DamagedFileError, InputError) as error:
        return SceneJournal(folder / "no-journal", base.grid.shape), str(error)
    if journal.generation or not journal.steps:
        return journal, ""
    # Its first record is damaged: the snapshots tell what stood there.
    first = journal.steps.pop(0)
    states = [path.stem.split("-")[1:] for path in snapshot_paths(folder)]
    journal.generation = states[0][1] if states else base.generation
    if journal.generation != base.generation:
        journal.start = min(int(rev) for rev, name in states if name == journal.generation)
    return journal, f"{path} is damaged at byte {first.record.at}"


def _newest(folder: Path, journal: SceneJournal, base: State) -> State:
    """Return the newest readable state of the journal's generation, or else of any generation."""
    of_journal = [*_states(folder, journal.generation)] if journal.generation else []
    if not of_journal and journal.generation == base.generation:
        return base
    states = of_journal or [*_states(folder, "")]
    return states[0] if states else base


def _states(folder: Path, generation: str) -> Iterator[State]:
    """Yield the newest intact state of a generation, if there is one."""
    for path in snapshot_paths(folder):
        if generation and not path.stem.endswith(generation):
            continue
        try:
            yield read_state(path)
        except InputError:
            continue
        return


def _replay(
    state: State, journal: SceneJournal, steps: Sequence[Step]
) -> tuple[SceneDraft, Timeline, int, str]:
    """Apply steps again; return the scene, the line, the number of steps and the reason to stop."""
    draft, line = state.draft(), state.line
    for done, step in enumerate(steps):
        if not step.verb:
            where = f"{journal.file.path} is damaged at byte {step.record.at}"
            return draft, line, done, where
        try:
            line = journal.line_after(line, [step])
            draft.apply(_effect(journal, step))
        except (DamagedFileError, ConflictError) as error:
            return draft, line, done, str(error)
    holes = [step.record.at for step in journal.steps if not step.verb]
    fault = f"{journal.file.path} is damaged at byte {holes[0]}" if holes else ""
    return draft, line, len(steps), fault


def _effect(journal: SceneJournal, step: Step) -> Operation:
    operation = journal.operation(step.number)
    return operation.inverse() if step.verb == UNDO else operation


def _reachable(line: Timeline, journal: SceneJournal) -> Timeline:
    """Return the part of a line around the current position whose operations are available."""
    missing = [at for at, number in enumerate(line.numbers) if not journal.bytes_of(number)]
    first = max((at + 1 for at in missing if at < line.done), default=0)
    last = min((at for at in missing if at >= line.done), default=len(line.numbers))
    return line.within(first, last)


def _trim_line(line: Timeline, journal: SceneJournal, keep_bytes: int) -> Timeline:
    """Return a line without its oldest operations, limited to a number of bytes."""
    first, held = len(line.numbers), 0
    while first > 0 and held + journal.bytes_of(line.numbers[first - 1]) <= keep_bytes:
        first -= 1
        held += journal.bytes_of(line.numbers[first])
    return line.within(min(first, line.done), len(line.numbers))


def _renumber(line: Timeline) -> Timeline:
    return line._replace(numbers=tuple(range(len(line.numbers))))


def _next_generation(generation: str, rev: int) -> str:
    return hashlib.sha256(f"{generation} {rev}".encode()).hexdigest()[:8]


def _put(path: Path, place: Path) -> None:
    try:
        path.replace(place)
    except OSError as error:
        raise OutputError(place, f"cannot be written: {error.strerror or error}") from error

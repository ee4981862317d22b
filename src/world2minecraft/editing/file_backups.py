"""Replacement of world files with backups, so that any step can be undone byte by byte.

A step is stored in ``WORLD/w2m_undo/0001``: the original files in ``old/``, the new files in
``new/``, their names and checksums in ``manifest.json``, and the changed blocks in
``edit.journal``. No world file is touched before the manifest exists. Then each file is replaced by
one rename, and the manifest is marked ``done``. If the program is killed at any point, either
nothing has been touched or the manifest states what to restore, which the next command does
(``recover``).
"""

import hashlib
import os
import re
import shutil
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import (
    MALFORMED,
    ConflictError,
    DamagedFileError,
    InputError,
    OutputError,
    UsageError,
)
from world2minecraft.core.files import read_bytes, read_json, write_bytes, write_json
from world2minecraft.core.types import BlockEdit
from world2minecraft.core.whole_reads import changing, remove_mark
from world2minecraft.editing.journal import write_journal
from world2minecraft.minecraft.worlds.level_dat import UNDO_FOLDER as FOLDER
from world2minecraft.minecraft.worlds.session_lock import session_lock

MANIFEST, JOURNAL = "manifest.json", "edit.journal"
PREPARED, DONE, UNDOING = "prepared", "done", "undoing"
MAX_FILE_BYTES = 512 << 20
SPARE_BYTES = 16 << 20
# The files that a step may change. A manifest in an untrusted world could name any file.
_ALLOWED = re.compile(
    r"(dimensions/minecraft/overworld/)?(region|entities)/(r\.-?\d{1,7}\.-?\d{1,7}\.mca"
    r"|c\.-?\d{1,8}\.-?\d{1,8}\.mcc)|datapacks/player_size\.zip"
)


@dataclass(frozen=True)
class FileChange:
    """A file changed by a step: its path in the world and its SHA-256 checksums.

    Attributes:
        path: Path of the file relative to the world folder.
        before: Checksum before the step. None if the file did not exist.
        after: Checksum after the step. None if the step removed the file.
        mode: Original file permissions.
        time_ns: Original modification time in nanoseconds.
    """

    path: str
    before: str | None
    after: str | None
    mode: int = 0o644
    time_ns: int = 0


@dataclass(frozen=True)
class Step:
    """A step applied to a world, as described by its manifest.

    Attributes:
        folder: Folder of the step in the world.
        state: ``prepared``, ``done`` or ``undoing``.
        what: Description of the step.
        files: Changed files.
        made: Folders that the step created.
    """

    folder: Path
    state: str
    what: str
    files: tuple[FileChange, ...]
    made: tuple[str, ...]

    @property
    def world(self) -> Path:
        """The folder of the world that the step changed."""
        return self.folder.parent.parent


def list_steps(world: Path) -> list[Step]:
    """Return the steps that can be undone, oldest first.

    Raises:
        DamagedFileError: If a manifest is invalid or names files that no step may change.
    """
    folders = sorted(
        path for path in (world / FOLDER).glob("[0-9]*") if (path / MANIFEST).is_file()
    )
    return [_read_step(folder) for folder in folders]


def last_step(world: Path) -> Step:
    """Return the last step that can be undone.

    Raises:
        UsageError: If there is no step to undo.
        DamagedFileError: If a manifest is invalid or names files that no step may change.
    """
    steps = list_steps(world)
    if not steps:
        raise UsageError(f"{world}: no build by World2Minecraft to undo")
    return steps[-1]


def commit_step(
    world: Path,
    files: Mapping[str, bytes | None],
    what: str,
    edit: BlockEdit | None = None,
) -> Step | None:
    """Replace files of a world atomically, and return the step, or None if nothing changes.

    The caller must hold the lock of the world and must have called ``recover``.

    Args:
        world: World folder.
        files: New contents by path in the world, with ``/`` as separator. None removes a file.
        what: Description of the step for the list of steps.
        edit: Changed blocks to record with the step.

    Raises:
        OutputError: If a file cannot be written. The world is then unchanged.
    """
    touched = [_describe_change(world, path, data) for path, data in sorted(files.items())]
    wanted = [entry for entry in touched if entry.before != entry.after]
    if not wanted:
        return None
    folder = world / FOLDER / f"{_next_number(world):04d}"
    made = {str(p.as_posix()) for entry in wanted for p in _missing_folders(world, entry.path)}
    step = Step(folder, PREPARED, what, tuple(wanted), tuple(sorted(made)))
    try:
        _check_space(world, step, files)
        _prepare(step, files, edit)
    except (OSError, InputError) as error:
        _forget(step)
        raise _as_output_error(world, error) from error
    try:
        with changing(world, "changed"):
            for number, entry in enumerate(step.files):
                _exchange(step, number, entry)
    except OSError as error:
        _restore(step)
        raise _as_output_error(world, error) from error
    return _mark(step, DONE)


def recover(world: Path) -> list[Step]:
    """Undo all interrupted steps and return them.

    Raises:
        ConflictError: If the world has changed since a step was interrupted.
    """
    for folder in sorted((world / FOLDER).glob("[0-9]*")):
        if not (folder / MANIFEST).is_file():  # Cut off before it touched anything.
            shutil.rmtree(folder, ignore_errors=True)
    cut_off = [step for step in list_steps(world) if step.state != DONE]
    for step in reversed(cut_off):
        changed = changed_since(step)
        if changed:
            reason = f"{changed[0]} has changed since a build was interrupted"
            raise ConflictError(world, f"{reason}; restore the old files with w2m undo --force")
        _restore(step)
    remove_mark(world)  # Of a process that was killed when all its files were in place.
    with suppress(OSError):
        (world / FOLDER).rmdir()  # Where it is empty.
    return cut_off


def changed_since(step: Step) -> list[str]:
    """Return the files that match neither the state before the step nor the state after it."""
    return [
        entry.path
        for entry in step.files
        if _checksum(step.world / entry.path)
        not in ((entry.after,) if step.state == DONE else (entry.before, entry.after))
    ]


def previous_data_packs(step: Step) -> dict[str, bytes | None]:
    """Return the previous contents of the data packs that a step changed.

    Data packs that have changed since the step are omitted. None means that the data pack did not
    exist.

    Raises:
        InputError: If a backup cannot be read.
    """
    found: dict[str, bytes | None] = {}
    for number, entry in enumerate(step.files):
        is_ours = entry.path.startswith("datapacks/")
        if is_ours and _checksum(step.world / entry.path) == entry.after:
            copy = step.folder / "old" / str(number)
            found[entry.path] = read_bytes(copy, MAX_FILE_BYTES) if entry.before else None
    return found


def revert_step(step: Step) -> None:
    """Restore all files that a step changed, and delete the step.

    Raises:
        DamagedFileError: If a backup does not match its checksum. Nothing is changed then.
        OutputError: If a file cannot be written. The next attempt continues.
    """
    _check_backups(step)
    try:
        _restore(_mark(step, UNDOING))
    except OSError as error:
        raise _as_output_error(step.world, error) from error
    with suppress(OSError):
        (step.world / FOLDER).rmdir()


def revert_last_step(world: Path, force: bool = False) -> Step:
    """Undo the last step, or an interrupted step, by restoring its files, and return the step.

    Args:
        world: World folder. Its lock is held during the operation.
        force: Also restore files that have changed since the step.

    Raises:
        UsageError: If there is no step to undo.
        ConflictError: If a file has changed since the step and ``force`` is False.
    """
    with session_lock(world):
        cut_off = [step for step in list_steps(world) if step.state != DONE]
        if cut_off and force:
            revert_step(cut_off[-1])
        elif cut_off:
            recover(world)
        if cut_off:
            return cut_off[-1]
        step = last_step(world)
        changed = changed_since(step)
        if changed and not force:
            reason = (
                f"{changed[0]} has changed since the build; pass blocks (--blocks) to undo only "
                "the build"
            )
            raise ConflictError(world, f"{reason}, or force (--force) to restore the old files")
        revert_step(step)
        return step


def discard_step(step: Step) -> None:
    """Delete the backup of a step, keeping its changes to the world."""
    _forget(step)
    with suppress(OSError):
        (step.world / FOLDER).rmdir()


def _prepare(step: Step, files: Mapping[str, bytes | None], edit: BlockEdit | None) -> None:
    for number, entry in enumerate(step.files):
        source, data = step.world / entry.path, files[entry.path]
        if entry.before is not None:
            old = read_bytes(source, MAX_FILE_BYTES)
            if hashlib.sha256(old).hexdigest() != entry.before:
                raise ConflictError(source, "changed during the backup; try again")
            write_bytes(step.folder / "old" / str(number), old)
        if data is not None:
            staged = step.folder / "new" / str(number)
            write_bytes(staged, data)
            os.chmod(staged, entry.mode)
    if edit is not None:
        write_journal(step.folder / JOURNAL, [edit])
    _mark(step, PREPARED)


def _exchange(step: Step, number: int, entry: FileChange) -> None:
    target = step.world / entry.path
    if entry.after is None:
        target.unlink(missing_ok=True)
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    os.replace(step.folder / "new" / str(number), target)


def _restore(step: Step) -> None:
    with changing(step.world, "changed"):
        for number, entry in reversed([*enumerate(step.files)]):
            target = step.world / entry.path
            if entry.before is None:
                target.unlink(missing_ok=True)
            elif _checksum(target) != entry.before:
                copy = step.folder / "old" / str(number)
                os.chmod(copy, entry.mode)
                os.utime(copy, ns=(entry.time_ns, entry.time_ns))
                os.replace(copy, target)  # Cut off after this, the file is as it was before.
    for name in sorted(step.made, reverse=True):
        with suppress(OSError):
            (step.world / name).rmdir()  # Where nothing came into it since.
    _forget(step)


def _forget(step: Step) -> None:
    (step.folder / MANIFEST).unlink(missing_ok=True)  # First: without it the rest is no step.
    shutil.rmtree(step.folder, ignore_errors=True)
    with suppress(OSError):
        step.folder.parent.rmdir()


def _check_backups(step: Step) -> None:
    for number, entry in enumerate(step.files):
        copy, target = step.folder / "old" / str(number), step.world / entry.path
        if entry.before is None or (not copy.exists() and _checksum(target) == entry.before):
            continue
        if _checksum(copy) != entry.before:
            raise DamagedFileError(copy, f"does not match the recorded checksum of {entry.path}")


def _mark(step: Step, state: str) -> Step:
    marked = replace(step, state=state)
    entries = [vars(entry) for entry in step.files]
    content = {"state": state, "what": step.what, "files": entries, "made": list(step.made)}
    write_json(step.folder / MANIFEST, content)
    return marked


def _read_step(folder: Path) -> Step:
    path = folder / MANIFEST
    raw = read_json(path, 16 << 20)
    try:
        files = tuple(FileChange(**entry) for entry in raw["files"])
        step = Step(folder, str(raw["state"]), str(raw["what"]), files, tuple(raw["made"]))
        for entry in files:
            _check_path(step.world, entry.path, path)
            if entry.mode & ~0o777 or abs(entry.time_ns) >> 63:
                raise ValueError(f"invalid permissions or time of {entry.path}")
        for name in step.made:
            if name not in ("region", "entities", "datapacks") and not re.fullmatch(
                r"dimensions(/minecraft(/overworld(/(region|entities))?)?)?", name
            ):
                raise ValueError(f"unexpected folder {name!r}")
    except MALFORMED as error:
        raise DamagedFileError(path, f"is not a valid manifest ({error})") from error
    return step


def _check_path(world: Path, name: Any, manifest: Path) -> None:
    """Raise DamagedFileError for a file that no step may change, or a link to outside the world."""
    if not isinstance(name, str) or not _ALLOWED.fullmatch(name):
        raise DamagedFileError(manifest, f"contains the unexpected file name {name!r}")
    if not (world / name).resolve().is_relative_to(world.resolve()):
        raise DamagedFileError(manifest, f"contains {name}, which is a link to outside the world")


def _describe_change(world: Path, name: str, data: bytes | None) -> FileChange:
    _check_path(world, name, world / name)
    path = world / name
    after = None if data is None else hashlib.sha256(data).hexdigest()
    if not path.exists():
        return FileChange(name, None, after)
    stat = path.stat()
    return FileChange(name, _checksum(path), after, stat.st_mode & 0o777, stat.st_mtime_ns)


def _checksum(path: Path) -> str | None:
    if not path.is_file():
        return None
    return hashlib.sha256(read_bytes(path, MAX_FILE_BYTES)).hexdigest()


def _missing_folders(world: Path, name: str) -> list[Path]:
    parents = [parent for parent in Path(name).parents if parent != Path(".")]
    return [parent for parent in parents if not (world / parent).exists()]


def _next_number(world: Path) -> int:
    numbers = [int(p.name) for p in (world / FOLDER).glob("[0-9]*") if p.name.isdecimal()]
    return max(numbers, default=0) + 1


def _check_space(world: Path, step: Step, files: Mapping[str, bytes | None]) -> None:
    old = sum((world / e.path).stat().st_size for e in step.files if e.before is not None)
    needed = old + sum(len(files[e.path] or b"") for e in step.files) + SPARE_BYTES
    free = shutil.disk_usage(world).free
    if free < needed:
        mb = f"the disk has {free >> 20} MB free; {needed >> 20} MB are needed for the backup"
        raise OutputError(world, mb)


def _as_output_error(world: Path, error: Exception) -> OutputError:
    if isinstance(error, InputError):
        return OutputError(world, error.reason)
    reason = getattr(error, "strerror", None) or str(error)
    return OutputError(world, f"cannot be changed ({reason}); nothing was modified")

"""Replacement of files of a world with backups, so that any step can be undone byte by byte.

A step lies in ``WORLD/w2m_undo/0001``: ``old/`` the files before it, ``new/`` the files to come,
``manifest.json`` their names and checksums, ``edit.journal`` the blocks. Nothing of the world is
touched before the manifest exists; then each file is exchanged by one rename; then the manifest is
marked ``done``. Whenever the program is killed, either nothing was touched or the manifest states
what to restore, and the next command does so (``recover``).
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
    ConflictError,
    DamagedFileError,
    InputError,
    OutputError,
    UsageError,
)
from world2minecraft.core.files import read_bytes, read_json, write_bytes, write_json
from world2minecraft.core.types import BlockEdit
from world2minecraft.editing.journal import write_journal
from world2minecraft.minecraft.worlds.level_dat import UNDO_FOLDER as FOLDER
from world2minecraft.minecraft.worlds.session_lock import session_lock

MANIFEST, JOURNAL = "manifest.json", "edit.journal"
PREPARED, DONE, UNDOING = "prepared", "done", "undoing"
MAX_FILE_BYTES = 512 << 20
SPARE_BYTES = 16 << 20
# What a step may touch: a manifest in a world from elsewhere could name any file.
_ALLOWED = re.compile(
    r"(dimensions/minecraft/overworld/)?(region|entities)/(r\.-?\d{1,7}\.-?\d{1,7}\.mca"
    r"|c\.-?\d{1,8}\.-?\d{1,8}\.mcc)|datapacks/player_size\.zip"
)


@dataclass(frozen=True)
class FileChange:
    """One file of a step: its path in the world and the SHA-256 before and after, None for none."""

    path: str
    before: str | None
    after: str | None
    mode: int = 0o644
    time_ns: int = 0


@dataclass(frozen=True)
class Step:
    """A step that was done to a world, as its manifest describes it."""

    folder: Path
    state: str
    what: str
    files: tuple[FileChange, ...]
    made: tuple[str, ...]  # Folders that were not there before.

    @property
    def world(self) -> Path:
        """The world that it was done to."""
        return self.folder.parent.parent


def list_steps(world: Path) -> list[Step]:
    """Return the steps that can be taken back, the first one first.

    Raises:
        DamagedFileError: a manifest is none, or names files that no step touches.
    """
    folders = sorted(
        path for path in (world / FOLDER).glob("[0-9]*") if (path / MANIFEST).is_file()
    )
    return [_read_step(folder) for folder in folders]


def commit_step(
    world: Path,
    files: Mapping[str, bytes | None],
    what: str,
    edit: BlockEdit | None = None,
) -> Step | None:
    """Exchange files of a world, whole or not at all; return the step, or None for no change.

    The caller holds the world's lock and has called ``recover``.

    Args:
        world: its folder.
        files: the new bytes by path in the world, with ``/``; None removes a file.
        what: a line for whoever lists the steps.
        edit: the blocks that change, kept with the step.

    Raises:
        OutputError: a file cannot be written; then the world is as it was.
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
        for number, entry in enumerate(step.files):
            _exchange(step, number, entry)
    except OSError as error:
        _restore(step)
        raise _as_output_error(world, error) from error
    return _mark(step, DONE)


def recover(world: Path) -> list[Step]:
    """Bring back what steps that were cut off had touched; return those steps.

    Raises:
        ConflictError: the world was changed since one of them was cut off.
    """
    for folder in sorted((world / FOLDER).glob("[0-9]*")):
        if not (folder / MANIFEST).is_file():  # Cut off before it touched anything.
            shutil.rmtree(folder, ignore_errors=True)
    cut_off = [step for step in list_steps(world) if step.state != DONE]
    for step in reversed(cut_off):
        changed = changed_since(step)
        if changed:
            reason = f"{changed[0]} was changed after a step on it was cut off"
            raise ConflictError(world, f"{reason}; w2m undo --force brings back what was before")
        _restore(step)
    with suppress(OSError):
        (world / FOLDER).rmdir()  # Where it is empty.
    return cut_off


def changed_since(step: Step) -> list[str]:
    """Return the files that are neither as the step left them nor as they were before it."""
    return [
        entry.path
        for entry in step.files
        if _checksum(step.world / entry.path)
        not in ((entry.after,) if step.state == DONE else (entry.before, entry.after))
    ]


def previous_data_packs(step: Step) -> dict[str, bytes | None]:
    """Return what a step's files beside the regions were before it, where they are as it left them.

    Raises:
        InputError: a backup cannot be read.
    """
    found: dict[str, bytes | None] = {}
    for number, entry in enumerate(step.files):
        is_ours = entry.path.startswith("datapacks/")
        if is_ours and _checksum(step.world / entry.path) == entry.after:
            copy = step.folder / "old" / str(number)
            found[entry.path] = read_bytes(copy, MAX_FILE_BYTES) if entry.before else None
    return found


def revert_step(step: Step) -> None:
    """Bring back every byte that a step changed, and forget the step.

    Raises:
        DamagedFileError: a backup is not what its checksum says; then nothing is changed.
        OutputError: a file cannot be written; the next try goes on.
    """
    _check_backups(step)
    try:
        _restore(_mark(step, UNDOING))
    except OSError as error:
        raise _as_output_error(step.world, error) from error
    with suppress(OSError):
        (step.world / FOLDER).rmdir()


def revert_last_step(world: Path, force: bool = False) -> Step:
    """Restore the files of the last step, or of one that was interrupted; return that step.

    Args:
        world: its folder; its lock is held meanwhile.
        force: restore files that were changed since, too.

    Raises:
        UsageError: there is no step. ConflictError: a file was changed since, without ``force``.
    """
    with session_lock(world):
        cut_off = [step for step in list_steps(world) if step.state != DONE]
        if cut_off and force:
            revert_step(cut_off[-1])
        elif cut_off:
            recover(world)
        if cut_off:
            return cut_off[-1]
        steps = list_steps(world)
        if not steps:
            raise UsageError(f"{world}: no build by World2Minecraft to undo")
        changed = changed_since(steps[-1])
        if changed and not force:
            reason = f"{changed[0]} has been saved since; add --blocks to undo the build alone"
            raise ConflictError(world, f"{reason}, or --force to restore the old files")
        revert_step(steps[-1])
        return steps[-1]


def discard_step(step: Step) -> None:
    """Remove a step's backup; the world keeps what the step did."""
    _forget(step)
    with suppress(OSError):
        (step.world / FOLDER).rmdir()


def _prepare(step: Step, files: Mapping[str, bytes | None], edit: BlockEdit | None) -> None:
    for number, entry in enumerate(step.files):
        source, data = step.world / entry.path, files[entry.path]
        if entry.before is not None:
            old = read_bytes(source, MAX_FILE_BYTES)
            if hashlib.sha256(old).hexdigest() != entry.before:
                raise ConflictError(source, "changes while it is backed up; try again")
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
            raise DamagedFileError(copy, f"is not the backup of {entry.path} that it says")


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
        for name in step.made:
            if name not in ("region", "entities", "datapacks") and not re.fullmatch(
                r"dimensions(/minecraft(/overworld(/(region|entities))?)?)?", name
            ):
                raise ValueError(f"a folder {name!r}")
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"is no manifest of a step ({error})") from error
    return step


def _check_path(world: Path, name: Any, manifest: Path) -> None:
    """Refuse a file that is none of those that steps touch, or lies elsewhere by a link."""
    if not isinstance(name, str) or not _ALLOWED.fullmatch(name):
        raise DamagedFileError(manifest, f"names {name!r}, which no step touches")
    if not (world / name).resolve().is_relative_to(world.resolve()):
        raise DamagedFileError(manifest, f"names {name}, which is a link out of the world")


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
        mb = f"its disk has {free >> 20} MB free; {needed >> 20} are needed with the backup"
        raise OutputError(world, mb)


def _as_output_error(world: Path, error: Exception) -> OutputError:
    if isinstance(error, InputError):
        return OutputError(world, error.reason)
    reason = getattr(error, "strerror", None) or str(error)
    return OutputError(world, f"cannot be changed ({reason}); it is as it was")

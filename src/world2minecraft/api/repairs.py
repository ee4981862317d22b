"""Repair built rooms, list the repairs, and undo or redo each of them."""

from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.classes import display_name
from world2minecraft.core.errors import ConflictError, InputError, OutputError
from world2minecraft.core.locks import folder_lock

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockEdit
    from world2minecraft.editing.volume_draft import History


@dataclass(frozen=True)
class Repair:
    """One repair of a build.

    Attributes:
        number: Number of the repair within the build, starting at 1.
        kind: Type of the repair, such as ``fill``, ``move`` or ``drop``.
        subject: Class and object id of the repaired object, such as ``chair 1``.
        blocks: Number of blocks that the repair changed.
        corner: Minimum x, y and z of the changed blocks in the world.
        reason: Why the repair was made.
        is_done: Whether the repair is in effect. False after it has been undone.
    """

    number: int
    kind: str
    subject: str
    blocks: int
    corner: tuple[int, int, int]
    reason: str
    is_done: bool = True


def repair(
    source: Run | str | Path, *, only: Sequence[str] = (), dry_run: bool = False
) -> list[Repair]:
    """Repair floating blocks, holes in walls and furniture that intersects a wall in a built room.

    Builds are repaired automatically unless the setting ``mend`` is off, so this function repairs
    faults introduced by later edits. Each repair is recorded in ``build/edits.journal``. The world
    and the additional file formats are then rewritten.

    Args:
        source: Run, run folder, or its ``build`` folder.
        only: Rules to apply: ``trim``, ``see_through``, ``holes``, ``floating`` and ``steady``.
            Defaults to all rules.
        dry_run: Return the repairs without changing the build.

    Returns:
        The new repairs.

    Raises:
        UnknownNameError: If a rule is unknown.
        InputError: If the source contains no build.
        OutputError: If the world has been played in.
        ConflictError: If the journal belongs to another build, or another process writes the run.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.repair(run, only=["holes"], dry_run=True)
        []
    """
    from world2minecraft.editing.cleanup.passes import RULES, repair_volume

    build = _build_folder(path_of(source))
    with nullcontext() if dry_run else _lock_of(build):
        history = _open_history(build)
        if not dry_run:
            _check_unplayed(build / "world")  # Before any edit is recorded.
        edits = repair_volume(history.volume, tuple(only or RULES))[1]
        first = 0 if dry_run else len(history.journal.edits)
        if edits and not dry_run:
            for edit in edits:
                history.do(edit)
            _rewrite_build(build, history)
    return [_repair_of(number, edit) for number, edit in enumerate(edits, first + 1)]


def list_repairs(source: Run | str | Path) -> list[Repair]:
    """Return all repairs of a build, including those that have been undone.

    Raises:
        InputError: If the source contains no build.
        ConflictError: If the journal belongs to another build.

    Example:
        >>> from world2minecraft.api.repairs import list_repairs
        >>> all(one.is_done for one in list_repairs(run))
        True
    """
    journal = _open_history(_build_folder(path_of(source))).journal
    rows = zip(journal.edits, journal.is_done, strict=True)
    return [_repair_of(number, edit, done) for number, (edit, done) in enumerate(rows, 1)]


def undo_repair(source: Run | str | Path, number: int | None = None) -> int:
    """Undo one repair or all repairs, and return the number of repairs undone.

    Args:
        source: Run, run folder, or its ``build`` folder.
        number: Number of the repair to undo. None undoes all repairs.

    Raises:
        UsageError: If the repair does not exist.
        ConflictError: If a later repair changed the same blocks, or another process writes the run.
        InputError: If the source contains no build.
        OutputError: If the world has been played in.
    """
    build = _build_folder(path_of(source))
    with _lock_of(build):
        history = _open_history(build)
        _check_unplayed(build / "world")
        count = sum(history.journal.is_done) if number is None else 1
        for _ in range(count):
            history.undo(None if number is None else number - 1)
        _rewrite_build(build, history)
    return count


def redo_repair(source: Run | str | Path, number: int) -> None:
    """Redo a repair that has been undone.

    Args:
        source: Run, run folder, or its ``build`` folder.
        number: Number of the repair to redo.

    Raises:
        UsageError: If the repair has not been undone.
        ConflictError: If a later repair changed the same blocks, or another process writes the run.
        InputError: If the source contains no build.
        OutputError: If the world has been played in.
    """
    build = _build_folder(path_of(source))
    with _lock_of(build):
        history = _open_history(build)
        _check_unplayed(build / "world")
        history.redo(number - 1)
        _rewrite_build(build, history)


def world_of(source: Run | str | Path) -> Path:
    """Return the world folder of a build.

    Raises:
        InputError: If the source contains no build.
    """
    return _build_folder(path_of(source)) / "world"


def _repair_of(number: int, edit: "BlockEdit", is_done: bool = True) -> Repair:
    subject = "" if edit.class_id is None else display_name(edit.class_id)
    x, y, z = edit.cells.min(axis=0).tolist()
    return Repair(
        number,
        edit.kind,
        f"{subject} {edit.instance}" if edit.instance else subject,
        len(edit.cells),
        (x, y, z),
        edit.reason,
        is_done,
    )


def _build_folder(source: Path) -> Path:
    """Return the build folder of a run.

    Raises:
        InputError: If the source contains no build.
    """
    for folder in (source / "build", source):
        if (folder / "scene.json").is_file():
            return folder
    raise InputError(
        source, "does not contain a build (build/scene.json); create one with w2m build"
    )


def _lock_of(build: Path) -> AbstractContextManager[object]:
    """Return the lock of the run that a build belongs to."""
    return folder_lock(build.parent if build.name == "build" else build, "repaired")


def _check_unplayed(world: Path) -> None:
    """Raise OutputError if the game has saved a world since it was built."""
    from world2minecraft.minecraft.worlds.level_dat import MAKER, MAKER_TAG
    from world2minecraft.minecraft.worlds.world_reader import read_level

    if read_level(world).get(MAKER_TAG) != MAKER:
        reason = "has been played in or was not created by World2Minecraft"
        raise OutputError(world, f"{reason}; build the room again in another output folder")


def _open_history(build: Path) -> "History":
    """Return the blocks of a build with its recorded edits.

    Raises:
        ConflictError: If the edits belong to another build.
        InputError: If a file cannot be read.
    """
    from world2minecraft.editing.journal import EDITS_FILE, Journal
    from world2minecraft.editing.volume_draft import History
    from world2minecraft.evaluation.report.finished_run import read_built

    volume = read_built(build)
    try:
        return History(volume, Journal(build / EDITS_FILE))
    except ConflictError as error:
        reason = f"does not belong to the build in this folder ({error.reason})"
        raise ConflictError(
            build / EDITS_FILE, f"{reason}; delete this file or build the room again"
        ) from error


def _rewrite_build(build: Path, history: "History") -> None:
    """Write a build with changed blocks, keeping the name of its world."""
    from world2minecraft.construction import WORLD_NAME, write_build
    from world2minecraft.core.files import read_json
    from world2minecraft.core.whole_reads import changing
    from world2minecraft.formats.object_names import read_world_names
    from world2minecraft.formats.world_labels import read_scene
    from world2minecraft.minecraft.worlds.world_reader import read_level
    from world2minecraft.reconstruction.file_stages import write_further_forms
    from world2minecraft.reconstruction.parameters import Parameters

    name, version = read_level(build / "world").get("LevelName"), read_scene(build).mc_version
    objects = read_world_names(build)
    title = str(name or WORLD_NAME)
    with changing(build.parent, "repaired"), changing(build, "repaired"):
        write_build(build, history.volume, mc_version=version, name=title, objects=objects)
        if (build / "forms.json").is_file():
            formats = ",".join(read_json(build / "forms.json"))
            chosen = Parameters(formats=formats, mc_version=version)
            write_further_forms(build.parent, history.volume, chosen)

"""Repairs of a built room: run them, list them, undo and redo each."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.classes import display_name
from world2minecraft.core.errors import ConflictError, InputError, OutputError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockEdit
    from world2minecraft.editing.volume_draft import History


@dataclass(frozen=True)
class Repair:
    """One repair of a build.

    Attributes:
        number: its number in the build, from 1.
        kind: what was done: ``fill``, ``move``, ``drop`` ...
        subject: the class of what was repaired and its object id, such as ``chair 1``.
        blocks: how many blocks it changed.
        corner: the lowest x, y and z of these blocks in the world.
        reason: why it was made.
        is_done: False where it was undone.
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
    """Repair a built room: floating blocks, holes in walls, furniture that intersects a wall.

    Every build is repaired already, unless the setting ``mend`` is off; this repairs what edits
    have left. Each repair is recorded in ``build/edits.journal``. The world and its further
    formats are written again.

    Args:
        source: a run, its folder, or the ``build`` folder in it.
        only: the rules to apply: ``trim``, ``see_through``, ``holes``, ``floating``, ``steady``;
            all by default.
        dry_run: return the repairs, and change nothing.

    Returns:
        The new repairs.

    Raises:
        UnknownNameError: a rule is not known. InputError: there is no build.
        OutputError: the world was played in. ConflictError: the journal is of another build.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.repair(run, only=["holes"], dry_run=True)
        []
    """
    from world2minecraft.editing.cleanup.passes import RULES, repair_volume

    build = _build_folder(path_of(source))
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
    """Return the repairs of a build, those that were undone too.

    Raises:
        InputError: there is no build. ConflictError: the journal is of another build.

    Example:
        >>> from world2minecraft.api.repairs import list_repairs
        >>> all(one.is_done for one in list_repairs(run))
        True
    """
    journal = _open_history(_build_folder(path_of(source))).journal
    rows = zip(journal.edits, journal.is_done, strict=True)
    return [_repair_of(number, edit, done) for number, (edit, done) in enumerate(rows, 1)]


def undo_repair(source: Run | str | Path, number: int | None = None) -> int:
    """Undo the repair of a number, or all of them; return how many were undone.

    Raises:
        UsageError: there is no such repair. ConflictError: a later one changed the same blocks.
        InputError: there is no build. OutputError: the world was played in.
    """
    build = _build_folder(path_of(source))
    history = _open_history(build)
    _check_unplayed(build / "world")
    count = sum(history.journal.is_done) if number is None else 1
    for _ in range(count):
        history.undo(None if number is None else number - 1)
    _rewrite_build(build, history)
    return count


def redo_repair(source: Run | str | Path, number: int) -> None:
    """Make the repair of a number again, after it was undone.

    Raises:
        UsageError: it was not undone. ConflictError: a later one changed the same blocks.
        InputError: there is no build. OutputError: the world was played in.
    """
    build = _build_folder(path_of(source))
    history = _open_history(build)
    _check_unplayed(build / "world")
    history.redo(number - 1)
    _rewrite_build(build, history)


def world_of(source: Run | str | Path) -> Path:
    """Return the world of a build. Raises InputError where there is no build."""
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
    """Return the build folder of a run. Raises InputError where there is none."""
    for folder in (source / "build", source):
        if (folder / "scene.json").is_file():
            return folder
    raise InputError(source, "holds no build (build/scene.json); build one with w2m build")


def _check_unplayed(world: Path) -> None:
    """Raise OutputError where the game has saved a world since it was built."""
    from world2minecraft.minecraft.worlds.level_dat import MAKER, MAKER_TAG
    from world2minecraft.minecraft.worlds.world_reader import read_level

    if read_level(world).get(MAKER_TAG) != MAKER:
        reason = "holds a world that has been played in or made elsewhere"
        raise OutputError(world, f"{reason}; build it again to another --out, and repair that")


def _open_history(build: Path) -> "History":
    """Return the blocks of a build with the edits made to them.

    Raises:
        ConflictError: the edits are those of another build. InputError: a file cannot be read.
    """
    from world2minecraft.editing.journal import EDITS_FILE, Journal
    from world2minecraft.editing.volume_draft import History
    from world2minecraft.evaluation.report.finished_run import read_built

    volume = read_built(build)
    try:
        return History(volume, Journal(build / EDITS_FILE))
    except ConflictError as error:
        reason = f"belongs to another build than the one beside it ({error.reason})"
        raise ConflictError(build / EDITS_FILE, f"{reason}; remove it, or build again") from error


def _rewrite_build(build: Path, history: "History") -> None:
    """Write a build with other blocks in it, under the name that its world has."""
    from world2minecraft.construction import WORLD_NAME, write_build
    from world2minecraft.core.files import read_json
    from world2minecraft.formats.world_labels import read_scene
    from world2minecraft.minecraft.worlds.world_reader import read_level
    from world2minecraft.reconstruction.file_stages import write_further_forms
    from world2minecraft.reconstruction.parameters import Parameters

    name, version = read_level(build / "world").get("LevelName"), read_scene(build).mc_version
    write_build(build, history.volume, mc_version=version, name=str(name or WORLD_NAME))
    if (build / "forms.json").is_file():
        formats = ",".join(read_json(build / "forms.json"))
        chosen = Parameters(formats=formats, mc_version=version)
        write_further_forms(build.parent, history.volume, chosen)

"""``w2m clean``: mend a built room as a person would, and take any mend back."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import ConflictError, InputError, OutputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockEdit
    from world2minecraft.editing.volume_draft import History

EXAMPLES = """\
w2m clean OUT                  mend what is left to mend
w2m clean OUT --list           what was mended, when it was built and since
w2m clean OUT --undo 3         take the third mend back
w2m clean OUT --undo-all       the room as it was built
w2m clean OUT --dry-run        what would be mended
"""

Undo = Annotated[
    int | None,
    typer.Option("--undo", metavar="N", min=1, help="Take back the mend of this number."),
]
Redo = Annotated[
    int | None,
    typer.Option("--redo", metavar="N", min=1, help="Do a mend that was taken back again."),
]


def run(
    source: Annotated[
        Path, typer.Argument(metavar="OUT", help="A run's folder, or the build folder in it.")
    ],
    list_: Annotated[bool, typer.Option("--list", help="List the mends; change nothing.")] = False,
    undo: Undo = None,
    undo_all: Annotated[bool, typer.Option("--undo-all", help="Take back all mends.")] = False,
    redo: Redo = None,
    only: Annotated[
        list[str] | None,
        typer.Option("--only", metavar="RULE", help="trim, see_through, holes, floating, steady."),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Say what would be done.")] = False,
) -> None:
    """Mend a built room: what floats, holes in shells, furniture in walls or in other furniture.

    Every build is mended so already (unless --set mend=no); each mend is an edit in
    build/edits.journal, which can be listed and taken back. The world and its other forms are
    written anew; a world that was played in is left alone.

    Args:
        source: the run.
        list_: whether to list, and change nothing.
        undo: the number of a mend to take back, from 1.
        undo_all: whether to take all back.
        redo: the number of a mend to do again.
        only: the rules to go by; all where left out.
        dry_run: whether to say what would be mended, and change nothing.

    Raises:
        UsageError: there is no such mend or rule. InputError: there is no build.
    """
    if sum((list_, undo is not None, undo_all, redo is not None)) > 1:
        raise UsageError("--list, --undo, --undo-all and --redo go one at a time")
    from world2minecraft.editing.cleanup.passes import RULES, repair_volume

    build = build_folder(source)
    history = open_history(build)
    if list_:
        edits, is_done = history.journal.edits, history.journal.is_done
        print(format_edits(edits, is_done) or "Nothing was mended.")
        return
    if not dry_run:
        check_unplayed(build / "world")  # Before any edit is recorded.
    if undo or undo_all or redo:
        print(undo_edits(history, undo, undo_all, redo))
    else:
        edits = repair_volume(history.volume, tuple(only or RULES))[1]
        first = 0 if dry_run else len(history.journal.edits)
        print(format_edits(edits, [True] * len(edits), first) or "Nothing is left to mend.")
        if dry_run or not edits:
            return
        for edit in edits:
            history.do(edit)
    rewrite_build(build, history)


def build_folder(source: Path) -> Path:
    """Return the build folder of a run.

    Raises:
        InputError: there is none.
    """
    for folder in (source / "build", source):
        if (folder / "scene.json").is_file():
            return folder
    raise InputError(source, "holds no build (build/scene.json); build one with w2m build")


def check_unplayed(world: Path) -> None:
    """Check that no game has saved a world since it was built.

    Raises:
        OutputError: one has, or it is of another maker.
    """
    from world2minecraft.minecraft.worlds.level_dat import MAKER, MAKER_TAG
    from world2minecraft.minecraft.worlds.world_reader import read_level

    if read_level(world).get(MAKER_TAG) != MAKER:
        reason = "holds a world that has been played in or made elsewhere"
        raise OutputError(world, f"{reason}; build it again to another --out, and clean that")


def open_history(build: Path) -> "History":
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
        reason = f"is of another build than the one beside it ({error.reason})"
        raise ConflictError(build / EDITS_FILE, f"{reason}; remove it, or build again") from error


def format_edits(edits: "Sequence[BlockEdit]", is_done: list[bool], first: int = 0) -> str:
    """Return edits as lines: number, verb, blocks, object, place, reason."""
    from world2minecraft.core.classes import CLASS_NAMES

    lines = []
    for number, (edit, done) in enumerate(zip(edits, is_done, strict=True), first + 1):
        what = "" if edit.class_id is None else CLASS_NAMES[edit.class_id]
        name = f"{what} {edit.instance}" if edit.instance else what
        x, y, z = edit.cells.min(axis=0).tolist()
        state = "" if done else "  (taken back)"
        size = f"{len(edit.cells)} block{'s' * (len(edit.cells) > 1)}"
        place = f"{size} at {x} {y} {z}"
        lines.append(f"{number:3}  {edit.kind:8} {name:10} {place}: {edit.reason}{state}")
    return "\n".join(lines)


def undo_edits(history: "History", undo: int | None, undo_all: bool, redo: int | None) -> str:
    """Take mends back, or do one again; return a line that tells.

    Raises:
        UsageError: there is no such mend. ConflictError: a later one changed the same blocks.
    """
    if redo:
        history.redo(redo - 1)
        return f"Mend {redo} is done again."
    if undo is not None:
        return f"Mend {history.undo(undo - 1) + 1} is taken back."
    count = sum(history.journal.is_done)
    for _ in range(count):
        history.undo()
    return f"{count} mend{'s' * (count != 1)} taken back."


def rewrite_build(build: Path, history: "History") -> None:
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
    print(f"{build / 'world'} is written anew, with its other forms.")

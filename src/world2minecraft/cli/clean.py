"""Repair a built room, and undo any repair: ``w2m clean``."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.repairs import Repair

EXAMPLES = """\
w2m clean OUT                  repair faults introduced by edits
w2m clean OUT --list           list all repairs
w2m clean OUT --undo 3         undo the third repair
w2m clean OUT --undo-all       restore the room as it was before all repairs
w2m clean OUT --dry-run        show what would be repaired
"""

Undo = Annotated[
    int | None, typer.Option("--undo", metavar="N", min=1, help="Undo the repair with this number.")
]
Redo = Annotated[
    int | None, typer.Option("--redo", metavar="N", min=1, help="Redo the repair with this number.")
]


def run(
    source: Annotated[Path, typer.Argument(metavar="OUT", help="Run folder, or its build folder.")],
    list_: Annotated[bool, typer.Option("--list", help="List the repairs.")] = False,
    undo: Undo = None,
    undo_all: Annotated[bool, typer.Option("--undo-all", help="Undo all repairs.")] = False,
    redo: Redo = None,
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only",
            metavar="RULE",
            help="trim, see_through, holes, floating or steady. Repeatable.",
            show_default="all",
        ),
    ] = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Print the repairs without changing the build.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="With --list, print JSON.")] = False,
) -> None:
    """Repair floating blocks, holes in walls and furniture that intersects a wall in a built room.

    Builds are repaired automatically (unless built with --set mend=no). Each repair is recorded in
    build/edits.journal and can be listed and undone. The world and its additional formats are then
    rewritten. A world that has been played in is not changed.

    Raises:
        UsageError: If a repair or a rule does not exist.
        InputError: If the folder contains no build.
    """
    from world2minecraft.api import repairs

    if sum((list_, undo is not None, undo_all, redo is not None)) > 1:
        raise UsageError("use only one of --list, --undo, --undo-all and --redo")
    if as_json and not list_:
        raise UsageError("--json requires --list")
    if list_:
        found = repairs.list_repairs(source)
        print(to_json(found) if as_json else format_repairs(found) or "No repairs.")
        return
    if redo is not None:
        repairs.redo_repair(source, redo)
        print(f"Repair {redo} redone.")
    elif undo is not None:
        repairs.undo_repair(source, undo)
        print(f"Repair {undo} undone.")
    elif undo_all:
        count = repairs.undo_repair(source)
        print(f"{count} repair{'s' * (count != 1)} undone.")
    else:
        done = repairs.repair(source, only=only or (), dry_run=dry_run)
        print(format_repairs(done) or "Nothing to repair.")
        if dry_run or not done:
            return
    print(f"{repairs.world_of(source)} and its additional formats have been rewritten.")


def to_json(repairs: "Sequence[Repair]") -> str:
    """Return repairs as a JSON list."""
    return json.dumps([asdict(one) for one in repairs], indent=1)


def format_repairs(repairs: "Sequence[Repair]") -> str:
    """Return one line per repair: number, kind, object, blocks, position and reason."""
    lines = []
    for one in repairs:
        size = f"{one.blocks} block{'s' * (one.blocks > 1)}"
        place = f"{size} at {' '.join(map(str, one.corner))}"
        state = "" if one.is_done else "  (undone)"
        lines.append(f"{one.number:3}  {one.kind:8} {one.subject:10} {place}: {one.reason}{state}")
    return "\n".join(lines)

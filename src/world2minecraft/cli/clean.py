"""``w2m clean``: repair a built room, and undo any repair."""

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
w2m clean OUT                  repair what edits have left
w2m clean OUT --list           the repairs, of the build and since
w2m clean OUT --undo 3         undo the third repair
w2m clean OUT --undo-all       the room as it was built
w2m clean OUT --dry-run        what would be repaired
"""

Undo = Annotated[
    int | None, typer.Option("--undo", metavar="N", min=1, help="Undo the repair of this number.")
]
Redo = Annotated[
    int | None, typer.Option("--redo", metavar="N", min=1, help="Make an undone repair again.")
]


def run(
    source: Annotated[
        Path, typer.Argument(metavar="OUT", help="A run's folder, or the build folder in it.")
    ],
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
        bool, typer.Option("--dry-run", help="Print the repairs; change nothing.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the --list as JSON.")] = False,
) -> None:
    """Repair a built room: floating blocks, holes in walls, furniture that intersects a wall.

    Every build is repaired already (unless built with --set mend=no); each repair is an edit in
    build/edits.journal that can be listed and undone. The world and its further formats are
    written again; a world that was played in is not changed.

    Raises:
        UsageError: there is no such repair or rule. InputError: there is no build.
    """
    from world2minecraft.api import repairs

    if sum((list_, undo is not None, undo_all, redo is not None)) > 1:
        raise UsageError("--list, --undo, --undo-all and --redo exclude each other; give one")
    if as_json and not list_:
        raise UsageError("--json needs --list")
    if list_:
        found = repairs.list_repairs(source)
        print(to_json(found) if as_json else format_repairs(found) or "No repairs.")
        return
    if redo is not None:
        repairs.redo_repair(source, redo)
        print(f"Repair {redo} is made again.")
    elif undo is not None:
        repairs.undo_repair(source, undo)
        print(f"Repair {undo} is undone.")
    elif undo_all:
        count = repairs.undo_repair(source)
        print(f"{count} repair{'s' * (count != 1)} undone.")
    else:
        done = repairs.repair(source, only=only or (), dry_run=dry_run)
        print(format_repairs(done) or "Nothing to repair.")
        if dry_run or not done:
            return
    print(f"{repairs.world_of(source)} and its further formats are written again.")


def to_json(repairs: "Sequence[Repair]") -> str:
    """Return repairs as a JSON list."""
    return json.dumps([asdict(one) for one in repairs], indent=1)


def format_repairs(repairs: "Sequence[Repair]") -> str:
    """Return repairs as lines: number, kind, blocks, object, place, reason."""
    lines = []
    for one in repairs:
        size = f"{one.blocks} block{'s' * (one.blocks > 1)}"
        place = f"{size} at {' '.join(map(str, one.corner))}"
        state = "" if one.is_done else "  (undone)"
        lines.append(f"{one.number:3}  {one.kind:8} {one.subject:10} {place}: {one.reason}{state}")
    return "\n".join(lines)

"""Undo the last build into a world: ``w2m undo``."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.core.errors import UsageError

EXAMPLES = """\
w2m undo saves/Home             restore all files from before the last build
w2m undo saves/Home --blocks    restore only blocks, if the world has been played in
w2m undo saves/Home --list      list the builds that can be undone
"""


def run(
    world: Annotated[Path, typer.Argument(metavar="WORLD", help="World folder.")],
    blocks: Annotated[
        bool, typer.Option("--blocks", help="Undo block by block, keeping later changes.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Restore the files even if they have changed since.")
    ] = False,
    list_: Annotated[
        bool, typer.Option("--list", help="List the builds that can be undone.")
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="With --list, print JSON.")] = False,
) -> None:
    """Undo the last `w2m build --into` in a world.

    Every file that the build changed is restored byte for byte. If the game has saved the world
    since the build, later changes to the world would be lost. In that case, --blocks removes the
    blocks one by one, except those that have changed since the build.

    Raises:
        UsageError: If there is no build to undo.
        ConflictError: If the world has changed since the build.
        InputError: If the folder does not contain a world.
    """
    from world2minecraft.api.worlds import undo_build, undo_steps

    if as_json and not list_:
        raise UsageError("--json requires --list")
    if blocks and force:
        raise UsageError("--blocks and --force exclude each other; omit one of them")
    if list_:
        steps = undo_steps(world)
        if as_json:
            print(json.dumps([asdict(step) for step in steps], indent=1))
            return
        if not steps:
            print(f"{world}: no build by World2Minecraft to undo.")
            return
        for step in steps:
            print(f"{step.number}  {step.what}, {count_text(step.files, 'file')}")
        print(f"{count_text(len(steps), 'step')} to undo, newest first.")
        return
    done = undo_build(world, blocks=blocks, force=force)
    if blocks:
        rest = (
            f"; {count_text(done.unchanged, 'block')} not restored because of later changes"
            * bool(done.unchanged)
        )
        print(f"{world}: {count_text(done.blocks, 'block')} restored{rest}.")
    elif done.interrupted:
        print(f"{world}: an interrupted build was undone.")
    else:
        print(f"{world}: {count_text(done.files, 'file')} restored, byte for byte.")


def count_text(number: int, what: str) -> str:
    """Return a number with its noun, in the plural unless the number is 1."""
    return f"{number:,} {what}" if number == 1 else f"{number:,} {what}s"

"""``w2m undo``: undo the last build into a world."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.core.errors import UsageError

EXAMPLES = """\
w2m undo saves/Home             restore every file from before the last build
w2m undo saves/Home --blocks    restore the blocks alone, in a world played in since
w2m undo saves/Home --list      what can be undone
"""


def run(
    world: Annotated[Path, typer.Argument(metavar="WORLD", help="The world's folder.")],
    blocks: Annotated[
        bool, typer.Option("--blocks", help="Undo block by block; later changes stay.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Restore the files even if they changed since.")
    ] = False,
    list_: Annotated[bool, typer.Option("--list", help="List what can be undone.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the --list as JSON.")] = False,
) -> None:
    """Undo the last `w2m build --into` in a world.

    Every file that it changed is restored byte for byte. If the game has saved the world since,
    that would lose what was done there: --blocks then removes the blocks one by one, and leaves
    those that were changed since.

    Raises:
        UsageError: there is nothing to undo. ConflictError: the world was changed since.
        InputError: there is no world.
    """
    from world2minecraft.api.worlds import undo_build, undo_steps

    if as_json and not list_:
        raise UsageError("--json needs --list")
    if blocks and force:
        raise UsageError("--blocks and --force exclude each other; give one of them")
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
        print(f"{count_text(len(steps), 'step')} to undo, the last one first.")
        return
    done = undo_build(world, blocks=blocks, force=force)
    if blocks:
        rest = f"; {count_text(done.unchanged, 'block')} changed since stay" * bool(done.unchanged)
        print(f"{world}: {count_text(done.blocks, 'block')} restored{rest}.")
    elif done.interrupted:
        print(f"{world}: an interrupted build is undone.")
    else:
        print(f"{world}: {count_text(done.files, 'file')} restored, byte for byte.")


def count_text(number: int, what: str) -> str:
    """Return a number with its noun, in the plural where it is not one."""
    return f"{number:,} {what}" if number == 1 else f"{number:,} {what}s"

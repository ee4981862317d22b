"""``w2m undo``: take back what was last built into a world."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.core.errors import ConflictError, UsageError

EXAMPLES = """\
w2m undo saves/Home             every byte as it was before the last build
w2m undo saves/Home --blocks    the blocks alone, in a world that was played in since
w2m undo saves/Home --list      what can be undone
"""


def run(
    world: Annotated[Path, typer.Argument(metavar="WORLD", help="The world's folder.")],
    blocks: Annotated[
        bool, typer.Option("--blocks", help="Block by block; keep what was done since.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Bring the files back, whatever was done since.")
    ] = False,
    list_: Annotated[bool, typer.Option("--list", help="List what can be undone.")] = False,
) -> None:
    """Take back what `w2m build --into` last did to a world.

    Every file that it touched comes back byte by byte. Where the game has saved the world since,
    that would destroy what was done there: then --blocks takes the blocks out one by one, and
    leaves those that someone has changed.

    Args:
        world: the world's folder.
        blocks: whether to undo block by block.
        force: whether to bring files back that were changed since.
        list_: whether to list the steps, and do nothing.

    Raises:
        UsageError: there is nothing to undo. ConflictError: the world was changed since.
        InputError: there is no world.
    """
    if blocks and force:
        raise UsageError("--blocks and --force are two ways to undo; choose one")
    from world2minecraft.editing.file_backups import list_steps
    from world2minecraft.minecraft.worlds.level_dat import no_world

    if list_:
        if not (world / "level.dat").is_file():
            raise no_world(world)
        steps = list_steps(world)
        if not steps:
            print(f"{world}: nothing of World2Minecraft is there to undo.")
            return
        for step in steps:
            print(f"{step.folder.name}  {step.what}, {count_text(len(step.files), 'file')}")
        print(f"{count_text(len(steps), 'step')} to undo, the last one first.")
        return
    if blocks:
        from world2minecraft.editing.build_into_world import remove_build

        done = remove_build(world)
        kept = f"; {count_text(done.kept, 'block')} changed since stay" if done.kept else ""
        print(f"{world}: {count_text(done.blocks, 'block')} put back as before{kept}.")
        return
    print(undo_files(world, force))


def undo_files(world: Path, force: bool) -> str:
    """Bring back the files of the last step; return a line that tells.

    Raises:
        UsageError: there is no step. ConflictError: a file was changed since, without ``force``.
    """
    from world2minecraft.editing.file_backups import changed_since, list_steps, recover, revert_step
    from world2minecraft.minecraft.worlds.session_lock import session_lock

    with session_lock(world):
        cut_off = [step for step in list_steps(world) if step.state != "done"]
        if cut_off:
            if force:
                revert_step(cut_off[-1])
            else:
                recover(world)
            return f"{world}: a step that was cut off is taken back."
        steps = list_steps(world)
        if not steps:
            raise UsageError(f"{world}: nothing of World2Minecraft is there to undo")
        changed = changed_since(steps[-1])
        if changed and not force:
            reason = f"{changed[0]} was saved since; --blocks takes out what was built and keeps"
            raise ConflictError(world, f"{reason} the rest, --force brings the old files back")
        revert_step(steps[-1])
        files = count_text(len(steps[-1].files), "file")
        return f"{world}: {files} brought back, byte by byte as before."


def count_text(number: int, what: str) -> str:
    """Return a number with its noun, in the plural where it is not one."""
    return f"{number:,} {what}" if number == 1 else f"{number:,} {what}s"

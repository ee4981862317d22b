"""``w2m convert``: one Minecraft format into another, by way of BlockVolume."""

import os
import tempfile
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.errors import InputError, OutputError, UsageError

EXAMPLES = """\
w2m convert house.schem worlds/house        a schematic to a world folder
w2m convert worlds/house house.schem        a world folder to a schematic
w2m convert house.schem house.zip           a schematic to a datapack
w2m convert a.schem b.schem --schem-version 3 --force
"""


def run(
    source: Annotated[Path, typer.Argument(metavar="A", help="What to read: a file or a world.")],
    target: Annotated[Path, typer.Argument(metavar="B", help="What to write; its name says how.")],
    force: Annotated[bool, typer.Option("--force", help="Replace B where it is there.")] = False,
    mc_version: Annotated[
        str, typer.Option(help="Game version to write for; newer games upgrade it.")
    ] = "1.20.1",
    schem_version: Annotated[int, typer.Option(help="Sponge schematic version: 2 or 3.")] = 2,
    name: Annotated[str, typer.Option(help="What a world or pack is called; B's name.")] = "",
) -> None:
    """Read blocks from A and write them to B.

    The format of A is found from its suffix and content; that of B from its suffix alone: a name
    without a suffix becomes a world folder. Nothing is lost on the way but what B's format cannot
    hold.

    Args:
        source: the file or folder to read.
        target: the file or folder to write.
        force: whether to replace ``target``.
        mc_version: the game version to write for.
        schem_version: 2 or 3, for a schematic.
        name: what a world or datapack is called; empty for the target's name.

    Raises:
        UsageError: ``target`` is there and ``force`` is not given, or no format ends so.
        InputError: ``source`` cannot be read, or ``target`` cannot be written.
    """
    check_target(source, target, force)
    from world2minecraft.minecraft.formats import WriteOptions, read_blocks, write_blocks

    options = WriteOptions(
        mc_version=mc_version, schem_version=schem_version, name=name or target.stem
    )
    volume = read_blocks(source)
    with_parent(target)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=".w2m-") as folder:
        # The new one is whole before the old one goes; both lie on one disk.
        written = Path(folder) / target.name
        write_blocks(volume, written, options)
        put_in_place(written, target)
    filled = int((volume.states != 0).sum())
    size = " x ".join(str(side) for side in volume.states.shape)
    print(f"{target}: {filled:,} blocks of {len(volume.palette) - 1} kinds, {size}")


def check_target(source: Path, target: Path, force: bool) -> None:
    """Check what can be known before any work.

    Raises:
        InputError: ``source`` is not there.
        UsageError: ``target`` has no known suffix, is ``source``, is there without ``force``, or
            is a folder that holds other things than a world.
    """
    if not source.exists():
        raise InputError(source, "is not there")
    from world2minecraft.minecraft.formats import FORMATS

    suffixes = [FORMATS.load(name)().suffix for name in FORMATS.names()]
    if target.suffix.lower() not in suffixes:
        known = ", ".join(suffix or "none (a world folder)" for suffix in suffixes)
        raise UsageError(f"{target}: no block format ends in {target.suffix}; known: {known}")
    if not os.path.lexists(target):
        return
    if target.exists() and source.samefile(target):
        raise UsageError(f"{target} is both A and B; give another name for B")
    if not force:
        raise UsageError(f"{target} is there already; add --force to replace it")
    if target.is_dir() and any(target.iterdir()) and not (target / "level.dat").is_file():
        raise UsageError(f"{target} is a folder and no world (no level.dat); give another name")


def with_parent(target: Path) -> None:
    """Make the folder that ``target`` lies in.

    Raises:
        OutputError: it cannot be made.
    """
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = "is a file" if target.parent.is_file() else f"cannot be made: {error.strerror}"
        raise OutputError(target.parent, f"{reason}; give another place for B") from error


def put_in_place(written: Path, target: Path) -> None:
    """Move ``written`` to ``target``, on the same disk, over a file or folder that is there."""
    if not target.is_dir() or target.is_symlink():
        os.replace(written, target)
        return
    old = written.parent / ".replaced"  # Goes with the folder that holds both.
    os.replace(target, old)
    try:
        os.replace(written, target)
    except OSError:
        os.replace(old, target)
        raise

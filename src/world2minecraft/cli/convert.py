"""``w2m convert``: any form of a room or a build into any other, by way of BlockVolume."""

import os
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import InputError, OutputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.formats.volume_crop import Box
    from world2minecraft.minecraft.file_format import Losses, WriteOptions

EXAMPLES = """\
w2m convert house.schem worlds/house        a schematic to a world folder
w2m convert worlds/house house.litematic    a world folder to a Litematica file
w2m convert OUT room.glb                    a run: one mesh for each of its objects
w2m convert OUT kitchen.habitat             a run: a scene dataset for Habitat-Sim
w2m convert OUT room.mcstructure            a run: a structure of Bedrock Edition
w2m convert saves/Home hut.schem --box 0,60,0,32,80,32    a part of a large world
w2m convert a.schem b.schem --schem-version 3 --force
"""
HABITAT_MARK = "*.scene_dataset_config.json"


def run(
    source: Annotated[
        Path, typer.Argument(metavar="A", help="What to read: a file, a world, a run's folder.")
    ],
    target: Annotated[Path, typer.Argument(metavar="B", help="What to write; its name says how.")],
    force: Annotated[bool, typer.Option("--force", help="Replace B where it is there.")] = False,
    mc_version: Annotated[
        str, typer.Option(help="Game version to write for; newer games upgrade it.")
    ] = "1.20.1",
    schem_version: Annotated[int, typer.Option(help="Sponge schematic version: 1, 2 or 3.")] = 2,
    name: Annotated[str, typer.Option(help="What a world or pack is called; B's name.")] = "",
    blocks_per_metre: Annotated[
        float | None,
        typer.Option(help="How many blocks are a metre, where A does not say; 1."),
    ] = None,
    box: Annotated[
        str,
        typer.Option(metavar="X0,Y0,Z0,X1,Y1,Z1", help="These blocks of A alone."),
    ] = "",
    labels: Annotated[
        str, typer.Option(metavar="PALETTE", help="Whose names of blocks say what they are.")
    ] = "",
) -> None:
    """Read blocks from A, write them to B, and say what B cannot hold.

    The format of A is found from its suffix and content; that of B from its suffix alone: a name
    without a suffix becomes a world folder. Of a run's folder the world is read, with what its
    blocks are. Known suffixes: .schem, .litematic, .nbt, .zip (data pack), .mcfunction,
    .mcstructure (Bedrock), .glb, .habitat (a folder), and to read .schematic.

    Args:
        source: the file or folder to read.
        target: the file or folder to write.
        force: whether to replace ``target``.
        mc_version: the game version to write for.
        schem_version: 1, 2 or 3, for a schematic.
        name: what a world or datapack is called; empty for the target's name.
        blocks_per_metre: the scale, for meshes and for the player's size.
        box: which blocks of ``source``, the last ones not included; empty for all.
        labels: a palette by whose words blocks get classes and objects, such as ``tmeo``.

    Raises:
        UsageError: ``target`` is there and ``force`` is not given, or no format ends so.
        InputError: ``source`` cannot be read, or ``target`` cannot be written.
    """
    check_target(source, target, force)
    from world2minecraft.cli.render.options import box_of
    from world2minecraft.formats.volume_formats import read_run_templates
    from world2minecraft.minecraft.file_format import WriteOptions

    options = WriteOptions(
        mc_version=mc_version,
        schem_version=schem_version,
        name=name or target.stem,
        other={"templates": read_run_templates(source)},
    )
    convert(source, target, options, blocks_per_metre, labels, force, box_of(box))


def convert(
    source: Path,
    target: Path,
    options: "WriteOptions",
    blocks_per_metre: float | None,
    labels: str,
    force: bool,
    box: "Box | None" = None,
) -> None:
    """Read ``source``, write ``target`` and print what came of it. Raises what ``run`` raises."""
    from world2minecraft.formats.volume_formats import write_volume
    from world2minecraft.minecraft.block_renames import count_mod_blocks
    from world2minecraft.minecraft.commands.datapack import to_namespace
    from world2minecraft.minecraft.file_format import Losses

    unread, unwritten = Losses(), Losses()
    volume = with_labels(with_scale(read_part(source, box, unread), blocks_per_metre), labels)
    make_parent(target)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=".w2m-") as folder:
        # The new one is whole before the old one goes; both lie on one disk.
        written = Path(folder) / target.name
        write_volume(volume, written, options, unwritten)
        replace_target(written, target, force)
    filled = int((volume.states != 0).sum())
    size = " x ".join(str(side) for side in volume.states.shape)
    print(f"{target}: {filled:,} blocks of {len(volume.palette) - 1} kinds, {size}")
    if target.suffix.lower() == ".zip":
        print(f"in the world that has it: /function {to_namespace(options.name)}:build")
    told = " ".join(what for what, _ in unwritten)
    for mod, count in count_mod_blocks(volume).items():
        if f"{mod}:" not in told:
            print(f"kept by their names: {count:,} blocks of the mod {mod}")
    print_losses(unread, f"not read from {source.name}")
    print_losses(unwritten, f"not written to {target.name}")


def read_part(source: Path, box: "Box | None", losses: "Losses") -> "BlockVolume":
    """Return the blocks of ``source``, or those in a box of it: of a world no others are read.

    Raises:
        InputError: it cannot be read, or nothing but air is in the box.
        UsageError: the box lies beside the build.
    """
    from world2minecraft.formats.build_reader import read_build
    from world2minecraft.formats.volume_formats import read_volume

    return read_volume(source, losses) if box is None else read_build(source, box).volume


def with_scale(volume: "BlockVolume", blocks_per_metre: float | None) -> "BlockVolume":
    """Return the volume at a scale; at its own where none is given.

    Raises:
        UsageError: the scale is no number above 0, or another than the volume's own.
    """
    if blocks_per_metre is None:
        return volume
    if not 0.01 <= blocks_per_metre <= 1000:
        raise UsageError(f"--blocks-per-metre must be 0.01 to 1000, not {blocks_per_metre:g}")
    own = volume.blocks_per_metre
    if volume.semantic.any() and abs(own - blocks_per_metre) > 1e-6:
        raise UsageError(f"--blocks-per-metre is {own:g} for this room; leave it out")
    to_room = volume.block_to_room.copy()
    to_room[:3] *= own / blocks_per_metre
    return replace(volume, block_to_room=to_room)


def with_labels(volume: "BlockVolume", palette: str) -> "BlockVolume":
    """Return the volume with the classes that a palette reads from its blocks' names.

    Raises:
        UnknownNameError: there is no such palette. UsageError: it reads no blocks.
    """
    if not palette:
        return volume
    from world2minecraft.construction.mod_block_classes import label_volume
    from world2minecraft.construction.palettes import load_palette

    meanings = load_palette(palette).meanings
    if meanings is None:
        raise UsageError(f"palette {palette} reads no blocks; add reads to it, or try vanilla")
    return label_volume(volume, meanings)


def print_losses(losses: "Losses", head: str) -> None:
    """Print what was lost, one line a kind; nothing where nothing was."""
    for what, count in losses:
        print(f"{head}: {count:,} {what}")


def check_target(source: Path, target: Path, force: bool) -> None:
    """Check what can be known before any work.

    Raises:
        InputError: ``source`` is not there.
        UsageError: ``target`` has no known suffix, is ``source``, is there without ``force``, or
            is a folder that holds other things than a world or a scene dataset.
        ConflictError: ``target`` is a world that the game has open.
    """
    if not source.exists():
        raise InputError(source, "is not there")
    from world2minecraft.formats.volume_formats import format_for_path

    form = format_for_path(target)
    if not os.path.lexists(target):
        return
    if target.exists() and source.samefile(target):
        raise UsageError(f"{target} is both A and B; give another name for B")
    if not force:
        raise UsageError(f"{target} is there already; add --force to replace it")
    if (target / "level.dat").is_file():
        from world2minecraft.minecraft.worlds.session_lock import session_lock

        with session_lock(target):  # A world that the game has open is left alone.
            pass
    if not target.is_dir() or not any(target.iterdir()):
        return
    if form.suffix == "" and not (target / "level.dat").is_file():
        raise UsageError(f"{target} is a folder and no world (no level.dat); give another name")
    if form.suffix != "" and not any(target.glob(HABITAT_MARK)):
        raise UsageError(f"{target} is a folder of other things; give another name")


def replace_target(written: Path, target: Path, force: bool) -> None:
    """Move what was written to ``target``, and files that were written beside it to beside it.

    Raises:
        UsageError: a file beside ``target`` is there and ``force`` is not given.
    """
    beside = [path for path in sorted(written.parent.iterdir()) if path != written]
    for path in beside:
        place = target.parent / path.name
        if place.exists() and not force:
            raise UsageError(f"{place} is there already; add --force to replace it")
    for path in beside:
        put_in_place(path, target.parent / path.name)
    put_in_place(written, target)


def make_parent(target: Path) -> None:
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

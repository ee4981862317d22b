"""Convert a room, a world or a block file to another format: ``w2m convert``."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import out_option

EXAMPLES = """\
w2m convert house.schem worlds/house        a schematic to a world folder
w2m convert worlds/house house.litematic    a world folder to a Litematica file
w2m convert OUT room.glb                    a run: one mesh for each of its objects
w2m convert OUT kitchen.habitat             a run: a scene dataset for Habitat-Sim
w2m convert OUT room.mcstructure            a run: a structure of Bedrock Edition
w2m convert saves/Home hut.schem --box 0,60,0,32,80,32    a part of a large world
w2m convert a.schem b.schem --schem-version 3 --force
"""


def run(
    source: Annotated[
        Path, typer.Argument(metavar="SOURCE", help="Block file, world, or run folder.")
    ],
    target: Annotated[
        Path | None,
        typer.Argument(
            metavar="TARGET", help="File or folder to write; the suffix selects the format."
        ),
    ] = None,
    out: Annotated[Path | None, out_option("TARGET, as an option.", metavar="TARGET")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace TARGET if it exists.")] = False,
    mc_version: Annotated[
        str, typer.Option(help="Minecraft version to write for; newer versions upgrade the file.")
    ] = "1.20.1",
    schem_version: Annotated[int, typer.Option(help="Sponge schematic version: 1, 2 or 3.")] = 2,
    name: Annotated[
        str, typer.Option(help="Name of the world or data pack.", show_default="TARGET's name")
    ] = "",
    blocks_per_metre: Annotated[
        float | None,
        typer.Option(help="Scale, if SOURCE does not record it.", show_default="1"),
    ] = None,
    box: Annotated[
        str,
        typer.Option(metavar="X0,Y0,Z0,X1,Y1,Z1", help="Convert only these blocks of SOURCE."),
    ] = "",
    labels: Annotated[
        str,
        typer.Option(
            metavar="PALETTE", help="Palette that assigns classes to the blocks of SOURCE."
        ),
    ] = "",
) -> None:
    """Convert a room, a world or a block file to another format.

    The format of SOURCE is detected from its suffix and contents, that of TARGET from its suffix
    alone. A TARGET without a suffix becomes a world folder. Supported suffixes: .schem, .litematic,
    .nbt, .zip (data pack), .mcfunction, .mcstructure (Bedrock), .glb, .habitat (a folder), and for
    reading only .schematic. Contents that TARGET does not support are listed.
    """
    from world2minecraft.api import convert
    from world2minecraft.cli.arguments import output_of
    from world2minecraft.cli.render.options import box_of

    target = output_of(target, out, "TARGET")
    done = convert(
        source,
        target,
        force=force,
        mc_version=mc_version,
        schem_version=schem_version,
        name=name,
        blocks_per_metre=blocks_per_metre,
        box=box_of(box),
        labels=labels,
    )
    size = " x ".join(str(side) for side in done.size_blocks)
    print(f"{target}: {done.blocks:,} blocks of {done.kinds} kinds, {size}")
    if done.function:
        print(f"to place it in a world with this data pack: /function {done.function}")
    for mod, count in done.mod_blocks.items():
        print(f"written with their original names: {count:,} blocks of the mod {mod}")
    _print_losses(done.not_read, f"not read from {source.name}")
    _print_losses(done.not_written, f"not written to {target.name}")


def _print_losses(losses: Mapping[str, int], head: str) -> None:
    for what, count in losses.items():
        print(f"{head}: {count:,} {what}")

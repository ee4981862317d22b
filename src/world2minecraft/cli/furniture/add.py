"""Add a piece built from blocks to the furniture library: ``w2m furniture add``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.furniture import AddedFurniture

EXAMPLES = """\
w2m furniture add my_chair.schem --class chair --blocks-per-metre 2
w2m furniture add sofa.litematic --class sofa --blocks-per-metre 4 --front south
w2m furniture add lamp.nbt --class object --blocks-per-metre 1 --size 0.4 0.4 1.6 --recolour
"""


Source = Annotated[
    Path, typer.Argument(metavar="FILE", help=".schem, .litematic, .nbt or other block file.")
]
Kind = Annotated[
    str, typer.Option("--class", help="chair, bed, sofa, table, television, furniture or object.")
]
Scale = Annotated[float, typer.Option(help="Scale at which the piece was built.")]
Name = Annotated[str, typer.Option(help="Name in the library.", show_default="FILE's name")]
Title = Annotated[str, typer.Option(help="Readable name.", show_default="its name")]
Front = Annotated[
    str | None,
    typer.Option(
        help="Side that the front faces: north, east, south or west.",
        show_default="inferred from its blocks",
    ),
]
Size = Annotated[
    tuple[float, float, float] | None,
    typer.Option(
        metavar="DEPTH WIDTH HEIGHT", help="Real size in metres.", show_default="of its blocks"
    ),
]
Mount = Annotated[str, typer.Option(help="floor, wall, ceiling or any.")]
Recolour = Annotated[
    bool, typer.Option("--recolour", help="Match wood, wool and stone to the object's colour.")
]
Match = Annotated[
    bool, typer.Option("--match/--no-match", help="Match reconstructed objects with this piece.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace your own piece with the same name.")]


def run(
    source: Source,
    kind: Kind,
    blocks_per_metre: Scale,
    name: Name = "",
    title: Title = "",
    front: Front = None,
    size: Size = None,
    mount: Mount = "floor",
    recolour: Recolour = False,
    match: Match = True,
    force: Force = False,
) -> None:
    """Add a piece of furniture built from blocks to your furniture library.

    Surrounding air is removed. At its own scale, the piece is built block for block. At other
    scales, its shape is fitted with blocks. Reconstructed objects of its class and approximate size
    are then matched with it. The piece is stored in the folder named by the environment variable
    W2M_FURNITURE, or next to the user's settings.

    Raises:
        UsageError: If a name or class is invalid, or if the name is already in use.
        InputError: If the file cannot be read.
    """
    from world2minecraft.api.furniture import add_furniture

    added = add_furniture(
        source,
        kind,
        blocks_per_metre,
        name=name,
        title=title,
        front=front,
        size_m=size,
        mount=mount,
        recolour=recolour,
        match=match,
        force=force,
    )
    _print_summary(added, inferred=front is None)


def _print_summary(added: "AddedFurniture", inferred: bool) -> None:
    size = " x ".join(f"{side:.2f}" for side in added.size_m)
    hint = " (inferred from its blocks; set it with --front)" if inferred else ""
    print(f"{added.name}: {added.blocks} blocks, {size} m (depth x width x height)")
    print(f"The front faces {added.front}{hint}.")
    for note in added.notes:
        print(f"note: {note}")
    print(f"Written to {added.path}")
    print(f"  look   w2m furniture show {added.name} -o {added.name}.png")

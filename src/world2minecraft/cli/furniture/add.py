"""``w2m furniture add``: blocks that someone built become furniture of the library."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.furniture import AddedFurniture

EXAMPLES = """\
w2m furniture add my_chair.schem --class chair --blocks-per-metre 2
w2m furniture add sofa.litematic --class sofa --blocks-per-metre 4 --front south
w2m furniture add lamp.nbt --class objs --blocks-per-metre 1 --size 0.4 0.4 1.6 --recolour
"""


Source = Annotated[
    Path, typer.Argument(metavar="FILE", help="A .schem, .litematic, .nbt or another build.")
]
Kind = Annotated[str, typer.Option("--class", help="chair, bed, sofa, table, tvs, furn or objs.")]
Scale = Annotated[float, typer.Option(help="The scale at which it was built.")]
Name = Annotated[str, typer.Option(help="Its name in the library.", show_default="FILE's name")]
Title = Annotated[str, typer.Option(help="Its name for people.", show_default="its name")]
Front = Annotated[
    str | None,
    typer.Option(help="north, east, south or west.", show_default="inferred from its blocks"),
]
Size = Annotated[
    tuple[float, float, float] | None,
    typer.Option(
        metavar="DEPTH WIDTH HEIGHT", help="Real size in metres.", show_default="of its blocks"
    ),
]
Mount = Annotated[str, typer.Option(help="floor, wall, ceiling or any.")]
Recolour = Annotated[
    bool, typer.Option("--recolour", help="Let wood, wool and stone take an object's colour.")
]
Match = Annotated[bool, typer.Option("--match/--no-match", help="Match objects against it.")]
Force = Annotated[bool, typer.Option("--force", help="Replace your own piece of this name.")]


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
    """Add a piece of furniture of your own, block for block.

    The air around it is cut off. At its own scale it is built as it is; at another its shape is
    fitted. Objects of its class and about its size are matched against it from now on. It is
    stored in the folder W2M_FURNITURE, or with the user's settings.

    Raises:
        UsageError: a name or a class is not valid, or taken. InputError: the file cannot be read.
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
    hint = " (inferred from its blocks; --front sets it)" if inferred else ""
    print(f"{added.name}: {added.blocks} blocks, {size} m deep, wide and high")
    print(f"Its front looked {added.front}{hint}.")
    for note in added.notes:
        print(f"note: {note}")
    print(f"Written to {added.path}")
    print(f"  look   w2m furniture show {added.name} -o {added.name}.png")

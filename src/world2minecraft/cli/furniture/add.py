"""``w2m furniture add``: blocks that someone built become furniture of the library."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.furniture.user_import import ImportedFurniture

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
Name = Annotated[str, typer.Option(help="Its name; that of the file.")]
Title = Annotated[str, typer.Option(help="What people call it.")]
Front = Annotated[str | None, typer.Option(help="north, east, south or west; seen by its blocks.")]
Size = Annotated[
    tuple[float, float, float] | None,
    typer.Option(metavar="DEPTH WIDTH HEIGHT", help="Real size in metres."),
]
Mount = Annotated[str, typer.Option(help="floor, wall, ceiling or any.")]
Recolour = Annotated[
    bool, typer.Option("--recolour", help="Let wood, wool and stone take an object's colour.")
]
Match = Annotated[
    bool, typer.Option("--match/--no-match", help="Whether objects are matched against it.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace one of this name.")]


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
    kept in the folder that W2M_FURNITURE names, else with the user's settings.

    Args: as the options say.

    Raises:
        UsageError: a name or a class is none, or is taken. InputError: the file cannot be read.
    """
    from world2minecraft.furniture.user_import import ImportRequest, import_blocks
    from world2minecraft.furniture.user_library import check_name
    from world2minecraft.minecraft.file_format import Losses
    from world2minecraft.minecraft.formats import read_blocks

    chosen = check_name(name or source.stem.lower().replace("-", "_").replace(" ", "_"))
    target = check_free(chosen, force)
    losses = Losses()
    volume = read_blocks(source, losses)
    losses.add("block entities", len(volume.block_entities))
    losses.add("entities", len(volume.entities))
    wish = ImportRequest(
        chosen, kind, blocks_per_metre, front, size, title, mount, recolour=recolour, match=match
    )
    adopted = import_blocks(volume, wish)
    write_checked(adopted, target)
    _print_summary(
        adopted, target, front, [f"{count} {what} left behind" for what, count in losses]
    )


def check_free(name: str, force: bool) -> Path:
    """Return the file of a new piece.

    Raises:
        UsageError: the library has a piece of this name, or the user has and ``force`` is not
            given.
    """
    from world2minecraft.furniture.library import builtin_design_files
    from world2minecraft.furniture.user_library import user_design_folder

    if name in builtin_design_files():
        raise UsageError(f"the library has a {name} of its own; add --name another_name")
    target = user_design_folder() / f"{name}.json"
    if target.exists() and not force:
        raise UsageError(f"{target} is there already; add --force to replace it, or --name another")
    return target


def write_checked(adopted: "ImportedFurniture", target: Path) -> None:
    """Write a piece that can be read again. Raises ``OutputError``."""
    from world2minecraft.core.files import write_json
    from world2minecraft.furniture.user_library import template_from_json

    template_from_json(adopted.content)
    write_json(target, adopted.content)


def _print_summary(
    adopted: "ImportedFurniture", target: Path, front: str | None, lost: list[str]
) -> None:
    content = adopted.content
    size = " x ".join(f"{content['size_m'][key][1]:.2f}" for key in ("depth", "width", "height"))
    count = sum(length for number, length in content["blocks"]["runs"] if number)
    seen = "" if front else " (seen by its blocks; else say --front)"
    print(f"{content['name']}: {count} blocks, {size} m deep, wide and high")
    print(f"Its front looked {adopted.front}{seen}.")
    for note in (*lost, *adopted.notes):
        print(f"note: {note}")
    print(f"Written to {target}")
    print(f"  look   w2m furniture show {content['name']} --picture {content['name']}.png")

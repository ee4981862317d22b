"""Draw furniture at 1, 2 and 4 blocks per metre, a page per class: ``w2m furniture sheet``."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m furniture sheet -o furniture.png        one page per class: furniture_chair.png, ...
w2m furniture sheet --class object -o small_things.png
w2m furniture sheet sofa corner_sofa -o sofas.png
"""


def run(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="Pieces to draw.", show_default="all"),
    ] = None,
    out: Annotated[
        Path,
        typer.Option(
            "--out",
            "-o",
            metavar="PNG",
            help="Output PNG file. Pages of all classes add the class to its name.",
        ),
    ] = Path("furniture.png"),
    kind: Annotated[
        str,
        typer.Option(
            "--class",
            help="chair, bed, sofa, table, television, furniture or object.",
            show_default="all",
        ),
    ] = "",
) -> None:
    """Draw the furniture of the library and your own furniture by class, at typical sizes.

    Raises:
        UnknownNameError: If a piece or class is unknown.
        OutputError: If the image cannot be written.
    """
    from world2minecraft.api.furniture import draw_furniture
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as progress:
        noted = compile_first(progress, "pictures")
        pages = draw_furniture(out, names or (), class_name=kind, progress=noted)
    for file, pieces in pages.items():
        print(f"{file}: {len(pieces)} designs")

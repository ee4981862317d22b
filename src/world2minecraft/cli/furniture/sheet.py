"""``w2m furniture sheet``: a picture of all furniture at 1, 2 and 4 blocks per metre."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m furniture sheet -o furniture.png
w2m furniture sheet --class objs -o small_things.png
w2m furniture sheet sofa corner_sofa -o sofas.png
"""


def run(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="The pieces to draw.", show_default="all"),
    ] = None,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="PNG", help="The picture to write.")
    ] = Path("furniture.png"),
    kind: Annotated[
        str,
        typer.Option(
            "--class", help="chair, bed, sofa, table, tvs, furn or objs.", show_default="all"
        ),
    ] = "",
) -> None:
    """Draw the furniture of the library and of your own, by class, at its usual sizes.

    Raises:
        UnknownNameError: there is no such piece or class. OutputError: it cannot be written.
    """
    from world2minecraft.api.furniture import draw_furniture
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import with_compile_note

    with show_progress() as progress:
        noted = with_compile_note(progress)
        drawn = draw_furniture(out, names or (), class_name=kind, progress=noted)
    print(f"{out}: {len(drawn)} designs")

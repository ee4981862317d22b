"""``w2m palettes``: the palettes there are, and whether one of your own is sound."""

from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.construction.palettes import Palette

EXAMPLES = """\
w2m palettes                      the palettes there are
w2m palettes mine.yaml            check one of your own, and what each class is made of
w2m build OUT --palette mine.yaml
"""
MAX_SHOWN = 6


def run(
    name: Annotated[
        str, typer.Argument(metavar="PALETTE", help="A palette's name, or its file.")
    ] = "",
) -> None:
    """List the palettes, or check one and say what rooms are built of with it.

    Args:
        name: a palette's name or file; empty lists all.

    Raises:
        UnknownNameError: there is no such palette. InputError: the file is no palette.
    """
    from world2minecraft.construction.palettes import PALETTE_FILES, load_palette

    if name:
        for line in lines_of(load_palette(name)):
            print(line)
        return
    for each in PALETTE_FILES:
        print(summary_of(load_palette(each)))


def summary_of(palette: "Palette") -> str:
    """Return what a palette holds in a line."""
    blocks = {state for states in palette.blocks.values() for state in states}
    words = 0 if palette.meanings is None else len(palette.meanings.words)
    pieces = len(palette.furniture)
    extra = f", {pieces} pieces of furniture" if pieces else ""
    return f"{palette.name:<24}{len(blocks)} full blocks{extra}, reads blocks by {words} words"


def lines_of(palette: "Palette") -> list[str]:
    """Return what each class is made of, and what else there is."""
    from world2minecraft.core.classes import CLASS_NAMES

    lines = [summary_of(palette)]
    if palette.only is not None:
        lines.append(f"  restricted to {len(palette.only)} blocks")
    for number, states in palette.blocks.items():
        names = [state.partition("[")[0].removeprefix("minecraft:") for state in states]
        more = f" and {len(names) - MAX_SHOWN} more" if len(names) > MAX_SHOWN else ""
        lines.append(f"  {CLASS_NAMES[number]:<10}{', '.join(names[:MAX_SHOWN])}{more}")
    for piece in palette.furniture:
        lines.append(f"  {', '.join(piece.designs)}: {', '.join(cell.id for cell in piece.cells)}")
    return lines

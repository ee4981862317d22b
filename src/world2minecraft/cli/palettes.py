"""List the included palettes, or check a palette file: ``w2m palettes``."""

import json
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.palettes import Palette

EXAMPLES = """\
w2m palettes                      list the included palettes
w2m palettes mine.yaml            check your own palette, and list the blocks of each class
w2m palettes --json               print JSON
w2m build OUT --palette mine.yaml
"""
MAX_SHOWN = 6


def run(
    name: Annotated[str, typer.Argument(metavar="PALETTE", help="Name or file of a palette.")] = "",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """List the palettes, or check a palette and list its blocks by class.

    Raises:
        UnknownNameError: If the palette is unknown.
        InputError: If the file is not a valid palette.
    """
    from world2minecraft.api.palettes import list_palettes, open_palette, palette_json

    if name:
        palette = open_palette(name)
        text = json.dumps(palette_json(palette), indent=1) if as_json else details_of(palette)
    else:
        palettes = list_palettes()
        rows = [palette_json(each) for each in palettes] if as_json else []
        text = json.dumps(rows, indent=1) if as_json else "\n".join(map(summary_of, palettes))
    print(text)


def summary_of(palette: "Palette") -> str:
    """Return a one-line summary of a palette."""
    blocks = {state for states in palette.blocks.values() for state in states}
    words = 0 if palette.meanings is None else len(palette.meanings.words)
    pieces = len(palette.furniture)
    extra = f", {pieces} pieces of furniture" if pieces else ""
    return f"{palette.name:<24}{len(blocks)} full blocks{extra}, {words} block name rules"


def details_of(palette: "Palette") -> str:
    """Return the blocks of each class and the furniture as lines of text."""
    from world2minecraft.core.classes import display_name

    lines = [summary_of(palette)]
    if palette.only is not None:
        lines.append(f"  restricted to {len(palette.only)} blocks")
    for number, states in palette.blocks.items():
        names = [state.partition("[")[0].removeprefix("minecraft:") for state in states]
        more = f" and {len(names) - MAX_SHOWN} more" if len(names) > MAX_SHOWN else ""
        lines.append(f"  {display_name(number):<12}{', '.join(names[:MAX_SHOWN])}{more}")
    for piece in palette.furniture:
        lines.append(f"  {', '.join(piece.designs)}: {', '.join(cell.id for cell in piece.cells)}")
    return "\n".join(lines)

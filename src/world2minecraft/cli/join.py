"""``w2m join``: finished runs of single rooms become one home."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    Settings,
    Style,
    Version,
    style_note,
    with_build_options,
)

if TYPE_CHECKING:
    from world2minecraft.core.types import Scan

EXAMPLES = """\
w2m join kitchen hall bedroom --out HOME          by the doors that they have in common
w2m join kitchen hall --out HOME --at hall=3.76,0,1     by hand: metres and quarter turns
w2m install HOME                                  the home comes into your game
"""


def run(
    rooms: Annotated[
        list[Path], typer.Argument(metavar="OUT...", help="Folders of finished runs.")
    ],
    out: Annotated[Path, typer.Option("--out", help="The folder of the home.")],
    places: Annotated[
        list[str] | None,
        typer.Option("--at", metavar="NAME=X,Y,TURNS", help="Where a room stands, by hand."),
    ] = None,
    blocks_per_metre: Scale = 4.0,
    style: Style = None,
    palette: PaletteName = None,
    formats: Formats = None,
    mc_version: Version = "1.20.1",
    settings: Settings = None,
) -> None:
    """Join finished runs into one home with one world.

    The first room keeps its place. Each other one is set beside those that stand, where a door of
    it meets one of theirs: of one width and height, a wall between. Where a room fits in several
    places, they are listed; --at says which. Rooms are turned by quarter turns and moved by whole
    cells, so that nothing is resampled.

    Args:
        rooms: the runs.
        out: the folder to write.
        places: where rooms stand, in metres of the first room's frame and quarter turns.
        blocks_per_metre: the scale.
        style: what furniture is made of.
        palette: which blocks may be used.
        formats: further forms of the build.
        mc_version: the game version.
        settings: further parameters.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.evaluation.report import write_brief_report
    from world2minecraft.reconstruction.homes import join
    from world2minecraft.reconstruction.parameters import Parameters, with_settings

    chosen = Parameters(blocks_per_metre=blocks_per_metre, mc_version=mc_version)
    chosen = with_settings(with_build_options(chosen, style, palette, formats), settings or [])
    style_note(chosen)
    print_compile_note()
    with show_progress() as progress:
        scan = join(rooms, out, chosen, places or (), progress)
        progress("report", 0, 1)
        write_brief_report(out, scan, report_links(rooms, out))
        progress("report", 1, 1)
    print_home(out, scan, len(rooms))


def report_links(rooms: list[Path], out: Path) -> list[tuple[str, str]]:
    """Return the name of each room that has a report, and its address seen from the home's."""
    links = []
    for folder in rooms:
        page = folder / "report.html"
        if page.is_file():
            try:
                address = os.path.relpath(page.resolve(), out.resolve())
            except ValueError:  # Windows: on another drive.
                address = page.resolve().as_uri()
            links.append((folder.resolve().name, address.replace(os.sep, "/")))
    return links


def print_home(out: Path, scan: "Scan", rooms: int) -> None:
    """Print what was joined, and how to see it."""
    from world2minecraft.cli.outcome import print_play_steps

    size = " x ".join(f"{side:.1f}" for side in scan.room_size_m)
    print(f"\n{rooms} rooms in one home, {size} m.")
    for note in scan.notes:
        print(f"note: {note}")
    print(f"\n  look   {out / 'report.html'} in a browser, {out / 'preview.png'}")
    print_play_steps(out / "build")

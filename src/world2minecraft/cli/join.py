"""Join finished runs of single rooms to one home: ``w2m join``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    SettingList,
    Style,
    Version,
    parse_settings,
    print_style_note,
    split_names,
)
from world2minecraft.cli.panels import Force

EXAMPLES = """\
w2m join kitchen hall bedroom -o HOME             by their common doors
w2m join kitchen hall -o HOME --at hall=3.76,0,1  by hand: metres and quarter turns
w2m install HOME                                  copy the home into your game
"""


def run(
    rooms: Annotated[
        list[Path], typer.Argument(metavar="OUT...", help="Folders of finished runs.")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Output folder of the home.")],
    places: Annotated[
        list[str] | None,
        typer.Option("--at", metavar="NAME=X,Y,TURNS", help="Position of a room. Repeatable."),
    ] = None,
    blocks_per_metre: Scale = 4.0,
    style: Style = None,
    palette: PaletteName = None,
    formats: Formats = None,
    mc_version: Version = "1.20.1",
    settings: SettingList = None,
    force: Force = False,
) -> None:
    """Join finished runs to one home with one world.

    The first room keeps its position. Each further room is placed where one of its doors meets a
    door of the same width and height in a room that is already placed, with a wall between the
    doors. If a room fits in several positions, they are listed, and --at selects one. Rooms are
    rotated by quarter turns and moved by whole cells, so no room is resampled.

    Raises:
        UsageError: If a room fits in no position or in several.
        InputError: If a run cannot be read.
        OutputError: If the output folder cannot be written.
    """
    from world2minecraft.api import join_rooms
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    changes = parse_settings(settings)
    print_style_note(blocks_per_metre, changes.get("build.style", style))
    with show_progress() as shown:
        join_rooms(
            rooms,
            out,
            places=places or (),
            blocks_per_metre=blocks_per_metre,
            style=style,
            palette=palette,
            formats=split_names(formats),
            mc_version=mc_version,
            settings=changes,
            force=force,
            progress=compile_first(shown),
        )
    print_home(out, len(rooms))


def print_home(out: Path, rooms: int) -> None:
    """Print the size of the joined home, its notes, and how to open it."""
    from world2minecraft.cli.outcome import print_play_steps
    from world2minecraft.core.files import read_json

    scan = read_json(out / "scan.json")
    size = " x ".join(f"{side:.1f}" for side in scan["room_size_m"])
    print(f"\n{rooms} rooms in one home, {size} m.")
    for note in scan["notes"]:
        print(f"note: {note}")
    print(f"\n  look   {out / 'report.html'} in a browser, {out / 'preview.png'}")
    print_play_steps(out / "build")

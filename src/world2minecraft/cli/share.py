"""Write a room as one file to send: ``w2m share``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import OutFile, more_option

EXAMPLES = """\
w2m share OUT -o room.html                  a page to walk in; opens from disk
w2m share OUT -o room.html --photos 8       with photos, to compare them with the room
w2m share OUT --title "My kitchen" --force  replace room.html
w2m share OUT -o room.gif                   a film of the room coming together
w2m share house.schem -o house.html         any build
"""

Source = Annotated[
    Path,
    typer.Argument(metavar="OUT", help="Run folder, world, or block file such as house.schem."),
]


def run(
    source: Source,
    out: OutFile = Path("room.html"),
    title: Annotated[str, typer.Option("--title", help="Heading of the page.")] = "",
    photos: Annotated[
        int,
        typer.Option(
            "--photos", metavar="N", help="Put up to N photos of the capture into the page."
        ),
    ] = 0,
    capture: Annotated[
        Path | None,
        more_option("--capture", help="Capture with the photos, if the run does not contain it."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Write a room as one file to send: a page to walk in, or a film of it coming together.

    A page (.html) has less than 5 MB, opens from disk in any browser and on a phone, and fetches
    nothing. It contains no photo unless --photos is given. A film (.gif, .mp4, .webm, .webp) shows
    the cells of a reconstruction, then its objects, then the blocks.

    Raises:
        UsageError: If the file exists without --force, or its suffix is unknown.
        InputError: If the room cannot be read, or is too large for a page.
    """
    from world2minecraft.api import share
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_first

    with show_progress() as shown:
        made = share(
            source,
            out,
            title=title,
            photos=photos,
            capture=capture,
            force=force,
            progress=compile_first(shown, "pictures"),
        )
    if made.frames:
        print(f"{made.path}: {made.frames} frames, {made.bytes / 1e6:.1f} MB")
        return
    with_photos = f", {made.photos} photos" if made.photos else ""
    print(f"{made.path}: {made.things} objects{with_photos}, {made.bytes / 1e6:.1f} MB")
    print("  look   open it in a browser; it needs no other file and no network")

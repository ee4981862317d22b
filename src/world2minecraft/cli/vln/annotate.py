"""``w2m vln annotate``: people see the walks of a set and write instructions for them."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.browser import open_link

EXAMPLES = """\
w2m vln annotate SET                          open the page; lines go to SET/annotations.jsonl
w2m vln annotate SET -o mine.jsonl            write to a file of your own
w2m vln annotate SET --no-browser             print the link; open no browser
"""

Folder = Annotated[Path, typer.Argument(metavar="SET", help="A set of w2m vln build.")]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        "-o",
        metavar="FILE",
        help="Add the lines to this file.",
        show_default="SET/annotations.jsonl",
    ),
]
Port = Annotated[
    int | None,
    typer.Option(
        "--port", min=0, max=65535, help="The port to listen on.", show_default="8484, or any free"
    ),
]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Print the link; open no browser.")]


def run(folder: Folder, out: Out = None, port: Port = None, no_browser: NoBrowser = False) -> None:
    """Show each walk as pictures, and record what a person writes of it on three levels.

    The page reports problems as you write: the goal is not named, or by an ambiguous word; turns
    that the walk does not make; an unusual length. Only this machine can open it, and only with
    the printed link.

    Raises:
        InputError: the set has no walk, or cannot be read. UsageError: the port is in use.
    """
    from world2minecraft.api.navigation import annotation_page

    page = annotation_page(folder, out, port=port)
    print(f"{page.walks} walks; lines are added to {page.out}")
    print(f"SceneForge: {page.link}", flush=True)
    print(f"next: w2m vln reword {folder} --annotations {page.out}")
    print("Ctrl+C stops the server; every line is on disk already.", flush=True)
    page.run(lambda: None if no_browser else open_link(page.link))

"""Show the walks of a set to people who write instructions: ``w2m vln annotate``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.browser import open_link

EXAMPLES = """\
w2m vln annotate SET                          write instructions to SET/annotations.jsonl
w2m vln annotate SET -o mine.jsonl            write instructions to another file
w2m vln annotate SET --no-browser             print the link without opening a browser
"""

Folder = Annotated[Path, typer.Argument(metavar="SET", help="Navigation set from w2m vln build.")]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        "-o",
        metavar="FILE",
        help="Append instructions to this file.",
        show_default="SET/annotations.jsonl",
    ),
]
Port = Annotated[
    int | None,
    typer.Option(
        "--port", min=0, max=65535, help="Port to listen on.", show_default="8484, or any free port"
    ),
]
NoBrowser = Annotated[
    bool, typer.Option("--no-browser", help="Print the link without opening a browser.")
]


Replace = Annotated[
    bool,
    typer.Option("--force", help="Keep only the instructions of a file with other data."),
]


def run(
    folder: Folder,
    out: Out = None,
    port: Port = None,
    no_browser: NoBrowser = False,
    force: Replace = False,
) -> None:
    """Show each walk as images, and record the instructions that a person writes on three levels.

    The page reports problems while you write: a missing or ambiguous goal, turns that differ from
    the walk, or an unusual length. Only this machine can open the page, and only with the printed
    link.

    Raises:
        InputError: If the set contains no walks or cannot be read.
        UsageError: If the port is in use, or the file contains other data.
    """
    from world2minecraft.api.navigation import annotation_page

    page = annotation_page(folder, out, port=port, force=force)
    print(f"{page.walks} walks; instructions are appended to {page.out}")
    print(f"SceneForge: {page.link}", flush=True)
    print(f"next: w2m vln reword {folder} --annotations {page.out}")
    print("Press Ctrl+C to stop; every instruction is saved immediately.", flush=True)
    page.run(lambda: None if no_browser else open_link(page.link))

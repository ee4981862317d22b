"""``w2m vln annotate``: a person sees walks of a set and writes what to tell the next one."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.browser import open_link

EXAMPLES = """\
w2m vln annotate SET                          a page; what is written is in SET/annotations.jsonl
w2m vln annotate SET --out mine.jsonl         kept in a file of your own
w2m vln annotate SET --no-browser             print the link, and open nothing
"""

Folder = Annotated[Path, typer.Argument(metavar="SET", help="Made by w2m vln build.")]
Out = Annotated[Path | None, typer.Option("--out", help="Where to write; lines are added to it.")]
Port = Annotated[
    int | None, typer.Option("--port", min=0, max=65535, help="8484, or any that is free.")
]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Print the link, and open nothing.")]


def run(folder: Folder, out: Out = None, port: Port = None, no_browser: NoBrowser = False) -> None:
    """Show each walk as pictures, and keep what a person writes of it on three levels.

    While one writes the page says what is wrong: the goal is not named, or by a word that means
    two things; other turns than the walk makes; a length out of the usual. Only this machine can
    open it, and only with the link that is printed.

    Raises:
        InputError: the set has no walk, or cannot be read. UsageError: the port is taken.
    """
    from world2minecraft.sceneforge.annotation.app import annotation_server
    from world2minecraft.sceneforge.annotation.store import AnnotationStore

    desk = AnnotationStore(folder, out)
    server = annotation_server(desk, port)
    print(f"{len(desk.walks)} walks; what is written is kept in {desk.out}")
    print(f"SceneForge: {server.link}", flush=True)
    print(f"next: w2m vln reword {folder} --annotations {desk.out}")
    print("Ctrl+C stops it; everything written is kept.", flush=True)
    server.run(lambda: None if no_browser else open_link(server.link))

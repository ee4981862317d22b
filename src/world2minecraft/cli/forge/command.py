"""View every stage of a room in the browser, and edit the room: ``w2m forge``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.browser import open_link
from world2minecraft.cli.panels import MORE
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.editor import EditorSession

EXAMPLES = """\
w2m forge OUT                   edit a run: its room, objects, photos, blocks
w2m forge room.npz              edit an occupancy file, or occ.json
w2m forge --demo                edit the demo room
w2m forge                       open the start page, to drop a capture on it
w2m forge IMG_2041.MOV          inspect a capture, then reconstruct the room
w2m forge OUT --capture scan    edit a run with the photos of its capture
w2m forge OUT --no-browser      print the link without opening a browser
w2m forge OUT --walk            walk with the view and steps of an agent
"""

Host = Annotated[
    str,
    typer.Option(
        "--host",
        help="Address to listen on; non-local addresses admit other machines.",
        rich_help_panel=MORE,
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
AllowHost = Annotated[
    list[str] | None,
    typer.Option(
        "--allow-host",
        help="Additional host name of this machine. Repeatable.",
        rich_help_panel=MORE,
    ),
]
Home = Annotated[
    Path | None,
    typer.Option(
        "--home",
        help="Folder for captures and rooms created in the editor.",
        show_default="SceneForge in your data folder",
        rich_help_panel=MORE,
    ),
]
PhotosOf = Annotated[
    Path | None, typer.Option("--capture", help="Capture of the run, to show its photos.")
]
Walk = Annotated[
    bool, typer.Option("--walk", help="Walk through a world by keyboard, without editing.")
]
MaxUpload = Annotated[
    int,
    typer.Option(
        "--max-upload",
        metavar="MB",
        min=1,
        help="Size limit of an uploaded capture.",
        rich_help_panel=MORE,
    ),
]


def run(
    source: Annotated[
        Path | None,
        typer.Argument(metavar="[OUT_OR_FILE]", help="Run folder, occupancy file or capture."),
    ] = None,
    demo: Annotated[bool, typer.Option("--demo", help="Open the demo room.")] = False,
    host: Host = "127.0.0.1",
    port: Port = None,
    allow_host: AllowHost = None,
    home: Home = None,
    capture: PhotosOf = None,
    max_upload: MaxUpload = 4096,
    no_browser: NoBrowser = False,
    walk: Walk = False,
) -> None:
    """Serve the editor for a room and open it in the browser, until Ctrl+C is pressed.

    Every edit is recorded next to the room immediately and can be undone. The files of the room
    change when you save in the editor. Only this machine can open the editor, and only with the
    printed link.

    Raises:
        UsageError: If options exclude each other or the port is in use.
        InputError: If the source does not contain a room.
    """
    from world2minecraft.api.editor import prepare_editor

    if walk:
        return _walk(source, no_browser)
    session = prepare_editor(
        source,
        demo=demo,
        host=host,
        port=port,
        allow_hosts=allow_host or (),
        home=home,
        capture=capture,
        max_upload_mb=max_upload,
    )
    _print_link(session)
    session.run(lambda: None if no_browser else open_link(session.link))


def _walk(source: Path | None, no_browser: bool) -> None:
    """Let the user walk through a world on a page that shows the view of an agent."""
    from world2minecraft.api.editor import prepare_walk
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_kernels

    if source is None:
        raise UsageError("--walk requires a world, as in w2m forge OUT --walk")
    with show_progress() as progress:
        compile_kernels("navigation", progress)
    walk = prepare_walk(source)
    print(f"walk here: {walk.link}\nPress Ctrl+C to stop.", flush=True)
    if not no_browser:
        open_link(walk.link)
    walk.run()


def _print_link(session: "EditorSession") -> None:
    """Print the notes, a warning if other machines can reach the page, and the link."""
    if session.demo_folder is not None:
        print(f"note: the demo room is stored in {session.demo_folder}")
    if session.is_public:
        print(
            f"warning: anyone with the link who can reach {session.host} can edit, and the "
            "connection is not encrypted; an SSH tunnel is safer (docs/forge.md)"
        )
    for note in session.notes:
        print(f"note: {note}")
    if session.read_only:
        print(f"note: opened read-only: {session.read_only}")
    print(f"SceneForge: {session.link}", flush=True)
    print("Press Ctrl+C to stop; every edit is saved.", flush=True)

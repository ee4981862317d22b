"""``w2m forge``: see every stage of a room in the browser, and edit it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.browser import open_link
from world2minecraft.cli.panels import MORE
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.editor import EditorSession

EXAMPLES = """\
w2m forge OUT                   a run: its room, objects, photos, blocks
w2m forge room.npz              any occupancy file; occ.json too
w2m forge --demo                a room to try it on
w2m forge                       the start page: drop a capture on it
w2m forge IMG_2041.MOV          a capture: see what is in it, then make the room
w2m forge OUT --capture scan    a run, and the capture with its photos
w2m forge OUT --no-browser      print the link, and open nothing
w2m forge OUT --walk            walk there with an agent's view and steps
"""

Host = Annotated[
    str,
    typer.Option(
        "--host",
        help="Address to listen on; one that is not local lets other machines in.",
        rich_help_panel=MORE,
    ),
]
Port = Annotated[
    int | None,
    typer.Option("--port", min=0, max=65535, help="Port.", show_default="8484, or a free one"),
]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Print the link, and open nothing.")]
AllowHost = Annotated[
    list[str] | None,
    typer.Option(
        "--allow-host",
        help="A further name of this machine. Repeatable.",
        rich_help_panel=MORE,
    ),
]
Home = Annotated[
    Path | None,
    typer.Option(
        "--home",
        help="Folder for captures and rooms made in the editor.",
        show_default="SceneForge in your data folder",
        rich_help_panel=MORE,
    ),
]
PhotosOf = Annotated[
    Path | None, typer.Option("--capture", help="The capture of the run, for its photos.")
]
Walk = Annotated[
    bool, typer.Option("--walk", help="Walk in any world as agents do, by keyboard; no editing.")
]
MaxUpload = Annotated[
    int,
    typer.Option(
        "--max-upload",
        metavar="MB",
        min=1,
        help="Limit of one dropped capture.",
        rich_help_panel=MORE,
    ),
]


def run(
    source: Annotated[
        Path | None,
        typer.Argument(metavar="[OUT_OR_FILE]", help="A run's folder, a file, a capture."),
    ] = None,
    demo: Annotated[bool, typer.Option("--demo", help="Open a room to try it on.")] = False,
    host: Host = "127.0.0.1",
    port: Port = None,
    allow_host: AllowHost = None,
    home: Home = None,
    capture: PhotosOf = None,
    max_upload: MaxUpload = 512,
    no_browser: NoBrowser = False,
    walk: Walk = False,
) -> None:
    """Serve the editor of one room and open it in the browser, until Ctrl+C.

    Every edit is saved beside the room as it is made and can be undone; the files of the room
    change when you save. Only this machine can reach the editor, and only by the link that is
    printed.

    Raises:
        UsageError: the options exclude each other, or the port is in use.
        InputError: the source holds no room.
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
    """Let a person walk in a world on the page that shows what agents see."""
    from world2minecraft.api.editor import prepare_walk
    from world2minecraft.cli.outcome import print_compile_note

    if source is None:
        raise UsageError("--walk needs a world, as in w2m forge OUT --walk")
    print_compile_note()
    walk = prepare_walk(source)
    print(f"walk here: {walk.link}\nCtrl+C ends it.", flush=True)
    if not no_browser:
        open_link(walk.link)
    walk.run()


def _print_link(session: "EditorSession") -> None:
    """Print notes, a warning where other machines can reach the page, and the link."""
    if session.demo_folder is not None:
        print(f"note: the demo room is stored in {session.demo_folder}")
    if session.is_public:
        print(
            f"warning: anyone who can reach {session.host} and has the link can edit, and nothing "
            "is encrypted; an SSH tunnel is safer (docs/forge.md)"
        )
    for note in session.notes:
        print(f"note: {note}")
    if session.read_only:
        print(f"note: opened read-only: {session.read_only}")
    print(f"SceneForge: {session.link}", flush=True)
    print("Ctrl+C stops it; every edit is saved.", flush=True)

"""``w2m forge``: see every stage of a room in the browser, and put it right."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.browser import open_link

if TYPE_CHECKING:
    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.server.server_process import ForgeServer

EXAMPLES = """\
w2m forge OUT                   a run: its room, objects, photos, blocks
w2m forge room.npz              any occupancy file; occ.json too
w2m forge --demo                a room to try it on
w2m forge                       a page to start from: drop a capture on it
w2m forge IMG_2041.MOV          a capture: see what is in it, then make the room
w2m forge OUT --capture scan    a run, and where its photos lie
w2m forge OUT --no-browser      print the link, and open nothing
w2m forge OUT --walk            walk there with an agent's eyes and steps
"""

Host = Annotated[
    str, typer.Option("--host", help="Listen here; others than this machine can come in.")
]
Port = Annotated[
    int | None, typer.Option("--port", min=0, max=65535, help="8484, or any that is free.")
]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Print the link, and open nothing.")]
AllowHost = Annotated[
    list[str] | None,
    typer.Option("--allow-host", help="A further name of this machine; may be given again."),
]
Home = Annotated[
    Path | None, typer.Option("--home", help="Where captures and rooms of the page are kept.")
]
PhotosOf = Annotated[
    Path | None, typer.Option("--capture", help="Where the photos of the run lie.")
]
Walk = Annotated[
    bool,
    typer.Option("--walk", help="Walk in any world as agents do, by the keyboard; edit nothing."),
]
MaxUpload = Annotated[
    int, typer.Option("--max-upload", metavar="MB", min=1, help="Of one dropped capture.")
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

    Everything is kept as it is done, beside the room, and can be undone; the room's own files
    change only when you save. Only this machine can reach the editor, and only with the link that
    is printed.

    Args:
        source: a run's folder, or an occupancy file; nothing for the start page.
        demo: whether to open the demo room.
        host: the address to listen on.
        port: the port to listen on.
        allow_host: names, beside addresses and localhost, that a browser may call it by.
        home: the folder for captures and rooms made here; SceneForge in your data folder.
        capture: what the run was made of, where its folder does not say so; remembered.
        max_upload: the most megabytes that a dropped capture may hold.
        no_browser: whether to open no browser.
        walk: whether to walk in the world rather than edit it.

    Raises:
        UsageError: the words contradict each other, or the port is taken.
        InputError: there is no room in the source.
    """
    from world2minecraft.core.errors import UsageError
    from world2minecraft.sceneforge.document.document_metadata import document_folder
    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.scene_sources import DEMO_OUT
    from world2minecraft.sceneforge.server.server_process import ForgeServer
    from world2minecraft.sceneforge.uploads import is_capture, user_home

    if walk:
        return _walk(source, no_browser)
    if demo and source is not None:
        raise UsageError("--demo is a room of its own; leave out the file, or --demo")
    dropped = source is not None and is_capture(source)
    place = (home or user_home()) / DEMO_OUT if demo else None
    editor = Editor.open(source, out=place) if demo or (source and not dropped) else None
    places = {"home": home, "capture": capture, "max_upload_bytes": max_upload << 20}
    server = ForgeServer(editor, host=host, port=port, hosts=allow_host or (), **places)
    first = source or (editor and document_folder(None, place))
    if first:
        server.workspace.begin_with(first, dropped)
    if place is not None:
        print(f"note: your demo room is kept in {place.parent}")
    _print_link(server, editor)
    server.run(lambda: None if no_browser else open_link(server.link))


def _walk(source: Path | None, no_browser: bool) -> None:
    """Let a person walk in a world on the page that shows what agents see."""
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.core.errors import UsageError
    from world2minecraft.navigation.browser_window import Window
    from world2minecraft.navigation.free_walk import walk_freely
    from world2minecraft.navigation.running.human_agent import VIEW_WIDTH_PX
    from world2minecraft.navigation.scene import open_scene

    if source is None:
        raise UsageError("say where to walk, such as w2m forge OUT --walk")
    print_compile_note()
    scene = open_scene(source)
    window = Window(VIEW_WIDTH_PX)
    print(f"walk here: {window.link}\nCtrl+C ends it.", flush=True)
    if not no_browser:
        open_link(window.link)
    try:
        walk_freely(scene, window)
    finally:
        window.close()


def _print_link(server: "ForgeServer", editor: "Editor | None") -> None:
    """Print what is to be known, and the link."""
    if server.is_open:
        print(
            f"warning: whoever reaches {server.host} and has the link can edit, and nothing is "
            "encrypted; an SSH tunnel is safer (docs/forge.md)"
        )
    for note in editor.notes if editor else ():
        print(f"note: {note}")
    if editor and editor.read_only:
        print(f"note: open to be read only: {editor.read_only}")
    print(f"SceneForge: {server.link}", flush=True)
    print("Ctrl+C stops it; everything done is kept.", flush=True)

"""View every stage of a room in the browser, and edit the room: ``w2m forge``."""

import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.browser import open_link
from world2minecraft.cli.panels import MORE
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.editor import EditorSession

LOOPBACK = "127.0.0.1"
EXAMPLES = """\
w2m forge OUT                   edit a run: its room, objects, photos, blocks
w2m forge room.npz              edit an occupancy file, or occ.json
w2m forge --demo                edit the demo room
w2m forge                       open the start page, to drop a capture on it
w2m forge IMG_2041.MOV          inspect a capture, then reconstruct the room
w2m forge OUT --capture scan    edit a run with the photos of its capture
w2m forge OUT --no-browser      print the link without opening a browser
w2m forge OUT --walk            walk with the view and steps of an agent
w2m forge --phone               scan a room with a phone on the same Wi-Fi
w2m forge OUT --agent gemini    let a model walk in Walk mode, at most for $0.25
"""

Host = Annotated[
    str | None,
    typer.Option(
        "--host",
        help="Address to listen on; non-local addresses admit other machines. With --phone, the "
        "address of the phone page alone.",
        show_default="127.0.0.1",
        rich_help_panel=MORE,
    ),
]
Phone = Annotated[
    bool,
    typer.Option("--phone", help="Also serve a page on the local network to scan with a phone."),
]
Tls = Annotated[
    tuple[Path, Path] | None,
    typer.Option(
        "--tls",
        metavar="CERT KEY",
        help="Certificate and key (PEM), to serve the phone page over HTTPS.",
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
Agent = Annotated[
    str,
    typer.Option(
        "--agent",
        help="Model that walks where you tell it to, in Walk mode: gemini, openai, qwen or local, "
        "optionally followed by :MODEL; or a server address. It sees views of the blocks.",
        show_default="those whose API key is set",
        rich_help_panel=MORE,
    ),
]
MaxUsd = Annotated[
    float | None,
    typer.Option(
        "--max-usd",
        min=0,
        help="Cost limit of each model in US dollars.",
        show_default="0.25",
        rich_help_panel=MORE,
    ),
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
    phone: Phone = False,
    host: Host = None,
    port: Port = None,
    allow_host: AllowHost = None,
    home: Home = None,
    capture: PhotosOf = None,
    max_upload: MaxUpload = 4096,
    agent: Agent = "",
    max_usd: MaxUsd = None,
    tls: Tls = None,
    no_browser: NoBrowser = False,
    walk: Walk = False,
) -> None:
    """Serve the editor for a room and open it in the browser, until Ctrl+C is pressed.

    Every edit is recorded next to the room immediately and can be undone. The files of the room
    change when you save in the editor. Only this machine can open the editor, and only with the
    printed link. With --phone, one phone can scan a room on a page of its own, with the printed
    code.

    Raises:
        UsageError: If options exclude each other, the port is in use or there is no local network.
        InputError: If the source does not contain a room.
    """
    from world2minecraft.api.editor import prepare_editor

    if tls and not phone:
        raise UsageError("--tls is for the phone page; add --phone, or omit --tls")
    if walk and phone:
        raise UsageError("--phone is part of the editor, not of --walk; omit one of them")
    if walk:
        return _walk(source, no_browser)
    session = prepare_editor(
        source,
        demo=demo,
        host=LOOPBACK if phone else host or LOOPBACK,
        port=port,
        allow_hosts=allow_host or (),
        home=home,
        capture=capture,
        max_upload_mb=max_upload,
        phone=phone,
        phone_host=host,
        tls=tls,
        agent=agent,
        max_usd=max_usd,
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
            "connection is not encrypted; an SSH tunnel is safer (docs/reference/forge.md)"
        )
    for note in session.notes:
        print(f"note: {note}")
    if session.read_only:
        print(f"note: opened read-only: {session.read_only}")
    print(f"SceneForge: {session.link}", flush=True)
    if session.phone_link:
        _print_phone(session)
    print("Press Ctrl+C to stop; every edit is recorded, and Save writes the room.", flush=True)


def _print_phone(session: "EditorSession") -> None:
    """Print the link for a phone, as a code where the terminal can show one."""
    print(f"phone:      {session.phone_link}")
    code = session.phone_code
    with suppress(UnicodeEncodeError):
        code.encode(sys.stdout.encoding or "ascii")
        if sys.stdout.isatty():
            print(code)
    print(
        "Scan the code with a phone in the same Wi-Fi. It lets one phone in, within ten minutes; "
        "the start page shows new ones."
    )
    if session.phone_link.startswith("http:"):
        print(
            "note: the phone page is not encrypted: use a Wi-Fi that you trust, or --tls CERT KEY"
        )

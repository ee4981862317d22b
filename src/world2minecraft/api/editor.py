"""Open SceneForge (the web editor), walk through worlds in the browser, and measure edits."""

import html
import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.evaluation.metrics.editing_effort import Effort
    from world2minecraft.navigation.browser_window import Window
    from world2minecraft.navigation.scene import VlnScene
    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.server.server_process import ForgeServer


# The frame and the notebook must have the same host name: browsers send the cookie of the editor
# only then. Where scripts do not run, the link alone is shown.
FRAME = """\
<p><a class="{name}" href="{link}" target="_blank">Open SceneForge</a></p>
<iframe class="{name}" width="100%" height="640" style="display: none; border: 0"></iframe>
<script>
(() => {{
  if (!["localhost", "127.0.0.1"].includes(location.hostname)) return;
  const [link, frame] = document.querySelectorAll(".{name}");
  link.hostname = location.hostname;
  frame.src = link.href;
  frame.style.display = "block";
}})();
</script>
"""


@dataclass(frozen=True, eq=False)
class EditorSession:
    """A running SceneForge editor. A notebook on this machine shows it in a frame.

    Attributes:
        server: Web server of the editor.
        notes: Remarks about the room from opening it.
        read_only: Why the room cannot be edited. Empty if it can be edited.
        demo_folder: Folder of the demo room. None for other rooms.
    """

    server: "ForgeServer"
    notes: tuple[str, ...] = ()
    read_only: str = ""
    demo_folder: Path | None = None

    @property
    def link(self) -> str:
        """The address of the page, including the token that grants access."""
        return self.server.link

    @property
    def is_public(self) -> bool:
        """Whether other machines can reach the page."""
        return self.server.is_open

    @property
    def host(self) -> str:
        """The address that the server listens on."""
        return self.server.host

    @property
    def phone_link(self) -> str:
        """The link that lets one phone scan a room. Empty without a phone page, or once used."""
        return "" if self.server.phone is None else self.server.phone.access.link

    @property
    def phone_code(self) -> str:
        """The QR code of ``phone_link`` as lines for a terminal."""
        from world2minecraft.sceneforge.phone_access import qr_text

        return qr_text(self.phone_link) if self.phone_link else ""

    def run(self, ready: Callable[[], None] = lambda: None) -> None:
        """Serve in this thread until Ctrl+C is pressed, if the server is not running yet.

        Args:
            ready: Callback that is called as soon as the page can be opened.
        """
        self.server.run(ready)

    def stop(self) -> None:
        """Stop the server. No edits are lost, because every edit is already saved."""
        self.server.stop()

    def __enter__(self) -> "EditorSession":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        return f"EditorSession({self.server.url!r})"

    def _repr_html_(self) -> str:
        return FRAME.format(link=html.escape(self.link), name=f"w2m-{secrets.token_hex(4)}")


def open_editor(
    source: Run | str | Path | None = None, *, port: int | None = None, browser: bool = False
) -> EditorSession:
    """Start SceneForge for a room in the background of this process.

    Every edit is recorded next to the room immediately and can be undone. The files of the room
    change when you save in the editor. Only this machine can open the page, and only with its link.

    Args:
        source: Run, run folder or occupancy file. None opens the start page.
        port: Port to listen on. Defaults to 8484, or to any free port if 8484 is in use.
        browser: Open the page in the browser.

    Raises:
        UsageError: If the port is in use.
        InputError: If the source does not contain a room.

    Example:
        >>> import world2minecraft as w2m
        >>> with w2m.open_editor(run, port=0) as editor:
        ...     editor.link.startswith("http://127.0.0.1:")
        True
    """
    import webbrowser

    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.server.server_process import ForgeServer

    editor = None if source is None else Editor.open(path_of(source))
    server = ForgeServer(editor, port=port, in_notebook=True).start()
    if browser:
        webbrowser.open(server.link)
    return EditorSession(server, *_state_of(editor))


def prepare_editor(
    source: Run | str | Path | None = None,
    *,
    demo: bool = False,
    host: str = "127.0.0.1",
    port: int | None = None,
    allow_hosts: Sequence[str] = (),
    home: str | Path | None = None,
    capture: str | Path | None = None,
    max_upload_mb: int = 4096,
    phone: bool = False,
    phone_host: str | None = None,
    tls: tuple[Path, Path] | None = None,
    agent: str = "",
    max_usd: float | None = None,
) -> EditorSession:
    """Prepare SceneForge without starting it.

    Call ``run`` on the returned session to serve until Ctrl+C is pressed.

    Args:
        source: Run, run folder, occupancy file or capture. None opens the start page.
        demo: Open the demo room. Cannot be combined with a source.
        host: Address to listen on.
        port: Port to listen on. Defaults to 8484, or to any free port if 8484 is in use.
        allow_hosts: Further host names of this machine, in addition to IP addresses and
            ``localhost``.
        home: Folder for captures and rooms created in the editor. Defaults to SceneForge in the
            user's data folder.
        capture: Capture of the run, if the run folder does not record it. The path is remembered.
        max_upload_mb: Maximum size of an uploaded capture in MiB.
        phone: Serve, beside the editor, a page on the local network to scan a room with a phone.
        phone_host: Address of this machine for the phone page. Defaults to its address on the
            local network.
        tls: Files of a certificate and its key (PEM), with which the phone page is served over
            HTTPS.
        agent: Model that can walk in the room beside the planner: a provider or the address of a
            server, as for ``w2m vln run``. Providers whose API key is set can walk as well.
        max_usd: Cost limit of each model in US dollars. Defaults to 0.25, or to 500 requests where
            no price is known.

    Raises:
        UsageError: If ``demo`` is combined with a source, if the port is in use, or if there is no
            local network or no library for the phone page.
        InputError: If the source does not contain a room, or the certificate cannot be used.

    Example:
        >>> from world2minecraft.api.editor import prepare_editor
        >>> prepare_editor(home=tmp, port=0).is_public
        False
    """
    from world2minecraft.sceneforge.agent_walks import WalkAgents
    from world2minecraft.sceneforge.document.document_metadata import document_folder
    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.phone_captures import check_phone_libraries
    from world2minecraft.sceneforge.scene_sources import DEMO_OUT
    from world2minecraft.sceneforge.server.local_address import lan_address
    from world2minecraft.sceneforge.server.server_process import ForgeServer
    from world2minecraft.sceneforge.uploads import is_capture, user_home

    if phone:
        check_phone_libraries()
    if demo and source is not None:
        raise UsageError("--demo opens the demo room; omit either --demo or the file")
    place = None if source is None else path_of(source)
    is_dropped = place is not None and is_capture(place)
    demo_out = (Path(home) if home else user_home()) / DEMO_OUT if demo else None
    opens_room = demo or (place is not None and not is_dropped)
    editor = Editor.open(place, out=demo_out) if opens_room else None
    server = ForgeServer(
        editor,
        host=host,
        port=port,
        hosts=allow_hosts,
        home=None if home is None else Path(home),
        capture=None if capture is None else Path(capture),
        max_upload_bytes=max_upload_mb << 20,
        phone=(phone_host or lan_address()) if phone else None,
        tls=tls,
        agents=WalkAgents.configured(agent, max_usd),
    )
    if server.phone is not None:
        server.phone.access.new_code()
    first = place or (document_folder(None, demo_out) if demo else None)
    if first is not None:
        server.workspace.begin_with(first, is_dropped)
    folder = None if demo_out is None else demo_out.parent
    return EditorSession(server, *_state_of(editor), folder)


def _state_of(editor: "Editor | None") -> tuple[tuple[str, ...], str]:
    """Return the notes of an editor and the reason why the room is read-only."""
    return (tuple(editor.notes), editor.read_only) if editor else ((), "")


@dataclass(frozen=True, eq=False)
class WalkSession:
    """A walk through a world in the browser, which ``run`` serves.

    Attributes:
        scene: World to walk through.
        window: Browser page of the walk.
    """

    scene: "VlnScene"
    window: "Window"

    @property
    def link(self) -> str:
        """The address of the page, including the token that grants access."""
        return self.window.link

    def run(self) -> None:
        """Move the player according to the keys pressed on the page, until Ctrl+C is pressed.

        Raises:
            UsageError: If no key is pressed for ten minutes.
        """
        from world2minecraft.navigation.free_walk import walk_freely

        try:
            walk_freely(self.scene, self.window)
        finally:
            self.close()

    def close(self) -> None:
        """Stop serving the page."""
        self.window.close()


def prepare_walk(source: Run | str | Path) -> WalkSession:
    """Prepare a walk through a world with the view and the steps of a navigation agent.

    Raises:
        InputError: If the source is not a world.
        UsageError: If the world has no position where a player can stand.

    Example:
        >>> from world2minecraft.api.editor import prepare_walk
        >>> walk = prepare_walk(run)
        >>> walk.link.startswith("http://127.0.0.1:")
        True
        >>> walk.close()
    """
    from world2minecraft.navigation.browser_window import Window
    from world2minecraft.navigation.running.human_agent import VIEW_WIDTH_PX
    from world2minecraft.navigation.scene import open_scene

    scene = open_scene(path_of(source))
    return WalkSession(scene, Window(VIEW_WIDTH_PX))


@dataclass(frozen=True)
class EffortTable:
    """The number of operations and the editing time of scenes, as in the paper's efficiency table.

    Attributes:
        efforts: Editing effort of the scenes that started from a reconstruction.
        scratch: Editing effort of the scenes that were built from an empty grid.
    """

    efforts: tuple["Effort", ...]
    scratch: tuple["Effort", ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return the effort of each scene, the means and the paper's results as JSON values."""
        from world2minecraft.sceneforge.effort_table import stats_json

        return stats_json(self.efforts, self.scratch)

    def to_csv(self) -> str:
        """Return a CSV table with a header and one row per scene."""
        from world2minecraft.sceneforge.effort_table import stats_csv

        return stats_csv([*self.efforts, *self.scratch])

    def to_latex(self) -> str:
        """Return the table of means in LaTeX."""
        from world2minecraft.sceneforge.effort_table import stats_latex

        return stats_latex(self.efforts, self.scratch)

    def __str__(self) -> str:
        from world2minecraft.sceneforge.effort_table import stats_text

        return stats_text(self.efforts, self.scratch)


def measure_editing(
    scenes: Sequence[Run | str | Path], scratch: Sequence[Run | str | Path] = ()
) -> EffortTable:
    """Count the operations and the working time of scenes that were edited in SceneForge.

    Args:
        scenes: Rooms that were opened in the editor, or their ``.forge`` folders.
        scratch: Scenes that were built from an empty grid.

    Raises:
        InputError: If a scene has never been edited.
    """
    from world2minecraft.sceneforge.effort_table import effort_at

    return EffortTable(
        tuple(effort_at(path_of(place)) for place in scenes),
        tuple(effort_at(path_of(place)) for place in scratch),
    )

"""SceneForge, the web editor, from Python; walks in the browser; the effort of edited scenes."""

import html
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


@dataclass(frozen=True, eq=False)
class EditorSession:
    """A running editor; a notebook shows it in a frame, and ``stop`` ends it.

    Attributes:
        server: the server behind the page.
        notes: what the editor found when it opened the room.
        read_only: the reason why the room cannot be edited; empty where it can.
        demo_folder: where the demo room is stored; None for other rooms.
    """

    server: "ForgeServer"
    notes: tuple[str, ...] = ()
    read_only: str = ""
    demo_folder: Path | None = None

    @property
    def link(self) -> str:
        """The address of the page, with the token that lets this user in."""
        return self.server.link

    @property
    def is_public(self) -> bool:
        """Whether other machines can reach the page."""
        return self.server.is_open

    @property
    def host(self) -> str:
        """The address that the server listens on."""
        return self.server.host

    def run(self, ready: Callable[[], None] = lambda: None) -> None:
        """Serve in this thread until Ctrl+C, where the editor was not started yet.

        Args:
            ready: called once the page can be opened.
        """
        self.server.run(ready)

    def stop(self) -> None:
        """Stop the server; every edit is on disk already."""
        self.server.stop()

    def __enter__(self) -> "EditorSession":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        return f"EditorSession({self.server.url!r})"

    def _repr_html_(self) -> str:
        link = html.escape(self.link)
        frame = f'<iframe src="{link}" width="100%" height="640"></iframe>'
        return f'<p><a href="{link}" target="_blank">Open SceneForge</a></p>{frame}'


def open_editor(
    source: Run | str | Path | None = None, *, port: int | None = None, browser: bool = False
) -> EditorSession:
    """Start SceneForge for a room in the background of this process.

    Every edit is saved beside the room as it is made and can be undone; the files of the room
    change when you save. Only this machine can reach the page, and only by its link.

    Args:
        source: a run, its folder or an occupancy file; None for the start page.
        port: the port to listen on; 8484, or any free one, by default.
        browser: open the page in the browser.

    Raises:
        UsageError: the port is in use. InputError: the source holds no room.

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
    server = ForgeServer(editor, port=port).start()
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
    max_upload_mb: int = 512,
) -> EditorSession:
    """Prepare SceneForge without starting it; ``run`` of the session serves until Ctrl+C.

    Args:
        source: a run, its folder, an occupancy file, or a capture; None for the start page.
        demo: open the demo room; no source is given then.
        host: the address to listen on.
        port: the port to listen on; 8484, or any free one, by default.
        allow_hosts: further names of this machine, beside addresses and ``localhost``.
        home: the folder for captures and rooms made in the editor; SceneForge in the user's data
            folder by default.
        capture: the capture of the run, where its folder does not state it; remembered.
        max_upload_mb: the limit of one uploaded capture.

    Raises:
        UsageError: ``demo`` and a source are given, or the port is in use.
        InputError: the source holds no room.

    Example:
        >>> from world2minecraft.api.editor import prepare_editor
        >>> prepare_editor(home=tmp, port=0).is_public
        False
    """
    from world2minecraft.sceneforge.document.document_metadata import document_folder
    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.scene_sources import DEMO_OUT
    from world2minecraft.sceneforge.server.server_process import ForgeServer
    from world2minecraft.sceneforge.uploads import is_capture, user_home

    if demo and source is not None:
        raise UsageError("--demo opens a room of its own; leave out the file, or --demo")
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
    )
    first = place or (document_folder(None, demo_out) if demo else None)
    if first is not None:
        server.workspace.begin_with(first, is_dropped)
    folder = None if demo_out is None else demo_out.parent
    return EditorSession(server, *_state_of(editor), folder)


def _state_of(editor: "Editor | None") -> tuple[tuple[str, ...], str]:
    """Return the notes of an editor, and why it cannot edit."""
    return (tuple(editor.notes), editor.read_only) if editor else ((), "")


@dataclass(frozen=True, eq=False)
class WalkSession:
    """A walk through a world in the browser; ``run`` serves it until nobody walks any more.

    Attributes:
        scene: the world.
        window: the page.
    """

    scene: "VlnScene"
    window: "Window"

    @property
    def link(self) -> str:
        """The address of the page, with the token that lets this user in."""
        return self.window.link

    def run(self) -> None:
        """Follow the keys that are pressed on the page, until Ctrl+C.

        Raises:
            UsageError: nobody pressed a key for ten minutes.
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
    """Prepare a walk through a world with the view and the steps of an agent.

    Raises:
        InputError: the source is no world. UsageError: there is no place to stand.

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
    """The operations and times of edited scenes, as the paper's efficiency table.

    Attributes:
        efforts: of the edited scenes.
        scratch: of scenes that were built from nothing, for the other column.
    """

    efforts: tuple["Effort", ...]
    scratch: tuple["Effort", ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return each scene, the means and the paper's figures as JSON values."""
        from world2minecraft.sceneforge.effort_table import stats_json

        return stats_json(self.efforts, self.scratch)

    def to_csv(self) -> str:
        """Return a line for each scene, under a head."""
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
        scenes: what was opened in the editor, or their ``.forge`` folders.
        scratch: scenes that were built from an empty grid.

    Raises:
        InputError: a scene was never edited.
    """
    from world2minecraft.sceneforge.effort_table import effort_at

    return EffortTable(
        tuple(effort_at(path_of(place)) for place in scenes),
        tuple(effort_at(path_of(place)) for place in scratch),
    )

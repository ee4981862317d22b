"""SceneForge, the web editor, from Python."""

import html
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of

if TYPE_CHECKING:
    from world2minecraft.sceneforge.server.server_process import ForgeServer


@dataclass(frozen=True, eq=False)
class EditorSession:
    """A running editor; a notebook shows it in a frame, and ``stop`` ends it.

    Attributes:
        server: the server behind the page.
    """

    server: "ForgeServer"

    @property
    def link(self) -> str:
        """The address of the page, with the token that lets this user in."""
        return self.server.link

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
    return EditorSession(server)

"""What stands around the document: jobs, captures, and the rooms that were open before."""

import asyncio
from pathlib import Path

from world2minecraft.errors import InputError, UnknownNameError, UsageError
from world2minecraft.files import read_json, write_json
from world2minecraft.forge.captures import MOST_UPLOAD_BYTES, CaptureFolder, Captures
from world2minecraft.forge.editor import Editor
from world2minecraft.forge.session import NO_ROOM, Session

MOST_RECENT = 12


class Workshop:
    """The start page's state; one for each server.

    Args:
        session: holds the document and the tabs (``session.hub.tell_soon``).
        home: the folder for captures and rooms made here.
        most_bytes: the most that one upload may hold.
        capture: where the capture of the open run lies, where its folder does not say so.
    """

    def __init__(
        self,
        session: Session,
        home: Path,
        *,
        most_bytes: int = MOST_UPLOAD_BYTES,
        capture: Path | None = None,
    ):
        self.session, self.home, self.capture = session, home, capture
        self.captures = Captures(home, most_bytes)
        self.jobs = session.jobs
        self.working: dict[str, str] = {}  # The job of a capture, by the capture's id.

    @property
    def editor(self) -> Editor:
        """The open document.

        Raises:
            UsageError: none is open.
        """
        if self.session.editor is None:
            raise UsageError(NO_ROOM)
        return self.session.editor

    async def open(self, source: Path) -> None:
        """Open a room in the place of what is open; every tab begins anew."""
        editor = await asyncio.to_thread(Editor.open, source)
        self.capture = None
        await self.session.show(editor)
        self.remember(source)

    def remember(self, source: Path) -> None:
        """Note that a room was opened; the newest come first."""
        place = str(source.resolve())
        kept = [place, *(old for old in self._noted() if old != place)][:MOST_RECENT]
        write_json(self.home / "recent.json", kept)

    def recent(self) -> list[Path]:
        """Return the rooms that were open before and are still there, but for those of captures."""
        own = {one.run for one in self.captures.all()}
        places = [Path(text) for text in self._noted()]
        return [place for place in places if place.exists() and place not in own]

    def room_named(self, number: str) -> Path:
        """Return the room of a capture's id, or of ``recent-N``.

        Raises:
            UnknownNameError: there is none. UsageError: the capture has no room yet.
        """
        kind, _, index = number.partition("-")
        if kind == "recent" and index.isdecimal():
            recent = self.recent()
            if int(index) >= len(recent):
                raise UnknownNameError("recent room", number, (f"recent-{n}" for n in range(9)))
            return recent[int(index)]
        found = self.captures.named(number)
        if not found.has_room:
            raise UsageError(f"no room was made of {found.title!r} yet; press Start")
        return found.run

    def job_of(self, capture: CaptureFolder) -> str | None:
        """Return the id of the job that is at work on a capture, None where none is."""
        number = self.working.get(capture.id)
        if number is None:
            return None
        try:
            running = self.jobs.state(number).state == "running"
        except UnknownNameError:
            running = False
        return number if running else None

    def _noted(self) -> list[str]:
        try:
            noted = read_json(self.home / "recent.json")
        except InputError:
            return []
        return [text for text in noted if isinstance(text, str)] if isinstance(noted, list) else []

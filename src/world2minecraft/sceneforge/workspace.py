"""What stands around the document: jobs, captures, and the rooms that were open before."""

import asyncio
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import InputError, OutputError, UnknownNameError, UsageError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.sceneforge.comparison import find_truth_folder
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.export_options import write_snapshot
from world2minecraft.sceneforge.run_photos import (
    RunPhotos,
    count_photos,
    find_capture_of,
    read_photos,
)
from world2minecraft.sceneforge.session import NO_ROOM, Session
from world2minecraft.sceneforge.uploads import MAX_UPLOAD_BYTES, CaptureFolder, CaptureStore

MAX_RECENT = 12
PLACES = "captures.json"  # Where the capture of each run lies, as the user said.


@dataclass(frozen=True, eq=False)
class Comparison:
    """What the document is compared with: labels uint8 [X, Y, Z] in the cells of an editor."""

    name: str
    labels: np.ndarray
    editor: Editor


class Workspace:
    """The start page's state; one for each server.

    Args:
        session: holds the document and the tabs (``session.broadcaster.broadcast_threadsafe``).
        home: the folder for captures and rooms made here.
        max_bytes: the most that one upload may hold.
        capture: where the capture of the open run lies, where its folder does not say so.
    """

    def __init__(
        self,
        session: Session,
        home: Path,
        *,
        max_bytes: int = MAX_UPLOAD_BYTES,
        capture: Path | None = None,
    ):
        self.session, self.home = session, home
        self.compared: Comparison | None = None
        self._capture = capture
        self._photos: tuple[Editor, RunPhotos] | None = None
        self._lock = threading.Lock()
        self._opening = asyncio.Lock()
        self._exports: tempfile.TemporaryDirectory[str] | None = None
        self.captures = CaptureStore(home, max_bytes)
        self.jobs = session.jobs
        self.wanted: str | None = None  # The capture that the start page shows first.
        self.running_jobs: dict[str, str] = {}  # Jobs by the id of a capture, or a demo's folder.

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
        async with self._opening:  # A second click finds the room open, not at work.
            if self.session.editor is not None and self.session.editor.holds(source):
                return  # Opened again it would find its own lock, and be read only.
            editor = await asyncio.to_thread(Editor.open, source)
            for one in self.captures.all():
                if one.run == source:
                    editor.name = one.title
            self._capture, self._photos, self.compared = None, None, None
            await self.session.show(editor)
        self.try_add_recent(source)

    @property
    def exports(self) -> Path:
        """The folder of what was exported; it goes with the server."""
        if self._exports is None:
            self._exports = tempfile.TemporaryDirectory(prefix="w2m-exports-")
        return Path(self._exports.name)

    @contextmanager
    def snapshot(self, editor: Editor) -> Iterator[Path]:
        """Give a folder with the scene as it is now; it is gone afterwards."""
        with tempfile.TemporaryDirectory(prefix="w2m-scene-") as scratch:
            write_snapshot(editor, Path(scratch))
            yield Path(scratch)

    @property
    def run(self) -> Path:
        """The folder of the open document. Raises UsageError where none is open."""
        return self.editor.opened.folder

    def capture_of_run(self) -> Path | None:
        """Return where the capture of the open run lies, as far as anybody said so."""
        run = self.run.resolve()
        noted = read_text_map(self.home / PLACES)
        if self._capture is not None:
            place = str(self._capture.resolve())
            if noted.get(str(run)) != place:
                with suppress(OutputError):  # It is looked at all the same.
                    write_json(self.home / PLACES, noted | {str(run): place})
            return self._capture
        for one in self.captures.all():
            if one.run.resolve() == run:
                return one.source
        place = noted.get(str(run))
        return Path(place) if place and Path(place).exists() else None

    def photos(self) -> RunPhotos:
        """Return the photos of the open run; the first time takes seconds.

        Raises:
            UsageError: it has none, or does not say where they are. CaptureError: they cannot be
            read.
        """
        editor = self.editor
        with self._lock:
            if self._photos is None or self._photos[0] is not editor:
                capture = find_capture_of(self.run, self.capture_of_run())
                made = read_photos(self.run, capture, editor.opened.scan_to_room)
                self._photos = (editor, made)
            return self._photos[1]

    def extras(self) -> dict[str, Any]:
        """Return what there is beside the open scene, as ``Scene.has`` of ``wire.ts``."""
        photos = count_photos(self.run, self.capture_of_run())
        return {"photos": photos, "truth": self.truth_folder() is not None}

    def truth_folder(self) -> Path | None:
        """Return where the truth of the open run lies, None where there is none."""
        return find_truth_folder(self.run, self.capture_of_run()) if self.session.editor else None

    def begin_with(self, source: Path, is_capture: bool) -> None:
        """Show a capture of this machine first, or note that a room was opened."""
        if is_capture:
            self.wanted = self.captures.register(source).id
        else:
            self.try_add_recent(source)

    def try_add_recent(self, source: Path) -> None:
        """Note that a room was opened; a home that cannot be written keeps nobody from editing."""
        with suppress(OutputError):
            self.add_recent(source)

    def add_recent(self, source: Path) -> None:
        """Note that a room was opened; the newest come first."""
        place = str(source.resolve())
        kept = [place, *(old for old in self._noted() if old != place)][:MAX_RECENT]
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
                known = (f"recent-{n}" for n in range(len(recent)))
                raise UnknownNameError("recent room", number, known)
            return recent[int(index)]
        found = self.captures.named(number)
        if not found.has_room:
            raise UsageError(f"{found.title!r} has no room yet; press Create room")
        return found.run

    def job_of(self, capture: CaptureFolder) -> str | None:
        """Return the id of the job that is at work on a capture, None where none is."""
        return self.job_at(capture.id)

    def job_at(self, what: str) -> str | None:
        """Return the id of the job under a key of ``running_jobs``, None where none runs."""
        number = self.running_jobs.get(what)
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


def read_text_map(path: Path) -> dict[str, str]:
    """Return the texts by text of a JSON object; none where the file is not there or not whole."""
    try:
        noted = read_json(path)
    except InputError:
        return {}
    pairs = noted.items() if isinstance(noted, dict) else ()
    return {key: value for key, value in pairs if isinstance(value, str)}

"""The state of a server besides its document: jobs, captures and recently opened rooms."""

import asyncio
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from world2minecraft.core.errors import InputError, OutputError, UnknownNameError, UsageError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.sceneforge.comparison import Reference, find_truth_folder
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.export_options import write_snapshot
from world2minecraft.sceneforge.game_folders import GameFolders
from world2minecraft.sceneforge.phone_access import PhoneAccess
from world2minecraft.sceneforge.photo_classes import PhotoClasses
from world2minecraft.sceneforge.run_photos import (
    RunPhotos,
    count_photos,
    find_capture_of,
    read_photos,
)
from world2minecraft.sceneforge.scene_sources import DEMO_OUT
from world2minecraft.sceneforge.session import NO_ROOM, Session
from world2minecraft.sceneforge.uploads import MAX_UPLOAD_BYTES, CaptureFolder, CaptureStore

MAX_RECENT = 12
PLACES = "captures.json"  # Where the capture of each run lies, as the user said.


@dataclass(frozen=True, eq=False)
class Comparison:
    """An occupancy to compare with, in the cells of an editor's scene."""

    name: str
    reference: Reference
    editor: Editor


class BegunRun(NamedTuple):
    """The run folder of a job and the time in seconds since 1970 at which the job began."""

    run: Path
    since_s: float


class Workspace:
    """The state of the start page. Each server has one workspace.

    Args:
        session: The document and the tabs (``session.broadcaster.broadcast_threadsafe``).
        home: Folder for the captures and rooms created on the page.
        max_bytes: Maximum size of one upload in bytes.
        capture: Path of the open run's capture. None uses the path recorded in the run folder.
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
        self._classes: PhotoClasses | None = None
        self._lock = threading.Lock()
        self._opening = asyncio.Lock()
        self._exports: tempfile.TemporaryDirectory[str] | None = None
        self.captures = CaptureStore(home, max_bytes)
        self.game_folders = GameFolders(home)
        self.jobs = session.jobs
        self.phone: PhoneAccess | None = None  # Only where a phone page is served.
        self.wanted: str | None = None  # The capture that the start page shows first.
        self._begun: dict[str, BegunRun] = {}
        self.running_jobs: dict[str, str] = {}  # Jobs by the id of a capture, or a demo's folder.

    @property
    def editor(self) -> Editor:
        """The editor of the open document.

        Raises:
            UsageError: If no document is open.
        """
        if self.session.editor is None:
            raise UsageError(NO_ROOM)
        return self.session.editor

    async def open(self, source: Path) -> None:
        """Open another room instead of the current one, and reload every tab."""
        async with self._opening:  # A second click finds the room open, not at work.
            if self.session.editor is not None and self.session.editor.holds(source):
                return  # Opened again it would find its own lock, and be read only.
            editor = await asyncio.to_thread(Editor.open, source)
            for one in self.captures.all():
                if one.run == source:
                    editor.name = one.title
            await self._show(editor)
        self.try_add_recent(source)

    async def open_example(self) -> None:
        """Open the demo room. Edits are saved in the home folder."""
        place = self.home / DEMO_OUT
        async with self._opening:
            if self.session.editor is not None and self.session.editor.opened.is_demo:
                return
            await self._show(await asyncio.to_thread(Editor.open, None, out=place))

    async def _show(self, editor: Editor) -> None:
        self._capture, self._photos, self.compared = None, None, None
        await self.session.show(editor)

    @property
    def exports(self) -> Path:
        """The folder for exported files, which is deleted when the server closes."""
        if self._exports is None:
            self._exports = tempfile.TemporaryDirectory(prefix="w2m-exports-")
        return Path(self._exports.name)

    @contextmanager
    def snapshot(self, editor: Editor) -> Iterator[Path]:
        """Create a temporary folder with the current scene, for use in a ``with`` statement."""
        with tempfile.TemporaryDirectory(prefix="w2m-scene-") as scratch:
            write_snapshot(editor, Path(scratch))
            yield Path(scratch)

    @property
    def run(self) -> Path:
        """The folder of the open document.

        Raises:
            UsageError: If no document is open.
        """
        return self.editor.opened.folder

    def capture_of_run(self) -> Path | None:
        """Return the path of the open run's capture, if it is known."""
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
        """Return the photos of the open run. The first call takes several seconds.

        Raises:
            UsageError: If the run has no photos or does not record where they are.
            CaptureError: If the photos cannot be read.
        """
        editor = self.editor
        with self._lock:
            if self._photos is None or self._photos[0] is not editor:
                capture = find_capture_of(self.run, self.capture_of_run())
                made = read_photos(self.run, capture, editor.opened.scan_to_room)
                self._photos = (editor, made)
            return self._photos[1]

    def photo_classes(self) -> PhotoClasses:
        """Return the classes in the photos of the open run, which are predicted on demand.

        Raises the exceptions of ``photos``.
        """
        photos = self.photos()
        with self._lock:
            if self._classes is None or self._classes.photos is not photos:
                self._classes = PhotoClasses(photos)
            return self._classes

    def extras(self) -> dict[str, Any]:
        """Return the additional data available for the scene, as ``Scene.has`` of ``wire.ts``."""
        photos = count_photos(self.run, self.capture_of_run())
        return {"photos": photos, "truth": self.truth_folder() is not None}

    def truth_folder(self) -> Path | None:
        """Return the folder with the open run's ground truth, or None."""
        return find_truth_folder(self.run, self.capture_of_run()) if self.session.editor else None

    def begin_with(self, source: Path, is_capture: bool) -> None:
        """Preselect a capture on the start page, or add a room to the recent rooms."""
        if is_capture:
            self.wanted = self.captures.register(source).id
        else:
            self.try_add_recent(source)

    def try_add_recent(self, source: Path) -> None:
        """Add a room to the recent rooms, and ignore a home folder that is not writable."""
        with suppress(OutputError):
            self.add_recent(source)

    def add_recent(self, source: Path) -> None:
        """Add a room to the front of the recent rooms."""
        place = str(source.resolve())
        kept = [place, *(old for old in self._noted() if old != place)][:MAX_RECENT]
        write_json(self.home / "recent.json", kept)

    def recent(self) -> list[Path]:
        """Return the recent rooms that still exist, except those of captures."""
        own = {one.run for one in self.captures.all()}
        places = [Path(text) for text in self._noted()]
        return [place for place in places if place.exists() and place not in own]

    def room_named(self, number: str) -> Path:
        """Return the room of a capture's id, or of ``recent-N``.

        Raises:
            UnknownNameError: If no capture or recent room has this id.
            UsageError: If the capture has no room yet.
        """
        kind, _, index = number.partition("-")
        if kind == "recent" and index.isdecimal() and len(index) < 10:
            recent = self.recent()
            if int(index) >= len(recent):
                known = (f"recent-{n}" for n in range(len(recent)))
                raise UnknownNameError("recent room", number, known)
            return recent[int(index)]
        found = self.captures.named(number)
        if not found.has_room:
            raise UsageError(f"{found.title!r} has no room yet; press Create room")
        return found.run

    def note_job(self, number: str, what: str, run: Path) -> None:
        """Remember that a job works on a capture's id or a demo's folder, and its run folder."""
        self.running_jobs[what] = number
        self._begun[number] = BegunRun(run, time.time())

    def run_of_job(self, number: str) -> BegunRun:
        """Return the run folder of a job of the start page.

        Raises:
            UnknownNameError: If no job that makes a room has this id.
        """
        if number not in self._begun:
            raise UnknownNameError("job", number, self._begun)
        return self._begun[number]

    def job_of(self, capture: CaptureFolder) -> str | None:
        """Return the id of the job that is running on a capture, or None."""
        return self.job_at(capture.id)

    def job_at(self, what: str) -> str | None:
        """Return the id of the running job under a key of ``running_jobs``, or None."""
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
    """Return a JSON object of strings, or an empty dict if the file cannot be read."""
    try:
        noted = read_json(path)
    except InputError:
        return {}
    pairs = noted.items() if isinstance(noted, dict) else ()
    return {key: value for key, value in pairs if isinstance(value, str)}

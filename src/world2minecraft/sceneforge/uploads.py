"""The captures of the start page, each in its own folder below a home folder, and their uploads.

::

    HOME/captures/ID/capture.json   title, and the list of files to upload or the path
    HOME/captures/ID/upload/NAME    the uploaded capture, a folder or a file
    HOME/captures/ID/survey.json    the survey of the capture, with survey.png
    HOME/captures/ID/run            the run folder of the reconstructed room

HOME is ``SceneForge`` in the user's data folder. Names of uploaded files are untrusted. They are
checked to be safe as paths on every operating system.
"""

import os
import re
import secrets
import shutil
import sys
from collections.abc import AsyncIterator, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
from world2minecraft.core.errors import (
    ConflictError,
    DamagedFileError,
    InputError,
    LimitError,
    OutputError,
    UnknownNameError,
    UsageError,
)
from world2minecraft.core.file_names import portable_name
from world2minecraft.core.files import read_json, write_json

MAX_FILES = 20_000  # Ten minutes of frames with depth and confidence.
MAX_DEPTH = 12
MAX_PART_BYTES = 200
MAX_PATH_BYTES = 400
# Names and characters that Windows does not allow in file names.
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_FORBIDDEN = re.compile(r'[<>:"|?*\x00-\x1f\x7f]')
IGNORED = frozenset({".ds_store", "thumbs.db", "desktop.ini"})  # Files of operating systems.
MAX_UPLOAD_BYTES = 4 << 30
SPARE_BYTES = 256 << 20  # Space for the run of a capture, with a margin.
CAPTURE, SURVEY, PICTURE = "capture.json", "survey.json", "survey.png"
RUN, UPLOAD = "run", "upload"
_ID = re.compile(r"[a-z0-9-]{1,64}")
_RECEIVING: set[Path] = set()  # The files that this process is receiving.


@dataclass(frozen=True)
class UploadFile:
    """A file to be uploaded: its checked path below the capture's folder, and its size in bytes."""

    path: str
    size: int


def check_files(data: Any, max_bytes: int) -> tuple[UploadFile, ...]:
    """Check the list of files that a page announces for upload, and return it.

    Args:
        data: JSON value, a list of ``{"path", "size"}``.
        max_bytes: Maximum total size of all files in bytes.

    Raises:
        UsageError: If a path leads out of the folder, is not a valid name, or occurs twice.
        LimitError: If there are too many files or bytes.
    """
    if not isinstance(data, list) or not data:
        raise UsageError('"files" must be a list of objects {"path", "size"}, one for each file')
    if len(data) > MAX_FILES:
        raise LimitError("the capture", f"contains {len(data):,} files, the limit is {MAX_FILES:,}")
    files = tuple(one for one in map(_check_file, data) if not _ignored(one.path))
    if not files:
        raise UsageError("no files found; upload a folder of photos, a ZIP file or a video")
    total = sum(one.size for one in files)
    if total > max_bytes:
        raise LimitError(
            "the capture",
            f"is {total >> 20:,} MB, the upload limit is {max_bytes >> 20:,} MB; "
            "run w2m forge with the path of the capture, or increase --max-upload",
        )
    _check_distinct(one.path for one in files)
    return files


def _check_file(data: Any) -> UploadFile:
    if not isinstance(data, Mapping) or not isinstance(data.get("path"), str):
        raise UsageError('each file must be {"path": "folder/name.jpg", "size": bytes}')
    size = data.get("size")
    if not isinstance(size, int) or isinstance(size, bool) or size < 0:
        raise UsageError(f"the size of {data['path'][:80]!r} must be an integer, got {size!r:.40}")
    return UploadFile(check_path(data["path"]), size)


def check_path(name: str) -> str:
    """Check that a relative path stays below its folder on every operating system, and return it.

    Raises:
        UsageError: If the path is invalid.

    Example:
        >>> check_path("kitchen/rgb/0.jpg")
        'kitchen/rgb/0.jpg'
    """
    shown = repr(name[:80])
    if name.startswith("/") or "\\" in name or _FORBIDDEN.search(name):
        raise UsageError(
            f"invalid file name {shown}: the path is absolute or has a forbidden character"
        )
    parts = PurePosixPath(name).parts
    if not parts or len(parts) > MAX_DEPTH or len(name.encode(errors="replace")) > MAX_PATH_BYTES:
        raise UsageError(f"invalid file name {shown}: the path is empty, too long or too deep")
    for part in parts:
        _check_part(part, shown)
    return "/".join(parts)


def _check_part(part: str, shown: str) -> None:
    try:
        size = len(part.encode())
    except UnicodeEncodeError as error:
        raise UsageError(f"invalid file name {shown}: not valid Unicode text") from error
    if part == ".." or part != part.strip() or part.endswith(".") or _RESERVED.fullmatch(part):
        raise UsageError(f"invalid file name {shown}: {part!r} is not allowed")
    if size > MAX_PART_BYTES or not part.isprintable():
        raise UsageError(f"invalid file name {shown}: a part is too long or has control characters")


def _ignored(path: str) -> bool:
    return path.rpartition("/")[2].casefold() in IGNORED


def _check_distinct(paths: Iterable[str]) -> None:
    """Reject files that would overwrite each other on a case-insensitive file system."""
    seen: set[str] = set()
    folders: set[str] = set()
    for path in paths:
        key = path.casefold()
        if key in seen:
            raise UsageError(f"the path {path[:80]!r} occurs twice; rename one of the files")
        seen.add(key)
        folders.update(str(parent) for parent in PurePosixPath(key).parents)
    if both := seen & folders:
        raise UsageError(f"the path {min(both)[:80]!r} is used for both a file and a folder")


def common_folder(files: Iterable[UploadFile]) -> str:
    """Return the top-level folder shared by all files, or an empty string if there is none."""
    firsts = {one.path.partition("/") for one in files}
    tops = {top for top, _, _ in firsts}
    return min(tops) if len(tops) == 1 and all(rest for _, _, rest in firsts) else ""


def user_home() -> Path:
    """Return SceneForge's folder for captures and rooms. The folder may not exist yet."""
    home = Path.home()
    if "W2M_FORGE_HOME" in os.environ:
        return Path(os.environ["W2M_FORGE_HOME"])
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA") or home / "AppData" / "Roaming") / "SceneForge"
    if sys.platform == "darwin":
        return home / "Library" / "Application Support" / "SceneForge"
    return Path(os.environ.get("XDG_DATA_HOME") or home / ".local" / "share") / "SceneForge"


@dataclass(frozen=True)
class CaptureFolder:
    """The folder of one capture.

    ``files`` are the files to be uploaded. It is empty for a capture that is read from its own
    path.
    """

    folder: Path
    title: str
    source: Path
    files: tuple[UploadFile, ...]

    @property
    def id(self) -> str:
        """The id of the capture in the HTTP API."""
        return self.folder.name

    @property
    def run(self) -> Path:
        """The run folder of the reconstructed room."""
        return self.folder / RUN

    @property
    def has_room(self) -> bool:
        """Whether the capture has a reconstructed room that can be opened."""
        return (self.run / "placements.json").is_file()

    def place_of(self, number: int) -> Path:
        """Return the path of an uploaded file, which may not exist yet.

        Raises:
            UsageError: If the capture has no file of this number.
        """
        if not 0 <= number < len(self.files):
            raise UsageError(f"file {number} not found; this capture has {len(self.files)} files")
        if self.source.name == self.files[number].path and len(self.files) == 1:
            return self.source
        return self.source / self.files[number].path

    def received_bytes(self) -> list[int]:
        """Return the number of bytes received of each file."""
        return [_size(self.place_of(number)) for number in range(len(self.files))]

    @property
    def complete(self) -> bool:
        """Whether all files are completely uploaded."""
        return all(
            _size(self.place_of(n)) == one.size and self.place_of(n).is_file()
            for n, one in enumerate(self.files)
        )

    def survey(self) -> dict[str, Any] | None:
        """Return the survey of the capture, or None if it has not been surveyed."""
        try:
            return read_json(self.folder / SURVEY)
        except InputError:
            return None

    async def receive(self, number: int, start: int, chunks: AsyncIterator[bytes]) -> int:
        """Append received bytes to a file, and return the number of its bytes so far.

        Bytes received before a lost connection are kept. The page asks for their number and
        continues from there.

        Args:
            number: Number of the file.
            start: Offset in bytes at which the sender continues. It must equal the number of bytes
                received so far.
            chunks: The next bytes of the file.

        Raises:
            ConflictError: If ``start`` differs from the bytes received, or if another connection is
                still uploading this file.
            LimitError: If the file exceeds its announced size.
            OutputError: If the disk is full.
        """
        place, path = self.place_of(number), self.files[number].path
        held = _size(place)
        if start != held:
            raise ConflictError(path, f"{held} bytes are already uploaded; continue from there")
        if place in _RECEIVING:
            raise ConflictError(path, "another upload of this file is running; wait for it")
        _RECEIVING.add(place)
        try:
            return await self._append(number, chunks)
        except OSError as error:
            raise OutputError(place, f"cannot be written: {error.strerror or error}") from error
        finally:
            _RECEIVING.discard(place)

    async def _append(self, number: int, chunks: AsyncIterator[bytes]) -> int:
        """Append chunks to a file, and return the number of its bytes so far."""
        place, file = self.place_of(number), self.files[number]
        place.parent.mkdir(parents=True, exist_ok=True)
        held = _size(place)
        with place.open("ab") as stream:
            async for chunk in chunks:
                if held + len(chunk) > file.size:
                    raise LimitError(
                        file.path, f"the upload exceeds the announced {file.size} bytes"
                    )
                stream.write(chunk)
                held += len(chunk)
        return held


class CaptureStore:
    """All captures below a home folder.

    Args:
        home: SceneForge's home folder. It is created when it is first needed.
        max_bytes: Maximum size of one upload in bytes.
    """

    def __init__(self, home: Path, max_bytes: int = MAX_UPLOAD_BYTES):
        self.home, self.max_bytes = home, max_bytes
        self.folder = home / "captures"

    def all(self) -> list[CaptureFolder]:
        """Return all captures, newest first. Folders that are not captures are skipped."""
        if not self.folder.is_dir():
            return []
        names = [entry.name for entry in self.folder.iterdir() if (entry / CAPTURE).is_file()]
        found = []
        for name in names:
            try:
                found.append(self.named(name))
            except InputError:
                continue
        return sorted(found, key=lambda one: (one.folder / CAPTURE).stat().st_mtime, reverse=True)

    def named(self, number: str) -> CaptureFolder:
        """Return the capture with a given id.

        Raises:
            UnknownNameError: If no capture has this id.
            DamagedFileError: If its ``capture.json`` is not valid.
        """
        folder = self.folder / number
        if not _ID.fullmatch(number) or not (folder / CAPTURE).is_file():
            raise UnknownNameError("capture", number[:64], (one.name for one in self._folders()))
        try:
            data = read_json(folder / CAPTURE)
            files = tuple(UploadFile(str(p), int(size)) for p, size in data["files"])
            elsewhere = data["elsewhere"]
            source = Path(elsewhere) if elsewhere else folder / UPLOAD / str(data["name"])
            return CaptureFolder(folder, str(data["title"]), source, files)
        except (KeyError, TypeError, ValueError) as error:
            raise DamagedFileError(folder / CAPTURE, f"is not a capture ({error})") from error

    def create(self, title: str, files: Any) -> CaptureFolder:
        """Create the folder for a capture that a page is about to upload.

        Args:
            title: Title that is shown to people.
            files: JSON value, a list of ``{"path", "size"}``.

        Raises:
            UsageError: If a file name is invalid.
            LimitError: If the capture is too large.
            OutputError: If the disk is full.
        """
        checked = check_files(files, self.max_bytes)
        self._check_space(sum(one.size for one in checked))
        top = common_folder(checked)
        inner = tuple(UploadFile(one.path[len(top) + 1 :], one.size) for one in checked)
        inner = inner if top else checked
        alone = len(inner) == 1 and not top
        name = inner[0].path if alone else _folder_name(top or title)
        return self._made(title or top or name, name, inner, "")

    def register(self, path: Path) -> CaptureFolder:
        """Register a capture at a path of this machine without copying it, and return it.

        Raises:
            InputError: If the path does not exist.
        """
        place = path.resolve()
        if not place.exists():
            raise InputError(path, "not found")
        for one in self.all():
            if not one.files and one.source == place:
                return one
        return self._made(place.stem if place.is_file() else place.name, "", (), str(place))

    def delete(self, number: str) -> None:
        """Delete a capture and its room. A registered capture's own files are not deleted."""
        shutil.rmtree(self.named(number).folder, ignore_errors=True)

    def _made(
        self, title: str, name: str, files: tuple[UploadFile, ...], elsewhere: str
    ) -> CaptureFolder:
        letters = re.sub(r"[^a-z0-9]+", "-", title.casefold()).strip("-")[:40]
        folder = self.folder / "-".join(filter(None, [letters, secrets.token_hex(4)]))
        plain = "".join(letter for letter in title if letter.isprintable())[:80]
        data = {
            "title": plain,
            "name": name,
            "files": [[one.path, one.size] for one in files],
            "elsewhere": elsewhere,
        }
        write_json(folder / CAPTURE, data)
        return self.named(folder.name)

    def _folders(self) -> list[Path]:
        return list(self.folder.iterdir()) if self.folder.is_dir() else []

    def _check_space(self, size: int) -> None:
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            free = shutil.disk_usage(self.folder).free
        except OSError as error:
            raise OutputError(
                self.folder, f"cannot be created: {error.strerror or error}"
            ) from error
        if free < size + SPARE_BYTES:
            needed = (size + SPARE_BYTES) >> 20
            raise OutputError(self.home, f"disk full: {free >> 20} MB free, {needed} MB needed")


def is_capture(place: Path) -> bool:
    """Return whether a path is a capture or a floor plan rather than a room that can be opened."""
    if (place / "room.npz").is_file() or place.suffix in (".npz", ".npy", ".forge"):
        return False
    try:
        find_capture(place)
        return True
    except InputError:
        return find_lone_roomplan(place) is not None


def _folder_name(title: str) -> str:
    try:
        return portable_name(title)
    except UsageError:  # Nothing of it can be a name.
        return "capture"


def _size(place: Path) -> int:
    try:
        return place.stat().st_size if place.is_file() else 0
    except OSError:
        return 0

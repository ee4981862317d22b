"""The names of uploaded files: hostile until checked, then safe as paths on every system."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

from world2minecraft.core.errors import LimitError, UsageError

MOST_FILES = 20_000  # Ten minutes of frames with depth and confidence.
MOST_DEPTH = 12
MOST_PART_BYTES = 200
MOST_PATH_BYTES = 400
# What no file may be named on Windows, and what means something else than a name there.
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_FORBIDDEN = re.compile(r'[<>:"|?*\x00-\x1f\x7f]')
IGNORED = frozenset({".ds_store", "thumbs.db", "desktop.ini"})  # What systems leave in folders.


@dataclass(frozen=True)
class UploadFile:
    """One file that is to come: its checked path below the capture's folder, and its bytes."""

    path: str
    size: int


def checked_files(told: Any, most_bytes: int) -> tuple[UploadFile, ...]:
    """Return the files that a page says it will send.

    Args:
        told: JSON, a list of ``{"path", "size"}``.
        most_bytes: of all files together.

    Raises:
        UsageError: a path leaves the folder, is no name, or stands there twice.
        LimitError: there are too many files or bytes.
    """
    if not isinstance(told, list) or not told:
        raise UsageError('"files" must be a list of {"path", "size"}, one for each file')
    if len(told) > MOST_FILES:
        raise LimitError(
            "the capture", f"has {len(told):,} files; at most {MOST_FILES:,} are taken"
        )
    files = tuple(one for one in map(_checked, told) if not _ignored(one.path))
    if not files:
        raise UsageError("there is nothing in it; drop a folder with pictures, a zip or a video")
    total = sum(one.size for one in files)
    if total > most_bytes:
        raise LimitError(
            "the capture",
            f"has {total >> 20:,} MB; at most {most_bytes >> 20:,} MB are taken by the page. "
            "Start w2m forge with the path of the capture instead, or with --max-upload",
        )
    _check_apart(one.path for one in files)
    return files


def _checked(told: Any) -> UploadFile:
    if not isinstance(told, Mapping) or not isinstance(told.get("path"), str):
        raise UsageError('each file must be {"path": "folder/name.jpg", "size": bytes}')
    size = told.get("size")
    if not isinstance(size, int) or isinstance(size, bool) or size < 0:
        raise UsageError(f"the size of {told['path'][:80]!r} must be whole bytes, not {size!r:.40}")
    return UploadFile(checked_path(told["path"]), size)


def checked_path(name: str) -> str:
    """Return a relative path with ``/`` that stays below its folder, on every system.

    Raises:
        UsageError: it does not.

    Example:
        >>> checked_path("kitchen/rgb/0.jpg")
        'kitchen/rgb/0.jpg'
    """
    shown = repr(name[:80])
    if name.startswith("/") or "\\" in name or _FORBIDDEN.search(name):
        raise UsageError(f"{shown} cannot be a file of a capture: its name leaves the folder")
    parts = PurePosixPath(name).parts
    if not parts or len(parts) > MOST_DEPTH or len(name.encode(errors="replace")) > MOST_PATH_BYTES:
        raise UsageError(f"{shown} cannot be a file of a capture: its path is empty or too long")
    for part in parts:
        _check_part(part, shown)
    return "/".join(parts)


def _check_part(part: str, shown: str) -> None:
    try:
        size = len(part.encode())
    except UnicodeEncodeError as error:
        raise UsageError(f"{shown} cannot be a file of a capture: it is no text") from error
    if part == ".." or part != part.strip() or part.endswith(".") or _RESERVED.fullmatch(part):
        raise UsageError(f"{shown} cannot be a file of a capture: {part!r} is no plain name")
    if size > MOST_PART_BYTES or not part.isprintable():
        raise UsageError(f"{shown} cannot be a file of a capture: a part is too long or not plain")


def _ignored(path: str) -> bool:
    return path.rpartition("/")[2].casefold() in IGNORED


def _check_apart(paths: Iterable[str]) -> None:
    """Refuse files that would overwrite each other where case does not count."""
    seen: set[str] = set()
    folders: set[str] = set()
    for path in paths:
        key = path.casefold()
        if key in seen:
            raise UsageError(f"{path[:80]!r} stands there twice; rename one of the two")
        seen.add(key)
        folders.update(str(parent) for parent in PurePosixPath(key).parents)
    if both := seen & folders:
        raise UsageError(f"{min(both)[:80]!r} is a file and a folder")


def common_folder(files: Iterable[UploadFile]) -> str:
    """Return the one folder that all files lie in, empty where there is none."""
    firsts = {one.path.partition("/") for one in files}
    tops = {top for top, _, _ in firsts}
    return min(tops) if len(tops) == 1 and all(rest for _, _, rest in firsts) else ""

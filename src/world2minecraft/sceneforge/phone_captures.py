"""Captures that a phone uploads: what it may send, and the job that makes a room of them.

A phone sends photos, or one video. The job surveys the capture, reconstructs it and writes the
room as one page (``room.html``) beside it; it goes on while the phone is locked or away.
"""

import time
from importlib.util import find_spec
from pathlib import Path, PurePosixPath
from typing import Any

from world2minecraft.capture.images import HEIF_SUFFIXES
from world2minecraft.capture.readers.video import SUFFIXES as VIDEO_SUFFIXES
from world2minecraft.core.errors import (
    InputError,
    LimitError,
    MissingExtraError,
    UsageError,
    World2MinecraftError,
)
from world2minecraft.sceneforge.jobs.export_tasks import SHARED
from world2minecraft.sceneforge.jobs.jobs import JobFunction, JobProgress
from world2minecraft.sceneforge.jobs.subprocess_job import run_in_subprocess
from world2minecraft.sceneforge.jobs.time_left import reconstruct_stage_seconds
from world2minecraft.sceneforge.uploads import CaptureFolder, UploadFile, check_files
from world2minecraft.sceneforge.workspace import Workspace

PHOTO_SUFFIXES = (".jpg", ".jpeg", ".png", ".webp", *HEIF_SUFFIXES)
MAX_PHOTOS = 600  # More than anyone takes of a room by hand.
MAX_CAPTURES = 20  # Captures of one phone.
VIDEO_FRAMES = 60  # Assumed until the survey has counted them.
LOOK_S, SHARE_S = 4.0, 4.0
LIBRARIES = ("av", "pillow_heif", "pycolmap")  # For videos, photos of iPhones, and poses.


def check_phone_libraries() -> None:
    """Check that photos and videos can be read and posed, before anyone takes them.

    Raises:
        MissingExtraError: If a library is not installed.
    """
    if not all(map(find_spec, LIBRARIES)):
        raise MissingExtraError("--phone", "capture")


def check_phone_files(data: Any, max_bytes: int) -> tuple[UploadFile, ...]:
    """Check the list of files that a phone announces, and return it.

    Args:
        data: JSON value, a list of ``{"path", "size"}``.
        max_bytes: Maximum total size of all files in bytes.

    Raises:
        UsageError: If a name is invalid, or the files are neither photos nor one video.
        LimitError: If there are too many files or bytes.
    """
    if isinstance(data, list) and len(data) > MAX_PHOTOS:
        raise LimitError("the capture", f"contains {len(data):,} files, the limit is {MAX_PHOTOS}")
    files = check_files(data, max_bytes)
    suffixes = [PurePosixPath(one.path).suffix.lower() for one in files]
    for file, suffix in zip(files, suffixes, strict=True):
        if "/" in file.path:
            raise UsageError(f"invalid file name {file.path[:80]!r}: a phone sends no folders")
        if suffix not in (*PHOTO_SUFFIXES, *VIDEO_SUFFIXES):
            raise UsageError(f"{file.path[:80]!r} is neither a photo nor a video; send one of them")
        if not file.size:
            raise UsageError(f"{file.path[:80]!r} is empty; choose it again")
    if len(files) > 1 and set(suffixes) & set(VIDEO_SUFFIXES):
        raise UsageError("send photos alone, or one video alone")
    return files


def phone_title() -> str:
    """Return the title of a capture that a phone sends now."""
    return time.strftime("Phone scan %Y-%m-%d %H.%M")


def start_phone_room(workspace: Workspace, one: CaptureFolder) -> str:
    """Start the job that makes a room of a complete capture, and return its id."""
    within, folder = one.source.parent, one.folder
    survey = run_in_subprocess("survey", within, capture=str(one.source), folder=str(folder))
    make = run_in_subprocess(
        "reconstruct", within, capture=str(one.source), out=str(one.run), choice={}
    )
    share = run_in_subprocess(
        "share", within, room=str(one.run), title=one.title, target=str(folder)
    )

    def work(report: JobProgress) -> dict[str, Any]:
        found = survey(report)
        if not found["can_start"]:
            raise InputError(one.title, _stop_reason(found))
        report.expect(_stage_seconds(found))
        made = make(report)
        return {"objects": made["objects"], "note": _shared(share, report)}

    number = workspace.jobs.start(one.title, work, _stage_seconds(_guess(one)))
    workspace.note_job(number, one.id, one.run)
    return number


def room_page_path(one: CaptureFolder) -> Path:
    """Return the path of the page of a capture's room, which may not exist yet."""
    return one.folder / SHARED


def _shared(share: JobFunction, report: JobProgress) -> str:
    """Write the page, and return why there is none, or an empty string."""
    try:
        share(report)
    except World2MinecraftError as error:
        return str(error)
    return ""


def _guess(one: CaptureFolder) -> dict[str, Any]:
    is_video = PurePosixPath(one.files[0].path).suffix.lower() in VIDEO_SUFFIXES
    frames = VIDEO_FRAMES if is_video else len(one.files)
    return {"route": "video" if is_video else "photos", "frames": frames}


def _stage_seconds(found: dict[str, Any]) -> dict[str, float]:
    return {"look": LOOK_S} | reconstruct_stage_seconds(found) | {"share": SHARE_S}


def _stop_reason(found: dict[str, Any]) -> str:
    stops = [one for one in found["doubts"] if one["level"] == "stop"]
    if not stops:
        return "shows no usable picture; film or photograph the room again in good light"
    advice = stops[0]["advice"].partition(";")[0]  # What follows is for the command line.
    return "; ".join(filter(None, (stops[0]["text"], advice)))

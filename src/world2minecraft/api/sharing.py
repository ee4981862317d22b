"""Share a room as one file: a page that opens from disk, or a film of the room coming together."""

import os
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress

PAGE_SUFFIXES = (".html", ".htm")
MAX_PHOTOS = 24


@dataclass(frozen=True)
class SharedFile:
    """A file that shows a room.

    Attributes:
        path: The file that was written.
        bytes: Its size.
        things: Number of named objects.
        photos: Number of photos in it.
        frames: Number of frames of a film. 0 for a page.
    """

    path: Path
    bytes: int
    things: int = 0
    photos: int = 0
    frames: int = 0


def share(
    source: Run | str | Path,
    out: str | Path = "room.html",
    *,
    title: str = "",
    photos: int = 0,
    capture: str | Path | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> SharedFile:
    """Write a room as one file to send: a page to walk in, or a film of it coming together.

    A page has less than 5 MB and opens from disk in any browser, also on a phone. It contains the
    blocks, their textures, and the names and sizes of the objects; it needs no server and fetches
    nothing. A film shows the cells of the reconstruction, then its objects, then the blocks.

    Args:
        source: Run, run folder, world, or block file such as ``house.schem``. A film needs a run.
        out: File to write. The suffix decides: ``.html`` is a page; ``.gif``, ``.mp4``, ``.webm``,
            ``.webp`` and ``.apng`` are films.
        title: Heading of the page. Derived from the name of the folder by default.
        photos: Maximum number of photos of the capture to put into the page, for comparison with
            the room. None by default, because photos show more of a home than its blocks.
        capture: Path of the capture with the photos, if the run does not contain it.
        force: Replace an existing file.
        progress: Callback that reports the progress.

    Raises:
        UsageError: If the suffix is unknown, the file exists without ``force``, or photos are
            wanted of something that has none.
        InputError: If the source cannot be read.
        LimitError: If the room is too large for a page.
        OutputError: If the file cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> page = w2m.share(run, tmp / "room.html", title="My kitchen")
        >>> page.bytes < 5_000_000, page.things > 0
        (True, True)
    """
    target = Path(out)
    suffix = target.suffix.lower()
    is_page = suffix in PAGE_SUFFIXES
    _check(target, is_page, photos, force)
    if not is_page:
        from world2minecraft.sceneforge.share.film import write_film

        frames = write_film(path_of(source), target, progress)
        return SharedFile(target, target.stat().st_size, frames=frames)
    from world2minecraft.core.files import write_bytes
    from world2minecraft.core.whole_reads import unchanged
    from world2minecraft.sceneforge.share.page import room_page
    from world2minecraft.sceneforge.share.room_data import SharedRoom

    progress("share", 0, 1)  # Before any work: kernels are compiled now, if they are not yet.
    room_folder = path_of(source)
    with unchanged(room_folder) if room_folder.is_dir() else nullcontext():
        room = SharedRoom.read(room_folder, title)
        progress("share", 1, 1)
        place = None if capture is None else Path(capture)
        page, count = room_page(room, photos, place, progress)
    write_bytes(target, page)
    return SharedFile(target, len(page), things=len(room.landmarks), photos=count)


def _check(target: Path, is_page: bool, photos: int, force: bool) -> None:
    """Check the arguments before any work.

    Raises:
        UsageError: If an argument is invalid.
    """
    from world2minecraft.rendering.output.animation import ANIMATION_SUFFIXES

    if not is_page and target.suffix.lower() not in ANIMATION_SUFFIXES:
        known = ", ".join((PAGE_SUFFIXES[0], *ANIMATION_SUFFIXES))
        raise UsageError(f"{target} must end in {known}; try room.html or room.gif")
    if photos and not is_page:
        raise UsageError(f"{target} is a film, which contains no photos; omit photos (--photos)")
    if not 0 <= photos <= MAX_PHOTOS:
        raise UsageError(f"photos must be 0 to {MAX_PHOTOS}, got {photos}")
    if target.is_dir():
        raise UsageError(f"{target} is a folder; give a file such as {target / 'room.html'}")
    if os.path.lexists(target) and not force:
        raise UsageError(f"{target} exists; use --force to replace it")

"""A shared room: one file of HTML with the room, its floor and its photos."""

from pathlib import Path

from world2minecraft.core.errors import LimitError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.rendering.mesh.viewer_page import assemble
from world2minecraft.sceneforge.share.photos import choose_photos
from world2minecraft.sceneforge.share.room_data import SharedRoom

MAX_PAGE_BYTES = 5_000_000
PHOTO_FACTS_BYTES = 20_000  # Reserved for the poses of the photos.


def room_page(
    room: SharedRoom,
    max_photos: int = 0,
    capture: Path | None = None,
    progress: Progress = no_progress,
) -> tuple[bytes, int]:
    """Return the page of a room, and the number of photos on it.

    Args:
        room: The room.
        max_photos: Maximum number of photos of the run. There are fewer where more do not fit.
        capture: Path of the capture with the photos, if the run does not contain it.
        progress: Callback that reports the progress.

    Raises:
        LimitError: If the page would be larger than ``MAX_PAGE_BYTES``.
        UsageError: If photos are wanted and the run does not record where they are.
        CaptureError: If the photos cannot be read.
    """
    drawn, floor = room.room_packet(), room.floor_packet(progress).compressed()
    page = assemble(room.title, {"room-data": drawn.compressed(), "floor-data": floor})
    if len(page) > MAX_PAGE_BYTES:
        size, limit = len(page) / 1e6, MAX_PAGE_BYTES / 1e6
        raise LimitError(
            room.source.path,
            f"makes a page of {size:.1f} MB, the limit is {limit:.0f} MB; build it with fewer "
            "blocks (w2m build OUT -o SMALL --blocks-per-metre 2) and share SMALL",
        )
    left = (MAX_PAGE_BYTES - len(page)) * 3 // 4  # In base64 they are larger.
    run, budget = Path(room.source.path), left - PHOTO_FACTS_BYTES
    photos = choose_photos(run, capture, max_photos, budget) if max_photos else ()
    if photos:
        blocks = {"room-data": drawn.compressed(photos=[one.facts for one in photos])}
        blocks |= {"floor-data": floor}
        blocks |= {f"photo-{number}": one.jpeg for number, one in enumerate(photos)}
        page = assemble(room.title, blocks)
    return page, len(photos)

"""One file of HTML with a room in it, which opens from disk and fetches nothing.

Script and style are inline, and the content security policy admits them by their hashes alone.
Whatever comes from the user's files is either in a base64 block, or escaped.
"""

import base64
import hashlib
import html
from collections.abc import Mapping
from pathlib import Path

from world2minecraft.core.errors import LimitError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.sceneforge.share.photos import choose_photos
from world2minecraft.sceneforge.share.room_data import SharedRoom

STATIC = Path(__file__).parents[1] / "static"
MAX_PAGE_BYTES = 5_000_000
PHOTO_FACTS_BYTES = 20_000  # Reserved for the poses of the photos.
ICON = (
    "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E"
    "%3Crect width='16' height='16' rx='4' fill='%23f59a3c'/%3E%3C/svg%3E"
)
PAGE = """\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover">
<meta name="referrer" content="no-referrer">
<link rel="icon" href="{icon}">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<noscript>This page draws a room in 3D, for which it needs JavaScript.</noscript>
<div id="room"></div>
{blocks}
<script type="text/plain" id="licences">{licences}</script>
<script>{script}</script>
</body>
</html>
"""


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


def assemble(title: str, blocks: Mapping[str, bytes]) -> bytes:
    """Return a page.

    Args:
        title: Its heading.
        blocks: The data that its script reads, by the name of the block.
    """
    script = (STATIC / "share.js").read_text("utf-8").strip()
    style = (STATIC / "share.css").read_text("utf-8").strip()
    return PAGE.format(
        policy=html.escape(content_policy(script, style)),
        icon=ICON,
        title=html.escape(title),
        style=style,
        blocks="\n".join(_block(name, data) for name, data in blocks.items()),
        licences=(STATIC.parent / "NOTICE-three.txt").read_text("utf-8").partition("\n")[2].strip(),
        script=script,
    ).encode()


def content_policy(script: str, style: str) -> str:
    """Return the content security policy of a page with one inline script and one inline style."""
    return (
        f"default-src 'none'; script-src {_hash_of(script)}; style-src {_hash_of(style)}; "
        "img-src data: blob:; connect-src 'none'; base-uri 'none'; form-action 'none'"
    )


def _hash_of(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _block(name: str, data: bytes) -> str:
    """Return bytes as a block of data, which browsers neither run nor draw."""
    text = base64.b64encode(data).decode()
    return f'<script type="application/octet-stream" id="{name}">{text}</script>'

"""One file of HTML with a room in it, which opens from disk and fetches nothing.

Script and style are inline, and the content security policy admits them by their hashes alone.
Whatever comes from the user's files is either in a base64 block, or escaped. Script and style are
built with the editor's page (``sceneforge/web``).
"""

import base64
import hashlib
import html
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.rendering.mesh.packets import pack_arrays

STATIC = Path(__file__).parents[2] / "sceneforge" / "static"
MAGIC = b"W2MS"
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


def packed_block(header: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return the data of a block: a packet, compressed by zlib."""
    return zlib.compress(pack_arrays(MAGIC, header, arrays), 9)


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

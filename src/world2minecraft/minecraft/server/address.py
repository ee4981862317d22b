"""Where a server's console is, and where this machine remembers how far a build on it is."""

import hashlib
import re
from pathlib import Path

from world2minecraft.core.errors import UsageError

PORT = 25575
_ADDRESS = re.compile(r"(?P<host>\[[0-9A-Fa-f:.%]+\]|[A-Za-z0-9.-]+)(?::(?P<port>[0-9]{1,5}))?")


def parse_address(text: str) -> tuple[str, int]:
    """Return host and port of ``HOST:PORT``; the port is 25575 where it is left out.

    Raises:
        UsageError: it is no address.
    """
    found = _ADDRESS.fullmatch(text)
    port = int(found["port"] or PORT) if found else 0
    if not found or not 1 <= port <= 65535:
        raise UsageError(f"--rcon must be HOST:PORT, such as localhost:{PORT}, not {text!r}")
    return found["host"].strip("[]"), port


def note_of(server: str, digest: str) -> Path:
    """Return the file that remembers how far a build on a server is."""
    from world2minecraft.core.jit import user_cache_dir  # noqa: PLC0415  # It loads numba.

    name = hashlib.sha256(f"{server} {digest}".encode()).hexdigest()[:24]
    return user_cache_dir() / "rcon" / f"{name}.json"

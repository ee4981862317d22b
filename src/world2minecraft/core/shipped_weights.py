"""The networks that the program ships, in ``weights/``, checked against ``weights/SHA256SUMS``.

A network of one's own is read without a checksum: only its user knows what it should be.
"""

from functools import cache
from hashlib import sha256
from pathlib import Path

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_bytes

FOLDER = Path(__file__).parents[1] / "weights"
SUMS = FOLDER / "SHA256SUMS"  # As sha256sum writes and checks it.
MAX_BYTES = 1 << 30


def shipped(name: str) -> Path:
    """Return the path of a shipped network."""
    return FOLDER / name


@cache
def checksums() -> dict[str, str]:
    """Return the SHA-256 of each shipped network by its file name."""
    rows = (line.split() for line in SUMS.read_text(encoding="utf-8").splitlines())
    return {name: digest for digest, name in rows}


def read_weights(path: str | Path, max_bytes: int = MAX_BYTES) -> bytes:
    """Read a network, and check it if it is a shipped one.

    Args:
        path: The file of the network.
        max_bytes: The maximum size of the file in bytes.

    Raises:
        InputError: If the file does not exist.
        LimitError: If the file is too large.
        DamagedFileError: If a shipped network is not what was shipped.
    """
    path = Path(path)
    data = read_bytes(path, max_bytes)
    if path.parent == FOLDER and sha256(data).hexdigest() != checksums().get(path.name):
        raise DamagedFileError(
            path,
            "differs from the network that was shipped; install world2minecraft again, or copy "
            "your own network to another folder",
        )
    return data

"""What networks said of pictures, kept in the user's cache: asked again, it costs nothing.

A file is found by the content of the picture, the state of the network and the meaning of its
labels, so that whatever changes one of them is asked anew. The oldest go when too much is kept.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import InputError, OutputError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.jit import user_cache_dir

FOLDER = "semantics"
MOST_BYTES = 1 << 30  # Some 5,000 pictures.
VERSION = b"1"  # Of what is kept: another makes all that is there unknown.


def key_of(colour: np.ndarray, *states: bytes) -> str:
    """Return the name of what is kept: a digest of a picture and of all that decides the answer."""
    digest = hashlib.sha256(VERSION)
    for part in (*states, str(colour.shape).encode(), np.ascontiguousarray(colour).tobytes()):
        digest.update(hashlib.sha256(part).digest())
    return digest.hexdigest()


def kept(key: str, ask: Callable[[], np.ndarray], folder: Path | None = None) -> np.ndarray:
    """Return uint8 [h, w, 12] that was kept under a key, or ask for it and keep it.

    A cache that cannot be read or written is done without.
    """
    place = user_cache_dir() / FOLDER if folder is None else folder
    path = place / key[:2] / f"{key}.npz"
    try:
        return read_npz(path, ("shares",))["shares"]
    except InputError:
        found = ask()
    try:
        write_npz(path, {"shares": found})
        _forget_oldest(place)
    except (OutputError, OSError):
        pass
    return found


def _forget_oldest(place: Path) -> None:
    files = [(path.stat().st_mtime, str(path), path) for path in place.glob("*/*.npz")]
    total = sum(path.stat().st_size for _, _, path in files)
    for _, _, path in sorted(files):
        if total <= MOST_BYTES:
            return
        total -= path.stat().st_size
        path.unlink(missing_ok=True)

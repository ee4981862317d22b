"""The pictures of a set: each is checked once, before a trainer would stumble over it.

Trainers only warn of a missing file, and fail hours later over a damaged one.
"""

import hashlib
import io
from pathlib import Path

from PIL import Image

from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.navigation.records import check_image_name

MAX_BYTES = 32 << 20
MAX_PIXELS = 64 << 20
FORMATS = ("JPEG", "PNG", "WEBP")


class SetPictures:
    """The pictures under the folder of a set."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._sizes: dict[str, tuple[int, int]] = {}
        self._copied: set[str] = set()

    def size(self, name: str, sha256: str) -> tuple[int, int]:
        """Return the width and height in pixels of a picture, once it was found to be whole.

        Raises:
            InputError: it is not there. DamagedFileError: its sum is another, or it cannot be
                decoded. LimitError: it is too large.
        """
        if name not in self._sizes:
            self._sizes[name] = _checked_size(self.folder / name, self.read(name), sha256)
        return self._sizes[name]

    def read(self, name: str) -> bytes:
        """Return the bytes of a picture. Raises InputError, LimitError."""
        check_image_name(name)
        return read_bytes(self.folder / name, MAX_BYTES)

    def copy(self, name: str, root: Path) -> None:
        """Copy a picture under its name to another folder, once. Raises OutputError too."""
        if name not in self._copied:
            data, target = self.read(name), root / name
            if not target.is_file() or target.read_bytes() != data:
                write_bytes(target, data)
            self._copied.add(name)


def _checked_size(path: Path, data: bytes, sha256: str) -> tuple[int, int]:
    if hashlib.sha256(data).hexdigest() != sha256:
        raise DamagedFileError(path, "is not the picture that the items were made of (its sha256)")
    try:
        with Image.open(io.BytesIO(data), formats=FORMATS) as image:
            if image.width * image.height > MAX_PIXELS:
                raise LimitError(path, f"has {image.width} x {image.height} pixels; too many")
            image.load()
            return image.size
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise DamagedFileError(path, f"is no picture that trainers read ({error})") from error

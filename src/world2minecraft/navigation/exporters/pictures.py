"""The images of a set, each verified once before it is exported.

Trainers only warn about missing images, and fail hours later on damaged ones.
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
    """The images in the folder of a set."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._sizes: dict[str, tuple[int, int]] = {}
        self._copied: set[str] = set()

    def size(self, name: str, sha256: str) -> tuple[int, int]:
        """Return the width and height of an image in pixels, after verifying the file.

        Raises:
            InputError: If the file is missing.
            DamagedFileError: If its SHA-256 differs, or it cannot be decoded.
            LimitError: If it is too large.
        """
        if name not in self._sizes:
            self._sizes[name] = _checked_size(self.folder / name, self.read(name), sha256)
        return self._sizes[name]

    def read(self, name: str) -> bytes:
        """Return the bytes of an image.

        Raises:
            InputError: If the file cannot be read.
            LimitError: If the file is too large.
        """
        check_image_name(name)
        return read_bytes(self.folder / name, MAX_BYTES)

    def copy(self, name: str, root: Path) -> None:
        """Copy an image to another folder under the same name, unless it was already copied.

        Raises:
            InputError: If the image cannot be read.
            OutputError: If the copy cannot be written.
        """
        if name not in self._copied:
            data, target = self.read(name), root / name
            if not target.is_file() or target.read_bytes() != data:
                write_bytes(target, data)
            self._copied.add(name)


def _checked_size(path: Path, data: bytes, sha256: str) -> tuple[int, int]:
    if hashlib.sha256(data).hexdigest() != sha256:
        raise DamagedFileError(
            path,
            "the image's SHA-256 does not match the one recorded in the items; build the set again",
        )
    try:
        with Image.open(io.BytesIO(data), formats=FORMATS) as image:
            if image.width * image.height > MAX_PIXELS:
                raise LimitError(
                    path, f"image of {image.width} x {image.height} pixels exceeds the size limit"
                )
            image.load()
            return image.size
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise DamagedFileError(path, f"not an image that trainers can read ({error})") from error

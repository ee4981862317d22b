"""Images embedded in larger files, which are read from their byte offset on demand.

Nothing is cached, except that the last member of a zip archive stays decompressed because archive
members are not seekable.
"""

import io
import zlib
from dataclasses import dataclass
from functools import lru_cache
from types import SimpleNamespace
from typing import IO

import numpy as np

from world2minecraft.capture.images import MAX_PIXELS, ImageHeader, NamedByFrame, open_image
from world2minecraft.core.archives import AnyPath, ArchivePath, file_stamp
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_bytes

HEADER_BYTES = 64 << 10  # A JPEG's size stands before its pixels, after at most a thumbnail.
MAX_MEMBER_BYTES = 512 << 20  # Maximum size of a zip member that is read into memory.


@dataclass(frozen=True)
class FileSlice(NamedByFrame):
    """A range of bytes in a file, which can be opened like a file.

    Attributes:
        path: The file.
        offset: First byte of the range.
        size: Number of bytes.
        frame: Name of the image, for messages.
    """

    path: AnyPath
    offset: int
    size: int
    frame: str

    @property
    def suffix(self) -> str:
        """An empty string, because the file type is detected from its first bytes."""
        return ""

    def stat(self) -> SimpleNamespace:
        """Return an object with the size in bytes as ``st_size``."""
        return SimpleNamespace(st_size=self.size)

    def open(self, mode: str = "rb") -> io.BytesIO:
        """Open the bytes for reading."""
        if mode != "rb":
            raise ValueError(f"a file slice can only be opened with mode 'rb', got {mode!r}")
        return io.BytesIO(self.part(0, self.size))

    def part(self, start: int, end: int) -> bytes:
        """Return bytes ``start`` to ``end`` of the slice; fewer if the file became shorter."""
        with open_seekable(self.path) as stream:
            stream.seek(self.offset + start)
            return stream.read(end - start)


def open_seekable(path: AnyPath) -> IO[bytes]:
    """Open a file for random access. Members of a zip archive are read into memory.

    Raises:
        InputError: If the file is missing.
        LimitError: If an archive member is larger than ``MAX_MEMBER_BYTES``.
    """
    if isinstance(path, ArchivePath):
        check_archive_member_size(path)
        return io.BytesIO(_read_member(path, file_stamp(path)))
    try:
        return path.open("rb")
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error


def check_archive_member_size(path: AnyPath) -> None:
    """Check that an archive member is small enough to be read into memory.

    Members of a zip archive do not support random access.

    Raises:
        LimitError: If the member is larger than ``MAX_MEMBER_BYTES``.
    """
    if isinstance(path, ArchivePath) and path.is_file():
        size = int(path.stat().st_size)
        if size > MAX_MEMBER_BYTES:
            raise LimitError(
                path,
                f"has {size:,} bytes, too many to be read from a zip archive; unpack the "
                "archive first",
            )


@lru_cache(maxsize=1)
def _read_member(path: ArchivePath, stamp: tuple[int, int]) -> bytes:
    return read_bytes(path, MAX_MEMBER_BYTES)


@dataclass(frozen=True)
class EncodedImage(FileSlice):
    """A JPEG or PNG image embedded in a file."""

    def header(self) -> ImageHeader:
        """Return the size and mode of the image.

        Raises:
            InputError: If the bytes are not a valid image.
        """
        first = min(self.size, HEADER_BYTES)
        head = FileSlice(self.path, self.offset, first, self.frame)
        with open_image(head) as image:
            return ImageHeader(*image.size, image.mode)

    def check_whole(self) -> None:
        """Check that a JPEG is complete. A PNG is checked when it is decoded."""
        start = self.part(0, 3)
        end = self.part(max(0, self.size - 4096), self.size)
        if start == b"\xff\xd8\xff" and b"\xff\xd9" not in end:
            raise DamagedFileError(
                self, "is truncated (JPEG without an end marker); copy the file again"
            )

    def colour(self) -> np.ndarray:
        """Return the image as sRGB, uint8 [H, W, 3]."""
        with open_image(self) as image:
            return np.array(image.convert("RGB"), np.uint8)

    def raw(self) -> np.ndarray:
        """Return the stored pixel values as an array [H, W]."""
        with open_image(self) as image:
            return np.array(image)


@dataclass(frozen=True)
class RawImage(FileSlice):
    """An uncompressed or zlib-compressed array of pixels embedded in a file.

    Attributes:
        width_px: Width in pixels.
        height_px: Height in pixels.
        mode: ``RGB`` for three bytes per pixel, or ``I;16`` for little-endian uint16.
        packed: Whether the pixels are compressed with zlib.
    """

    width_px: int
    height_px: int
    mode: str = "I;16"
    packed: bool = False

    def header(self) -> ImageHeader:
        """Return the size and mode of the image."""
        return ImageHeader(self.width_px, self.height_px, self.mode)

    def check_whole(self) -> None:
        """Check the length of the stored pixels.

        Compressed pixels are checked when they are decompressed.
        """
        if not self.packed and self.size != self._unpacked_size:
            raise DamagedFileError(
                self,
                f"has {self.size:,} bytes, expected {self._unpacked_size:,}; copy the file again",
            )
        if self.packed and not 0 < self.size <= self._unpacked_size + 4096:
            raise DamagedFileError(
                self,
                f"has {self.size:,} compressed bytes, more than its uncompressed pixels; "
                "copy the file again",
            )

    @property
    def _unpacked_size(self) -> int:
        return self.width_px * self.height_px * (3 if self.mode == "RGB" else 2)

    def colour(self) -> np.ndarray:
        """Return the image as sRGB, uint8 [H, W, 3]."""
        return self._pixels(np.dtype(np.uint8)).reshape(self.height_px, self.width_px, 3)

    def raw(self) -> np.ndarray:
        """Return the stored pixel values as uint16 [H, W]."""
        return self._pixels(np.dtype("<u2")).reshape(self.height_px, self.width_px)

    def _pixels(self, dtype: np.dtype) -> np.ndarray:
        if self.width_px * self.height_px > MAX_PIXELS:
            raise DamagedFileError(
                self,
                f"has a size of {self.width_px}x{self.height_px} pixels, the limit is "
                f"{MAX_PIXELS:,} pixels",
            )
        data = self.part(0, self.size)
        if self.packed:
            data = self._unpacked(data)
        if len(data) != self._unpacked_size:
            raise DamagedFileError(
                self,
                f"contains {len(data):,} bytes, expected {self._unpacked_size:,}; copy the file "
                "again",
            )
        return np.frombuffer(data, dtype).astype(dtype.newbyteorder("="))

    def _unpacked(self, data: bytes) -> bytes:
        """Decompress at most the stated size plus one byte, to detect longer data."""
        try:
            return zlib.decompressobj().decompress(data, self._unpacked_size + 1)
        except zlib.error as error:
            raise DamagedFileError(
                self, f"cannot be decompressed ({error}); copy the file again"
            ) from error

"""Images embedded in larger files, read from their offset when needed.

Nothing is cached between two reads but for zips, whose members cannot be sought in: there the
last member stays decompressed.
"""

import io
import zlib
from dataclasses import dataclass
from functools import lru_cache
from types import SimpleNamespace
from typing import IO

import numpy as np

from world2minecraft.capture.images import MAX_PIXELS, ImageHeader, NamedByFrame, open_image
from world2minecraft.core.archives import AnyPath, ArchivePath
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_bytes

HEADER_BYTES = 64 << 10  # A JPEG's size stands before its pixels, after at most a thumbnail.
MAX_MEMBER_BYTES = 512 << 20  # As much as is held in memory of a file that lies in a zip.


@dataclass(frozen=True)
class FileSlice(NamedByFrame):
    """Some bytes of a file, which open like a file; ``frame`` names them in messages."""

    path: AnyPath
    offset: int
    size: int
    frame: str

    @property
    def suffix(self) -> str:
        """None: the bytes tell what they are."""
        return ""

    def stat(self) -> SimpleNamespace:
        """Return ``st_size`` in bytes."""
        return SimpleNamespace(st_size=self.size)

    def open(self, mode: str = "rb") -> io.BytesIO:
        """Open the bytes for reading."""
        if mode != "rb":
            raise ValueError(f"a slice is opened with rb, not {mode}")
        return io.BytesIO(self.part(0, self.size))

    def part(self, start: int, end: int) -> bytes:
        """Return bytes of the slice; fewer where the file has become shorter."""
        with open_seekable(self.path) as stream:
            stream.seek(self.offset + start)
            return stream.read(end - start)


def open_seekable(path: AnyPath) -> IO[bytes]:
    """Open a file that is sought in; a zip's member of at most ``MAX_MEMBER_BYTES``.

    Raises:
        InputError: it is missing. LimitError: a member is too large: unpack the zip first.
    """
    if isinstance(path, ArchivePath):
        check_archive_member_size(path)
        stamp = path.path.stat()
        return io.BytesIO(_read_member(path, (stamp.st_size, stamp.st_mtime_ns)))
    try:
        return path.open("rb")
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error


def check_archive_member_size(path: AnyPath) -> None:
    """Refuse a large file within a zip, which cannot be sought in but only held in memory.

    Raises:
        LimitError: it is over ``MAX_MEMBER_BYTES``.
    """
    if isinstance(path, ArchivePath) and path.is_file():
        size = int(path.stat().st_size)
        if size > MAX_MEMBER_BYTES:
            raise LimitError(path, f"has {size:,} bytes within a zip; unpack the zip first")


@lru_cache(maxsize=1)
def _read_member(path: ArchivePath, stamp: tuple[int, int]) -> bytes:
    return read_bytes(path, MAX_MEMBER_BYTES)


@dataclass(frozen=True)
class EncodedImage(FileSlice):
    """A JPEG or PNG within a file."""

    def header(self) -> ImageHeader:
        """Return size and mode. Raises what ``images.read_header`` raises."""
        first = min(self.size, HEADER_BYTES)
        head = FileSlice(self.path, self.offset, first, self.frame)
        with open_image(head) as image:
            return ImageHeader(*image.size, image.mode)

    def check_whole(self) -> None:
        """Check the end of a JPEG; a PNG's check sums are held against it when it is decoded."""
        start = self.part(0, 3)
        end = self.part(max(0, self.size - 4096), self.size)
        if start == b"\xff\xd8\xff" and b"\xff\xd9" not in end:
            raise DamagedFileError(self, "is cut short (a JPEG without its end); copy it again")

    def colour(self) -> np.ndarray:
        """Return uint8 [H, W, 3] sRGB."""
        with open_image(self) as image:
            return np.array(image.convert("RGB"), np.uint8)

    def raw(self) -> np.ndarray:
        """Return [H, W] values as stored."""
        with open_image(self) as image:
            return np.array(image)


@dataclass(frozen=True)
class RawImage(FileSlice):
    """Rows of numbers within a file, packed by zlib or not, of a size that is stated elsewhere.

    ``mode`` is RGB (three bytes a pixel) or I;16 (little-endian).
    """

    width_px: int
    height_px: int
    mode: str = "I;16"
    packed: bool = False

    def header(self) -> ImageHeader:
        """Return the stated size and mode."""
        return ImageHeader(self.width_px, self.height_px, self.mode)

    def check_whole(self) -> None:
        """Check the length of plain pixels; packed ones tell when they are unpacked."""
        if not self.packed and self.size != self._unpacked_size:
            raise DamagedFileError(
                self,
                f"has {self.size:,} bytes, not {self._unpacked_size:,}; copy it again",
            )
        if self.packed and not 0 < self.size <= self._unpacked_size + 4096:
            raise DamagedFileError(
                self, f"has {self.size:,} packed bytes, more than its pixels: copy it again"
            )

    @property
    def _unpacked_size(self) -> int:
        return self.width_px * self.height_px * (3 if self.mode == "RGB" else 2)

    def colour(self) -> np.ndarray:
        """Return uint8 [H, W, 3] sRGB."""
        return self._pixels(np.dtype(np.uint8)).reshape(self.height_px, self.width_px, 3)

    def raw(self) -> np.ndarray:
        """Return uint16 [H, W] as stored."""
        return self._pixels(np.dtype("<u2")).reshape(self.height_px, self.width_px)

    def _pixels(self, dtype: np.dtype) -> np.ndarray:
        if self.width_px * self.height_px > MAX_PIXELS:
            raise DamagedFileError(self, f"states {self.width_px}x{self.height_px} pixels")
        data = self.part(0, self.size)
        if self.packed:
            data = self._unpacked(data)
        if len(data) != self._unpacked_size:
            raise DamagedFileError(
                self,
                f"holds {len(data):,} bytes, not {self._unpacked_size:,}; copy it again",
            )
        return np.frombuffer(data, dtype).astype(dtype.newbyteorder("="))

    def _unpacked(self, data: bytes) -> bytes:
        """Unpack no more than the stated size, one byte over to see that there is more."""
        try:
            return zlib.decompressobj().decompress(data, self._unpacked_size + 1)
        except zlib.error as error:
            raise DamagedFileError(self, f"cannot be unpacked ({error}); copy it again") from error

"""Reading of the images of a capture, which are untrusted input.

The size in the header is compared with ``MAX_PIXELS`` before an image is decoded. Only the formats
that captures use are tried, and truncated files are detected without decoding. An image is a file,
a member of a zip archive, or an ``ImageSource``, such as a frame of a video or a rendered view.
"""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tokenize import TokenError
from typing import IO, Any, Protocol

import numpy as np
from PIL import Image, UnidentifiedImageError

from world2minecraft.core.archives import AnyPath, ArchivePath
from world2minecraft.core.errors import (
    MALFORMED,
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    reason_of,
)
from world2minecraft.core.files import read_npy

MAX_PIXELS = 64_000_000  # A 48-megapixel phone photo passes; decoding it takes 144 MB.
FORMATS = ("PNG", "JPEG", "TIFF", "PPM", "WEBP", "BMP")
HEIF_SUFFIXES = (".heic", ".heif", ".hif")  # Written by phones; reading them needs an extra.
HEIF_BRANDS = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1")
HEAD_BYTES = 12  # A HEIF file's first box: its length, "ftyp" and the brand.
SUFFIXES = (".png", ".jpg", ".jpeg", ".tiff", ".tif", ".ppm", ".pgm", ".webp", ".bmp")
_FILES = (Path, ArchivePath)


class NamedByFile:
    """Mixin for images that are named after their file ``path``."""

    path: AnyPath

    def __str__(self) -> str:
        """Return the path of the file, for messages."""
        return str(self.path)

    @property
    def stem(self) -> str:
        """The name of the file without suffix."""
        return self.path.stem

    @property
    def name(self) -> str:
        """The name of the file."""
        return self.path.name


class NamedByFrame:
    """Mixin for images inside a larger file ``path`` that are named after their ``frame``."""

    path: AnyPath
    frame: str

    def __str__(self) -> str:
        """Return the path of the file and the frame, for messages."""
        return f"{self.path}/{self.frame}"

    @property
    def stem(self) -> str:
        """The name by which label images are found."""
        return self.frame.partition(" ")[0]

    @property
    def name(self) -> str:
        """A short name for messages."""
        return self.frame


@dataclass(frozen=True)
class ImageHeader:
    """The size and mode of an image. ``mode`` is a Pillow mode, or the dtype of a ``.npy`` file."""

    width_px: int
    height_px: int
    mode: str

    @property
    def size(self) -> tuple[int, int]:
        """The width and height in pixels."""
        return self.width_px, self.height_px


class ImageSource(Protocol):
    """An image that is not a file of its own, such as a frame of a video.

    ``str()`` returns its name for messages, such as ``scan.sens/frame 12``. Its methods raise the
    same exceptions as the functions of this module.
    """

    @property
    def stem(self) -> str:
        """A name without suffix, by which label images are found."""
        ...

    @property
    def name(self) -> str:
        """A short name for messages."""
        ...

    def header(self) -> ImageHeader:
        """Return the size and mode of the image without decoding it."""
        ...

    def check_whole(self) -> None:
        """Check without decoding that the image is complete."""
        ...

    def colour(self) -> np.ndarray:
        """Return the image as sRGB, uint8 [H, W, 3]."""
        ...

    def raw(self) -> np.ndarray:
        """Return the stored values, such as depth, labels or confidence, as an array [H, W]."""
        ...


ImagePlace = AnyPath | ImageSource


def read_header(path: ImagePlace) -> ImageHeader:
    """Read the size and mode of an image without its pixels.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not an image.
        LimitError: If the image has more than ``MAX_PIXELS`` pixels.
    """
    if not isinstance(path, _FILES):
        found = path.header()
        _check_pixels(path, *found.size)
        return found
    if path.suffix == ".npy":
        array = _open_npy(path)
        return ImageHeader(array.shape[1], array.shape[0], array.dtype.name)
    with open_image(path) as image:
        return ImageHeader(*image.size, image.mode)


def check_whole(path: ImagePlace) -> None:
    """Check that an image file is complete, without decoding it if possible.

    Raises:
        DamagedFileError: If the file is truncated or a checksum is wrong.
    """
    if not isinstance(path, _FILES):
        return path.check_whole()
    if path.suffix == ".npy":
        _open_npy(path)
        return
    with open_image(path) as image:
        kind = image.format
        if kind == "PNG":
            image.verify()
    if kind == "HEIF":
        _check_boxes(path)
    if kind in ("JPEG", "MPO") and b"\xff\xd9" not in _read_end(path, 4096):
        _check_by_decoding(path)


def _check_by_decoding(path: AnyPath) -> None:
    """Decode a JPEG with data after its end marker, which phones append."""
    try:
        with open_image(path) as image:
            image.load()
    except DamagedFileError as error:
        reason = "is truncated (JPEG without an end marker); copy the file again"
        raise DamagedFileError(path, reason) from error


def read_colour(path: ImagePlace) -> np.ndarray:
    """Decode a colour image to sRGB, uint8 [H, W, 3].

    Raises:
        InputError: If the image is missing, damaged or too large.
    """
    if not isinstance(path, _FILES):
        return path.colour()
    with open_image(path) as image:
        return np.array(image.convert("RGB"), np.uint8)


def read_small(path: ImagePlace, longest_px: int) -> np.ndarray:
    """Decode a colour image to sRGB, uint8 [h, w, 3], with at most ``longest_px`` per side.

    A JPEG is decoded at a reduced resolution if possible, which is several times faster.

    Raises:
        InputError: If the image is missing, damaged or too large.
    """
    if not isinstance(path, _FILES):
        return downscale(path.colour(), longest_px)
    with open_image(path) as image:
        image.draft("RGB", (longest_px, longest_px))
        return downscale(np.array(image.convert("RGB"), np.uint8), longest_px)


def downscale(colour: np.ndarray, longest_px: int) -> np.ndarray:
    """Downscale an image so that its longer side has at most ``longest_px`` pixels.

    Args:
        colour: Image, uint8 [H, W, 3].
        longest_px: Maximum length of the longer side. Smaller images are returned unchanged.

    Returns:
        The image as uint8 [h, w, 3]. Each pixel is the mean of its area, to avoid aliasing.
    """
    height, width = colour.shape[:2]
    share = longest_px / max(height, width)
    if share >= 1:
        return colour
    size = (max(1, round(width * share)), max(1, round(height * share)))
    return np.array(Image.fromarray(colour).resize(size, Image.Resampling.BOX), np.uint8)


def read_raw(path: ImagePlace) -> np.ndarray:
    """Decode a single-channel image to an array [H, W] of its stored values and dtype."""
    if not isinstance(path, _FILES):
        return path.raw()
    if path.suffix == ".npy":
        return np.array(_open_npy(path))
    with open_image(path) as image:
        return np.array(image)


class Openable(Protocol):
    """An object that can be opened like a file, such as a part of a larger file."""

    def open(self, mode: str = "rb") -> IO[bytes]:
        """Open the object for reading bytes."""
        ...

    def stat(self) -> Any:
        """Return an object with the size in bytes as ``st_size``."""
        ...


@contextmanager
def open_image(path: AnyPath | Openable) -> Iterator[Image.Image]:
    """Open an image after checking its size, and convert all errors to project exceptions.

    Raises:
        InputError: If the image is missing.
        DamagedFileError: If the image is damaged.
        LimitError: If the image has more than ``MAX_PIXELS`` pixels.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Ours is the stricter limit, checked below.
            with path.open("rb") as stream:
                formats = _formats(stream.read(HEAD_BYTES))
                stream.seek(0)
                with Image.open(stream, formats=formats) as image:
                    _check_pixels(path, *image.size)
                    yield image
    except Image.DecompressionBombError as error:
        raise LimitError(
            path,
            f"has over {MAX_PIXELS * 2 // 1_000_000} megapixels, the limit is 64; export a "
            "smaller image",
        ) from error
    except UnidentifiedImageError as error:
        kind = (
            "is empty"
            if path.stat().st_size == 0
            else f"is not in a supported image format ({', '.join(FORMATS)})"
        )
        raise DamagedFileError(path, f"{kind}; copy the file again") from error
    except FileNotFoundError as error:
        raise InputError(path, "not found") from error
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, MemoryError) as error:
        # Pillow raises SyntaxError for a PNG whose chunks fail their check sums.
        raise DamagedFileError(
            path, f"is damaged ({reason_of(error, 120)}); copy the file again"
        ) from error


def _formats(head: bytes) -> tuple[str, ...]:
    """Return the image formats to try; HEIF support is imported only for HEIF files.

    The format is detected from the first bytes, because apps send HEIC photos named ``.jpg``.
    """
    if head[4:8] != b"ftyp" or head[8:12] not in HEIF_BRANDS:
        return FORMATS
    try:
        import pillow_heif  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("reading HEIC photos", "capture") from error
    pillow_heif.register_heif_opener(thumbnails=False)
    return (*FORMATS, "HEIF")


def _check_boxes(path: AnyPath) -> None:
    """Check that the boxes of a HEIF file end at the end of the file."""
    size, at = path.stat().st_size, 0
    with path.open("rb") as stream:
        while at < size:
            stream.seek(at)
            head = stream.read(16)
            length = int.from_bytes(head[:4], "big")
            if length == 1:
                length = int.from_bytes(head[8:16], "big")
            at = size if length == 0 else at + max(length, 8)
    if at > size:
        raise DamagedFileError(path, "is truncated (its last part is missing); copy the file again")


def _check_pixels(path: object, width_px: int, height_px: int) -> None:
    if width_px * height_px > MAX_PIXELS:
        raise LimitError(
            path,
            f"is {width_px}x{height_px} px, {width_px * height_px / 1e6:.0f} megapixels; the "
            f"limit is {MAX_PIXELS // 1_000_000}; export a smaller image",
        )


def _open_npy(path: AnyPath) -> Any:
    """Map a ``.npy`` file of [H, W] numbers, and check its length against its header."""
    try:
        if isinstance(path, Path):
            array = np.lib.format.open_memmap(path, mode="r")
        else:
            array = read_npy(path)
    except FileNotFoundError as error:
        raise InputError(path, "not found") from error
    except (OSError, EOFError, TokenError, *MALFORMED) as error:
        reason = f"is not a complete .npy file ({reason_of(error, 120)}); copy the file again"
        raise DamagedFileError(path, reason) from error
    if array.ndim != 2 or array.dtype.kind not in "fu" or not array.size:
        raise DamagedFileError(
            path,
            f"must contain unsigned integers or floats of shape [H, W], got {array.dtype} "
            f"{array.shape}; save it as uint16 or float32",
        )
    _check_pixels(path, array.shape[1], array.shape[0])
    return array


def _read_end(path: AnyPath, size: int) -> bytes:
    with path.open("rb") as stream:
        stream.seek(max(0, path.stat().st_size - size))
        return stream.read()

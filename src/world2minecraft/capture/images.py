"""Reading images of a capture, which are untrusted until checked.

The size is read from the header and compared with ``MAX_PIXELS`` before anything is decoded, only
the formats that captures use are tried, and a truncated file is found without decoding it. An
image lies in a file, in a member of a zip, or wherever an ``ImageSource`` takes it from: a video,
a ``.sens`` file, a rendered mesh.
"""

import warnings
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Protocol

import numpy as np
from PIL import Image, UnidentifiedImageError

from world2minecraft.core.archives import AnyPath, ArchivePath
from world2minecraft.core.errors import (
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    reason_of,
)

MAX_PIXELS = 64_000_000  # A 48-megapixel phone photo passes; decoding it takes 144 MB.
FORMATS = ("PNG", "JPEG", "TIFF", "PPM", "WEBP", "BMP")
HEIF_SUFFIXES = (".heic", ".heif", ".hif")  # What phones write; read by an extra.
HEIF_BRANDS = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1")
HEAD_BYTES = 12  # A HEIF file's first box: its length, "ftyp" and the brand.
SUFFIXES = (".png", ".jpg", ".jpeg", ".tiff", ".tif", ".ppm", ".pgm", ".webp", ".bmp")
_FILES = (Path, ArchivePath)


class NamedByFile:
    """An image that is called as its file ``path``."""

    path: AnyPath

    def __str__(self) -> str:
        """The file's path, for messages."""
        return str(self.path)

    @property
    def stem(self) -> str:
        """The file's name without suffix."""
        return self.path.stem

    @property
    def name(self) -> str:
        """The file's name."""
        return self.path.name


class NamedByFrame:
    """An image within the larger file ``path`` that is called as its ``frame``."""

    path: AnyPath
    frame: str

    def __str__(self) -> str:
        """The file and the frame in it."""
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
    """Size and mode of an image; ``mode`` is Pillow's, or the dtype of a ``.npy``."""

    width_px: int
    height_px: int
    mode: str

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.width_px, self.height_px


class ImageSource(Protocol):
    """An image that lies in no file of its own.

    ``str()`` of it names it in messages, as ``scan.sens/frame 12``. Its methods raise what the
    functions of this module raise.
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
        """Return size and mode, cheaply."""
        ...

    def check_whole(self) -> None:
        """Check, without decoding, that the image is there whole."""
        ...

    def colour(self) -> np.ndarray:
        """Return uint8 [H, W, 3] sRGB."""
        ...

    def raw(self) -> np.ndarray:
        """Return [H, W] values as stored: depth, labels, confidence."""
        ...


ImagePlace = AnyPath | ImageSource


def read_header(path: ImagePlace) -> ImageHeader:
    """Read an image's size and kind, without its pixels.

    Raises:
        InputError: it is missing. DamagedFileError: it is no image. LimitError: it is over
            ``MAX_PIXELS``.
    """
    if not isinstance(path, _FILES):
        found = path.header()
        _check_pixels(path, *found.size)
        return found
    if path.suffix == ".npy":
        array = _open_npy(path)
        return ImageHeader(array.shape[1], array.shape[0], array.dtype.name)
    with _open_checked(path) as image:
        return ImageHeader(*image.size, image.mode)


def check_whole(path: ImagePlace) -> None:
    """Check that an image file is not cut short, without decoding it where its end tells.

    Raises:
        DamagedFileError: it ends early or fails its own check sums.
    """
    if not isinstance(path, _FILES):
        return path.check_whole()
    if path.suffix == ".npy":
        _open_npy(path)
        return
    with _open_checked(path) as image:
        kind = image.format
        if kind == "PNG":
            image.verify()
    if kind == "HEIF":
        _check_boxes(path)
    if kind in ("JPEG", "MPO") and b"\xff\xd9" not in _read_end(path, 4096):
        _check_by_decoding(path)


def _check_by_decoding(path: AnyPath) -> None:
    """Decode a JPEG whose end is not at the file's: phones append a video or facts of their own."""
    try:
        with _open_checked(path) as image:
            image.load()
    except DamagedFileError as error:
        reason = "is cut short (a JPEG without its end); copy it again"
        raise DamagedFileError(path, reason) from error


def read_colour(path: ImagePlace) -> np.ndarray:
    """Decode a colour image to uint8 [H, W, 3] sRGB. Raises what ``read_header`` raises."""
    if not isinstance(path, _FILES):
        return path.colour()
    with _open_checked(path) as image:
        return np.array(image.convert("RGB"), np.uint8)


def read_small(path: ImagePlace, longest_px: int) -> np.ndarray:
    """Decode a colour image to at most ``longest_px`` a side, uint8 [h, w, 3] sRGB.

    A JPEG is decoded at an eighth to a half of its size where that is enough, which is several
    times as fast. Raises what ``read_header`` raises.
    """
    if not isinstance(path, _FILES):
        image = Image.fromarray(path.colour())
        return _shrink_to(image, longest_px)
    with _open_checked(path) as image:
        image.draft("RGB", (longest_px, longest_px))
        return _shrink_to(image.convert("RGB"), longest_px)


def _shrink_to(image: Image.Image, longest_px: int) -> np.ndarray:
    share = min(1.0, longest_px / max(image.size))
    size = (max(1, round(image.width * share)), max(1, round(image.height * share)))
    if size != image.size:
        image = image.resize(size, Image.Resampling.BOX)
    return np.array(image, np.uint8)


def read_raw(path: ImagePlace) -> np.ndarray:
    """Decode an image of single values as it is stored, [H, W] of any number type."""
    if not isinstance(path, _FILES):
        return path.raw()
    if path.suffix == ".npy":
        return np.array(_open_npy(path))
    with _open_checked(path) as image:
        return np.array(image)


class Openable(Protocol):
    """What opens like a file: a part of a larger one, for instance."""

    def open(self, mode: str = "rb") -> IO[bytes]:
        """Open it for reading bytes."""
        ...

    def stat(self) -> Any:
        """Return ``st_size`` in bytes."""
        ...


def open_image(source: AnyPath | Openable) -> AbstractContextManager[Image.Image]:
    """Open an image that lies within another file, with its size checked.

    Raises:
        DamagedFileError: it is no image. LimitError: it is over ``MAX_PIXELS``.
    """
    return _open_checked(source)


@contextmanager
def _open_checked(path: AnyPath | Openable) -> Iterator[Image.Image]:
    """Open an image with its size checked; any way to fail becomes one of our errors."""
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
            f"has over {MAX_PIXELS * 2 // 1_000_000} megapixels; at most 64 are read: export it "
            "smaller",
        ) from error
    except UnidentifiedImageError as error:
        kind = "is empty" if path.stat().st_size == 0 else f"is none of {', '.join(FORMATS)}"
        raise DamagedFileError(path, f"{kind}; copy it again") from error
    except FileNotFoundError as error:
        raise InputError(path, "is not there") from error
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, MemoryError) as error:
        # Pillow raises SyntaxError for a PNG whose chunks fail their check sums.
        raise DamagedFileError(
            path, f"is damaged ({reason_of(error, 120)}); copy it again"
        ) from error


def _formats(head: bytes) -> tuple[str, ...]:
    """Return the formats to try; the reader of HEIF is looked for only where one is met.

    Its first bytes tell, not its name: apps send HEIC photos that are called ``.jpg``.
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
    """Check that the boxes of a HEIF file end where the file does."""
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
        raise DamagedFileError(path, "is cut short (its last part is missing); copy it again")


def _check_pixels(path: object, width_px: int, height_px: int) -> None:
    if width_px * height_px > MAX_PIXELS:
        raise LimitError(
            path,
            f"is {width_px}x{height_px}, {width_px * height_px / 1e6:.0f} megapixels; "
            f"at most {MAX_PIXELS // 1_000_000} are read: export it smaller",
        )


def _open_npy(path: AnyPath) -> Any:
    """Map a ``.npy`` of [H, W] numbers; its length is checked against its header."""
    try:
        if isinstance(path, Path):
            array = np.load(path, mmap_mode="r", allow_pickle=False)
        else:
            array = np.load(path.open("rb"), allow_pickle=False)
    except FileNotFoundError as error:
        raise InputError(path, "is not there") from error
    except (OSError, ValueError, EOFError) as error:
        reason = f"is no whole .npy ({reason_of(error, 120)}); copy it again"
        raise DamagedFileError(path, reason) from error
    if array.ndim != 2 or array.dtype.kind not in "fu" or not array.size:
        raise DamagedFileError(
            path,
            f"must hold unsigned or float numbers [H, W], not {array.dtype} {array.shape}; "
            "save it as uint16 or float32",
        )
    _check_pixels(path, array.shape[1], array.shape[0])
    return array


def _read_end(path: AnyPath, size: int) -> bytes:
    with path.open("rb") as stream:
        stream.seek(max(0, path.stat().st_size - size))
        return stream.read()

"""Reader for in-game screenshots with their poses, from a sidecar file, file names or PNG texts.

The caller must state whether the positions are those of the feet, as shown by F3, or of the eye: a
mistake shifts all labels by 1.62 blocks. By default, a sidecar file in the folder is used, then the
texts in the PNG files, then the file names. Each view records where its pose came from.

A file name pattern is either a template such as ``shot_{x}_{y}_{z}_{yaw}_{pitch}``, which is safe
for any file name, or a regular expression with the named groups x, y, z, yaw and pitch. Regular
expressions that could take very long for some names (nested repeats or many wildcards) are
rejected.

PNG files are parsed chunk by chunk with limits on all sizes, without Pillow. Pillow keeps only the
last of several texts with the same keyword, although a pose that is given twice must be rejected.
It also decodes all pixels to find texts after them, and treats a text that cannot be decompressed
as empty.
"""

import re
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO, Literal, NamedTuple

import numpy as np

from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.rendering.views.cameras import GamePose, camera_of
from world2minecraft.rendering.views.pose_file import TourPose, read_tour

SIGNATURE = b"\x89PNG\r\n\x1a\n"
MAX_CHUNKS = 20_000
MAX_TEXT, MAX_TEXTS = 1 << 16, 64  # Bytes of a decompressed text; texts of a file.
MAX_SIDE_PX = 20_000
POSE_FIELDS = ("x", "y", "z", "yaw", "pitch")
DEFAULT_PATTERNS = (
    "*{x}_{y}_{z}_{yaw}_{pitch}",
    "*{x},{y},{z},{yaw},{pitch}",
    "*{x} {y} {z} {yaw} {pitch}",
)
MAX_NAME = 255  # Characters, as in most file systems.
MAX_PATTERN = 400
MAX_WILD = 2  # Wildcards; the time grows exponentially with their number.
NUMBER = r"[-+]?\d{1,9}(?:\.\d{1,9})?"
_WHOLE = r"(?:(?<![\d.])|(?=[-+]))"  # A number begins here and is not continued.
_EXAMPLE = "{x}_{y}_{z}_{yaw}_{pitch}"
At = Literal["feet", "eye"]
SIDECARS = ("poses.jsonl", "poses.csv", "tour.jsonl", "screenshots.jsonl", "screenshots.csv")
MAX_PICTURES = 1_000_000
_PAIR = re.compile(
    r"(?<![A-Za-z_])(yaw|pitch|x|y|z)[\"']?\s{0,3}[:=]\s{0,3}([-+]?\d{1,9}(?:\.\d{1,16})?)(?![\d.])",
    re.IGNORECASE,
)


class PngFacts(NamedTuple):
    """The size and texts of a PNG file, read without decoding its pixels.

    Attributes:
        width_px: Image width in pixels.
        height_px: Image height in pixels.
        texts: Pairs of keyword and text, in file order.
    """

    width_px: int
    height_px: int
    texts: tuple[tuple[str, str], ...]


def read_png_facts(path: str | Path) -> PngFacts:
    """Read the size and the texts of a PNG file.

    Raises:
        InputError: If the file cannot be opened.
        DamagedFileError: If the file is not a PNG or is truncated.
        LimitError: If the file has too many or too long texts.
    """
    source = Path(path)
    try:
        with source.open("rb") as stream:
            return _read_facts(stream, source)
    except OSError as error:
        raise InputError(source, f"cannot be read: {error.strerror or error}") from error


def _read_facts(stream: BinaryIO, source: Path) -> PngFacts:
    if stream.read(8) != SIGNATURE:
        raise DamagedFileError(source, "not a PNG file")
    length, kind = _read_chunk_head(stream, source)
    if kind != b"IHDR" or length != 13:
        raise DamagedFileError(source, "not a valid PNG file: the header (IHDR) is missing")
    width, height = struct.unpack(">II", _read_chunk_body(stream, length, kind, source)[:8])
    if not (0 < width <= MAX_SIDE_PX and 0 < height <= MAX_SIDE_PX):
        raise DamagedFileError(
            source, f"image sides must be from 1 to {MAX_SIDE_PX:,} pixels, got {width}x{height}"
        )
    texts: list[tuple[str, str]] = []
    for _ in range(MAX_CHUNKS):
        length, kind = _read_chunk_head(stream, source)
        if kind == b"IEND":
            return PngFacts(width, height, tuple(texts))
        if kind not in (b"tEXt", b"zTXt", b"iTXt"):
            stream.seek(length + 4, 1)
            continue
        if length > MAX_TEXT or len(texts) == MAX_TEXTS:
            raise LimitError(
                source, f"exceeds the limit of {MAX_TEXTS} texts of at most {MAX_TEXT:,} bytes"
            )
        texts.append(_parse_text(kind, _read_chunk_body(stream, length, kind, source), source))
    raise LimitError(source, f"exceeds the limit of {MAX_CHUNKS:,} PNG chunks")


def _read_chunk_head(stream: BinaryIO, source: Path) -> tuple[int, bytes]:
    head = stream.read(8)
    if len(head) < 8:
        raise DamagedFileError(source, "the file is truncated")
    length, kind = struct.unpack(">I4s", head)
    if length > 1 << 31:
        raise DamagedFileError(
            source, "not a valid PNG file: the length of a chunk is out of range"
        )
    return length, kind


def _read_chunk_body(stream: BinaryIO, length: int, kind: bytes, source: Path) -> bytes:
    data = stream.read(length + 4)
    if len(data) < length + 4:
        raise DamagedFileError(source, "the file is truncated")
    if zlib.crc32(kind + data[:length]) != struct.unpack(">I", data[length:])[0]:
        raise DamagedFileError(source, f"wrong checksum in PNG chunk {kind.decode()}")
    return data[:length]


def _parse_text(kind: bytes, data: bytes, source: Path) -> tuple[str, str]:
    keyword, _, rest = data.partition(b"\0")
    encoding = "latin-1"
    if kind == b"zTXt":
        rest = _decompress(rest[1:], source)
    elif kind == b"iTXt":
        packed, encoding = rest[:1] == b"\1", "utf-8"
        rest = rest[2:].partition(b"\0")[2].partition(b"\0")[2]  # Skip language and translation.
        rest = _decompress(rest, source) if packed else rest
    return keyword.decode("latin-1"), rest.decode(encoding, "replace")


def _decompress(data: bytes, source: Path) -> bytes:
    unpacker = zlib.decompressobj()
    try:
        text = unpacker.decompress(data, MAX_TEXT)
    except zlib.error as error:
        raise DamagedFileError(source, "a compressed PNG text cannot be decompressed") from error
    if unpacker.unconsumed_tail:
        raise LimitError(source, f"contains a text of more than {MAX_TEXT:,} bytes")
    return text


class NamePattern:
    """A pattern that extracts a pose from a file name without its suffix."""

    def __init__(self, text: str):
        """Parse a pattern.

        Raises:
            UsageError: If the pattern is not valid.
        """
        self.text = text
        if len(text) > MAX_PATTERN:
            raise UsageError(
                f"a pattern may have at most {MAX_PATTERN} characters, got {len(text)}"
            )
        self._compiled = re.compile(_check_regex(text) if "(?P<" in text else _template_regex(text))
        missing = [name for name in POSE_FIELDS if name not in self._compiled.groupindex]
        if missing:
            raise UsageError(
                f"pattern {text!r} does not contain {missing[0]}; it must contain all of {_EXAMPLE}"
            )

    def read(self, stem: str) -> dict[str, float] | None:
        """Return x, y, z, yaw and pitch from a file name, or None if the name does not match."""
        if len(stem) > MAX_NAME or (found := self._compiled.fullmatch(stem)) is None:
            return None
        try:
            return {name: float(found[name]) for name in POSE_FIELDS}
        except (TypeError, ValueError):  # A group without a match, or not a number.
            return None


def _template_regex(text: str) -> str:
    """Convert a template to a regular expression.

    Raises:
        UsageError: If the template is not valid.
    """
    if text.count("*") > MAX_WILD:
        raise UsageError(f"pattern {text!r} may contain * at most {MAX_WILD} times")
    parts, known, before = [], set(), ""
    for part in filter(None, re.split(r"(\{[^{}]*\}|\*)", text)):
        if part == "*":
            parts.append(".*?")
        elif part.startswith("{") and part.endswith("}"):
            name = part[1:-1]
            if name not in POSE_FIELDS:
                raise UsageError(
                    f"pattern {text!r} contains the unknown field {part}; known: "
                    f"{', '.join(POSE_FIELDS)}"
                )
            if name in known:
                raise UsageError(f"pattern {text!r} contains {part} twice")
            if before.startswith("{"):
                raise UsageError(f"pattern {text!r} must have a separator between two fields")
            known.add(name)
            parts.append(_WHOLE * (before == "*") + f"(?P<{name}>{NUMBER})")
        else:
            parts.append(re.escape(part))
        before = part
    return "".join(parts)


def _check_regex(text: str) -> str:
    """Check that a regular expression is valid and fast for every name.

    Raises:
        UsageError: If it is not.
    """
    try:
        tree = import_module("re._parser").parse(text)
    except (re.error, RecursionError, OverflowError) as error:
        raise UsageError(
            f"pattern {text!r} is not a valid regular expression ({error}); try {_EXAMPLE}"
        ) from error
    found = list(_regex_parts(tree))
    names = [name for name, _, _ in found]
    if any("ASSERT" in name or name.startswith(("GROUPREF", "BRANCH")) for name in names):
        raise UsageError(
            f"pattern {text!r} uses lookaround, branches or backreferences; try {_EXAMPLE}"
        )
    if any(inside for name, inside, _ in found if name == "REPEAT"):
        raise UsageError(f"pattern {text!r} contains nested repeats; try {_EXAMPLE}")
    wild = sum(is_wild for name, _, is_wild in found if name == "REPEAT")
    if wild > MAX_WILD:
        raise UsageError(
            f"pattern {text!r} contains {wild} wildcards, the limit is {MAX_WILD}; try {_EXAMPLE}"
        )
    return text


def _regex_parts(tree: Any, inside: bool = False) -> Iterator[tuple[str, bool, bool]]:
    """Yield the parts of a parsed pattern: name, whether repeated, whether a wildcard."""
    for code, value in tree:
        name = str(code)
        if name.endswith("_REPEAT"):
            _, max_repeats, body = value
            is_many = int(max_repeats) > 1
            if is_many:
                yield "REPEAT", inside, _matches_anything(body)
            yield from _regex_parts(body, inside or is_many)
        elif name == "SUBPATTERN":
            yield from _regex_parts(value[-1], inside)
        elif name == "ATOMIC_GROUP":
            yield from _regex_parts(value, inside)
        else:
            yield name, inside, False


def _matches_anything(body: Any) -> bool:
    """Return whether a repeated part can match more than digits, dots and signs."""
    if len(body) != 1:
        return True
    code, value = body[0]
    if str(code) == "LITERAL":
        return False
    return str(code) != "IN" or not all(
        _is_numeric(str(kind), argument) for kind, argument in value
    )


def _is_numeric(kind: str, argument: Any) -> bool:
    """Return whether a part of a character set contains only digits, dots or signs."""
    if kind == "LITERAL":
        return chr(argument) in "+-.0123456789"
    if kind == "RANGE":
        return ord("0") <= argument[0] and argument[1] <= ord("9")
    return kind == "CATEGORY" and str(argument) == "CATEGORY_DIGIT"


@dataclass(frozen=True, eq=False)
class RecordedView:
    """A screenshot with its camera and pose.

    Attributes:
        image: Screenshot file.
        camera: Camera of the screenshot.
        pose: Pose in the game, at the feet or the eye as stated by the caller.
        pose_source: Where the pose was found, such as ``poses.csv`` or ``PNG texts``.
        frame: Frame number.
        tour_id: Name of the tour, if the sidecar file states one.
        t_s: Time in seconds, if the sidecar file states one.
    """

    image: Path
    camera: Camera
    pose: GamePose
    pose_source: str
    frame: int = 0
    tour_id: str = ""
    t_s: float = 0.0

    def camera_to_room(self, block_to_room: np.ndarray) -> np.ndarray:
        """Return the camera pose in the room, float64 [4, 4].

        Positions of the feet are raised to eye height, which is 1.62 blocks at one block per metre
        and proportional to the scale of the world.
        """
        blocks_per_metre = 1 / float(np.linalg.norm(block_to_room[:3, 0]))
        return self.pose.camera_to_room(block_to_room, eye_height_blocks(blocks_per_metre))


def read_screenshots(
    folder: str | Path,
    *,
    at: At,
    poses: str | Path | None = None,
    pattern: str | None = None,
    vertical_fov_deg: float = 70.0,
) -> list[RecordedView]:
    """Read the screenshots in a folder with their poses, in sidecar order or sorted by name.

    Args:
        folder: Folder with PNG files. Other files are ignored.
        at: Reference point of the positions: ``feet`` (as shown by F3 and most mods) or ``eye``. A
            row of the sidecar file can override it.
        poses: Sidecar file (JSONL or CSV) with the columns ``image`` (or ``file``), x, y, z, yaw
            and pitch. Images that it does not list are ignored.
        pattern: Pattern that extracts poses from file names; see ``NamePattern``.
        vertical_fov_deg: Field of view option of the game in degrees. A row of the sidecar file can
            override it.

    Raises:
        UsageError: If ``at`` is missing or the pattern is not valid.
        InputError: If the folder has no images, or if an image has no pose.
        DamagedFileError: If a file is not valid.
        LimitError: If a file or the folder exceeds a limit.
    """
    if at not in ("feet", "eye"):
        raise UsageError(
            f"at must be feet (as shown by F3 and most mods) or eye (1.62 above), got {at!r}"
        )
    source = Path(folder)
    pictures = _pictures(source)
    sidecar = _sidecar(source, poses, pattern)
    if sidecar is not None:
        return _by_sidecar(source, sidecar, at, vertical_fov_deg)
    read, origin = _reader(pictures, pattern)
    views = []
    for frame, path in enumerate(pictures):
        facts = read_png_facts(path)
        numbers = read(path, facts)
        if numbers is None:
            raise InputError(
                path, f"no pose found (read from {origin}); expected x, y, z, yaw and pitch"
            )
        camera = camera_of(facts.width_px, facts.height_px, vertical_fov_deg=vertical_fov_deg)
        try:
            pose = GamePose(*(numbers[name] for name in POSE_FIELDS), at=at)
        except UsageError as error:
            raise DamagedFileError(path, f"not a valid game pose: {error}") from error
        views.append(RecordedView(path, camera, pose, origin, frame))
    return views


def _pictures(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise InputError(folder, "not a folder; expected a folder of screenshots")
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".png")
    if not found:
        raise InputError(folder, "contains no screenshots (.png files)")
    if len(found) > MAX_PICTURES:
        raise LimitError(folder, f"exceeds the limit of {MAX_PICTURES:,} screenshots")
    return found


def _sidecar(folder: Path, poses: str | Path | None, pattern: str | None) -> Path | None:
    """Return the given sidecar file, or the one in the folder of screenshots."""
    if poses is not None and pattern is not None:
        raise UsageError("poses and pattern cannot be combined; use only one of them")
    if poses is not None:
        named = Path(poses)
        return named if named.is_file() else folder / named
    if pattern is not None:
        return None
    return next((folder / name for name in SIDECARS if (folder / name).is_file()), None)


def _by_sidecar(folder: Path, sidecar: Path, at: At, fov_deg: float) -> list[RecordedView]:
    views, counts, known = [], {}, set()
    for one in read_tour(sidecar, at=at):
        path = _named(folder, one.image, sidecar)
        if path in known:
            raise DamagedFileError(sidecar, f"lists {one.image} twice")
        known.add(path)
        number = counts.get(one.tour_id, 0)
        counts[one.tour_id] = number + 1
        frame = number if one.frame is None else one.frame
        camera = _camera(path, one, sidecar, fov_deg)
        views.append(
            RecordedView(path, camera, one.pose, sidecar.name, frame, one.tour_id, one.t_s)
        )
    return views


def _named(folder: Path, name: str, sidecar: Path) -> Path:
    """Return the path of an image listed in a row, which must be inside the folder."""
    if not name:
        raise DamagedFileError(
            sidecar, "contains a row without an image file name (column image or file)"
        )
    parts = PurePosixPath(name.replace("\\", "/"))
    if parts.is_absolute() or ".." in parts.parts or ":" in name or "\0" in name:
        raise DamagedFileError(
            sidecar, f"lists {name!r}, which is not inside the folder of screenshots"
        )
    path = folder.joinpath(*parts.parts)
    if not path.is_file():
        raise InputError(sidecar, f"lists {name}, which does not exist")
    return path


def _camera(path: Path, one: TourPose, sidecar: Path, fov_deg: float) -> Camera:
    facts = read_png_facts(path)
    size = (facts.width_px, facts.height_px)
    if one.camera is None:
        return camera_of(*size, vertical_fov_deg=one.vertical_fov_deg or fov_deg)
    if (one.camera.width_px, one.camera.height_px) != size:
        stated = f"{one.camera.width_px}x{one.camera.height_px}"
        raise DamagedFileError(
            sidecar, f"states {stated} pixels for {one.image}, which has {size[0]}x{size[1]}"
        )
    return one.camera


Reader = Callable[[Path, PngFacts], dict[str, float] | None]


def _reader(pictures: list[Path], pattern: str | None) -> tuple[Reader, str]:
    """Return the function that reads poses, chosen for the first image, and its description."""
    if pattern is not None:
        return _by_name(pattern), f"file name with pattern {pattern}"
    first = pictures[0]
    facts = read_png_facts(first)
    if _by_text(first, facts) is not None:
        return _by_text, "PNG texts"
    for usual in DEFAULT_PATTERNS:
        if _by_name(usual)(first, facts) is not None:
            return _by_name(usual), f"file name with pattern {usual}"
    raise InputError(
        first,
        f"no pose found in a sidecar file ({', '.join(SIDECARS)}), in the PNG texts or in the file "
        f"name ({DEFAULT_PATTERNS[0]}); add a sidecar file or a pattern",
    )


def _by_name(pattern: str) -> Reader:
    compiled = NamePattern(pattern)
    return lambda path, facts: compiled.read(path.stem)


def _by_text(path: Path, facts: PngFacts) -> dict[str, float] | None:
    """Return the pose in the texts of a PNG: five keywords, or pairs such as ``x=1.5``."""
    found: dict[str, float] = {}
    for keyword, text in facts.texts:
        own = f"{keyword}={text.strip()}" if keyword.lower() in POSE_FIELDS else text
        for name, number in _PAIR.findall(own):
            value = float(number)
            if found.setdefault(name.lower(), value) != value:
                raise DamagedFileError(
                    path, f"contains two values for {name.lower()} in its PNG texts"
                )
    return found if len(found) == len(POSE_FIELDS) else None

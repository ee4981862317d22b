"""Reader of point clouds in text form (``.xyz .pts .txt .csv .asc``) and of S3DIS rooms.

Each line is a point that starts with x, y and z. Columns are separated by white space, commas or
semicolons. A first line with letters names the columns; a first line with a single number is the
point count of a PTS file. Without column names, colour is the first group of three columns with
integers up to 255, or else with values from 0 to 1 that are not normals. S3DIS stores one file per
object, such as ``Annotations/chair_1.txt``.
"""

import re
import warnings
from collections.abc import Iterator

import numpy as np

from world2minecraft.capture.readers.meshes.colours_and_classes import (
    class_of_name,
    classes_of_label_ids,
    colours_of_columns,
    colours_or_black,
)
from world2minecraft.capture.readers.meshes.mesh_and_cloud import MAX_POINTS, LoadedGeometry
from world2minecraft.capture.readers.meshes.voxel_downsampling import VoxelDownsampler
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, DamagedFileError, LimitError

BLOCK = 32 << 20
MAX_BYTES = 8 << 30
MAX_COLUMNS = 64
NAMES = {"x": "x", "y": "y", "z": "z", "r": "red", "g": "green", "b": "blue"}
LABEL_NAMES = ("label", "class", "classification", "semantic")
S3DIS_FOLDER = "Annotations"  # Contains one file per object.
MAX_FILES = 5000


def parse_numbers(place: AnyPath, text: bytes) -> np.ndarray:
    """Parse all whitespace-separated numbers of a text as float64 [N].

    Raises:
        DamagedFileError: If the text contains anything that is not a number.
    """
    if not text.strip():
        return np.zeros(0)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # How numpy says that it stopped early.
            return np.fromstring(text.decode("ascii"), np.float64, sep=" ")
    except (DeprecationWarning, UnicodeDecodeError, ValueError) as error:
        raise DamagedFileError(
            place, "contains text where numbers are expected; export the file again"
        ) from error


def load_text(place: AnyPath) -> LoadedGeometry:
    """Load a point cloud from a text file.

    Raises:
        DamagedFileError: If the file does not contain rows of numbers.
        LimitError: If the file is too large.
    """
    thinner = VoxelDownsampler()
    note = add_text(place, thinner)
    if thinner.offset is None:
        raise DamagedFileError(place, "contains no points; each line must start with x, y and z")
    notes = (note,) if note else ()
    return LoadedGeometry(thinner.cloud(), "text", thinner.offset, notes=notes, read=thinner.read)


def add_text(place: AnyPath, thinner: VoxelDownsampler, label: int | None = None) -> str:
    """Add the points of a text file to a downsampler.

    Args:
        place: The text file.
        thinner: The downsampler that collects the points.
        label: Class id of all points, or None to read a label column.

    Returns:
        A note about the labels, or an empty string.

    Raises:
        DamagedFileError: If the file does not contain rows of numbers.
        LimitError: If the file is too large.
    """
    names: list[str] | None = None
    colour_at: int | None = None
    width, note = 0, ""
    for lines in _blocks(place):
        names, block = (names, lines) if width else _column_names(place, lines)
        rows = _parse_rows(place, block, width or _width(place, block))
        if not len(rows):
            continue
        if not width:
            width = rows.shape[1]
            colour_at = None if names else _colour_column(rows)
        columns = dict(zip(names or (), rows.T, strict=False))
        labels = None if label is None else np.full(len(rows), label, np.uint8)
        if names:
            points = np.stack([columns[axis] for axis in "xyz"], axis=1)
            colour = colours_of_columns(columns)
            column = next((name for name in LABEL_NAMES if name in columns), None)
            if column and label is None:
                labels, note = classes_of_label_ids(place, column, columns[column])
        else:
            points = rows[:, :3]
            colour = (
                None if colour_at is None else colours_or_black(rows[:, colour_at : colour_at + 3])
            )
        thinner.add(points, colour, labels)
        if thinner.read > MAX_POINTS:
            raise LimitError(
                place, f"contains more than {MAX_POINTS:,} points; reduce the number of points"
            )
    return note


def _blocks(place: AnyPath) -> Iterator[bytes]:
    """Yield the file in blocks of complete lines."""
    if place.stat().st_size > MAX_BYTES:
        raise LimitError(
            place,
            f"has {place.stat().st_size:,} bytes, the limit is {MAX_BYTES:,}; reduce "
            "the number of points",
        )
    with place.open("rb") as stream:
        rest = b""
        while piece := stream.read(BLOCK):
            piece = rest + piece
            end = piece.rfind(b"\n") + 1
            if not end and len(piece) > BLOCK:
                raise DamagedFileError(place, "is not a text file with one point per line")
            yield piece[:end]
            rest = piece[end:]
        yield rest


def _column_names(place: AnyPath, block: bytes) -> tuple[list[str] | None, bytes]:
    """Return the column names if the first lines contain them, and the remaining lines."""
    names = None
    while block:
        line, _, rest = block.partition(b"\n")
        words = re.findall(r"[^\s,;]+", line.decode("latin-1").lstrip("#/ \ufeff").lower())
        if words and _numeric(words) and len(words) >= 3 and not line.lstrip().startswith(b"#"):
            break
        if len(words) >= 3 and not _numeric(words):
            cleaned = [word.strip("\"'").removeprefix("//") for word in words]
            found: list[str] = [NAMES.get(word) or word for word in cleaned]
            if {"x", "y", "z"} <= set(found):
                names = found
            elif not line.lstrip().startswith((b"#", b"//")):
                raise DamagedFileError(
                    place, f"has a first line that does not name x, y and z: {line[:40]!r}"
                )
        block = rest
    return names, block


def _numeric(words: list[str]) -> bool:
    try:
        [float(word) for word in words]
    except ValueError:
        return False
    return True


def _width(place: AnyPath, block: bytes) -> int:
    line = block.partition(b"\n")[0]
    width = len(re.findall(rb"[^\s,;]+", line))
    if block.strip() and not 3 <= width <= MAX_COLUMNS:
        raise DamagedFileError(place, f"has {width} columns; a point requires x, y and z")
    return max(width, 3)


def _parse_rows(place: AnyPath, block: bytes, width: int) -> np.ndarray:
    numbers = parse_numbers(place, block.replace(b",", b" ").replace(b";", b" "))
    if len(numbers) % width:
        raise DamagedFileError(
            place,
            f"has lines without exactly {width} columns or is truncated; export the file again",
        )
    return numbers.reshape(-1, width)


def _colour_column(rows: np.ndarray) -> int | None:
    """Return the index of the first of three colour columns, inferred from their values."""
    some = rows[:: max(1, len(rows) // 5000)]
    starts = range(3, rows.shape[1] - 2)
    for start in starts:
        values = some[:, start : start + 3]
        whole = (values == np.round(values)).all() and values.min() >= 0 and values.max() <= 255
        if whole and values.max() > 1:
            return start
    for start in starts:
        values = some[:, start : start + 3]
        unit = np.abs(np.linalg.norm(values, axis=1) - 1).max() < 0.01
        if values.min() >= 0 and values.max() <= 1 and not unit and values.max() > 0:
            return start
    return None


def load_s3dis(place: AnyPath) -> LoadedGeometry:
    """Load the folder of an S3DIS room.

    Raises:
        CaptureError: If the folder contains no points.
        DamagedFileError: If a file is not a point cloud.
    """
    thinner = VoxelDownsampler(unit_m=1.0)
    files = sorted((place / S3DIS_FOLDER).glob("*.txt"), key=lambda path: path.name)[:MAX_FILES]
    for path in files:
        add_text(path, thinner, class_of_name(path.stem))
    if thinner.offset is None:
        raise CaptureError(place, f"contains no points in {S3DIS_FOLDER}/*.txt")
    note = f"classes are taken from the names of {len(files)} files in {S3DIS_FOLDER}"
    cloud = thinner.cloud()
    return LoadedGeometry(cloud, "S3DIS", thinner.offset, 1.0, "z", True, (note,), thinner.read)

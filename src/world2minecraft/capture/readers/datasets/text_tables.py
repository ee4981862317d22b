"""Parsing of numbers in the text files of data sets, with size limits and precise errors."""

import re
from collections.abc import Collection, Iterable, Sequence
from pathlib import PurePosixPath

import numpy as np

from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes

_DIGITS = re.compile(r"(\d+)")
MAX_TEXT_BYTES = 64 << 20  # An hour of motion capture at 300 Hz takes 60 MB.


def read_rows(path: AnyPath, limit_bytes: int = MAX_TEXT_BYTES) -> list[list[str]]:
    """Return the words of each line, without empty lines and lines that start with #.

    Raises:
        InputError: If the file is missing.
        LimitError: If the file is too large.
    """
    text = read_bytes(path, limit_bytes).decode("utf-8", "replace")
    lines = (line.strip() for line in text.splitlines())
    return [line.split() for line in lines if line and not line.startswith("#")]


def to_floats(path: AnyPath, words: Sequence[str]) -> np.ndarray:
    """Convert words to float64; nan and inf are accepted.

    Raises:
        CaptureError: If a word is not a number.
    """
    numbers = []
    for word in words:
        try:
            numbers.append(float(word))
        except ValueError as error:
            raise CaptureError(
                path, f"contains {word[:20]!r} where a number is expected"
            ) from error
    return np.array(numbers, np.float64)


def read_matrix(path: AnyPath, shapes: Sequence[tuple[int, int]]) -> np.ndarray:
    """Read a file as a float64 matrix of one of the given shapes.

    Raises:
        CaptureError: If the file contains a different count of numbers.
        InputError: If the file is missing.
    """
    words = [word for row in read_rows(path, 1 << 20) for word in row]
    for rows, columns in shapes:
        if len(words) == rows * columns:
            return to_floats(path, words).reshape(rows, columns)
    counts = " or ".join(f"{rows * columns} ({rows}x{columns})" for rows, columns in shapes)
    raise CaptureError(path, f"must contain {counts} numbers, got {len(words)}")


def natural_sort_key(path: AnyPath) -> list[tuple[int, str]]:
    """Return a sort key that orders file names by the numbers in them: 9.png before 10.png."""
    parts = _DIGITS.split(path.name)
    return [(int(part[:18]), "") if part.isdecimal() else (-1, part) for part in parts]


def numbered_files(paths: Iterable[AnyPath], prefix: str = "") -> dict[int, AnyPath]:
    """Return the files whose names are a prefix and a number, such as ``frame_000012``, by number.

    Of several files with the same number, the last one by path is returned.
    """
    found = {}
    for path in sorted(paths, key=str):
        digits = path.stem.removeprefix(prefix)
        if path.stem.startswith(prefix) and digits.isdecimal() and len(digits) <= 9:
            found[int(digits)] = path
    return found


def files_with_suffix(folder: AnyPath, suffixes: Collection[str]) -> list[AnyPath]:
    """Return the files of a folder with one of the suffixes, sorted by the numbers in their names.

    The folder may be missing.
    """
    held = folder.iterdir() if folder.is_dir() else ()
    found = [path for path in held if path.suffix.lower() in suffixes]
    return sorted(found, key=natural_sort_key)


def check_relative_path(stated_by: AnyPath, name: str) -> PurePosixPath:
    """Return the relative path of a file named by a data set, if it is inside the folder.

    Raises:
        CaptureError: If the path leaves the folder or contains unprintable characters.
    """
    pure = PurePosixPath(name.replace("\\", "/"))
    if pure.is_absolute() or ".." in pure.parts or not pure.name or not name.isprintable():
        raise CaptureError(
            stated_by, f"contains the file name {name[:80]!r}; images must be inside the folder"
        )
    return pure

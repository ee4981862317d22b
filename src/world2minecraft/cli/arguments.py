"""Parsers for arguments that several verbs have in common."""

import re
from pathlib import Path

from world2minecraft.core.errors import UsageError

SIZE = re.compile(r"\s*([0-9]{1,9})\s*x\s*([0-9]{1,9})\s*", re.IGNORECASE)


def output_of(positional: Path | None, option: Path | None, metavar: str = "DIR") -> Path:
    """Return the output path, which is given as an argument or with ``--out``.

    Raises:
        UsageError: If neither or both are given.
    """
    if positional is not None and option is not None:
        raise UsageError(f"the output is given twice; omit {metavar} or --out")
    if positional is None and option is None:
        raise UsageError(f"the output is missing; add {metavar} or --out {metavar}")
    return (option if positional is None else positional) or Path()


def size_of(text: str, option: str = "--size") -> tuple[int, int] | None:
    """Return the width and height in a text such as ``640x480``, or None for an empty text.

    Raises:
        UsageError: If the text is not a valid size.
    """
    return parse_size(text, option) if text else None


def parse_size(text: str, option: str = "--size", example: str = "640x480") -> tuple[int, int]:
    """Return the width and height in a text such as ``640x480``.

    Args:
        text: The text to parse.
        option: Name of the option, for the error.
        example: A valid size, for the error.

    Raises:
        UsageError: If the text is not a valid size.
    """
    found = SIZE.fullmatch(text)
    if found is None:
        raise UsageError(
            f"{option} must be WIDTHxHEIGHT in pixels, such as {example}, got {text!r}"
        )
    return int(found[1]), int(found[2])

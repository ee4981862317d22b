"""Parsers for arguments that several verbs have in common."""

from pathlib import Path

from world2minecraft.core.errors import UsageError


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
    if not text:
        return None
    sides = [side.strip() for side in text.lower().split("x")]
    if len(sides) != 2 or not all(side.isdigit() for side in sides):
        raise UsageError(f"{option} must be WIDTHxHEIGHT in pixels, such as 640x480, got {text!r}")
    return int(sides[0]), int(sides[1])

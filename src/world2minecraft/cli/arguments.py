"""Values of arguments that several verbs read alike."""

from pathlib import Path

from world2minecraft.core.errors import UsageError


def output_of(positional: Path | None, option: Path | None, metavar: str = "DIR") -> Path:
    """Return the output path, which is given either by its position or with ``--out``.

    Raises:
        UsageError: neither or both are given.
    """
    if positional is not None and option is not None:
        raise UsageError(f"{metavar} and --out both name the output; give one of them")
    if positional is None and option is None:
        raise UsageError(f"no output folder; give {metavar} or --out {metavar}")
    return (option if positional is None else positional) or Path()


def size_of(text: str, option: str = "--size") -> tuple[int, int] | None:
    """Return the width and height that ``640x480`` means; None for an empty text.

    Raises:
        UsageError: the text is not a width and a height.
    """
    if not text:
        return None
    sides = [side.strip() for side in text.lower().split("x")]
    if len(sides) != 2 or not all(side.isdigit() for side in sides):
        raise UsageError(f"{option} is WIDTHxHEIGHT in pixels, such as 640x480, not {text!r}")
    return int(sides[0]), int(sides[1])

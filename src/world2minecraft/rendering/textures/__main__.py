"""Command that writes a sheet of all textures.

Usage: ``python -m world2minecraft.rendering.textures OUT.png``.
"""

import sys

from world2minecraft.core.errors import UsageError, World2MinecraftError
from world2minecraft.core.files import write_bytes
from world2minecraft.rendering.textures.texture_sheet import page_png, texture_sheet

USAGE = "usage: python -m world2minecraft.rendering.textures OUT.png [SIZE_PX [REPEAT]]"


def main(words: list[str]) -> None:
    """Write the sheet of all textures; without a size, at 16 px on the left and 64 px on the right.

    Raises:
        UsageError: If the arguments are not a file name and up to two numbers.
        OutputError: If the file cannot be written.
    """
    if not 1 <= len(words) <= 3 or not all(word.isdecimal() for word in words[1:]):
        raise UsageError(USAGE)
    numbers = [int(word) for word in words[1:]]
    size_px, repeat = (numbers + [16, 1][len(numbers) :])[:2]
    if not 1 <= repeat <= 8:
        raise UsageError(f"{USAGE}; REPEAT must be 1 to 8, got {repeat}")
    page = texture_sheet(size_px, repeat, right_px=64 if len(words) == 1 else None)
    write_bytes(words[0], page_png(page))


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except World2MinecraftError as fault:
        raise SystemExit(f"error: {fault}") from None

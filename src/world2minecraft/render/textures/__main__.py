"""The sheet of all textures as a picture: ``python -m world2minecraft.render.textures OUT.png``."""

import sys

from world2minecraft.errors import UsageError, World2MinecraftError
from world2minecraft.files import write_bytes
from world2minecraft.render.sheet import sheet_png
from world2minecraft.render.textures.sheet import texture_sheet

USAGE = "write: python -m world2minecraft.render.textures OUT.png [SIZE_PX [REPEAT]]"


def main(words: list[str]) -> None:
    """Write the sheet of all textures.

    Raises:
        UsageError: the words are not a file's name and up to two numbers.
        OutputError: the file cannot be written.
    """
    if not 1 <= len(words) <= 3 or not all(word.isdigit() for word in words[1:]):
        raise UsageError(USAGE)
    numbers = [int(word) for word in words[1:]]
    write_bytes(words[0], sheet_png(texture_sheet(*(numbers or [16]))))


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except World2MinecraftError as fault:
        raise SystemExit(f"error: {fault}") from None

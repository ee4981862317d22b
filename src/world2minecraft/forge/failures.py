"""What went wrong, as the one line that a page or a script is told."""

import errno

from world2minecraft.errors import World2MinecraftError, one_line


def explained(error: BaseException) -> str:
    """Return one line: what was expected, or what to do."""
    if isinstance(error, World2MinecraftError):
        return one_line(error)
    if isinstance(error, MemoryError):
        return "out of memory; close other programs and try again"
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return "the disk is full; free some space and try again"
    return f"unexpected {type(error).__name__}; the terminal of w2m forge has the details"

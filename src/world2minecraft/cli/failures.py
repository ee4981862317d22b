"""Report errors as one line on stderr with an exit code."""

import errno
import sys
import traceback

from world2minecraft.core.errors import World2MinecraftError, one_line

FAILURE, USAGE, BAD_INPUT, STOPPED = 1, 2, 3, 130


def report_error(error: BaseException, with_traceback: bool = False) -> int:
    """Print an error to stderr and return its exit code."""
    if isinstance(error, SystemExit):
        return error.code if isinstance(error.code, int) else int(error.code is not None)
    if with_traceback:
        traceback.print_exception(error, file=sys.stderr)
    text, code = explain_error(error)
    print(f"error: {text}" if code != STOPPED else text, file=sys.stderr)
    return code


def explain_error(error: BaseException) -> tuple[str, int]:
    """Return a one-line message with the error and the next step, and the exit code.

    Example:
        >>> explain_error(MemoryError())
        ('out of memory; close other programs, or use a larger --voxel', 1)
    """
    if isinstance(error, KeyboardInterrupt) or type(error).__name__ == "Abort":
        return "interrupted; run the same command again to continue", STOPPED
    if isinstance(error, World2MinecraftError):
        return one_line(error), error.exit_code
    if hasattr(error, "format_message"):  # typer's usage errors; older ones come from click.
        return _usage(error), USAGE
    if isinstance(error, MemoryError):
        return "out of memory; close other programs, or use a larger --voxel", FAILURE
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        where = f"{error.filename}: " if error.filename else ""
        return f"{where}the disk is full; free some space and run the same command again", BAD_INPUT
    what = one_line(f"{type(error).__name__}: {error}" if str(error) else type(error).__name__)
    return f"unexpected {what}; please report it with the output of --traceback", FAILURE


def _usage(error: BaseException) -> str:
    message = one_line(error.format_message()).rstrip(".")  # type: ignore[attr-defined]
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "w2m"
    return f"{message[:1].lower()}{message[1:]}; see {command} --help"

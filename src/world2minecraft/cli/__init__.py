"""The command line ``w2m``, with one module per verb.

``verbs`` contains the table of verbs and imports each module only when its verb is called, so ``w2m
--help`` loads neither numpy nor numba. ``failures`` reports an error as one line and an exit code:
0 for success, 1 for failure, 2 for a usage error, 3 for bad input, 130 if interrupted.
"""

import os
import sys
from collections.abc import Sequence
from typing import Any

TRACEBACK_FLAG = "--traceback"


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its exit code."""
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: Sequence[str]) -> int:
    """Run a command and return its exit code. Errors are reported on stderr, never raised.

    Args:
        arguments: Command-line arguments after ``w2m``. ``--traceback`` can be at any position.
            Setting the environment variable ``W2M_TRACEBACK=1`` has the same effect.
    """
    words = [word for word in arguments if word != TRACEBACK_FLAG] or ["--help"]
    wants_traceback = len(words) < len(arguments) or os.environ.get("W2M_TRACEBACK", "0") != "0"
    for stream in (sys.stdout, sys.stderr):
        _print_any_name(stream)
    try:
        from world2minecraft.cli.verbs import call

        return call(words)
    except BaseException as error:
        from world2minecraft.cli.failures import report_error

        return report_error(error, with_traceback=wants_traceback)


def _print_any_name(stream: Any) -> None:
    """Let a stream escape what it cannot encode, such as file names that are not UTF-8."""
    if getattr(stream, "errors", "") == "strict" and hasattr(stream, "reconfigure"):
        stream.reconfigure(errors="backslashreplace")

"""The exceptions that the program raises on purpose.

::

    World2MinecraftError            exit code 1
    ├── UsageError                  2   a command, an option or a parameter is invalid
    │   ├── UnknownNameError        2   a name is not registered
    │   └── MissingExtraError       2   an optional dependency is not installed
    ├── ServerError                 1   a server refuses a request or cannot be reached
    ├── WorkerError                 1   a worker process has exited or failed
    ├── BudgetError                 1   a limit on requests or cost is reached
    └── InputError                  3   a file or folder cannot be used
        ├── DamagedFileError        3   a file is not valid in its format
        ├── LimitError              3   a file exceeds a limit of the program
        ├── CaptureError            3   a capture lacks data that a reconstruction requires
        ├── ConflictError           3   a step would overwrite a later change or other data
        └── OutputError             3   the output folder cannot be written

Each message is a single line with the expected value, the given value and the next step for the
user.
"""

import difflib
from collections.abc import Iterable
from typing import Any

# What Python raises for values of a wrong form, type or range that a file contains.
MALFORMED = (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError)


class World2MinecraftError(Exception):
    """Base class for all exceptions in this module."""

    exit_code = 1

    def __reduce__(self):  # Makes subclasses picklable whatever their __init__ accepts.
        return _restore, (type(self), str(self), self.__dict__)


def _restore(kind: type[World2MinecraftError], text: str, facts: dict[str, Any]) -> Exception:
    error = kind.__new__(kind)
    error.args = (text,)
    error.__dict__.update(facts)
    return error


class UsageError(World2MinecraftError):
    """A command, an option or a parameter is invalid."""

    exit_code = 2


MAX_LISTED, FIRST_LISTED = 60, 20  # Limits for the list of known names.


class UnknownNameError(UsageError):
    """A name is not registered. The message suggests the closest match."""

    def __init__(self, kind: str, name: str, known: Iterable[str]):
        choices = sorted(known)
        near = difflib.get_close_matches(name, choices, n=1)
        listed = choices if len(choices) <= MAX_LISTED else choices[:FIRST_LISTED]
        more = f" and {len(choices) - len(listed)} more" if len(listed) < len(choices) else ""
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(listed)}{more}"
        super().__init__(f"no {kind} is named {name!r}; {hint}")


class MissingExtraError(UsageError):
    """An optional dependency is not installed. The message contains the install command."""

    def __init__(self, feature: str, extra: str):
        super().__init__(f"{feature} needs an extra: pip install 'world2minecraft[{extra}]'")


class ServerError(World2MinecraftError):
    """A server cannot be reached, refuses a request or does not perform it."""


class WorkerError(World2MinecraftError):
    """A worker process has exited, or failed with an exception that cannot be pickled."""


class BudgetError(World2MinecraftError):
    """A limit on the number or the cost of model requests is reached."""


class InputError(World2MinecraftError):
    """A file or folder cannot be used. The message contains its path and the reason."""

    exit_code = 3

    def __init__(self, path: object, reason: str):
        super().__init__(f"{path}: {reason}")
        self.path, self.reason = str(path), reason


class DamagedFileError(InputError):
    """A file is not valid in its format."""


class LimitError(InputError):
    """A file exceeds the program's limits on memory, nesting depth or size."""


class CaptureError(InputError):
    """A capture lacks data that a reconstruction requires, or contains contradictory data."""


class ConflictError(InputError):
    """A file or folder is in use, or has changed since a step was prepared or completed."""


class OutputError(InputError):
    """The output folder is a file, is full or is not writable."""


def one_line(text: object, most: int | None = None) -> str:
    """Collapse white space to single spaces and truncate the text to ``most`` characters.

    Example:
        >>> one_line(ValueError("no   table here"), 10)
        'no table h'
    """
    return " ".join(str(text).split())[:most]


def reason_of(error: BaseException, most: int = 100) -> str:
    """Return an exception's message on one line, or its type if the message is empty.

    Example:
        >>> reason_of(EOFError())
        'EOFError'
    """
    return one_line(error, most) or type(error).__name__


def first_line(error: BaseException) -> str:
    """Return the first line of an exception's message, or its type if the message is empty."""
    return (str(error).strip().splitlines() or [type(error).__name__])[0]

"""The exceptions that the program raises on purpose, one for each way to fail.

::

    World2MinecraftError            exit code 1
    ├── UsageError                  2   the command or a parameter is wrong
    │   ├── UnknownNameError        2   a name that no registry holds
    │   └── MissingExtraError       2   an optional dependency is not installed
    ├── ServerError                 1   a running server refuses, or cannot be reached
    ├── WorkerError                 1   a process that shares the work has ended or failed
    ├── BudgetError                 1   a cap on calls or money is reached
    └── InputError                  3   a file or folder cannot be used
        ├── DamagedFileError        3   a file is not what its format says
        ├── LimitError              3   a file asks for more than the program allows
        ├── CaptureError            3   a capture lacks what a reconstruction needs
        ├── ConflictError           3   something changed since, so that a step would destroy it
        └── OutputError             3   the output folder cannot be written

Each message says what was expected, what was given and what to type next, on one line.
"""

import difflib
from collections.abc import Iterable
from typing import Any


class World2MinecraftError(Exception):
    """The root of the tree."""

    exit_code = 1

    def __reduce__(self):  # So that one process can send it to another, whatever makes it.
        return _restore, (type(self), str(self), self.__dict__)


def _restore(kind: type[World2MinecraftError], text: str, facts: dict[str, Any]) -> Exception:
    error = kind.__new__(kind)
    error.args = (text,)
    error.__dict__.update(facts)
    return error


class UsageError(World2MinecraftError):
    """A command, an option or a parameter is wrong."""

    exit_code = 2


MAX_LISTED, FIRST_LISTED = 60, 20  # Of more names than a terminal's screen, the first are listed.


class UnknownNameError(UsageError):
    """A name that no registry holds; the message suggests the nearest."""

    def __init__(self, kind: str, name: str, known: Iterable[str]):
        choices = sorted(known)
        near = difflib.get_close_matches(name, choices, n=1)
        listed = choices if len(choices) <= MAX_LISTED else choices[:FIRST_LISTED]
        more = f" and {len(choices) - len(listed)} more" if len(listed) < len(choices) else ""
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(listed)}{more}"
        super().__init__(f"no {kind} is named {name!r}; {hint}")


class MissingExtraError(UsageError):
    """An optional dependency is not installed; the message is the install line."""

    def __init__(self, feature: str, extra: str):
        super().__init__(f"{feature} needs an extra: pip install 'world2minecraft[{extra}]'")


class ServerError(World2MinecraftError):
    """A running server cannot be reached, refuses, or does not do what it was asked to."""


class WorkerError(World2MinecraftError):
    """A process that shares the work has ended, or failed with an error that cannot be sent."""


class BudgetError(World2MinecraftError):
    """A cap on calls of a model, or on what they cost, is reached."""


class InputError(World2MinecraftError):
    """A file or folder cannot be used. The message names it, then the reason."""

    exit_code = 3

    def __init__(self, path: object, reason: str):
        super().__init__(f"{path}: {reason}")
        self.path, self.reason = str(path), reason


class DamagedFileError(InputError):
    """A file is not what its format says."""


class LimitError(InputError):
    """A file asks for more memory, depth or size than the program allows."""


class CaptureError(InputError):
    """A capture lacks what a reconstruction needs, or contradicts itself."""


class ConflictError(InputError):
    """Something changed, or is in use, since a step was prepared or done."""


class OutputError(InputError):
    """The output folder is a file, is full or may not be written."""


def one_line(text: object, most: int | None = None) -> str:
    """Return a text with each run of white space as one space, cut at ``most`` letters.

    Example:
        >>> one_line(ValueError("no   table here"), 10)
        'no table h'
    """
    return " ".join(str(text).split())[:most]


def reason_of(error: BaseException, most: int = 100) -> str:
    """Return what an error of another library says as one line, or its kind where it says nothing.

    Example:
        >>> reason_of(EOFError())
        'EOFError'
    """
    return one_line(error, most) or type(error).__name__


def first_line(error: BaseException) -> str:
    """Return the first line of what an error of another library says, or its kind."""
    return (str(error).strip().splitlines() or [type(error).__name__])[0]

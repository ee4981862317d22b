"""Names of files: those that every operating system takes, and those that are no text."""

import re

from world2minecraft.core.errors import UsageError

MAX_NAME = 60
# What no file may be named on Windows, whose users share files with others.
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]')


def is_reserved(name: str) -> bool:
    """Return whether Windows takes a name for a device.

    Example:
        >>> is_reserved("aux"), is_reserved("Con.json"), is_reserved("console")
        (True, True, False)
    """
    return _RESERVED.fullmatch(name) is not None


def portable_name(name: str) -> str:
    """Convert a name to one of a file or folder that is valid on every operating system.

    Raises:
        UsageError: If no valid characters remain.
    """
    text = _FORBIDDEN.sub(" ", name)
    text = " ".join("".join(letter for letter in text if letter.isprintable()).split())
    text = text[:MAX_NAME].strip(". ")
    if not text:
        raise UsageError(f"name must contain letters or digits, got {name!r}")
    return f"{text} world" if is_reserved(text) else text


def free_name(wanted: str, taken: set[str]) -> str:
    """Return a name that is not taken, with the lowest number appended if necessary.

    The comparison ignores case.

    Example:
        >>> free_name("Room", {"room", "Room (2)"})
        'Room (3)'
    """
    known = {name.casefold() for name in taken}
    number, name = 1, wanted
    while name.casefold() in known:
        number += 1
        name = f"{wanted} ({number})"
    return name


def is_text(text: str) -> bool:
    """Return whether a string can be written as UTF-8: names of files may be other bytes."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def readable_name(name: str) -> str:
    """Return a file name as text: U+FFFD stands for bytes that are not UTF-8."""
    return name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")

r"""Poses in file names: a template such as ``shot_{x}_{y}_{z}_{yaw}_{pitch}``, or a plain regex.

A template is safe whatever the names are. A regex has the named groups x, y, z, yaw and pitch; one
that could take very long on some name (nested repeats, many wild ones) is refused.
"""

import re
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from world2minecraft.core.errors import UsageError

NEEDED = ("x", "y", "z", "yaw", "pitch")
USUAL = ("*{x}_{y}_{z}_{yaw}_{pitch}", "*{x},{y},{z},{yaw},{pitch}", "*{x} {y} {z} {yaw} {pitch}")
MOST_NAME = 255  # Letters, as most file systems have it.
MOST_PATTERN = 400
MOST_WILD = 2  # Repeats of nearly anything: the time grows with the power of their number.
NUMBER = r"[-+]?\d{1,9}(?:\.\d{1,9})?"
_WHOLE = r"(?:(?<![\d.])|(?=[-+]))"  # Behind anything a number begins, and does not go on.
_EXAMPLE = "{x}_{y}_{z}_{yaw}_{pitch}"


class NamePattern:
    """What reads a pose out of a file's name, without its suffix."""

    def __init__(self, text: str):
        """Check a pattern. Raises UsageError."""
        self.text = text
        if len(text) > MOST_PATTERN:
            raise UsageError(f"a pattern has up to {MOST_PATTERN} letters, not {len(text)}")
        self._compiled = re.compile(_regex(text) if "(?P<" in text else _of_template(text))
        missing = [name for name in NEEDED if name not in self._compiled.groupindex]
        if missing:
            raise UsageError(
                f"pattern {text!r} has no {missing[0]}; it needs all of {_EXAMPLE}, in any order"
            )

    def read(self, stem: str) -> dict[str, float] | None:
        """Return x, y, z, yaw and pitch of a name; None where it does not match."""
        if len(stem) > MOST_NAME or (found := self._compiled.fullmatch(stem)) is None:
            return None
        try:
            return {name: float(found[name]) for name in NEEDED}
        except (TypeError, ValueError):  # A group that took part in no match, or no number.
            return None


def _of_template(text: str) -> str:
    """Return the regex of a template. Raises UsageError."""
    if text.count("*") > MOST_WILD:
        raise UsageError(f"pattern {text!r} has more than {MOST_WILD} *")
    parts, known, before = [], set(), ""
    for part in filter(None, re.split(r"(\{[^{}]*\}|\*)", text)):
        if part == "*":
            parts.append(".*?")
        elif part.startswith("{") and part.endswith("}"):
            name = part[1:-1]
            if name not in NEEDED:
                raise UsageError(f"pattern {text!r} has {part}; it knows {', '.join(NEEDED)} and *")
            if name in known:
                raise UsageError(f"pattern {text!r} has {part} twice")
            if before.startswith("{"):
                raise UsageError(f"pattern {text!r} needs something between two numbers")
            known.add(name)
            parts.append(_WHOLE * (before == "*") + f"(?P<{name}>{NUMBER})")
        else:
            parts.append(re.escape(part))
        before = part
    return "".join(parts)


def _regex(text: str) -> str:
    """Return a regex as it is, when it is quick on every name. Raises UsageError."""
    try:
        tree = import_module("re._parser").parse(text)
    except (re.error, RecursionError, OverflowError) as error:
        raise UsageError(f"pattern {text!r} is no regex ({error}); try {_EXAMPLE}") from error
    found = list(_items(tree))
    names = [name for name, _, _ in found]
    if any("ASSERT" in name or name.startswith(("GROUPREF", "BRANCH")) for name in names):
        raise UsageError(f"pattern {text!r} looks ahead or back, or branches; try {_EXAMPLE}")
    if any(inside for name, inside, _ in found if name == "REPEAT"):
        raise UsageError(f"pattern {text!r} has a repeat within a repeat; try {_EXAMPLE}")
    wild = sum(is_wild for name, _, is_wild in found if name == "REPEAT")
    if wild > MOST_WILD:
        raise UsageError(f"pattern {text!r} has {wild} repeats of anything; try {_EXAMPLE}")
    return text


def _items(tree: Any, inside: bool = False) -> Iterator[tuple[str, bool, bool]]:
    """Give what a parsed regex is made of: its name, whether it is repeated, whether it is wild."""
    for code, value in tree:
        name = str(code)
        if name.endswith("_REPEAT"):
            _, most, body = value
            is_many = int(most) > 1
            if is_many:
                yield "REPEAT", inside, _is_wild(body)
            yield from _items(body, inside or is_many)
        elif name == "SUBPATTERN":
            yield from _items(value[-1], inside)
        elif name == "ATOMIC_GROUP":
            yield from _items(value, inside)
        else:
            yield name, inside, False


def _is_wild(body: Any) -> bool:
    """Whether what is repeated takes more than figures, dots and signs."""
    if len(body) != 1:
        return True
    code, value = body[0]
    if str(code) == "LITERAL":
        return False
    return str(code) != "IN" or not all(_is_numeric(str(kind), told) for kind, told in value)


def _is_numeric(kind: str, told: Any) -> bool:
    """Whether a part of a set is of figures, dots or signs."""
    if kind == "LITERAL":
        return chr(told) in "+-.0123456789"
    if kind == "RANGE":
        return ord("0") <= told[0] and told[1] <= ord("9")
    return kind == "CATEGORY" and str(told) == "CATEGORY_DIGIT"

"""Parsing of NBT in text form (SNBT), as used in commands. ``commands.writer`` writes it."""

import re
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.nbt import Byte, Float, Long, Short

MAX_DEPTH = 100
MAX_SHOWN = 40
MAX_VALUES = 500_000  # As of a file of NBT.
_SPACE = re.compile(r"\s*")
_WORD = re.compile(r"[A-Za-z0-9_.+-]+")
_QUOTED = {mark: re.compile(rf"(?:[^{mark}\\]|\\.)*{mark}", re.DOTALL) for mark in "\"'"}
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)([bBsSlLfFdD]?)")
_WHOLE = re.compile(r"[+-]?\d+")
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_WHOLE_KINDS: dict[str, Any] = {"b": (Byte, 8), "s": (Short, 16), "l": (Long, 64), "": (int, 32)}
_ARRAYS = {"B": np.int8, "I": np.int32, "L": np.int64}


class SnbtReader:
    """An SNBT parser with a limit on the total number of values that it reads."""

    def __init__(self, values: int = MAX_VALUES) -> None:
        self.values_left = values

    def read(self, text: str) -> tuple[Any, int]:
        r"""Parse the SNBT value at the start of a text.

        Returns:
            The value, with types as in ``minecraft.nbt``, and the offset after its end.

        Raises:
            UsageError: If the text is not valid SNBT, nests deeper than 100 tags or contains too
                many values.

        Example:
            >>> SnbtReader().read('{Count:3b, list:[1.5f, 2f], "name":\'my room\'}')[0]
            {'Count': 3, 'list': [1.5, 2.0], 'name': 'my room'}
        """
        return self._value(text, 0, 0)

    def _value(self, text: str, at: int, depth: int) -> tuple[Any, int]:
        self.values_left -= 1
        if self.values_left < 0:
            raise UsageError(f"SNBT text exceeds the limit of {MAX_VALUES:,} values")
        if depth > MAX_DEPTH:
            raise UsageError(f"SNBT text exceeds the limit of {MAX_DEPTH} nested tags")
        at = _skip(text, at)
        first = text[at : at + 1]
        if first == "{":
            return self._compound(text, at + 1, depth)
        if first == "[":
            return self._items(text, at + 1, depth)
        if first in _QUOTED and first:
            return _quoted(text, at)
        word = _WORD.match(text, at)
        if word is None:
            raise _unreadable(text, at, "a value")
        return _plain(word[0]), word.end()

    def _compound(self, text: str, at: int, depth: int) -> tuple[dict[str, Any], int]:
        result: dict[str, Any] = {}
        at = _skip(text, at)
        while text[at : at + 1] != "}":
            key, at = _key(text, at)
            at = _expect(text, at, ":")
            result[key], at = self._value(text, at, depth + 1)
            at = _skip(text, at)
            if text[at : at + 1] != "}":
                at = _skip(text, _expect(text, at, ","))
        return result, at + 1

    def _items(self, text: str, at: int, depth: int) -> tuple[Any, int]:
        kind = text[at : at + 1]
        if kind in _ARRAYS and text[at + 1 : at + 2] == ";":
            values, at = self._items(text, at + 2, depth)
            return _array(values, _ARRAYS[kind]), at
        result = []
        at = _skip(text, at)
        while text[at : at + 1] != "]":
            value, at = self._value(text, at, depth + 1)
            result.append(value)
            at = _skip(text, at)
            if text[at : at + 1] != "]":
                at = _skip(text, _expect(text, at, ","))
        return result, at + 1


def _array(values: Any, kind: type) -> np.ndarray:
    try:
        return np.array(values, kind).reshape(-1)
    except (ValueError, TypeError, OverflowError) as error:
        raise UsageError(f"SNBT array contains a value that is not an integer: {error}") from error


def _key(text: str, at: int) -> tuple[str, int]:
    if text[at : at + 1] in ('"', "'"):
        return _quoted(text, at)
    word = _WORD.match(text, at)
    if word is None:
        raise _unreadable(text, at, "a name")
    return word[0], word.end()


def _quoted(text: str, at: int) -> tuple[str, int]:
    found = _QUOTED[text[at]].match(text, at + 1)
    if found is None:
        raise _unreadable(text, at, "a closing quote")
    return _ESCAPE.sub(r"\1", found[0][:-1]), found.end()


def _plain(word: str) -> Any:
    """Return the value of an unquoted word: a number, a boolean or a string."""
    if word in ("true", "false"):
        return Byte(word == "true")
    number = _NUMBER.fullmatch(word)
    if number is None:
        return word
    digits, suffix = number[1], number[2].lower()
    if suffix in _WHOLE_KINDS and _WHOLE.fullmatch(digits):
        kind, bits = _WHOLE_KINDS[suffix]
        value = int(digits[:30])
        return kind(value) if -(1 << bits - 1) <= value < 1 << bits - 1 else word
    if suffix == "f":
        return Float(digits)
    return float(digits) if suffix in ("d", "") else word


def _skip(text: str, at: int) -> int:
    found = _SPACE.match(text, at)
    return found.end() if found else at


def _expect(text: str, at: int, mark: str) -> int:
    at = _skip(text, at)
    if text[at : at + 1] != mark:
        raise _unreadable(text, at, repr(mark))
    return at + 1


def _unreadable(text: str, at: int, wanted: str) -> UsageError:
    found = repr(text[at : at + MAX_SHOWN]) if text[at:] else "the end of the text"
    return UsageError(f"invalid SNBT text: expected {wanted}, got {found}")

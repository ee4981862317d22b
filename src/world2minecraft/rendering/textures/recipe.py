"""Texture recipes: the names of the built-in textures, which describe how they are painted.

The form is ``own:GENERATOR#rrggbb[,#rrggbb...][?key=value&key=value]``. The first colour is the
mean of the texture, further colours are its accents, and the options are those of the generator.
"""

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UnknownNameError, UsageError

PREFIX = "own:"
MAX_LENGTH = 400  # A longer recipe is a mistake or a trap.
COLOUR = re.compile("#[0-9a-f]{6}")
EXAMPLE = "own:planks#a2824e?boards=4"


@dataclass(frozen=True)
class Number:
    """An option whose value is a number from ``low`` to ``high``."""

    default: float
    low: float
    high: float

    def read(self, text: str) -> float:
        """Parse the number.

        Raises:
            ValueError: If the number is invalid. The message states the valid range.
        """
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not self.low <= value <= self.high:
            raise ValueError(f"a number from {self.low:g} to {self.high:g}")
        return value

    def __str__(self) -> str:
        return f"{self.low:g} to {self.high:g} ({self.default:g})"


@dataclass(frozen=True)
class Choice:
    """An option whose value is one of several words, of which the first is the default."""

    words: tuple[str, ...]

    @property
    def default(self) -> str:
        """The first word."""
        return self.words[0]

    def read(self, text: str) -> str:
        """Check the word and return it.

        Raises:
            ValueError: If the word is invalid. The message lists the valid words.
        """
        if text not in self.words:
            raise ValueError(f"one of {', '.join(self.words)}")
        return text

    def __str__(self) -> str:
        return ", ".join(self.words)


Option = Number | Choice


@dataclass(frozen=True)
class Recipe:
    """A parsed recipe with all accents and options, including defaults.

    ``colours`` are sRGB, 0 to 255, of which the first is the mean. ``text`` is the canonical name.
    """

    generator: str
    colours: tuple[tuple[int, int, int], ...]
    options: Mapping[str, float | str]
    text: str

    @property
    def seed(self) -> int:
        """The random seed: 64 bits of the SHA-256 of the name."""
        return int.from_bytes(hashlib.sha256(self.text.encode()).digest()[:8], "little")

    def ink(self, index: int) -> np.ndarray:
        """Return a colour, float64 [3]: index 0 is the mean, the others are the accents."""
        return np.array(self.colours[index], np.float64)

    def number(self, key: str) -> float:
        """Return an option as a number."""
        return float(self.options[key])

    def word(self, key: str) -> str:
        """Return an option as a word."""
        return str(self.options[key])


def split_recipe(text: str) -> tuple[str, tuple[str, ...], dict[str, str]]:
    """Return the generator, the colours and the options of a recipe as text.

    Raises:
        UsageError: If the text is not a valid recipe.
    """
    if len(text) > MAX_LENGTH or not text.startswith(PREFIX):
        raise UsageError(f"invalid texture recipe {text[:60]!r}; use the form {EXAMPLE}")
    head, mark, tail = text[len(PREFIX) :].partition("?")
    generator, hash_mark, colours = head.partition("#")
    inks = tuple((hash_mark + colours).lower().split(","))
    bad = next((ink for ink in inks if not COLOUR.fullmatch(ink)), None)
    if bad is not None:
        raise UsageError(f"{text}: invalid colour {bad!r}; use #rrggbb as in {EXAMPLE}")
    options: dict[str, str] = {}
    for part in tail.split("&") if mark else ():
        key, equals, value = part.partition("=")
        if not (key and equals and value) or key in options:
            raise UsageError(
                f"{text}: invalid option {part!r}; use key=value and each key only once"
            )
        options[key] = value
    return generator, inks, options


def join_recipe(generator: str, colours: tuple[str, ...], options: Mapping[str, str]) -> str:
    """Return the canonical recipe text, with lower-case colours and sorted keys."""
    tail = "&".join(f"{key}={options[key]}" for key in sorted(options))
    return PREFIX + generator + ",".join(colours).lower() + ("?" + tail if tail else "")


def read_options(
    text: str, generator: str, given: Mapping[str, str], known: Mapping[str, Option]
) -> dict[str, float | str]:
    """Return all options of a generator, with defaults for options that are not given.

    Raises:
        UnknownNameError: If the generator has no such option.
        UsageError: If the value of an option is invalid.
    """
    values: dict[str, float | str] = {key: option.default for key, option in known.items()}
    for key, value in given.items():
        if key not in known:
            raise UnknownNameError(f"option of texture {generator!r}", key, known)
        try:
            values[key] = known[key].read(value)
        except ValueError as fault:
            raise UsageError(f"{text}: {key} must be {fault}, got {value!r}") from None
    return values


def rgb_of(colour: str) -> tuple[int, int, int]:
    """Return the sRGB values of ``#rrggbb``."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)

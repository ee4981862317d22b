"""Griffe extension that converts docstrings to Markdown.

Examples (``>>> ...``) become code instead of nested quotations. Exceptions, which docstrings list
in one text, and arguments that are described together become one list item each.
"""

import re
from collections.abc import Iterator
from typing import Any

import griffe

RAISES = re.compile(r"^Raises:\n((?:[ ]{4}.*\n?|\n(?=[ ]{4}))+)", re.MULTILINE)
ARGS = re.compile(r"^Args:\n((?:[ ]{4}.*\n?|\n(?=[ ]{4}))+)", re.MULTILINE)
TOGETHER = re.compile(r"^[ ]{4}(\w+(?:, \w+)+)(: .*\n?(?:[ ]{8}.*\n?)*)", re.MULTILINE)
SHAPE = re.compile(r"(?<= )(\[\d+\]\[\d+\])")
NEXT_ERROR = re.compile(r"(?:^|(?<=[.;]) )(?=[A-Z]\w+: )")


class Docstrings(griffe.Extension):
    """Turn each docstring before it is parsed."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Turn the docstring of one object."""
        if obj.docstring:
            obj.docstring.value = as_markdown(obj.docstring.value)


def as_markdown(text: str) -> str:
    """Return a docstring with its examples fenced and its errors apart."""
    split = RAISES.sub(lambda found: "Raises:\n" + _apart(found[1]), text)
    split = ARGS.sub(lambda found: "Args:\n" + TOGETHER.sub(_each, found[1]), split)
    literal = SHAPE.sub(r"`\1`", split)  # Which Markdown takes for a link.
    literal = re.sub(r"::\n\n(?=[ ]{4})", ":\n\n", literal)
    return "\n".join(_fenced(literal.splitlines()))


def _apart(errors: str) -> str:
    running = " ".join(line.strip() for line in errors.splitlines() if line.strip())
    return "".join(f"    {one.strip()}\n" for one in NEXT_ERROR.split(running) if one.strip())


def _each(told: re.Match[str]) -> str:
    words = told[2] if told[2].endswith("\n") else f"{told[2]}\n"
    return "".join(f"    {name}{words}" for name in told[1].split(", "))


def _fenced(lines: list[str]) -> Iterator[str]:
    """Yield the lines, with a fence around each run of examples and what they print."""
    margin = None
    for line in [*lines, ""]:
        if margin is None and line.lstrip().startswith(">>> "):
            margin = line[: len(line) - len(line.lstrip())]
            yield from ("", f"{margin}```pycon")
        elif margin is not None and not line.strip():
            yield f"{margin}```"
            margin = None
        yield line

"""MkDocs hook: the pages are written as GitHub reads them, and Python-Markdown wants a little more.

A list or a table may follow a sentence without an empty line, and lists inside lists may be
indented by two or three blanks: here the line is put in, and the blanks are made four.
"""

import re
from collections.abc import Iterator
from typing import Any

ITEM = re.compile(r"( *)(?:[-*]|\d+\.) ")


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Return a page as Python-Markdown reads it alike."""
    return "\n".join(_translated(markdown.split("\n")))


def _translated(lines: list[str]) -> Iterator[str]:
    in_code = in_list = False
    before = ""
    for line in lines:
        if line.lstrip().startswith("```"):
            in_code = not in_code
        elif not in_code:
            item = ITEM.match(line)
            begins_list = item and not in_list
            begins_table = line.startswith("|") and not before.startswith("|")
            if before.strip() and (begins_list or begins_table):
                yield ""
            # A list goes on over its own lines and empty ones, up to text at the margin.
            in_list = bool(item) or (in_list and (not line or line.startswith("  ")))
        before = line
        yield _deeper(line) if not in_code else line


def _deeper(line: str) -> str:
    item = ITEM.match(line)
    return f"    {line.lstrip()}" if item and 1 < len(item[1]) < 4 else line

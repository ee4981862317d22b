"""MkDocs hook: a page that ``nav`` does not name goes to the end of the section of its folder."""

from collections.abc import Iterator
from typing import Any

SECTIONS = {
    "tutorials": "Tutorials",
    "how-to": "How-to guides",
    "reference": "Reference",
    "explanation": "Explanation",
    "results": "Results",
}


def on_files(files: Any, config: Any) -> Any:
    """Add to the navigation the pages of ``docs`` that it does not name."""
    named = set(_pages(config.nav))
    for page in sorted(file.src_uri for file in files.documentation_pages()):
        if page not in named and page.partition("/")[0] in SECTIONS:
            _place(config.nav, page)
    return files


def _place(nav: list[Any], page: str) -> None:
    section = SECTIONS[page.partition("/")[0]]
    (entries,) = [entry[section] for entry in nav if section in entry]
    entries.append(page)


def _pages(entries: list[Any]) -> Iterator[str]:
    """Yield the pages that a list of entries and all lists in it name."""
    for entry in entries:
        if isinstance(entry, str):
            yield entry
        else:
            for value in entry.values():
                yield from _pages([value] if isinstance(value, str) else value)

"""MkDocs hook: a page that ``nav`` does not name still has its place, after those like it.

``vln-server.md`` follows the last page of ``nav`` whose name begins with ``vln-``; a page without
its like goes to the end of the section ``Reference``. A line in ``mkdocs.yml`` gives a better one.
"""

from typing import Any

REST = "Reference"


def on_files(files: Any, config: Any) -> Any:
    """Add to the navigation whatever lies in ``docs`` and is not named there."""
    named = set(_pages(config.nav))
    for page in sorted(file.src_uri for file in files.documentation_pages()):
        if page not in named and "/" not in page:
            _place(config.nav, page)
    return files


def _place(nav: list[Any], page: str) -> None:
    """Put a page after the last one of its kind, or at the end of the rest."""
    kind = page.partition("-")[0] + "-"
    lists = [entries for entries in _lists(nav) if any(_is_like(one, kind) for one in entries)]
    if "-" in page and lists:
        entries = lists[-1]
        last = max(index for index, one in enumerate(entries) if _is_like(one, kind))
        entries.insert(last + 1, page)
        return
    (rest,) = [entry[REST] for entry in nav if isinstance(entry, dict) and REST in entry]
    rest.append(page)


def _is_like(entry: Any, kind: str) -> bool:
    return isinstance(entry, str) and entry.startswith(kind)


def _lists(entries: list[Any]) -> list[list[Any]]:
    """Return a list of entries and all lists in it."""
    inner = [value for one in entries if isinstance(one, dict) for value in one.values()]
    return [entries, *(found for one in inner if isinstance(one, list) for found in _lists(one))]


def _pages(entries: list[Any]) -> list[str]:
    flat = [one for found in _lists(entries) for one in found]
    titled = [value for one in flat if isinstance(one, dict) for value in one.values()]
    return [one for one in [*flat, *titled] if isinstance(one, str)]

"""MkDocs hook: the site takes from the repository's own pages what they say already.

``README.md`` stays the front door: a line ``<!-- README: Try it -->`` in a page is replaced by the
README's section of that name, and ``<!-- README -->`` by what it says before its first section.
``CONTRIBUTING.md``, ``CHANGELOG.md`` and the cards of the shipped networks become pages of the site
as they are. Links are turned to where the files lie in the site.
"""

import re
from pathlib import Path
from typing import Any

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

ROOT = Path(__file__).parents[2]
CARDS = ROOT / "src" / "world2minecraft" / "weights"
# Where a page of the repository's root stands in the site.
PAGES = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changes.md"}
CARD_FOLDER = "reference"
CARD_LINK = re.compile(r"\]\((?:\.\./)+src/world2minecraft/weights/(\w+)\.md")
SLOT = re.compile(r"^<!-- README(?:: (.+?))? -->$", re.MULTILINE)


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that lie outside ``docs``."""
    for name, page in PAGES.items():
        text = _in_the_site((ROOT / name).read_text("utf-8"), page)
        files.append(File.generated(config, page, content=text))
    for card in sorted(CARDS.glob("*.md")):
        page = f"{CARD_FOLDER}/network-{card.stem}.md"
        text = _in_the_site(card.read_text("utf-8"), page)
        files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Fill a page's slots from the README, and turn its links."""
    readme = (ROOT / "README.md").read_text("utf-8")
    place = page.file.src_uri
    up = "../" * place.count("/")
    filled = SLOT.sub(lambda slot: _in_the_site(section(readme, slot[1]), place), markdown)
    for name, target in PAGES.items():
        filled = filled.replace(f"]({up}../{name}", f"]({up}{target}")
    return CARD_LINK.sub(rf"]({up}{CARD_FOLDER}/network-\1.md", filled)


def section(text: str, title: str | None) -> str:
    """Return the body of a section, or what stands between the title and the first section.

    Raises:
        PluginError: there is no such section.
    """
    head, *rest = re.split(r"^## +(.+)$", text, flags=re.MULTILINE)
    if title is None:
        return head.partition("\n")[2].strip()
    bodies = dict(zip(rest[::2], rest[1::2], strict=True))
    if title not in bodies:
        raise PluginError(f"README.md has no section {title!r}; it has {', '.join(bodies)}")
    return bodies[title].strip()


def _in_the_site(text: str, place: str) -> str:
    """Return a text of the repository's root with the links of a page at ``place`` in the site."""
    up = "../" * place.count("/")
    text = re.sub(r"\]\((?:\.\./)*docs/", f"]({up}", text)
    for name, page in PAGES.items():
        text = text.replace(f"]({name}", f"]({up}{page}")
    return text

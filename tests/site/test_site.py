"""The site of the docs: every page has its place, nothing is written twice, no link is dead."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from world2minecraft.cli.verbs import VERBS

ROOT = Path(__file__).resolve().parents[2]
CARDS = (ROOT / "src" / "world2minecraft" / "weights").glob("*.md")
GENERATED = {"reference/verbs.md", "results/benchmarks.md", "contributing.md", "changes.md"}
GENERATED |= {f"reference/network-{card.stem}.md" for card in CARDS}


class _Loader(yaml.SafeLoader):
    """Reads mkdocs.yml without making what it names of Python."""


_Loader.add_multi_constructor("tag:yaml.org,2002:python/name:", lambda *_: None)


def nav_pages(entries):
    for entry in entries:
        if isinstance(entry, str):
            yield entry
        else:
            for value in entry.values():
                yield from nav_pages([value] if isinstance(value, str) else value)


def test_what_the_navigation_names_is_there_and_named_once():
    config = yaml.load((ROOT / "mkdocs.yml").read_text(), _Loader)
    named = list(nav_pages(config["nav"]))
    pages = {path.relative_to(ROOT / "docs").as_posix() for path in ROOT.glob("docs/**/*.md")}
    assert len(named) == len(set(named))
    assert not set(named) - pages - GENERATED
    assert set(named) >= GENERATED


def test_the_front_page_links_each_task():
    front = (ROOT / "docs" / "index.md").read_text()
    linked = set(re.findall(r"\]\((how-to/[\w.-]+\.md)\)", front))
    tasks = {f"how-to/{path.name}" for path in ROOT.glob("docs/how-to/*.md")}
    assert tasks and not tasks ^ linked


def test_each_picture_of_the_docs_is_shown_somewhere():
    texts = [path.read_text() for path in [*ROOT.glob("docs/**/*.md"), ROOT / "README.md"]]
    texts += [(ROOT / "mkdocs.yml").read_text()]
    texts += [path.read_text() for path in ROOT.glob("docs/**/*.css")]
    pictures = [path for path in (ROOT / "docs" / "images").rglob("*") if path.is_file()]
    assert pictures
    assert not [one.name for one in pictures if not any(one.name in text for text in texts)]


def test_a_site_without_a_warning_holds_all_of_it(tmp_path):
    pytest.importorskip("material", reason="the docs extra is not installed")
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    built = subprocess.run(words, check=False, cwd=ROOT, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr[-4000:]
    front = (tmp_path / "index.html").read_text()
    sentence = re.search(r"Real rooms become [^.]+\.", (ROOT / "README.md").read_text())[0]
    assert sentence in front and "<!-- README" not in front
    verbs = (tmp_path / "reference" / "verbs.html").read_text()
    assert all(f'id="{verb.replace(" ", "-")}"' in verbs for verb in VERBS)
    api = (tmp_path / "api" / "reconstruction.fusion.html").read_text()
    assert 'id="world2minecraft.reconstruction.fusion.extract_grid.extract_grid"' in api
    assert (tmp_path / "api" / "navigation.environment.html").is_file()

"""What the site takes from elsewhere: sections of the README, docstrings, the verbs' help."""

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

pytest.importorskip("mkdocs", reason="the docs extra is not installed")
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools" / "site"))

import dialect
import docstrings
import measuring
import modules
import places
import readme
import verbs
from mkdocs.exceptions import PluginError

README = "# Name\n\nHead [a](docs/a.md).\n\n## One\n\ntext\n\n### Part\n\n## Two\nlast\n"


def test_a_section_ends_where_the_next_begins():
    assert readme.section(README, "One") == "text\n\n### Part"
    assert readme.section(README, "Two") == "last"
    assert readme.section(README, None) == "Head [a](docs/a.md)."


def test_a_section_that_is_not_there_is_told():
    with pytest.raises(PluginError, match=r"README.md has no section 'Three'; it has One, Two"):
        readme.section(README, "Three")


def test_links_of_the_root_are_turned():
    text = "[a](docs/a.md#b) ![p](docs/images/p.png) [c](CONTRIBUTING.md#x) [d](https://d/docs/)"
    turned = "[a](a.md#b) ![p](images/p.png) [c](contributing.md#x) [d](https://d/docs/)"
    assert readme._in_the_site(text, "index.md") == turned
    deeper = readme._in_the_site(text, "reference/a.md")
    assert deeper.startswith("[a](../a.md#b) ![p](../images/p.png) [c](../contributing.md#x)")


def test_links_out_of_the_docs_lead_to_pages_of_the_site():
    page = SimpleNamespace(file=SimpleNamespace(src_uri="how-to/a.md"))
    text = "[a](../../CHANGELOG.md#x) [b](../../src/world2minecraft/weights/mono.md)"
    turned = "[a](../changes.md#x) [b](../reference/network-mono.md)"
    assert readme.on_page_markdown(text, page=page) == turned


def test_examples_of_a_docstring_are_fenced():
    text = "Add.\n\n>>> add(1, 2)\n3\n>>> add(\n...     0, 0)\n0\n\nMore."
    fenced = "```pycon\n>>> add(1, 2)\n3\n>>> add(\n...     0, 0)\n0\n```\n\nMore."
    assert docstrings.as_markdown(text).startswith(f"Add.\n\n\n{fenced}")


def test_errors_of_a_docstring_stand_apart():
    text = "Read.\n\nRaises:\n    InputError: it is no file. LimitError: it is\n    too large.\n"
    apart = "Raises:\n    InputError: it is no file.\n    LimitError: it is too large.\n"
    assert apart in docstrings.as_markdown(text)


def test_arguments_that_are_told_together_stand_apart():
    text = "Do.\n\nArgs:\n    one: a, b: c.\n    two, three: as there,\n        too.\n    four: d."
    read = docstrings.as_markdown(text)
    assert read.startswith("Do.\n\nArgs:\n    one: a, b: c.\n    two: as there,\n        too.\n")
    assert "    three: as there,\n        too.\n    four: d." in read


def test_shapes_are_no_links():
    assert docstrings.as_markdown("the pose [4][4], a[0][1]") == "the pose `[4][4]`, a[0][1]\n"


def test_a_page_of_a_package_names_its_public_modules():
    page = modules._page("reconstruction.fusion", modules.SOURCE / "reconstruction" / "fusion")
    assert "::: world2minecraft.reconstruction.fusion.extract_grid\n" in page
    assert "fusion.__init__" not in page


def test_a_benchmark_stands_with_its_command():
    text = measuring.text()
    assert "`python -m benchmarks --only render`" in text
    assert "`python -m benchmarks.check_faithful`" in text
    assert "### rows" not in text


def test_a_verb_stands_with_its_examples():
    text = verbs.text()
    assert "## w2m rooms scan { #rooms-scan }" in text
    assert "w2m rooms scan --seed 7 --sensor photos -o photos" in text


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ("Words:\n- a\n- b\n\nMore", "Words:\n\n- a\n- b\n\nMore"),
        ("Words:\n| a |\n|---|\n| b |", "Words:\n\n| a |\n|---|\n| b |"),
        ("- a\n  - b\n  goes on\n- c", "- a\n    - b\n  goes on\n- c"),
        ("1. a\n   - b", "1. a\n    - b"),
        ("```\nx\n- a\n```\n- b", "```\nx\n- a\n```\n\n- b"),
        ("Words - and\nmore - words", "Words - and\nmore - words"),
    ],
)
def test_lists_and_tables_are_read_as_github_reads_them(written, read):
    assert dialect.on_page_markdown(written) == read


def test_a_page_without_a_line_goes_to_the_section_of_its_folder():
    nav = [{"Home": "index.md"}, {"How-to guides": [{"Deep": "how-to/a.md"}]}, {"Reference": []}]
    for page in ("how-to/b.md", "reference/c.md"):
        places._place(nav, page)
    assert nav[1] == {"How-to guides": [{"Deep": "how-to/a.md"}, "how-to/b.md"]}
    assert nav[2] == {"Reference": ["reference/c.md"]}
    assert set(places._pages(nav)) == {"index.md", "how-to/a.md", "how-to/b.md", "reference/c.md"}

"""The tables of docs/reference/furniture-library.md are the library's."""

from pathlib import Path

from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.furniture.library import templates_to_markdown

PAGES = Path(__file__).resolve().parents[2] / "docs" / "reference"
PAGE = PAGES / "furniture.md"


def test_each_template_has_its_row():
    """A design that was changed or added: see the command in the page."""
    told = (PAGES / "furniture-library.md").read_text("utf-8").partition("\n### ")[2]
    assert f"### {told}" == templates_to_markdown(template(name) for name in TEMPLATES.names())


def test_the_example_of_the_page_is_a_sound_template():
    from world2minecraft.furniture import check_template

    pieces = PAGE.read_text("utf-8").split("```python\n")[2:]
    scope: dict = {}
    exec("\n".join(piece.partition("```")[0] for piece in pieces), scope)
    assert check_template(scope["TEMPLATE"]) == ()

"""The table of docs/furniture.md is the library's."""

from pathlib import Path

from world2minecraft.classes import CLASS_NAMES
from world2minecraft.furniture import TEMPLATES, Span, template

PAGE = Path(__file__).resolve().parents[2] / "docs" / "furniture.md"


def _span(span: Span) -> str:
    return f"{span.minimum:g} · **{span.typical:g}** · {span.maximum:g}"


def _row(name: str) -> str:
    one = template(name)
    sizes = [_span(span) for span in one.size_m]
    known = ", ".join(f"{key} {_span(span)}" for key, span in one.parameters.items()) or "none"
    kind = CLASS_NAMES[one.class_id]
    cells = [name, kind, *sizes, str(one.turns), one.mount, known]
    return f"| {' | '.join(cells)} |"


def test_each_template_has_its_row():
    rows = [line for line in PAGE.read_text().splitlines() if line.startswith("| ")][1:]
    assert rows == [_row(name) for name in TEMPLATES.names()]


def test_the_example_of_the_page_is_a_sound_template():
    from world2minecraft.furniture import check_template

    text = PAGE.read_text().split("```python\n")[2].split("   ```")[0]
    scope: dict = {}
    exec("\n".join(line.removeprefix("   ") for line in text.splitlines()), scope)
    assert check_template(scope["TEMPLATE"]) == ()

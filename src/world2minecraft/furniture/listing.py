"""The library as a table for people, by class: what docs/furniture-library.md shows."""

from collections.abc import Iterable

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.furniture.template import Span, Template

HEADINGS = {
    "chair": "Chairs",
    "bed": "Beds",
    "sofa": "Sofas",
    "table": "Tables",
    "tvs": "Screens",
    "furn": "Cupboards, kitchen and bath",
    "objs": "Lamps, plants, curtains and small things",
}
COLUMNS = ("name", "title", "family", "depth", "width", "height", "turns", "mount", "parameters")


def by_class(templates: Iterable[Template]) -> dict[str, list[Template]]:
    """Return templates under the heading of their class, classes in order, none empty."""
    every = list(templates)
    found = {
        HEADINGS[CLASS_NAMES[number]]: [one for one in every if one.class_id == number]
        for number in OBJECT_CLASSES
    }
    return {heading: members for heading, members in found.items() if members}


def markdown(templates: Iterable[Template]) -> str:
    """Return a table a class in Markdown: a row a template, with a star where it is matched."""
    tables = []
    for heading, members in by_class(templates).items():
        rows = [_row(COLUMNS), _row(["---"] * len(COLUMNS)), *map(row_of, members)]
        tables.append("\n".join([f"### {heading}", "", *rows]))
    return "\n\n".join(tables) + "\n"


def row_of(one: Template) -> str:
    """Return a template's row: smallest, usual and largest sizes in metres, and what else."""
    sizes = [_span(span) for span in one.size_m]
    known = ", ".join(f"{name} {_span(span)}" for name, span in one.parameters.items()) or "none"
    name = f"{one.name} \\*" if one.matched else one.name
    return _row([name, one.title, one.family, *sizes, str(one.turns), one.mount, known])


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _span(span: Span) -> str:
    if span.minimum == span.maximum:
        return f"{span.typical:g}"
    return f"{span.minimum:g} · **{span.typical:g}** · {span.maximum:g}"

"""The furniture library L of the paper: templates by name, and the library as a table.

A template is a data file in ``designs/``, a file of the user, or a ``Template`` of another package
that is registered in the entry point group ``world2minecraft.template``. Objects are only matched
against templates with ``matched``; other templates of the family are chosen after the match.
docs/reference/furniture-library.md contains the table, by class.
"""

from collections.abc import Iterable, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.registry import Registry
from world2minecraft.furniture.design_files import read_design
from world2minecraft.furniture.template import Span, Template
from world2minecraft.furniture.user_library import read_user_design, user_design_files

HEADINGS = {
    "chair": "Chairs",
    "bed": "Beds",
    "sofa": "Sofas",
    "table": "Tables",
    "tvs": "Screens",
    "furn": "Cupboards, kitchen and bath",
    "objs": "Lamps, plants, curtains and small things",
}
COLUMNS = ("family", "designs", "depth/width/height", "place")
# Of templates that match equally well the first is taken: the plainer one.
MATCH_ORDER = (
    "chair",
    "armchair",
    "office_chair",
    "stool",
    "single_bed",
    "double_bed",
    "bunk_bed",
    "sofa",
    "corner_sofa",
    "bench",
    "dining_table",
    "round_table",
    "desk",
    "coffee_table",
    "wall_tv",
    "monitor",
    "cabinet",
    "wall_cabinet",
    "counter",
    "bookcase",
    "wardrobe",
    "lamp",
    "plant",
    "box",
)


def group_by_class(templates: Iterable[Template]) -> dict[str, list[Template]]:
    """Group templates by the heading of their class, in class order without empty groups."""
    every = list(templates)
    found = {
        HEADINGS[CLASS_NAMES[number]]: [one for one in every if one.class_id == number]
        for number in OBJECT_CLASSES
    }
    return {heading: members for heading, members in found.items() if members}


def templates_to_markdown(templates: Iterable[Template]) -> str:
    """Return a Markdown table for each class, with a row per family, mount and quarter turns.

    Templates that objects are matched against are marked with a star.
    """
    tables = []
    for heading, members in group_by_class(templates).items():
        alike: dict[tuple[str, str, int], list[Template]] = {}
        for one in members:
            alike.setdefault((one.family, one.mount, one.turns), []).append(one)
        rows = [_row(COLUMNS), _row(["---"] * len(COLUMNS)), *map(family_row, alike.values())]
        tables.append("\n".join([f"### {heading}", "", *rows]))
    return "\n\n".join(tables) + "\n"


def family_row(members: Sequence[Template]) -> str:
    """Return the row of designs that share family, mount and turns: names, and sizes in metres."""
    first = members[0]
    names = ", ".join(f"{one.name}\\*" if one.matched else one.name for one in members)
    sizes = "/".join(_range([one.size_m[axis] for one in members]) for axis in range(3))
    return _row([first.family, names, sizes, f"{first.mount}/{first.turns}"])


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _range(spans: Sequence[Span]) -> str:
    low, high = min(one.minimum for one in spans), max(one.maximum for one in spans)
    return f"{low:g}-{high:g}" if low < high else f"{low:g}"


class Library(Registry):
    """Templates by name: built-in designs, then user files and templates of other packages."""

    def __init__(self):
        super().__init__("template", {})

    def names(self) -> tuple[str, ...]:
        """All names: first the matched templates in order, then the others, sorted."""
        own = builtin_design_files()
        rest = sorted({*own, *user_design_files(), *super().names()} - set(MATCH_ORDER))
        return (*(name for name in MATCH_ORDER if name in own), *rest)

    def load(self, name: str) -> Template:
        """Return the template of a given name.

        Raises:
            UnknownNameError: If no template has this name.
            InputError: If its file is not a valid design.
        """
        if name in builtin_design_files():
            return read_design(builtin_design_files()[name])
        if name in user_design_files():
            return read_user_design(user_design_files()[name])
        return super().load(name)


@cache
def builtin_design_files() -> dict[str, Path]:
    """Return the design files of the library by name, sorted."""
    folder = Path(str(files("world2minecraft.furniture"))) / "designs"
    return {path.stem: path for path in sorted(folder.glob("*.json"))}


TEMPLATES = Library()


@cache
def template(name: str) -> Template:
    """Return the template of a given name.

    Raises:
        UnknownNameError: If no template has this name. The message suggests the closest name.
    """
    return TEMPLATES.load(name)


@cache
def templates_of_class(class_id: int) -> tuple[Template, ...]:
    """Return the templates that objects of a class are matched against, in library order."""
    every = (template(name) for name in TEMPLATES.names())
    return tuple(one for one in every if one.class_id == class_id and one.matched)


@cache
def variants_of(family: str) -> tuple[Template, ...]:
    """Return all templates of a family, in library order."""
    every = (template(name) for name in TEMPLATES.names())
    return tuple(one for one in every if one.family == family)
